// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "meridian/kinematics/joints.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::bridge {

/// What the groups of drives say, put together: the newest report of each joint. A report older
/// than 0.5 s counts for nothing. Proof: tests/unit/bridge/drive_positions_test.cpp.
class DrivePositions {
 public:
  explicit DrivePositions(int joint_count) : joint_count_(static_cast<std::size_t>(joint_count)) {}

  void add(const dds::DriveFeedback& feedback, std::int64_t now_ns) noexcept;
  /// Forgets what is too old.
  void pass(std::int64_t now_ns) noexcept;

  /// Drive coordinates, where every joint is reported.
  [[nodiscard]] std::optional<JointVector> all() const noexcept;
  /// 0: the joint is silent.
  [[nodiscard]] std::uint16_t statusword(std::size_t joint) const noexcept {
    return drives_[joint].statusword;
  }
  [[nodiscard]] std::uint16_t error(std::size_t joint) const noexcept {
    return drives_[joint].error;
  }

 private:
  struct Drive {
    bool is_known = false;
    double position = 0;
    std::uint16_t statusword = 0, error = 0;
    std::int64_t time_ns = 0;
  };
  std::size_t joint_count_;
  std::array<Drive, kMaxJoints> drives_{};
};

}  // namespace meridian::bridge
