// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/scene/limit_shares.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::ros {

/// What follows from the rows of a recording: tip and axis, how fast they are, how near the joints
/// and drives come to their limits. What is not known is 0. Units: mm, rad, s. Frame: W. Proof:
/// tests/unit/ros/derived_row_test.cpp.
class DerivedRow {
 public:
  /// `model` must live on.
  explicit DerivedRow(const MachineModel& model) : model_(model), shares_(model) {}

  /// The next row.
  void add(const record::RecordingRow& row);

  /// With the tool that the model has in its spindle.
  [[nodiscard]] const Pose<double>& pose() const noexcept { return pose_; }
  [[nodiscard]] double feed_mm_per_s() const noexcept { return feed_mm_per_s_; }
  [[nodiscard]] double turn_rad_per_s() const noexcept { return turn_rad_per_s_; }
  /// The largest since forget_shares().
  [[nodiscard]] const scene::Shares& shares() const noexcept { return shares_.largest(); }
  void forget_shares() noexcept { shares_.clear(); }

 private:
  const MachineModel& model_;
  bool has_row_ = false;
  std::uint64_t cycle_ = 0;
  Pose<double> pose_{};
  double feed_mm_per_s_ = 0, turn_rad_per_s_ = 0;
  scene::LimitShares shares_;
};

}  // namespace meridian::ros
