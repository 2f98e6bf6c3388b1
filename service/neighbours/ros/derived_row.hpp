// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/recording/record/file/recording_reader.hpp"

namespace meridian::ros {

/// Share of the limit of velocity, acceleration and jerk; 1 is the limit.
using Shares = Limited<std::array<double, 3>>;

/// What follows from the rows of a recording: tip and axis, how fast they are, how near the joints
/// and drives come to their limits. Finite differences of one cycle after the other; a lost cycle
/// or a setpoint that the machine does not lead by breaks the row of them, and what is not known is
/// 0. Units: mm, rad, s. Frame: W. Proof: tests/unit/ros/derived_row_test.cpp.
class DerivedRow {
 public:
  /// `model` must live on.
  explicit DerivedRow(const MachineModel& model) : model_(model) {}

  /// The next row.
  void add(const record::RecordingRow& row);

  /// With the tool that the model has in its spindle.
  [[nodiscard]] const Pose<double>& pose() const noexcept { return pose_; }
  [[nodiscard]] double feed_mm_per_s() const noexcept { return feed_mm_per_s_; }
  [[nodiscard]] double turn_rad_per_s() const noexcept { return turn_rad_per_s_; }
  /// The largest since forget_shares().
  [[nodiscard]] const Shares& shares() const noexcept { return shares_; }
  void forget_shares() noexcept { shares_ = {}; }

 private:
  void differentiate(const record::RecordingRow& row);

  const MachineModel& model_;
  bool has_row_ = false;
  std::uint64_t cycle_ = 0;
  int known_ = 0;                          ///< differences that there are of the row before
  std::array<LimitedVector, 3> before_{};  ///< position, velocity, acceleration
  Pose<double> pose_{};
  double feed_mm_per_s_ = 0, turn_rad_per_s_ = 0;
  Shares shares_{};
};

}  // namespace meridian::ros
