// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "property/cycle/feed_in_force.hpp"
#include "property/cycle/operated_run.hpp"
#include "property/path/hostile_path.hpp"
#include "property/planner/smooth_trace.hpp"
#include "support/draws.hpp"

/// Feed overrides above 100 %, planned for: joints keep their limits, the tip never exceeds the
/// feed times the override in force, and the plan is the same again from what the planner reported.
namespace meridian::test::feed_raise {
namespace {

constexpr double kRounding = 1 + 1e-6;

using SmoothRunning = PlannedRun<SmoothPlanner>;

MachineModel raising(MachineModel machine, Transition transition = Transition::kSmooth) {
  machine.transition = transition;
  machine.max_feed_override = 1.5;
  return machine;
}

/// One feed that the joints can follow for most of the way, also half as fast again.
std::vector<ClBlock> hostile(std::uint32_t seed, double feed, int sections = 6) {
  auto blocks = HostilePath(seed).make_program(sections);
  for (ClBlock& block : blocks) block.feed = feed;
  return blocks;
}

/// A straight way of `count` blocks of 5 mm.
std::vector<ClBlock> straight(int count, double feed) {
  std::vector<ClBlock> blocks;
  for (int n = 0; n <= count; ++n) {
    ClBlock block;
    block.kind = BlockKind::kCut;
    block.feed_meaning = FeedMeaning::kTip;
    block.feed = feed;
    block.sequence = static_cast<std::uint64_t>(n);
    block.line = static_cast<std::uint32_t>(n) + 1;
    block.tip_mm = {5.0 * n - 100, 20, -50};
    block.axis = {0.2, 0, std::sqrt(0.96)};
    blocks.push_back(block);
  }
  end_program(blocks);
  return blocks;
}

/// Turns the feed up and down and holds now and then.
constexpr Operator kRaising{.turns_rapids = false,
                            .min_wait_s = 0.05,
                            .max_wait_s = 2,
                            .hold_share = 0.15,
                            .feed_share = 0.85,
                            .raise_share = 0.7};

double seconds_of(const SmoothRunning& run) {
  return static_cast<double>(run.world.records.size()) * run.world.dt();
}

/// Tip speed between the last two records.
double speed_of(const SmoothRunning& run) {
  const auto& records = run.world.records;
  const auto tip = [&](std::size_t back) {
    return forward(run.world.machine, run.world.machine.tool_length_mm,
                   records[records.size() - back].joints)
        .tip;
  };
  return (tip(1) - tip(2)).norm() / run.world.dt();
}

TEST(FeedRaise, KeepsLimitsFeedTimesOverrideAndTolerancesOnHostilePrograms) {
  LimitShares worst;
  double seconds = 0, worst_off = 0, worst_feed = 0, fastest = 0;
  const std::uint32_t programs =
      number_of("MERIDIAN_RAISE_PROGRAMS", static_cast<std::uint32_t>(draws(8)));
  for (std::uint32_t seed = 1; seed <= programs; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomPrograms random(seed);
    const MachineModel machine = raising(seed % 2 == 0 ? bench_machine() : lai_machine());
    const double feed = random.log_uniform(3, 60);
    const auto blocks = hostile(seed, feed);
    SmoothRunning run(machine, blocks, joints_of(machine, blocks[0]));
    ASSERT_TRUE(run.is_started());
    Operator raising_operator = kRaising;
    seconds += raising_operator.operate(run, random, 10);
    expect_within_limits(run.world, 0, false, worst);
    EXPECT_EQ(run.world.count(EventCode::kAlarm), 0);
    EXPECT_EQ(run.world.count(EventCode::kRefused), 0);
    const double used = largest_feed(run, feed);
    EXPECT_LE(used, kRounding);
    worst_feed = std::max(worst_feed, used);
    const auto paths = programmed_paths(blocks);
    double programmed = 0;
    Vector3 tip = Vector3::Zero();
    std::uint64_t cycle = 0;
    for_each_cut(machine, run.world.records, 0, 1, [&](const auto& record, const auto& pose) {
      if (record.setpoint.cycle == cycle + 1) {
        programmed = std::max(programmed, (pose.tip - tip).norm() / run.world.dt() / feed);
      }
      tip = pose.tip;
      cycle = record.setpoint.cycle;
      if (cycle % 31 != 0) return;
      worst_off =
          std::max(worst_off, distance_from(paths, record.sequence, pose, machine.tolerances.tip_mm,
                                            machine.tolerances.axis_rad));
    });
    fastest = std::max(fastest, programmed);
  }
  std::printf(
      "%.0f s, worst v %.6f a %.6f j %.6f, %.6f of feed times override, %.3f of the feed, "
      "%.3f tolerances\n",
      seconds, worst.v, worst.a, worst.j, worst_feed, fastest, worst_off);
  EXPECT_GT(fastest, 1.2) << "nothing was planned for more than the programmed feed";
  EXPECT_LE(worst_off, 1 + 1e-6);
}

/// Raised for a moment, long before what is planned for it comes: when it does, it must not be run
/// faster than what is then in force.
TEST(FeedRaise, LoweredBeforeWhatIsPlannedFasterComesIsInForceThere) {
  const double feed = 20;
  const MachineModel machine = raising(bench_machine());
  const auto blocks = straight(40, feed);
  double worst = 0;
  for (int n = 0; n < 4; ++n) {
    SCOPED_TRACE(n);
    SmoothRunning run(machine, blocks, joints_of(machine, blocks[0]));
    ASSERT_TRUE(run.is_started());
    for (double t = 0; t < 1; t += run.world.dt()) run.run();
    run.command(Verb::kFeedOverride, 1.5);
    for (double t = 0; t < 0.4 + 0.4 * n; t += run.world.dt()) run.run();
    run.command(Verb::kFeedOverride, 1.0 + 0.1 * n);
    while (!run.is_over()) run.run();
    const double used = largest_feed(run, feed);
    EXPECT_LE(used, kRounding);
    worst = std::max(worst, used);
  }
  std::printf("%.6f of feed times override\n", worst);
}

TEST(FeedRaise, TakesEffectWithinTheLookAheadAndSavesItsTime) {
  const double feed = 20;
  const MachineModel machine = raising(bench_machine());
  const auto blocks = straight(40, feed);
  const auto run_with = [&](double factor, double& reached_s) {
    SmoothRunning run(machine, blocks, joints_of(machine, blocks[0]));
    EXPECT_TRUE(run.is_started());
    for (double t = 0; t < 1; t += run.world.dt()) run.run();
    run.command(Verb::kFeedOverride, factor);
    const double set_s = seconds_of(run);
    reached_s = -1;
    while (!run.is_over()) {
      run.run();
      if (reached_s < 0 && speed_of(run) > 0.99 * factor * feed)
        reached_s = seconds_of(run) - set_s;
    }
    return seconds_of(run);
  };
  double reached_s = 0, reached_more_s = 0;
  const double at_100_s = run_with(1, reached_s);
  const double at_150_s = run_with(1.5, reached_more_s);
  std::printf(
      "200 mm at %.0f mm/s: %.3f s, at 150 %% from the first second on %.3f s; in force after "
      "%.3f s\n",
      feed, at_100_s, at_150_s, reached_more_s);
  EXPECT_GT(reached_more_s, 0);
  // The horizon, a window and what the spline holds back, and the lead of the label.
  EXPECT_LT(reached_more_s, kFeedHorizon_s + 2.0);
  const double left_s = at_100_s - 1 - reached_more_s;  // of the way at the old feed
  EXPECT_NEAR(at_100_s - at_150_s, left_s / 3, 0.4);
}

TEST(FeedRaise, LoweredIsInForceAtOnce) {
  const double feed = 20;
  const MachineModel machine = raising(bench_machine());
  const auto blocks = straight(40, feed);
  SmoothRunning run(machine, blocks, joints_of(machine, blocks[0]));
  ASSERT_TRUE(run.is_started());
  run.command(Verb::kFeedOverride, 1.5);
  for (double t = 0; t < 5; t += run.world.dt()) run.run();
  EXPECT_GT(speed_of(run), 1.49 * feed);
  run.command(Verb::kFeedOverride, 0.6);
  for (double t = 0; t < 0.6 + 0.2; t += run.world.dt()) run.run();  // (1 - 0.6/1.5) of the ramp
  EXPECT_NEAR(speed_of(run), 0.6 * feed, 0.002 * feed);
  run.command(Verb::kFeedOverride, 1.51);
  EXPECT_EQ(run.world.count(EventCode::kRefused), 1);
  EXPECT_EQ(run.world.state.feed_override, 0.6);
}

TEST(FeedRaise, IsReplayedBitForBitFromItsMarksHoweverFarAheadThePlanIs) {
  for (const auto transition : {Transition::kSmooth, Transition::kExactStop}) {
    const MachineModel machine = raising(lai_machine(), transition);
    const auto blocks = hostile(3, 20, 12);
    struct Said {
      std::size_t cycle;
      double factor;
    };
    RandomPrograms random(11);
    std::vector<Said> said;
    SmoothRunning live(machine, blocks, joints_of(machine, blocks[0]));
    ASSERT_TRUE(live.is_started());
    for (int n = 0; n < 12; ++n) {
      for (int k = 0; k < 500; ++k) live.run();
      const double factor = random.uniform(0.8, 1.5);
      said.push_back({live.world.records.size(), factor});
      live.command(Verb::kFeedOverride, factor);
    }
    while (!live.is_over()) live.run();
    std::vector<FeedMark> marks;
    for (FeedMark mark; live.planner().take_feed_mark(mark);) marks.push_back(mark);
    ASSERT_GT(marks.size(), 4U);
    EXPECT_TRUE(marks.front().is_begin);
    // The same program, all of it planned at once.
    const auto replay = [&](const std::vector<FeedMark>& with) {
      MachineModel at_once = machine;
      SmoothRunning run(at_once, blocks, joints_of(machine, blocks[0]), ~std::size_t{0}, &with);
      EXPECT_TRUE(run.is_started());
      std::size_t next = 0;
      while (!run.is_over()) {
        const bool is_due = next < said.size() && run.world.records.size() == said[next].cycle;
        if (is_due) {
          run.command(Verb::kFeedOverride, said[next++].factor);
        } else {
          run.run();
        }
      }
      const auto& a = live.world.records;
      const auto& b = run.world.records;
      if (a.size() != b.size()) return false;
      for (std::size_t n = 0; n < a.size(); ++n) {
        if (a[n].joints != b[n].joints || a[n].rate != b[n].rate) return false;
      }
      return true;
    };
    EXPECT_TRUE(replay(marks));
    std::vector<FeedMark> other = marks;
    for (FeedMark& mark : other) ++mark.span, ++mark.sequence;
    EXPECT_FALSE(replay(other)) << "the marks say nothing";
  }
}

}  // namespace
}  // namespace meridian::test::feed_raise
