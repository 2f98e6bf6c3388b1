// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/singular/robot_pass.hpp"
#include "support/family_machines.hpp"

/// A straight path of a 6R robot past its wrist singularity.
namespace meridian::test::wrist_path {

/// The tool goes 20 mm of u and tilts by 0.004 rad a mm; at u = 10 mm the bend is `beside_rad`.
struct WristPath : SpanLookup {
  explicit WristPath(double beside_rad) {
    for (JointSpec& joint : model.joints) {
      joint.limits.velocity = 3;
      joint.limits.acceleration = 100;
      joint.limits.jerk = 10000;
      joint.limits.travel_min = -6;
      joint.limits.travel_max = 6;
    }
    middle[robot::kYaw] = 0.2;
    middle[robot::kShoulder] = 1.2;
    middle[robot::kElbow] = -1.9;
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

  static constexpr double kLength_mm = 20, kTilt_rad_per_mm = 0.004;
  MachineModel model = robot_machine(true);
  JointVector middle{}, begin_joints{};
  int branch = -1;
  BandSpan span;
  ProgrammedAxis axes;
  ProgrammedTip tips{true};
};

}  // namespace meridian::test::wrist_path
