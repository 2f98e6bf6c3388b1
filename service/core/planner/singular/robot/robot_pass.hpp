// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/solve_driven.hpp"
#include "meridian/planner/relaxed_axis.hpp"
#include "service/core/planner/singular/pole/pole_bounds.hpp"
#include "service/core/planner/singular/pole/pole_zone.hpp"
#include "service/core/planner/singular/robot/programmed_tip.hpp"

namespace meridian {

/// Singular places of a robot at which a joint has no direction of its own.
enum class Singularity : std::uint8_t {
  kWrist,    ///< 6R: the tool in line with the forearm; the roll is redundant, the axis may give
  kShoulder  ///< the wrist point over the base axis; the yaw is redundant, the tip may give
};
inline constexpr int kSingularities = 2;

/// At which of them.
enum class SingularSet : std::uint8_t { kNone, kWrist, kShoulder, kWristAndShoulder };

[[nodiscard]] constexpr SingularSet only(Singularity at) noexcept {
  return at == Singularity::kWrist ? SingularSet::kWrist : SingularSet::kShoulder;
}
[[nodiscard]] constexpr SingularSet operator|(SingularSet a, SingularSet b) noexcept {
  return static_cast<SingularSet>(static_cast<int>(a) | static_cast<int>(b));
}
[[nodiscard]] constexpr SingularSet operator&(SingularSet a, SingularSet b) noexcept {
  return static_cast<SingularSet>(static_cast<int>(a) & static_cast<int>(b));
}
[[nodiscard]] constexpr bool contains(SingularSet set, Singularity at) noexcept {
  return (set | only(at)) == set;
}

/// A stretch of path beside singular places of a robot on which its redundant joints are driven and
/// the others follow. At the wrist the tip is exact and the axis inside its tolerance, at the
/// shoulder the axis is exact and the tip inside its tolerance, at both each is inside its own.
/// Outside it the joints follow the path.
struct RobotPass {
  SingularSet at = SingularSet::kNone;
  double begin = 0, end = 0;  ///< u; equal: none
  FreeQuintic joint{};        ///< the redundant one: Bernstein values over [begin, end]
  FreeQuintic roll{};         ///< the same, at wrist and shoulder, where `joint` is the yaw
  int branch_before = 0, branch_after = 0;
  SingularSet rests_at_end = SingularSet::kNone;  ///< whose joints rest there, by any value
  double axis_deviation_rad = 0;                  ///< largest from the programmed axis
};

/// Why a pass moves the axis.
[[nodiscard]] constexpr RelaxedReason reason_of(const RobotPass& pass) noexcept {
  const bool is_turned = pass.branch_after != pass.branch_before;
  if (pass.at == SingularSet::kWristAndShoulder) {
    return is_turned ? RelaxedReason::kThroughBoth : RelaxedReason::kPastBoth;
  }
  return is_turned ? RelaxedReason::kThroughWrist : RelaxedReason::kPastWrist;
}

/// Where a pass may lie: about `nearest`, between `from` and `to`.
struct PassRange {
  Singularity at = Singularity::kWrist;
  double nearest = 0, from = 0, to = 0;
  SingularSet rests_at_from = SingularSet::kNone;  ///< whose joints begin there as they stand
  SingularSet rests_at_to = SingularSet::kNone;    ///< whose joints may rest there by any value
  /// The same where the machine stops anyway: farther off, but inside the tolerance.
  SingularSet stops_at_from = SingularSet::kNone, stops_at_to = SingularSet::kNone;
  double rest_share = kOnPoleTolerances;  ///< of the tolerance: so near joints may rest at `to`
  int branch = 0;                         ///< on the way in
  JointVector joints{};                   ///< at `from`
};

/// What stays the same along a path.
struct PassTask {
  const MachineModel& model;
  const SpanLookup& spans;
  const ProgrammedAxis& axes;
  const ProgrammedTip& tips;
  double tool_length_mm = 0;
  double axis_tolerance_rad = 0, tip_tolerance_mm = 0;  ///< from what was programmed
  bool is_exact = false;                                ///< from the spans instead
};

/// Farthest that a pass begins ahead of the nearest point, and ends behind it.
inline constexpr double kPassReach_mm = 20;

/// The branch that solve_driven() asks for where the redundant joints of `at` are driven.
[[nodiscard]] constexpr int driven_branch(SingularSet at, int branch) noexcept {
  if (at == SingularSet::kShoulder) return branch | robot::kYawDriven;
  if (at == SingularSet::kWristAndShoulder) return branch | robot::kYawAndRollDriven;
  return branch;
}

/// How far `pose` in W is from the singular place with the front and the elbow of `branch`: the
/// angle between tool and forearm, or wrist point and base axis in mm. Infinite where the robot has
/// no such place.
[[nodiscard]] double singular_distance(const MachineModel& model, double tool_length_mm,
                                       Singularity at, const ToolPose& pose, int branch,
                                       const JointVector& joints) noexcept;

/// How a robot comes to a block.
struct PassCourse {
  const MachineModel& model;
  double tool_length_mm = 0;
  int branch = 0;
  const JointVector& joints;
};

/// Whether `pose` is so near a singular place that the redundant joint turns fast there.
[[nodiscard]] bool is_near_singularity(const PassCourse& course, const ToolPose& pose) noexcept;

/// Whether the path from `from` to the end of `block`, whose axis is unit, comes so near one.
[[nodiscard]] bool comes_near_singularity(const PassCourse& course, const ToolPose& from,
                                          const ClBlock& block) noexcept;

/// Picks the pass with the least time between `from` and `to`. Candidates are quintics of the
/// redundant joint that meet the exact path with two derivatives at both ends, out on the same
/// branch or on the one with the bend, or the arm, turned over: straight through, the joint hardly
/// turns. A pass that meets the other singularity drives the redundant joints of both. Where the
/// nearest winding is outside travel, the joint turns the other way round; where a
/// joint at rest leads another one out of travel, it turns to where it may rest. One that leaves
/// the tolerance about the programmed path, or whose joints leave travel, is none. Bounded work, no
/// memory. Source: docs/motion.md, section 2. Proof:
/// tests/property/planner/robot_passes_test.cpp.
[[nodiscard]] RobotPass find_robot_pass(const PassTask& task, const PassRange& range) noexcept;

}  // namespace meridian
