// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <vector>

#include "property/planner/plan_trace.hpp"
#include "property/rt/program_run.hpp"

/// Holds, overrides and FaultStops at any instant of random programs: the machine keeps to its path
/// and every joint to its limits, third differences included.
namespace meridian {
namespace {

using test::Draw;
using test::LimitShares;
using test::ProgramRun;

constexpr std::uint64_t kSeed = 20240620;
constexpr int kPrograms = 60;
constexpr double kMostSeconds = 40;  // of motion per program
constexpr double kLimit = 1 + 1e-6;
constexpr double kTip_mm = 1e-6, kAxis_rad = 1e-9;  // rounding of the matched pose
// Beside the pole the axis is eased (kPoleEase_rad), and matching trades axis for tip at this rate.
constexpr double kTrade_mm_per_rad = 1.01 * 1e-3 / (1e-3 * units::kDegree_rad);

TEST(CycleMotion, KeepsPathAndLimitsUnderRandomHoldsAndOverrides) {
  std::cout << "seed " << kSeed << ", " << kPrograms << " programs\n";
  LimitShares worst;
  double worst_tip = 0, worst_axis = 0, seconds = 0;
  int holds = 0, done = 0;
  for (int n = 0; n < kPrograms; ++n) {
    Draw draw(kSeed + static_cast<std::uint64_t>(n));
    ProgramRun run(draw.machine, draw.blocks, draw.start());
    if (!run.is_started()) continue;
    const auto ways = test::programmed_ways(draw.blocks);
    double next = 0, t = 0;
    const double dt = run.world.dt();
    for (; t < kMostSeconds && !run.is_over(); t += dt) {
      if (t < next) {
        run.run();
        continue;
      }
      next = t + draw.random.log_uniform(0.01, 1.0);
      const double what = draw.random.uniform(0, 1);
      if (run.world.now() == State::kHeld) {
        run.command(Verb::kResume);
      } else if (what < 0.5) {
        run.command(Verb::kHold);
        ++holds;
      } else if (what < 0.8) {
        run.command(Verb::kFeedOverride, draw.random.uniform(0, 1.5));
      } else {
        run.command(Verb::kRapidOverride, draw.random.uniform(0.2, 1.0));
      }
    }
    done += run.is_over();
    seconds += t;
    const LimitShares shares = test::shares_of_limits(run.world, 0, false);
    EXPECT_LE(std::max({shares.v, shares.a, shares.j}), kLimit)
        << "program " << n << " v " << shares.v << " a " << shares.a << " j " << shares.j;
    worst.take(shares);
    EXPECT_EQ(run.world.count(EventCode::kAlarm), 0) << "program " << n;
    for (std::size_t k = 0; k < run.world.records.size(); k += 7) {
      const CycleRecord& record = run.world.records[k];
      EXPECT_GE(record.rate, 0);
      if ((record.setpoint.flags & kSetpointMoving) == 0) continue;
      if (record.motion == MotionKind::kApproach) continue;
      const ToolPose pose = forward(draw.machine, draw.machine.tool_length_mm, record.joints);
      const test::Deviation off = test::match_pose(ways[record.sequence], pose);
      worst_tip = std::max(worst_tip, off.tip_mm - kTrade_mm_per_rad * off.axis_rad);
      worst_axis = std::max(worst_axis, off.axis_rad);
    }
  }
  std::printf(
      "%d of %d programs to the end, %.0f s, %d holds; worst v %.6f a %.6f j %.6f; "
      "tip %.2e mm, axis %.2e rad\n",
      done, kPrograms, seconds, holds, worst.v, worst.a, worst.j, worst_tip, worst_axis);
  EXPECT_GT(done, 0);
  EXPECT_LE(worst_tip, kTip_mm);
  EXPECT_LE(worst_axis, kPoleEase_rad + kAxis_rad);
}

TEST(CycleMotion, FaultStopsKeepPathAndFaultLimitsAtAnyInstant) {
  std::cout << "seed " << kSeed << "\n";
  LimitShares worst;
  double worst_tip = 0;
  int stops = 0;
  for (int n = 0; n < 4 * kPrograms; ++n) {
    Draw draw(kSeed + 2000 + static_cast<std::uint64_t>(n));
    ProgramRun run(draw.machine, draw.blocks, draw.start());
    if (!run.is_started()) continue;
    const auto ways = test::programmed_ways(draw.blocks);
    const double until = draw.random.uniform(0.05, 3);
    for (double t = 0; t < until && !run.is_over(); t += run.world.dt()) run.run();
    if (draw.random.chance(0.3)) run.command(Verb::kHold);
    if (run.is_over()) continue;
    run.world.in.feedback.fault_mask = 1;
    const std::size_t first = run.world.records.size();
    ASSERT_TRUE(run.world.run_until(State::kFault, 10));
    ++stops;
    const LimitShares shares = test::shares_of_limits(run.world, first, true);
    EXPECT_LE(std::max({shares.v, shares.a, shares.j}), kLimit)
        << "program " << n << " v " << shares.v << " a " << shares.a << " j " << shares.j;
    worst.take(shares);
    for (std::size_t k = first; k < run.world.records.size(); ++k) {
      const CycleRecord& record = run.world.records[k];
      if (record.motion == MotionKind::kApproach || record.state != State::kFaultStop) continue;
      const ToolPose pose = forward(draw.machine, draw.machine.tool_length_mm, record.joints);
      const test::Deviation off = test::match_pose(ways[record.sequence], pose);
      worst_tip = std::max(worst_tip, off.tip_mm - kTrade_mm_per_rad * off.axis_rad);
    }
  }
  std::printf("%d FaultStops; worst v %.6f a %.6f j %.6f; tip %.2e mm\n", stops, worst.v, worst.a,
              worst.j, worst_tip);
  EXPECT_GT(stops, kPrograms);
  EXPECT_LE(worst_tip, kTip_mm);
}

}  // namespace
}  // namespace meridian
