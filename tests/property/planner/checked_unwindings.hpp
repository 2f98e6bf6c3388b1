// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"

/// Checks programs in which C comes to its end of travel.
namespace meridian::test::unwind {

inline constexpr double kLimit = 1 + 1e-6;

/// Checks what was made of `blocks`, the unwindings alone: off along the tool axis, C alone, back.
/// Returns their number.
inline int check_unwindings(const MachineModel& model, const SmoothTrace& trace,
                            const std::vector<PlanSample>& setpoints) {
  const int free = redundant_joint(model);
  int count = 0;
  bool was_in = false;
  JointVector rest{};
  double farthest = 0;
  for (std::size_t n = 1; n < setpoints.size(); ++n) {
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    const bool is_in =
        trace.times[k].kind == TimeKind::kMove && trace.paths[k].motion == MotionKind::kUnwind;
    const double length = model.tool_length_mm;
    if (is_in && !was_in) {
      rest = setpoints[n - 1].q;
      farthest = 0;
      ++count;
    }
    const ToolPose begin = forward(model, length, rest);
    const ToolPose pose = forward(model, length, setpoints[n].q);
    const double off = (pose.tip - begin.tip).dot(begin.axis);
    if (is_in) {
      const double turned = std::abs(setpoints[n].q[free] - setpoints[n - 1].q[free]);
      // The setpoint before the first may be a cycle short of the rest: 1 µm.
      if (turned > 0 &&
          std::abs(std::remainder(setpoints[n].q[free] - rest[free], kTurn_rad)) > 1e-5) {
        EXPECT_NEAR(farthest, kRetract_mm, 1e-3) << "C turns beside the part";
        for (int i = 0; i < model.joint_count; ++i) {
          if (i == free) continue;
          EXPECT_NEAR(setpoints[n].q[i], setpoints[n - 1].q[i], 1e-9) << "with C, joint " << i;
        }
      } else {
        farthest = std::max(farthest, off);
        EXPECT_LT((pose.tip - begin.tip - off * begin.axis).norm(), 2e-3);
        EXPECT_LT(angle_between(pose.axis, begin.axis), 1e-4);
        EXPECT_GT(off, -1e-3);
      }
    } else if (was_in) {
      EXPECT_LT((pose.tip - begin.tip).norm(), 2e-2) << "not where it left";
      EXPECT_NEAR(farthest, kRetract_mm, 1e-3);
      EXPECT_GT(std::abs(setpoints[n].q[free] - rest[free]), 6);
    }
    was_in = is_in;
  }
  return count;
}

/// Of all programs that were checked: unwindings, and the most of the limits and in tolerances.
struct Found {
  int unwindings = 0;
  double v = 0, a = 0, j = 0, off = 0;
};

/// Checks what was made of `blocks`: travel, limits, feed, the distance from the programmed path
/// off approaches and unwindings, these by themselves, and that the program ends at its last cut.
inline void check(const MachineModel& model, const SmoothTrace& trace,
                  const std::vector<ClBlock>& blocks, const JointVector& start, Found& found) {
  ASSERT_EQ(trace.last.status, PlanStatus::kOk)
      << "code " << static_cast<int>(trace.last.reject.code) << " joint " << trace.last.reject.joint
      << " block " << trace.last.reject.sequence << " at " << trace.last.reject.value;
  ASSERT_EQ(trace.times.back().kind, TimeKind::kEnd);
  const auto ways = programmed_paths(blocks);
  const auto setpoints = sample(model, trace, 1e-3, 0.37, start);
  const LimitUse use = measure_limits(model, setpoints, 1e-3);
  EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where;
  EXPECT_LE(measure_feed(model, trace, setpoints, 1e-3), 1.0001);
  for (std::size_t n = 3; n + 3 < setpoints.size(); ++n) {
    ASSERT_LT(first_joint_outside_travel(model, setpoints[n].q, 1e-9), 0) << "setpoint " << n;
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    const PathPiece& path = trace.paths[k];
    if (n % 11 != 0 || trace.times[k].kind != TimeKind::kMove) continue;
    if (path.motion == MotionKind::kApproach || path.motion == MotionKind::kUnwind) continue;
    const ToolPose pose = forward(model, path.tool_length_mm, setpoints[n].q);
    const double off = distance_from(ways, trace.times[k].sequence, pose, model.tolerances.tip_mm,
                                     model.tolerances.axis_rad);
    ASSERT_LE(off, kLimit) << "setpoint " << n << " block " << trace.times[k].sequence;
    found.off = std::max(found.off, off);
  }
  const int unwindings = check_unwindings(model, trace, setpoints);
  EXPECT_EQ(unwindings, static_cast<int>(trace.unwindings.size()));
  found.unwindings += unwindings;
  found.v = std::max(found.v, use.v);
  found.a = std::max(found.a, use.a);
  found.j = std::max(found.j, use.j);
  const ToolPose end = forward(model, model.tool_length_mm, trace.joints);
  EXPECT_LE((end.tip - to_vector(blocks[blocks.size() - 2].tip_mm)).norm(), 2e-6);
}

}  // namespace meridian::test::unwind
