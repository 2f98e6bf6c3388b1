// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/kinematics/winding.hpp"
#include "service/core/planner/route/router.hpp"
#include "support/machines.hpp"
#include "unit/planner/feed/staged_motion.hpp"

/// A machine that is to come to the first block of a program.
namespace meridian::test::approach {

inline constexpr double kRounding = 1e-9;

inline Vector3 leaning(double tilt, double azimuth) {
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

inline ClBlock cut(const Vector3& tip, const Vector3& axis) {
  ClBlock block;
  block.sequence = 7;
  block.line = 107;
  block.tip_mm = to_array(tip);
  block.axis = to_array(axis);
  block.feed_meaning = FeedMeaning::kTip;
  block.feed = 50;
  return block;
}

/// A machine that stands at a pose, 50 mm of clearance.
struct Approached {
  explicit Approached(const MachineModel& m, const ToolPose& pose = {{0, 0, 0}, leaning(0.3, 0.4)},
                      int branch = 0)
      : model(m), router(model) {
    staged->clear(0);
    cursor.pose = pose;
    cursor.tool_length_mm = model.tool_length_mm;
    cursor.joints = start = solve(model, model.tool_length_mm, pose, branch, {}).q;
    cursor.epoch = 3;
  }
  [[nodiscard]] std::vector<PathPiece> paths() const {
    return {staged->paths.begin(), staged->paths.begin() + staged->path_count};
  }
  [[nodiscard]] double away_from(const ClBlock& block) const {
    const ToolPose at = forward(model, cursor.tool_length_mm, cursor.joints);
    return std::max((at.tip - to_vector(block.tip_mm)).norm(),
                    angle_between(at.axis, to_vector(block.axis)));
  }
  [[nodiscard]] double length() const {
    double sum = 0;
    for (const PathPiece& path : paths()) sum += path.length;
    return sum;
  }

  MachineModel model;
  Router router;
  PlanCursor cursor;
  JointVector start{};
  std::unique_ptr<Staging> staged = std::make_unique<Staging>();
};

}  // namespace meridian::test::approach
