// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "service/core/planner/singular/pole_zone.hpp"
#include "service/core/planner/singular/programmed_tip.hpp"

namespace meridian {

/// Singular places of a robot at which a joint has no direction of its own.
enum class Singularity : std::uint8_t {
  kWrist,     ///< 6R: the tool in line with the forearm; the roll is redundant, the axis may give
  kShoulder,  ///< the wrist point over the base axis; the yaw is redundant, the tip may give
  kBoth       ///< 6R: the two in one pass
};
/// Those that have a distance: kWrist and kShoulder.
inline constexpr int kSingularities = 2;
inline constexpr Singularity kSingularPlaces[] = {Singularity::kShoulder, Singularity::kWrist};
/// Of what there is for either of them.
[[nodiscard]] constexpr std::size_t index_of(Singularity at) noexcept {
  return static_cast<std::size_t>(at);
}

/// Whether passing `at` drives the redundant joint of `one`, kWrist or kShoulder.
[[nodiscard]] constexpr bool drives(Singularity at, Singularity one) noexcept {
  return at == one || at == Singularity::kBoth;
}

/// The other of kWrist and kShoulder.
[[nodiscard]] constexpr Singularity other_of(Singularity one) noexcept {
  return one == Singularity::kWrist ? Singularity::kShoulder : Singularity::kWrist;
}

/// A stretch of path beside a singular place of a robot on which its redundant joint is driven and
/// the others follow. At the wrist the tip is exact and the axis inside its tolerance, at the
/// shoulder the axis is exact and the tip inside its tolerance, at both neither is exact. Outside
/// it the joints follow the path.
struct RobotPass {
  double begin = 0, end = 0;  ///< u; equal: none
  FreeQuintic joint{};        ///< the redundant one: Bernstein values over [begin, end]
  FreeQuintic roll{};         ///< at both: `joint` is the yaw, and this the roll
  int branch_before = 0, branch_after = 0;
  std::array<bool, kSingularities> rests{};  ///< the joint of that place, at the end
  bool is_turned = false;                    ///< next to standstill, from rest to rest
  double axis_deviation_rad = 0;             ///< largest from the programmed axis
};

/// How a pass meets an end of its range.
enum class PassEnd : std::uint8_t {
  kOnPath,  ///< anywhere inside it, on the exact way
  kAtRest   ///< at that end, which is singular and where the machine rests: any joint value
};

/// The same at both ends; kAtRest at the begin: the redundant joint begins as it stands.
struct PassEnds {
  PassEnd from = PassEnd::kOnPath, to = PassEnd::kOnPath;
};

/// Where a pass may lie: from ahead of `nearest` to behind `last_nearest`, between `from` and `to`.
struct PassRange {
  Singularity at = Singularity::kWrist;
  double nearest = 0, last_nearest = 0;
  double from = 0, to = 0;
  std::array<PassEnds, kSingularities>
      ends{};                  ///< of the roll at the wrist, the yaw at the shoulder
  bool may_turn = false;       ///< a joint that rests at the begin may turn there
  bool may_be_narrow = false;  ///< of both, from rest: each for itself would do no better
  int branch = 0;              ///< on the way in
  JointVector joints{};        ///< at `from`
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

/// The branch that solve_driven() asks for where the redundant joint of `at` is driven.
[[nodiscard]] constexpr int driven_branch(Singularity at, int branch) noexcept {
  switch (at) {
    case Singularity::kShoulder:
      return branch | robot::kYawDriven;
    case Singularity::kBoth:
      return branch | robot::kYawDriven | robot::kRollDrivenToo;
    case Singularity::kWrist:
      break;
  }
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

/// Whether the way from `from` to the end of `block`, whose axis is unit, comes so near one.
[[nodiscard]] bool comes_near_singularity(const PassCourse& course, const ToolPose& from,
                                          const ClBlock& block) noexcept;

/// Picks the pass with the least time between `from` and `to`. Candidates are quintics of the
/// redundant joint that meet the exact way with two derivatives at both ends, out on the same
/// branch or on the one with the bend, or the arm, turned over: straight through, the joint hardly
/// turns. Where the nearest winding is outside travel, the joint turns the other way round. One
/// that leaves the tolerance about the programmed path, or whose joints leave travel, is none.
/// Bounded work, no memory. Source: docs/motion.md, section 2. Proof:
/// tests/property/planner/robot_passes_test.cpp.
[[nodiscard]] RobotPass find_robot_pass(const PassTask& task, const PassRange& range) noexcept;

}  // namespace meridian
