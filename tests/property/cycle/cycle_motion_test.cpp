// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <vector>

#include "property/cycle/operated_run.hpp"
#include "property/planner/plan_trace.hpp"
#include "support/draws.hpp"

/// Holds, overrides and FaultStops at any instant of random programs: the machine keeps to its path
/// and every joint to its limits, third differences included.
namespace meridian::test::cycle_motion {
namespace {

using test::Draw;
using test::LimitShares;
using test::ProgramRun;

constexpr std::uint64_t kSeed = 20240620;
constexpr int kPrograms = test::draws(60);
constexpr double kMaxSeconds = 40;                  // of motion per program
constexpr double kTip_mm = 1e-6, kAxis_rad = 1e-9;  // rounding of the matched pose
// Beside the pole the axis is relaxed (kPoleDeviation_rad), and matching trades axis for tip at
// this rate.
constexpr double kTrade_mm_per_rad = 1.01 * 1e-3 / (1e-3 * units::kDegree_rad);

TEST(CycleMotion, KeepsPathAndLimitsUnderRandomHoldsAndOverrides) {
  std::cout << "seed " << kSeed << ", " << kPrograms << " programs\n";
  LimitShares worst;
  double worst_tip = 0, worst_axis = 0, seconds = 0;
  int done = 0;
  test::Operator random_operator;
  for (int n = 0; n < kPrograms; ++n) {
    SCOPED_TRACE(testing::Message() << "program " << n);
    Draw draw(kSeed + static_cast<std::uint64_t>(n));
    ProgramRun run(draw.machine, draw.blocks, draw.start());
    if (!run.is_started()) continue;
    const auto paths = test::programmed_paths(draw.blocks);
    seconds += random_operator.operate(run, draw.random, kMaxSeconds);
    done += run.is_over();
    test::expect_within_limits(run.world, 0, false, worst);
    EXPECT_EQ(run.world.count(EventCode::kAlarm), 0);
    for (const CycleRecord& record : run.world.records) EXPECT_GE(record.rate, 0);
    test::for_each_cut(
        draw.machine, run.world.records, 0, 7, [&](const auto& record, const auto& pose) {
          const test::Deviation off = test::match_pose(paths[record.sequence], pose);
          worst_tip = std::max(worst_tip, off.tip_mm - kTrade_mm_per_rad * off.axis_rad);
          worst_axis = std::max(worst_axis, off.axis_rad);
        });
  }
  std::printf(
      "%d of %d programs to the end, %.0f s, %d holds; worst v %.6f a %.6f j %.6f; "
      "tip %.2e mm, axis %.2e rad\n",
      done, kPrograms, seconds, random_operator.holds, worst.v, worst.a, worst.j, worst_tip,
      worst_axis);
  EXPECT_GT(done, 0);
  EXPECT_LE(worst_tip, kTip_mm);
  EXPECT_LE(worst_axis, kPoleDeviation_rad + kAxis_rad);
}

TEST(CycleMotion, FaultStopsKeepPathAndFaultLimitsAtAnyInstant) {
  std::cout << "seed " << kSeed << "\n";
  LimitShares worst;
  double worst_tip = 0;
  int stops = 0;
  for (int n = 0; n < 4 * kPrograms; ++n) {
    SCOPED_TRACE(testing::Message() << "program " << n);
    Draw draw(kSeed + 2000 + static_cast<std::uint64_t>(n));
    ProgramRun run(draw.machine, draw.blocks, draw.start());
    if (!run.is_started()) continue;
    const auto paths = test::programmed_paths(draw.blocks);
    const double until = draw.random.uniform(0.05, 3);
    const bool is_held = draw.random.chance(0.3);
    if (!test::run_into_fault(run, until)) continue;
    if (is_held) run.command(Verb::kHold);
    const std::size_t first = run.world.records.size();
    ASSERT_TRUE(run.world.run_until(State::kFault, 10));
    ++stops;
    test::expect_within_limits(run.world, first, true, worst);
    test::for_each_cut(
        draw.machine, run.world.records, first, 1, [&](const auto& record, const auto& pose) {
          const test::Deviation off = test::match_pose(paths[record.sequence], pose);
          worst_tip = std::max(worst_tip, off.tip_mm - kTrade_mm_per_rad * off.axis_rad);
        });
  }
  std::printf("%d FaultStops; worst v %.6f a %.6f j %.6f; tip %.2e mm\n", stops, worst.v, worst.a,
              worst.j, worst_tip);
  EXPECT_GT(stops, kPrograms);
  EXPECT_LE(worst_tip, kTip_mm);
}

}  // namespace
}  // namespace meridian::test::cycle_motion
