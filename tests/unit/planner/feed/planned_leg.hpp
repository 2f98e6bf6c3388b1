// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/feed/legs/leg_planner.hpp"
#include "unit/planner/feed/staged_motion.hpp"

/// Legs that are planned by themselves.
namespace meridian::test::leg_planner {

inline ToolPose pose_of(const Vector3& tip, double tilt, double azimuth) {
  return {tip,
          {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)}};
}

/// One leg, planned; its pieces are the third and those that follow.
struct Planned {
  explicit Planned(const MachineModel& m) : model(m), planner(model) { staged->clear(100); }
  PathFault plan(Leg leg, const JointVector& from) {
    leg.path.tool_length_mm = model.tool_length_mm;
    leg.path.branch = 0;
    leg.window = 7;
    start = joints = from;
    return planner.plan(leg, *staged, joints);
  }
  /// From `begin` on branch 0.
  PathFault plan_line(const ToolPose& begin, const ToolPose& end, double feed_mm_per_s) {
    Leg leg;
    leg.path = make_line(begin, end);
    leg.feed_mm_per_s = feed_mm_per_s;
    return plan(leg, solve(model, model.tool_length_mm, begin, 0, {}).q);
  }

  MachineModel model;
  LegPlanner planner;
  std::unique_ptr<Staging> staged = std::make_unique<Staging>();
  JointVector start{}, joints{};
};

/// Every piece of the leg begins where the one before it ends, the last one where the joints are.
inline void expect_joined(const Planned& one) {
  JointVector before = one.start;
  for (int n = 0; n < one.staged->path_count; ++n) {
    const PathPiece& path = one.staged->paths[n];
    EXPECT_EQ(path.index, 100U + static_cast<unsigned>(n));
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(path.joints_begin[i], before[i], 1e-7);
    before = path.joints_end;
  }
  EXPECT_EQ(before, one.joints);
}

}  // namespace meridian::test::leg_planner
