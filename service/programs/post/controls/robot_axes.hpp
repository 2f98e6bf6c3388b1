// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/programs/post/axis_words.hpp"
#include "service/programs/post/post_options.hpp"

namespace meridian::post {

/// The arm's axes as its controller shows them: J1 first, degrees, rounded to kRotaryDecimals.
///
/// An axis is the joint whose `nc_word` is J1 to J6; "-J2" counts against the joint. `zero_deg` is
/// added; with `is_forearm_coupled` J3 shows joints two and three together.
class RobotAxes {
 public:
  /// Refused: joints that are not rotary, words other than J1, J2, ... without a gap, and Universal
  /// Robots' arms that have not six.
  [[nodiscard]] static Expected<RobotAxes, PostError> of(const MachineModel& model,
                                                         const AxisWords& words,
                                                         const PostOptions& options);

  /// What the controller shows where the drives are at `drives` (rad, as written).
  [[nodiscard]] std::array<double, kRobotAxes> shown_deg(const JointVector& drives) const;

  /// How far each axis turns from `from` to `to`, rad.
  [[nodiscard]] std::array<double, kRobotAxes> turned_rad(const JointVector& from,
                                                          const JointVector& to) const;

  [[nodiscard]] int count() const noexcept { return count_; }
  /// Highest speed of axis `k` (0 is J1), rad/s.
  [[nodiscard]] double velocity(int k) const noexcept { return velocity_[k]; }

 private:
  std::array<int, kRobotAxes> joint_{}, sign_{};
  std::array<double, kRobotAxes> velocity_{}, zero_deg_{};
  int count_ = 0;
  bool is_forearm_coupled_ = false;
};

}  // namespace meridian::post
