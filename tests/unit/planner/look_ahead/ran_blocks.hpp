// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/look_ahead/smooth_run.hpp"
#include "support/machines.hpp"
#include "unit/planner/look_ahead/published.hpp"

/// A smooth run of blocks, and what it published.
namespace meridian::test::ran_blocks {

using Status = SmoothRun::Status;

inline constexpr double kTolerance_rad = 1.745e-3;
inline const ToolPose kBegin{Vector3(0, 30, -20), Vector3(0.3, 0.2, 1).normalized()};

inline ClBlock cut_to(const ToolPose& end, std::uint64_t sequence, double feed = 50) {
  ClBlock block;
  block.sequence = sequence;
  block.line = static_cast<std::uint32_t>(sequence) + 100;
  block.tip_mm = to_array(end.tip);
  block.axis = to_array(end.axis);
  block.feed_meaning = FeedMeaning::kTip;
  block.feed = feed;
  return block;
}

/// A run of blocks from kBegin on, and what it published.
struct Ran : Published {
  explicit Ran(const MachineModel& m = bench_machine(), const ToolPose& from = kBegin)
      : model(m), pose(from) {
    raise.begin(model.tool_length_mm);
    start.pose = start.programmed = from;
    start.joints = solve(model, model.tool_length_mm, from, 0, {}).q;
    start.tool_length_mm = model.tool_length_mm;
    start.epoch = 3;
    start.path_index = 70;
    start.window = 11;
    begin();
  }
  void begin() {
    BandTolerance tolerance;
    tolerance.pole = to_array(pole_direction(model));
    run.begin(start, tolerance, kTolerance_rad);
  }
  Status cut(const ToolPose& end, double feed = 50) {
    run.take(cut_to(pose = end, sequence++, feed));
    return status = run.publish(writer);
  }
  /// `count` blocks of `length` mm along x.
  void cut_straight(int count, double length, double feed = 50) {
    for (int n = 0; n < count; ++n) {
      cut({pose.tip + Vector3(length, 0, 0), pose.axis}, feed);
    }
  }
  Status finish() {
    run.finish();
    return status = run.publish(writer);
  }

  MachineModel model;
  FeedRaise raise{model};
  SmoothRun run{model, raise};
  MotionReader reader{*port};
  RunStart start;
  ToolPose pose;
  std::uint64_t sequence = 40;
  Status status = Status::kNeedsBlocks;
};

}  // namespace meridian::test::ran_blocks
