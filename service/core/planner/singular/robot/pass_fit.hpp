// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/core/planner/singular/robot/robot_pass.hpp"

namespace meridian {

/// Lays the quintics of the redundant joints between the ends of a pass: they meet the exact path
/// with two derivatives, or the joint rests there. Bounded work, no memory. Proof:
/// tests/property/planner/singular_sweep_test.cpp.
class PassFit {
 public:
  PassFit(const PassTask& task, const PassRange& range) noexcept : task_(task), range_(range) {}

  /// Fills in the joints of `pass`, which has its ends and branches; one that rests behind it is
  /// turned by `rest_turn`. False: there is nothing to meet.
  [[nodiscard]] bool fit(RobotPass& pass, double rest_turn) noexcept;
  /// The joints at the begin of the pass that was fitted last.
  [[nodiscard]] const JointVector& reference() const noexcept { return reference_; }
  /// Whether the exact path behind that pass keeps travel, as far as the range goes.
  [[nodiscard]] bool leads_on(const RobotPass& pass) const noexcept;

 private:
  /// On the exact path at the begin, `reference` becomes the joints there.
  [[nodiscard]] bool fit_first(RobotPass& pass, double rest_turn,
                               JointVector& reference) const noexcept;
  /// Beside the yaw of `pass`, of which the roll is exact at both ends.
  [[nodiscard]] bool fit_roll(RobotPass& pass, const JointVector& reference) const noexcept;
  [[nodiscard]] double distance_at(Singularity at, double u) const noexcept;
  /// Inside both tolerances.
  [[nodiscard]] bool is_beside_both(double u) const noexcept;
  /// So near that the yaw may rest.
  [[nodiscard]] bool is_over_base(double u) const noexcept;
  [[nodiscard]] bool ends_with_range(const RobotPass& pass) const noexcept {
    return !(pass.end < range_.to);
  }
  /// The exact path at an end of a pass.
  [[nodiscard]] Solution<Jet<2>> exactly(double u, int branch,
                                         const JointVector& reference) const noexcept;
  /// At an end, 0 or 1, with the yaw of `pass` and the wrist exact.
  [[nodiscard]] Solution<Jet<3>> beside_yaw(const RobotPass& pass, double share, int branch,
                                            const JointVector& reference) const noexcept;
  /// `value`, or the winding of it inside travel.
  [[nodiscard]] double inside_travel(int joint, double value) const noexcept;

  /// A stretch of the exact path.
  struct Stretch {
    double from = 0, to = 0;
    int branch = 0;
    bool keeps_travel = false;
  };
  /// Follows the joints to its end; false: there are none there, or they leave travel.
  [[nodiscard]] bool follow(const Stretch& stretch, JointVector& joints) const noexcept;

  const PassTask& task_;
  const PassRange& range_;
  JointVector reference_{};
};

/// Shortest pass, and nearest that an end of it comes to an end of a span.
inline constexpr double kSamePoint_mm = 1e-4;

}  // namespace meridian
