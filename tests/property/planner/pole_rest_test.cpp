// SPDX-License-Identifier: Apache-2.0

/// From rest to rest beside the pole: what lies inside the axis tolerance about it takes no turn of
/// the free joint.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "property/planner/smooth_trace.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::pole_rest {
namespace {

ClBlock block_to(std::size_t n, double x, double y) {
  ClBlock block;
  block.sequence = n;
  block.line = 10 + static_cast<std::uint32_t>(n);
  block.tip_mm = {0.5 * static_cast<double>(n), 20, 30};
  block.axis = to_array(Vector3(x, y, 1).normalized());
  block.feed = 50;
  block.feed_meaning = FeedMeaning::kTip;
  return block;
}

/// Axes drawn within `most_deg` of the pole.
std::vector<ClBlock> waver(std::size_t count, double most_deg) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> share(-1, 1);
  const double most = units::rad_from_deg(most_deg) / std::sqrt(2.0);
  std::vector<ClBlock> out;
  for (std::size_t n = 0; n < count; ++n) {
    const double x = most * share(engine);
    out.push_back(block_to(n, x, most * share(engine)));
  }
  end_program(out);
  return out;
}

/// Past the pole at `off_deg`, no block of it beside the pole.
std::vector<ClBlock> pass(double off_deg) {
  std::vector<ClBlock> out;
  const double off = units::rad_from_deg(off_deg);
  for (int n = -5; n <= 6; ++n) {
    const double x = units::rad_from_deg(n - 0.5);
    out.push_back(block_to(static_cast<std::size_t>(n + 5), x, off));
  }
  end_program(out);
  return out;
}

struct Cut {
  double time_s = 0, turn_rad = 0, off = 0;  ///< off: in tolerances
};

Cut cut(const MachineModel& model, const std::vector<ClBlock>& blocks) {
  const JointVector start = joints_of(model, blocks[0]);
  const SmoothTrace trace = plan_smooth(model, blocks, start, {Transition::kExactStop, 0, 0});
  EXPECT_EQ(trace.last.status, PlanStatus::kOk) << "block " << trace.last.reject.sequence;
  const auto setpoints = sample(model, trace, 1e-3, 0.37, start);
  const LimitUse use = measure_limits(model, setpoints, 1e-3);
  EXPECT_LE(std::max({use.v, use.a, use.j}), 1 + 1e-6) << use.where;
  const auto ways = programmed_ways(blocks);
  const auto free = static_cast<std::size_t>(free_joint(model));
  Cut out;
  out.time_s = trace.duration_s();
  for (std::size_t n = 1; n < setpoints.size(); ++n) {
    out.turn_rad += std::abs(setpoints[n].q[free] - setpoints[n - 1].q[free]);
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    const bool is_cut =
        trace.times[k].kind == TimeKind::kMove && trace.paths[k].motion != MotionKind::kApproach;
    if (n % 7 != 0 || !is_cut) continue;
    const ToolPose pose = forward(model, trace.paths[k].tool_length_mm, setpoints[n].q);
    out.off = std::max(out.off, distance_from(ways, trace.times[k].sequence, pose,
                                              model.tolerances.tip_mm, model.tolerances.axis_rad));
  }
  return out;
}

TEST(PoleRest, AWaveringAxisTurnsTheFreeJointNowhere) {
  for (const MachineModel& model : {bench_machine(), lai_machine()}) {
    const Cut at = cut(model, waver(kIsTimed ? 120 : 30, 0.09));
    std::printf("%s: %.3f s, C turns %.4f rad, %.3f tolerances\n", model.name.c_str(), at.time_s,
                at.turn_rad, at.off);
    EXPECT_LT(at.turn_rad, 1e-9);
    EXPECT_LE(at.off, 1 + 1e-6);
  }
}

TEST(PoleRest, ABlockThatPassesInsideTheToleranceRunsThrough) {
  const MachineModel model = lai_machine();
  MachineModel exact = model;
  exact.pole_policy = PolePolicy::kExact;
  const Cut eased = cut(model, pass(0.05)), whole = cut(exact, pass(0.05));
  std::printf("past at 0.05 deg: %.3f s, C turns %.3f rad; exact %.3f s, %.3f rad\n", eased.time_s,
              eased.turn_rad, whole.time_s, whole.turn_rad);
  EXPECT_LT(eased.turn_rad, 0.5);
  EXPECT_LE(eased.off, 1 + 1e-6);
  EXPECT_GT(whole.turn_rad, 2.5);
  EXPECT_LT(whole.off, 0.01);
  EXPECT_LT(eased.time_s, whole.time_s - 1);
}

TEST(PoleRest, WhatPassesFartherOffStaysExact) {
  const MachineModel model = lai_machine();
  EXPECT_LT(cut(model, pass(0.12)).off, 0.01);
}

}  // namespace
}  // namespace meridian::test::pole_rest
