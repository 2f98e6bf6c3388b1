// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/geometry/vector3.hpp"
#include "meridian/path/cl_block.hpp"
#include "meridian/units.hpp"

/// Blocks that sample parts are made of.
namespace meridian::surface {

[[nodiscard]] inline ClBlock motion(BlockKind kind, const ToolPose& pose, double feed_mm_per_min) {
  ClBlock block;
  block.kind = kind;
  block.tip_mm = to_array(pose.tip);
  block.axis = to_array(pose.axis);
  if (kind == BlockKind::kCut) {
    block.feed_meaning = FeedMeaning::kTip;
    block.feed = units::per_s_from_per_min(feed_mm_per_min);
  }
  return block;
}

[[nodiscard]] inline ClBlock action(BlockKind kind, ActionKind what, double value) {
  ClBlock block;
  block.kind = kind;
  block.action = what;
  block.value = value;
  return block;
}

[[nodiscard]] inline ToolPose above(const ToolPose& pose, double distance_mm) {
  return {pose.tip + distance_mm * pose.axis, pose.axis};
}

}  // namespace meridian::surface
