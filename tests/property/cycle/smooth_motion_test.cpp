// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "property/cycle/operated_run.hpp"
#include "property/cycle/stepped_program.hpp"
#include "property/path/hostile_path.hpp"
#include "property/planner/smooth_trace.hpp"
#include "support/draws.hpp"

/// Smooth plans in the cycle: holds, overrides, FaultStops at any instant, and blocks that come
/// late. The machine keeps to its path and every joint to its limits.
namespace meridian::test::smooth_motion {
namespace {

using test::LimitShares;
using SmoothRunning = test::PlannedRun<SmoothPlanner>;

constexpr double kLimit = 1 + 1e-6;
constexpr double kMaxSeconds = 15;  // of motion per program

std::vector<ClBlock> hostile(std::uint32_t seed, int sections = 6) {
  auto blocks = test::HostilePath(seed).make_program(sections);
  for (ClBlock& block : blocks) block.feed = std::max(block.feed, 20.0);
  return blocks;
}

/// Largest matched distance from the programmed path, in tolerances, of every eleventh setpoint
/// that moves.
double largest_distance(const MachineModel& machine, const std::vector<ClBlock>& blocks,
                        const std::vector<CycleRecord>& records, std::size_t first = 0) {
  const auto paths = test::programmed_paths(blocks);
  double largest = 0;
  test::for_each_cut(machine, records, first, 11, [&](const auto& record, const auto& pose) {
    const double off = test::distance_from(paths, record.sequence, pose, machine.tolerances.tip_mm,
                                           machine.tolerances.axis_rad);
    largest = std::max(largest, off);
  });
  return largest;
}

TEST(SmoothMotion, KeepsPathAndLimitsUnderHoldsAndOverrides) {
  LimitShares worst;
  double seconds = 0, worst_off = 0;
  int done = 0;
  test::Operator random_operator{.min_override = 0.1, .turns_rapids = false};
  for (std::uint32_t seed = 1; seed <= test::draws(6); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::RandomPrograms random(seed);
    MachineModel machine = seed % 2 == 0 ? test::bench_machine() : test::lai_machine();
    machine.transition = Transition::kSmooth;
    const auto blocks = hostile(seed);
    SmoothRunning run(machine, blocks, test::joints_of(machine, blocks[0]));
    ASSERT_TRUE(run.is_started());
    seconds += random_operator.operate(run, random, kMaxSeconds);
    done += run.is_over();
    test::expect_within_limits(run.world, 0, false, worst);
    EXPECT_EQ(run.world.count(EventCode::kAlarm), 0);
    worst_off = std::max(worst_off, largest_distance(machine, blocks, run.world.records));
  }
  std::printf(
      "%d programs to the end, %.0f s, %d holds; worst v %.6f a %.6f j %.6f; "
      "%.3f tolerances\n",
      done, seconds, random_operator.holds, worst.v, worst.a, worst.j, worst_off);
  EXPECT_GT(seconds, test::draws(40));
  EXPECT_GT(random_operator.holds, test::draws(20));
  EXPECT_LE(worst_off, 1 + 1e-6);
}

/// Plans have all of the limits: the override is left next to nothing.
MachineModel without_reserve() {
  MachineModel machine = test::bench_machine();
  machine.transition = Transition::kSmooth;
  machine.override_ramp_s = 1000;
  return machine;
}

/// A plan with all of the limits in it leaves the rate next to no room. A hold then stops where the
/// plan gives it authority, at the latest at the plan's next rest.
TEST(SmoothMotion, HoldsWherePlansKeepNothingForTheOverride) {
  LimitShares worst;
  double longest = 0;
  int holds = 0;
  constexpr std::uint32_t kHolds = std::max(test::draws(16), 4);
  for (std::uint32_t n = 0; n < kHolds; ++n) {
    SCOPED_TRACE(testing::Message() << "hold " << n);
    test::RandomPrograms random(7000 + n);
    const MachineModel machine = without_reserve();
    const auto blocks = hostile(1 + n % 6);
    SmoothRunning run(machine, blocks, test::joints_of(machine, blocks[0]));
    ASSERT_TRUE(run.is_started());
    const double until = random.uniform(0.2, 3);
    for (double t = 0; t < until && !run.is_over(); t += run.world.dt()) run.run();
    if (run.is_over()) continue;
    run.command(Verb::kHold);
    double t = 0;
    for (; t < 10 && run.world.now() != State::kHeld; t += run.world.dt()) run.run();
    EXPECT_EQ(run.world.now(), State::kHeld);
    longest = std::max(longest, t);
    ++holds;
    test::expect_within_limits(run.world, 0, false, worst);
  }
  std::printf("%d holds, the longest %.3f s; worst v %.6f a %.6f j %.6f\n", holds, longest, worst.v,
              worst.a, worst.j);
  EXPECT_GT(holds, static_cast<int>(kHolds) / 2);
  EXPECT_LT(longest, 1.5);
  EXPECT_GT(worst.j, 0.9) << "the reserve was kept";
}

TEST(SmoothMotion, FaultStopsWherePlansKeepNothingForTheOverride) {
  LimitShares worst;
  double longest = 0;
  int stops = 0;
  constexpr std::uint32_t kStops = std::max(test::draws(10), 3);
  for (std::uint32_t n = 0; n < kStops; ++n) {
    SCOPED_TRACE(testing::Message() << "stop " << n);
    test::RandomPrograms random(7100 + n);
    const MachineModel machine = without_reserve();
    const auto blocks = hostile(1 + n % 6);
    SmoothRunning run(machine, blocks, test::joints_of(machine, blocks[0]));
    ASSERT_TRUE(run.is_started());
    if (!test::run_into_fault(run, random.uniform(0.2, 3))) continue;
    const std::size_t first = run.world.records.size();
    ASSERT_TRUE(run.world.run_until(State::kFault, 10));
    ++stops;
    longest =
        std::max(longest, static_cast<double>(run.world.records.size() - first) * run.world.dt());
    test::expect_within_limits(run.world, first, true, worst);
  }
  std::printf("%d FaultStops, the longest %.3f s; worst v %.6f a %.6f j %.6f\n", stops, longest,
              worst.v, worst.a, worst.j);
  EXPECT_GT(stops, static_cast<int>(kStops) / 2);
  EXPECT_LT(longest, 0.5);
}

TEST(SmoothMotion, GoesOnWhereBlocksComeTooLate) {
  LimitShares worst;
  std::uint64_t dry = 0;
  for (std::uint32_t seed = 21; seed < 21 + test::draws(2); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::RandomPrograms random(seed);
    MachineModel machine = test::lai_machine();
    machine.starve_auto_resume_s = 100;
    machine.transition = Transition::kSmooth;
    const auto blocks = hostile(seed, 20);
    SmoothRunning run(machine, blocks, test::joints_of(machine, blocks[0]), blocks.size() / 2);
    ASSERT_TRUE(run.is_started());
    run.max_blocks = 1;
    for (double t = 0; t < 200 && !run.is_over(); t += run.world.dt()) {
      if (random.chance(0.004)) {
        run.run();
      } else {
        run.run_unplanned();
      }
    }
    EXPECT_TRUE(run.is_over());
    dry += run.world.state.starvations;
    test::expect_within_limits(run.world, 0, false, worst);
    EXPECT_EQ(run.world.count(EventCode::kAlarm), 0);
    EXPECT_LE(largest_distance(machine, blocks, run.world.records), 1 + 1e-6);
    const ToolPose end = forward(machine, machine.tool_length_mm, run.world.records.back().joints);
    EXPECT_LE((end.tip - to_vector(blocks[blocks.size() - 2].tip_mm)).norm(), 2e-6);
  }
  std::printf("%llu times dry; worst v %.6f a %.6f j %.6f\n", static_cast<unsigned long long>(dry),
              worst.v, worst.a, worst.j);
  EXPECT_GT(dry, static_cast<unsigned>(test::draws(2)) * 2U);
}

/// All of a program is published before it starts. Wherever a hold ends, the planner can go on.
TEST(SmoothMotion, GoesOnAfterHoldsWhereThePlanIsFarAhead) {
  int holds = 0, along_plan = 0;
  for (std::uint32_t seed = 11; seed < 11 + std::max(test::draws(6), 3); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::RandomPrograms random(seed);
    const test::single_block::Job job(seed);
    SmoothRunning run(job.machine, job.blocks, job.start());
    ASSERT_TRUE(run.is_started());
    double hold_at = 0, holding = 0;
    for (double t = 0; t < 200 && !run.is_over(); t += run.world.dt()) {
      const State state = run.world.now();
      if (state == State::kHeld) {
        run.command(Verb::kResume);
        along_plan += holding > 0.35;
        holding = 0;
        hold_at = t + random.log_uniform(0.05, 1);
      } else if (state == State::kRunning && t > hold_at) {
        run.command(Verb::kHold);
        ++holds;
      } else {
        run.run();
        holding += state == State::kHolding ? run.world.dt() : 0;
      }
    }
    EXPECT_TRUE(run.is_over());
    EXPECT_EQ(run.world.state.starvations, 0U);
  }
  std::printf("%d holds, %d of more than 0.35 s\n", holds, along_plan);
  EXPECT_GT(along_plan, 0);
}

/// The last cut of a run is too short for a span, and turns the axis: what follows starts from
/// where the machine is. At 8 kHz a step of 1e-8 rad is above every limit of jerk.
TEST(SmoothMotion, GoesOnBehindACutThatIsTooShortToBeOne) {
  MachineModel machine = test::bench_machine();
  machine.transition = Transition::kSmooth;
  machine.cycle_ns = 125'000;
  constexpr double kTilt = 0.051, kTurn = 0.95e-9;  // of the axis
  std::vector<ClBlock> blocks;
  for (int n = 0; n < 13; ++n) {
    ClBlock block;
    block.sequence = static_cast<std::uint64_t>(n);
    const double azimuth = n < 11 ? 0.3 : 0.3 + kTurn / kTilt;
    block.kind = n < 12 ? BlockKind::kCut : BlockKind::kRapid;
    block.tip_mm = {n < 11 ? 1.0 * n : n == 11 ? 10.0 : 12.0, 0, 0};
    block.axis = {std::sin(kTilt) * std::cos(azimuth), std::sin(kTilt) * std::sin(azimuth),
                  std::cos(kTilt)};
    block.feed = 50;
    block.feed_meaning = n < 12 ? FeedMeaning::kTip : FeedMeaning::kNone;
    blocks.push_back(block);
  }
  test::end_program(blocks);
  SmoothRunning run(machine, blocks, test::joints_of(machine, blocks[0]));
  ASSERT_TRUE(run.is_started());
  for (double t = 0; t < 5 && !run.is_over(); t += run.world.dt()) run.run();
  EXPECT_EQ(run.world.count(EventCode::kProgramEnd), 1) << "refused: the joints would jump";
  LimitShares worst;
  test::expect_within_limits(run.world, 0, false, worst);
}

TEST(SmoothMotion, StopsOnThePathByTheFaultStopLimits) {
  LimitShares worst;
  double worst_off = 0, longest = 0;
  int stops = 0, over = 0;
  for (std::uint32_t n = 0; n < test::draws(16); ++n) {
    test::RandomPrograms random(9000 + n);
    MachineModel machine = test::bench_machine();
    machine.transition = Transition::kSmooth;
    const auto blocks = hostile(1 + n % 6);
    SmoothRunning run(machine, blocks, test::joints_of(machine, blocks[0]));
    ASSERT_TRUE(run.is_started());
    const double until = random.uniform(0.2, 3);
    if (!test::run_into_fault(run, until)) continue;
    const std::size_t first = run.world.records.size();
    ASSERT_TRUE(run.world.run_until(State::kFault, 10));
    ++stops;
    const LimitShares shares = test::shares_of_limits(run.world, first, true);
    over += std::max({shares.v, shares.a, shares.j}) > kLimit ? 1 : 0;
    worst.take(shares);
    longest =
        std::max(longest, static_cast<double>(run.world.records.size() - first) * run.world.dt());
    worst_off = std::max(worst_off, largest_distance(machine, blocks, run.world.records, first));
  }
  std::printf("%d FaultStops, %d over a limit, worst v %.4f a %.4f j %.4f, longest %.3f s\n", stops,
              over, worst.v, worst.a, worst.j, longest);
  EXPECT_GT(16 * stops, 10 * test::draws(16));
  EXPECT_EQ(over, 0);
  EXPECT_LE(worst_off, 1 + 1e-6);
}

}  // namespace
}  // namespace meridian::test::smooth_motion
