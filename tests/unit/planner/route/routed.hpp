// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/winding.hpp"
#include "service/core/planner/route/router.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"
#include "unit/planner/feed/staged_motion.hpp"

/// Blocks, and a router whose machine rests somewhere.
namespace meridian::test::router {

inline constexpr double kRounding = 1e-9;

inline ClBlock cut(const Vector3& tip, const Vector3& axis, double feed = 50) {
  ClBlock block;
  block.sequence = 7;
  block.line = 107;
  block.tip_mm = to_array(tip);
  block.axis = to_array(axis);
  block.feed_meaning = FeedMeaning::kTip;
  block.feed = feed;
  return block;
}

inline ClBlock rapid(const Vector3& tip, const Vector3& axis) {
  ClBlock block = cut(tip, axis, 0);
  block.kind = BlockKind::kRapid;
  block.feed_meaning = FeedMeaning::kNone;
  return block;
}

/// A router whose machine rests at a pose.
struct Routed {
  explicit Routed(const MachineModel& m) : model(m), router(model) { staged->clear(0); }

  void stand_at(const ToolPose& pose, int branch = 0, const JointVector& near = {}) {
    cursor = {};
    cursor.pose = pose;
    cursor.tool_length_mm = model.tool_length_mm;
    cursor.joints = solve(model, model.tool_length_mm, pose, branch, near).q;
    cursor.epoch = 3;
    cursor.window = 11;
  }
  PathFault route(const ClBlock& block) {
    staged->clear(0);
    return router.route(block, cursor, *staged);
  }
  [[nodiscard]] ToolPose reached() const {
    return forward(model, cursor.tool_length_mm, cursor.joints);
  }
  [[nodiscard]] double away_from(const ClBlock& block) const {
    const ToolPose at = reached();
    return std::max((at.tip - to_vector(block.tip_mm)).norm(),
                    angle_between(at.axis, to_vector(block.axis)));
  }
  [[nodiscard]] std::vector<PathPiece> paths() const {
    return {staged->paths.begin(), staged->paths.begin() + staged->path_count};
  }
  /// Each piece begins where the one before it ends.
  void expect_joined(const JointVector& from) const {
    JointVector before = from;
    for (const PathPiece& path : paths()) {
      for (int i = 0; i < 5; ++i) EXPECT_NEAR(path.joints_begin[i], before[i], 1e-7) << i;
      EXPECT_EQ(path.sequence, 7U);
      EXPECT_EQ(path.line, 107U);
      EXPECT_EQ(path.epoch, 3);
      EXPECT_EQ(path.tool_length_mm, cursor.tool_length_mm);
      before = path.joints_end;
    }
    EXPECT_EQ(before, cursor.joints);
    for (int n = 0; n < staged->time_count; ++n) EXPECT_EQ(staged->times[n].window, 11U);
  }

  MachineModel model;
  Router router;
  PlanCursor cursor;
  std::unique_ptr<Staging> staged = std::make_unique<Staging>();
};

}  // namespace meridian::test::router
