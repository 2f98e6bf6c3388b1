// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/joint_cells.hpp"
#include "service/core/planner/singular/robot_pass_search.hpp"

/// What a pass has to keep: tolerances and travel, on it and after it. Part of RobotPassSearch.
namespace meridian {
namespace {

constexpr double kMaxRolledTipError_mm = 1e-7;

}  // namespace

bool RobotPassSearch::follow(const Stretch& way, JointVector& joints) const noexcept {
  constexpr int kSteps = 48;
  for (int k = 1; k <= kSteps; ++k) {
    const double at = way.from + (way.to - way.from) * k / kSteps;
    const auto there = solve(task_.model, task_.tool_length_mm,
                             pose_of<double>(task_.spans.span_at(at), at), way.branch, joints);
    if (there.status == SolveStatus::kUnreachable) return false;
    joints = there.q;
    const bool is_out = first_joint_outside_travel(task_.model, joints, kTravelMargin) >= 0;
    if (way.keeps_travel && is_out) return false;
  }
  return true;
}

bool RobotPassSearch::leads_on(const RobotPass& pass) const noexcept {
  if (rests_at(&PassEnds::to)) return true;
  JointVector joints = reference_;
  if (drives_roll_) joints[robot::kRoll] = pass.roll.back();
  if (drives_yaw_) joints[robot::kYaw] = pass.joint.back();
  return follow({pass.end, range_.to, pass.branch_after, true}, joints);
}

bool RobotPassSearch::rests_on(const RobotPass& pass) const noexcept {
  if (!(pass.end < range_.to)) return true;
  RobotPass rest = pass;
  rest.begin = pass.end;
  rest.end = range_.to;
  rest.joint.fill(pass.joint.back());
  rest.roll.fill(pass.roll.back());
  return is_inside(rest, kSamples);
}

RobotPassSearch::Off RobotPassSearch::off_at(const RobotPass& pass, double u) const noexcept {
  const ToolPose pose = pose_of<double>(task_.spans.span_at(u), u);
  const double share = (u - pass.begin) / (pass.end - pass.begin);
  const auto at = solve_on(pass, pose, quintic_at(pass.joint, share), quintic_at(pass.roll, share));
  if (at.status == SolveStatus::kUnreachable) return {};
  if (first_joint_outside_travel(task_.model, at.q, kTravelMargin) >= 0) return {};
  const ToolPose there = forward(task_.model, task_.tool_length_mm, at.q);
  const double tip = (there.tip - pose.tip).norm();
  Off out{0, 0};
  if (drives_yaw_) {
    out.tip_mm = task_.is_exact ? tip : task_.tips.distance_to(u, there.tip);
  } else if (!(tip <= kMaxRolledTipError_mm)) {
    return {};
  }
  if (drives_roll_) {
    out.axis_rad =
        task_.is_exact ? angle_between(pose.axis, there.axis) : task_.axes.angle_to(u, there.axis);
  }
  return out;
}

bool RobotPassSearch::is_within(RobotPass& pass, double u) const noexcept {
  const Off off = off_at(pass, u);
  pass.axis_deviation_rad = std::max(pass.axis_deviation_rad, off.axis_rad);
  return off.tip_mm <= kSampledShare * task_.tip_tolerance_mm &&
         off.axis_rad <= kSampledShare * task_.axis_tolerance_rad;
}

bool RobotPassSearch::is_inside(RobotPass& pass, int samples) const noexcept {
  for (int k = 0; k <= samples; ++k) {
    if (!is_within(pass, pass.begin + (pass.end - pass.begin) * k / samples)) return false;
  }
  return true;
}

bool RobotPassSearch::is_inside_at_kinks(RobotPass& pass) const noexcept {
  for (std::size_t n = 0; n < kink_count_; ++n) {
    const bool is_there = kinks_[n] > pass.begin && kinks_[n] < pass.end;
    if (is_there && !is_within(pass, kinks_[n])) return false;
  }
  return true;
}

}  // namespace meridian
