// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/solve_driven.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/singular/robot/robot_pass.hpp"

/// How near a robot comes to its singular places. Part of robot_pass.hpp.
namespace meridian {
namespace {

/// How much farther the arm may stretch until its elbow is straight, mm.
double reach_left(const PassCourse& course, const ToolPose& pose) noexcept {
  const RobotKinematics& robot = course.model.robot;
  const auto wrist =
      robot::wrist_point<double>(robot, course.tool_length_mm, pose_in_machine(course.model, pose));
  return robot.upper_arm_mm + robot.forearm_mm - std::hypot(wrist[0], wrist[1], wrist[2]);
}

}  // namespace

double singular_distance(const MachineModel& model, double tool_length_mm, Singularity at,
                         const ToolPose& pose, int branch, const JointVector& joints) noexcept {
  const bool is_there =
      at == Singularity::kWrist ? has_wrist_roll(model) : model.family == MachineFamily::kRobot;
  if (!is_there) return std::numeric_limits<double>::infinity();
  const ToolPose in_machine = pose_in_machine(model, pose);
  return at == Singularity::kWrist
             ? robot::wrist_distance(model.robot, tool_length_mm, in_machine, branch, joints)
             : robot::shoulder_distance(model.robot, tool_length_mm, in_machine);
}

bool is_near_singularity(const PassCourse& course, const ToolPose& pose) noexcept {
  constexpr double kNear_rad = 0.35, kNear_mm = 100, kNearStraight_mm = 10;
  const auto distance = [&](Singularity at) {
    return singular_distance(course.model, course.tool_length_mm, at, pose, course.branch,
                             course.joints);
  };
  return distance(Singularity::kWrist) < kNear_rad || distance(Singularity::kShoulder) < kNear_mm ||
         reach_left(course, pose) < kNearStraight_mm;
}

bool comes_near_singularity(const PassCourse& course, const ToolPose& from,
                            const ClBlock& block) noexcept {
  constexpr double kStep_mm = 10, kMaxSteps = 256;
  const ToolPose end{to_vector(block.tip_mm), to_vector(block.axis)};
  const PathPiece path = block.is_arc ? make_arc(from, end, block) : make_line(from, end);
  const int steps = static_cast<int>(std::clamp(path.length / kStep_mm, 4.0, kMaxSteps));
  for (int k = 0; k <= steps; ++k) {
    if (is_near_singularity(course, pose_at(path, path.length * k / steps))) return true;
  }
  return false;
}

}  // namespace meridian
