// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/singular/pole/pole_time.hpp"
#include "service/core/planner/singular/robot/robot_pass.hpp"
#include "support/family_machines.hpp"

/// A straight path of a 6R robot past its wrist singularity, in the middle of its reach or over its
/// base axis.
namespace meridian::test::wrist_path {

/// The tool goes 20 mm of u and tilts by 0.004 rad a mm; at u = 10 mm the bend is `beside_rad`.
struct WristPath : SpanLookup {
  explicit WristPath(double beside_rad) : WristPath(beside_rad, 1.2, -1.9) {}
  /// With shoulder and elbow so at u = 10 mm.
  WristPath(double beside_rad, double shoulder, double elbow) {
    for (JointSpec& joint : model.joints) {
      joint.limits.velocity = 3;
      joint.limits.acceleration = 100;
      joint.limits.jerk = 10000;
      joint.limits.travel_min = -6;
      joint.limits.travel_max = 6;
    }
    middle[robot::kYaw] = 0.2;
    middle[robot::kShoulder] = shoulder;
    middle[robot::kElbow] = elbow;
    middle[robot::kRoll] = 0.4;
    middle[robot::kBend] = beside_rad;
    const ToolPose at = forward(model, model.tool_length_mm, middle);
    const Vector3 tilt = at.axis.unitOrthogonal();
    span.length = kLength_mm;
    span.feed_mm_per_s = 50;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto n = static_cast<Eigen::Index>(i);
      span.c[i] = {at.tip[n] - (i == 0 ? 10 : 0), i == 0 ? 1.0 : 0.0};
      span.c[i + 3] = {at.axis[n] - 10 * kTilt_rad_per_mm * tilt[n], kTilt_rad_per_mm * tilt[n]};
    }
    for (int n = 0; n < branch_count(model); ++n) {
      const auto there = solve(model, model.tool_length_mm, at, n, middle);
      double off = 0;
      for (std::size_t i = 0; i < 6; ++i) off += std::abs(there.q[i] - middle[i]);
      if (off < 1e-6) branch = n;
    }
    begin_joints = solve(model, model.tool_length_mm, pose(0), branch, middle).q;
    axes.begin(pose(0).axis);
    axes.add(kLength_mm, pose(kLength_mm).axis);
    tips.begin(pose(0).tip);
    tips.add(kLength_mm, pose(kLength_mm).tip);
  }
  [[nodiscard]] const BandSpan& span_at(double /*u*/) const noexcept override { return span; }
  [[nodiscard]] ToolPose pose(double u) const { return pose_on(span.c, u); }
  [[nodiscard]] PassTask task() const {
    return {model, *this, axes, tips, model.tool_length_mm, 0.002, 0.01, false};
  }
  /// The whole path, nearest to the singularity in its middle.
  [[nodiscard]] PassRange range() const {
    PassRange range;
    range.nearest = 10;
    range.to = kLength_mm;
    range.branch = branch;
    range.joints = begin_joints;
    return range;
  }

  [[nodiscard]] Solution<Jet<2>> exact(double u, const JointVector& near) const {
    return solve(model, model.tool_length_mm, pose_of<Jet<2>>(span, u), branch, near);
  }

  static constexpr double kLength_mm = 20, kTilt_rad_per_mm = 0.004;
  MachineModel model = robot_machine(true);
  JointVector middle{}, begin_joints{};
  int branch = -1;
  BandSpan span;
  ProgrammedAxis axes;
  ProgrammedTip tips{true};
};

/// Past both singularities: at u = 10 mm the wrist point is `off_axis_mm` beside the base axis.
[[nodiscard]] inline WristPath path_past_both(double beside_rad, double off_axis_mm) {
  const double lean = 0.5;  // upper arm and forearm to either side, 700 mm each
  const double shoulder = std::acos(off_axis_mm / 700 - std::sin(lean));
  return {beside_rad, shoulder, 0.5 * std::numbers::pi - lean - shoulder};
}

}  // namespace meridian::test::wrist_path
