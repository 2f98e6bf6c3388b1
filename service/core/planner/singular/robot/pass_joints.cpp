// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/robot/pass_joints.hpp"

#include <cmath>
#include <limits>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/solve_driven.hpp"
#include "service/core/planner/singular/pole/pole_time.hpp"

namespace meridian {
namespace {

constexpr double kMaxTipError_mm = 1e-7;

/// The wrist point of the path as seen along the base axis, mm.
Vector3 off_base_axis(const PassTask& task, double u) noexcept {
  const ToolPose pose = pose_of<double>(task.spans.span_at(u), u);
  const auto wrist = robot::wrist_point<double>(task.model.robot, task.tool_length_mm,
                                                pose_in_machine(task.model, pose));
  return {wrist[0], wrist[1], 0};
}

/// The tool as seen along the forearm, of length 1.
Vector3 off_forearm(const JointVector& q) noexcept {
  const double roll = q[robot::kRoll];
  return std::sin(q[robot::kBend]) * Vector3(-std::sin(roll), std::cos(roll), 0);
}

}  // namespace

Solution<double> joints_on_pass(const PassTask& task, const RobotPass& pass, double u,
                                const JointVector& reference) noexcept {
  const double share = (u - pass.begin) / (pass.end - pass.begin);
  return solve_on_pass<double>(task, pass, pose_of<double>(task.spans.span_at(u), u),
                               quintic_at(pass.joint, share), quintic_at(pass.roll, share),
                               reference);
}

PassDeviation deviation_on_pass(const PassTask& task, const RobotPass& pass, double u,
                                const JointVector& q) noexcept {
  const ToolPose pose = pose_of<double>(task.spans.span_at(u), u);
  const ToolPose there = forward(task.model, task.tool_length_mm, q);
  const double off_path = (there.tip - pose.tip).norm();
  PassDeviation out;
  if (contains(pass.at, Singularity::kShoulder)) {
    out.tip_mm = task.is_exact ? off_path : task.tips.distance_to(u, there.tip);
  } else if (!(off_path <= kMaxTipError_mm)) {
    out.tip_mm = std::numeric_limits<double>::infinity();
  }
  if (contains(pass.at, Singularity::kWrist)) {
    out.axis_rad =
        task.is_exact ? angle_between(pose.axis, there.axis) : task.axes.angle_to(u, there.axis);
  }
  return out;
}

Vector3 off_other_singularity(const PassTask& task, const RobotPass& pass, double u,
                              const JointVector& q) noexcept {
  return pass.at == SingularSet::kWrist ? off_base_axis(task, u) : off_forearm(q);
}

double other_tolerance(const PassTask& task, const RobotPass& pass) noexcept {
  switch (pass.at) {
    case SingularSet::kWrist:
      return task.tip_tolerance_mm;
    case SingularSet::kShoulder:
      return has_wrist_roll(task.model) ? task.axis_tolerance_rad : 0;
    case SingularSet::kWristAndShoulder:
    case SingularSet::kNone:
      break;
  }
  return 0;
}

bool settles(const PassTask& task, const RobotPass& pass, const JointVector& q) noexcept {
  constexpr double kLargestLeft = 0.5;  // of a turn of the yaw, after a round
  if (pass.at != SingularSet::kWrist) return true;
  const RobotKinematics& robot = task.model.robot;
  const double forearm = q[robot::kShoulder] + q[robot::kElbow], bend = q[robot::kBend];
  const double from_axis =
      robot.upper_arm_mm * std::cos(q[robot::kShoulder]) + robot.forearm_mm * std::cos(forearm);
  const double pivot = robot.wrist_mm + task.tool_length_mm, roll = std::cos(q[robot::kRoll]);
  const double tool =
      std::cos(forearm) * std::cos(bend) - std::sin(forearm) * std::sin(bend) * roll;
  return std::abs(pivot * tool) * roll * roll < kLargestLeft * std::abs(from_axis);
}

double time_on_pass(const PassTask& task, const RobotPass& pass, const JointVector& reference,
                    int steps) noexcept {
  const double h = pass.end - pass.begin;
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const double t = (k + 0.5) / steps, u = pass.begin + t * h;
    const BandSpan& span = task.spans.span_at(u);
    const auto pose = pose_of<Jet<3>>(span, u);
    const auto at = solve_on_pass<Jet<3>>(task, pass, pose, free_at(pass.joint, t, h),
                                          free_at(pass.roll, t, h), reference);
    sum += h / steps * slowness(task.model, span, pose, at.q);
  }
  return sum;
}

}  // namespace meridian
