// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/robot_driven.hpp"

/// The inverse where a joint that a singularity leaves free is driven by the path.
namespace meridian {

/// Whether the machine is a robot whose roll solve_driven() can drive.
[[nodiscard]] inline bool has_wrist_roll(const MachineModel& model) noexcept {
  return model.family == MachineFamily::kRobot && model.robot.has_spherical_wrist;
}

/// Which joint solve_driven() drives: the redundant joint, the yaw of a robot or the roll of a 6R
/// one; -1: none. Of yaw and roll, the yaw.
[[nodiscard]] inline int driven_joint(const MachineModel& model, int branch) noexcept {
  if (model.family != MachineFamily::kRobot) return redundant_joint(model);
  if ((branch & (robot::kYawDriven | robot::kYawAndRollDriven)) != 0) return robot::kYaw;
  return model.robot.has_spherical_wrist ? static_cast<int>(robot::kRoll) : -1;
}

namespace detail {

/// Out of line, as solve_robot(): other families have none of it.
template <class S>
[[nodiscard, gnu::noinline]] inline Solution<S> solve_robot_driven(
    const MachineModel& model, double tool_length_mm, const Pose<S>& X_WT, const S& free,
    const S& roll, int branch, const JointVector& reference) noexcept {
  const Pose<S> any = pose_in_machine(model, X_WT);
  const Pose<S> X_MT{any.tip, made_unit(any.axis)};
  const bool drives_both = (branch & robot::kYawAndRollDriven) != 0;
  const int driven = driven_joint(model, branch);
  Solution<S> out{{}, SolveStatus::kUnreachable};
  bool is_solved = false;
  if (drives_both) {
    is_solved = has_wrist_roll(model) &&
                robot::solve_with_yaw_and_roll(model.robot, tool_length_mm, X_MT, branch, free,
                                               roll, reference, out.q);
  } else if (driven == robot::kYaw) {
    is_solved =
        robot::solve_with_yaw(model.robot, tool_length_mm, X_MT, branch, free, reference, out.q);
  } else if (driven >= 0) {
    is_solved =
        robot::solve_with_roll(model.robot, tool_length_mm, X_MT, branch, free, reference, out.q);
  }
  if (!is_solved || !all_finite(out.q)) return out;
  for (int joint = 0; joint < model.joint_count; ++joint) {
    const bool is_driven = joint == driven || (drives_both && joint == robot::kRoll);
    if (!is_driven) wind(out.q, joint, reference);
  }
  out.status = SolveStatus::kOk;
  return out;
}

}  // namespace detail

/// As solve_held(), and for robots, with the rotary joints that are not driven in the windings
/// nearest to `reference`: with the roll of a 6R robot at `free` the tip is that of `X_WT`, the
/// axis the nearest that it has with that roll, on the front and the elbow of `branch`; with
/// robot::kYawDriven in `branch` and the yaw at `free` the axis is that of `X_WT`, the tip the
/// nearest in the arm plane; with robot::kYawAndRollDriven in it both are near, with the yaw at
/// `free` and the roll at `roll`. Frame: W. RT: cycle. Proof: tests/property/kinematics.
template <class S>
[[nodiscard]] inline Solution<S> solve_driven(const MachineModel& model, double tool_length_mm,
                                              const Pose<S>& X_WT, const S& free, const S& roll,
                                              int branch, const JointVector& reference) noexcept {
  return model.family == MachineFamily::kRobot
             ? detail::solve_robot_driven(model, tool_length_mm, X_WT, free, roll, branch,
                                          reference)
             : solve_held(model, tool_length_mm, X_WT, free);
}
/// The same where at most one joint is driven.
template <class S>
[[nodiscard]] inline Solution<S> solve_driven(const MachineModel& model, double tool_length_mm,
                                              const Pose<S>& X_WT, const S& free, int branch,
                                              const JointVector& reference) noexcept {
  return solve_driven(model, tool_length_mm, X_WT, free, S(0.0), branch, reference);
}

}  // namespace meridian
