// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/solve_driven.hpp"
#include "service/core/planner/singular/robot/robot_pass.hpp"

/// The joints of a robot on a pass, and what they leave of the path. Units: mm, rad, s. No memory.
/// Proof: tests/property/planner/singular_sweep_test.cpp.
namespace meridian {

/// The redundant joint at a singularity.
[[nodiscard]] constexpr int joint_of(Singularity at) noexcept {
  return at == Singularity::kWrist ? int{robot::kRoll} : int{robot::kYaw};
}

/// Whose joint RobotPass::joint is.
[[nodiscard]] constexpr Singularity first_of(SingularSet at) noexcept {
  return contains(at, Singularity::kShoulder) ? Singularity::kShoulder : Singularity::kWrist;
}

/// The bit of a branch that says on which side of it the wrist, or the arm, is.
[[nodiscard]] constexpr int turned_over(Singularity at) noexcept {
  return at == Singularity::kWrist ? robot::kFlip : robot::kBack;
}

/// The joints at `pose` with the redundant joints at `joint` and, if there are two, `roll`.
template <class S>
[[nodiscard]] Solution<S> solve_on_pass(const PassTask& task, const RobotPass& pass,
                                        const Pose<S>& pose, const S& joint, const S& roll,
                                        const JointVector& reference) noexcept {
  return solve_driven(task.model, task.tool_length_mm, pose, joint, roll,
                      driven_branch(pass.at, pass.branch_before), reference);
}

[[nodiscard]] Solution<double> joints_on_pass(const PassTask& task, const RobotPass& pass, double u,
                                              const JointVector& reference) noexcept;

/// How far the tool is off the programmed path, as far as it may be.
struct PassDeviation {
  double tip_mm = 0, axis_rad = 0;
};

/// With the joints at `q`; infinite where the tip ought to be exact and is not.
[[nodiscard]] PassDeviation deviation_on_pass(const PassTask& task, const RobotPass& pass, double u,
                                              const JointVector& q) noexcept;

/// How far the robot is from its other singularity, at which the pass drives no joint, with the
/// joints at `q`: a vector in mm or of sines that goes through zero where it meets it.
[[nodiscard]] Vector3 off_other_singularity(const PassTask& task, const RobotPass& pass, double u,
                                            const JointVector& q) noexcept;
/// Nearer, it counts as met. 0: there is none.
[[nodiscard]] double other_tolerance(const PassTask& task, const RobotPass& pass) noexcept;

/// Whether the rounds of solve_with_roll() settle with the joints at `q`. The tip moves the wrist
/// point, which turns the yaw the more the nearer the base axis is.
[[nodiscard]] bool settles(const PassTask& task, const RobotPass& pass,
                           const JointVector& q) noexcept;

[[nodiscard]] double time_on_pass(const PassTask& task, const RobotPass& pass,
                                  const JointVector& reference, int steps) noexcept;

}  // namespace meridian
