// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/rolling/rolling_feed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "unit/planner/feed/rolled_feed.hpp"

namespace meridian::test::rolling_feed {
namespace {

constexpr double kLimit = 1 + 1e-6;

/// The least time from rest to rest over `length` with cruise at `v`.
double ideal_s(double length, double v, double a = 3000, double j = 60000) {
  const double depth = std::min(a, std::sqrt(j * v));
  return length / v + v / depth + depth / j;
}

TEST(RollingFeed, RunsAStraightPathHardlySlowerThanItsLimitsAllow) {
  Rolled one;
  one.add_straight(30, 3.2, 10, 80);
  one.run();
  const auto pieces = one.pieces();
  expect_joined(pieces);
  const double ideal = ideal_s(96, 80);
  EXPECT_GT(one.duration(), 0.999 * ideal);
  EXPECT_LT(one.duration(), 1.01 * ideal);
  const FeedUse use = one.use(pieces);
  EXPECT_LE(use.worst(), kLimit);
  EXPECT_LE(use.b, kLimit);
  EXPECT_GT(use.b, 0.99);
  EXPECT_GT(use.jerk, 0.9);
}

/// Less of the limits is planned in the tail alone, so that the next window has a way on.
TEST(RollingFeed, UsesAllOfTheAccelerationInTheCellsThatStand) {
  Rolled rolled;
  rolled.add_straight(40, 2, 10);
  rolled.run();
  int checked = 0;
  double begin = 0;
  for (const RolledWindow& window : rolled.windows) {
    for (const FeedPiece& piece : window.committed) {
      const PathState state = state_on(piece, 0.5);
      // There it is constant, before the window prepares to brake.
      if (begin > 1.5 && begin < 2.9) {
        EXPECT_GT(state.dds, 2996) << begin << ": 0.999 of 3000 is planned";
        ++checked;
      }
      begin += state_on(piece, 1).s - state_on(piece, 0).s;
    }
  }
  EXPECT_GT(checked, 5);
}

TEST(RollingFeed, KeepsEveryLimitOnABentPathAndUsesThem) {
  for (const double feed : {20.0, 1000.0}) {
    for (const int refinements : {1, 2}) {
      FeedSettings settings = without_reserve();
      settings.refinements = refinements;
      Rolled one(settings);
      one.add_bent(40, feed);
      one.run();
      const auto pieces = one.pieces();
      expect_joined(pieces);
      const FeedUse use = one.use(pieces);
      EXPECT_LE(use.worst(), kLimit);
      EXPECT_LE(use.b, 1.002 * kLimit);
      EXPECT_GT(std::max(use.b, use.jerk), 0.98);
      EXPECT_EQ(one.feed.count().crawls, 0);
      EXPECT_EQ(one.feed.count().stops, 0);
    }
  }
}

TEST(RollingFeed, PlansAWindowWhenItsCellsAreThereAndNotEarlier) {
  Rolled one;
  one.add_straight(40, 3.2, 10, 80);
  one.begin();
  int pushed = 0;
  const auto push = [&] { ASSERT_FALSE(is_fault(one.feed.push(one.spans[pushed++]))); };
  while (one.feed.grid().last() < 120) {
    EXPECT_FALSE(one.feed.try_plan());
    push();
  }
  EXPECT_EQ(pushed, 12 + CellGrid::kAhead);
  ASSERT_TRUE(one.feed.try_plan());
  EXPECT_TRUE(one.feed.window().is_from_rest);
  EXPECT_EQ(one.feed.window().rest_cell, 120);
  const std::int64_t kept = one.feed.window().committed.back().cell + 1;
  EXPECT_FALSE(one.feed.try_plan()) << "until as many follow";
  while (one.feed.grid().last() < kept + 120) {
    EXPECT_FALSE(one.feed.try_plan());
    push();
  }
  ASSERT_TRUE(one.feed.try_plan());
  EXPECT_FALSE(one.feed.window().is_from_rest);
  EXPECT_EQ(one.feed.window().rest_cell, kept + 120);
  EXPECT_EQ(one.feed.count().windows, 2);
}

TEST(RollingFeed, EveryWindowGoesOnFromTheLastAndCouldEndAtRestInItsTail) {
  Rolled one;
  one.add_straight(60, 3.2, 10, 80);
  one.run();
  ASSERT_GT(one.windows.size(), 5U);
  double v = 0, a = 0;
  std::int64_t next = 0;
  for (const RolledWindow& w : one.windows) {
    std::vector<FeedPiece> run = w.committed;
    run.insert(run.end(), w.tail.begin(), w.tail.end());
    expect_joined(run, v, a);
    EXPECT_LE(one.use(run).worst(), kLimit);
    EXPECT_EQ(run.front().cell, next);
    EXPECT_EQ(run.back().cell, w.rest_cell - 1);
    const PathState end = state_on(w.committed.back(), 1);
    v = end.ds;
    a = end.dds;
    next = w.committed.back().cell + 1;
  }
  EXPECT_TRUE(one.windows.back().tail.empty());
  EXPECT_EQ(one.windows.back().rest_cell, 600);
}

TEST(RollingFeed, NotEvenRoundingComesBetweenTwoWindows) {
  Rolled straight, bent;
  straight.add_straight(60, 3.2, 10, 80);
  bent.add_bent(40, 1000);
  for (Rolled* one : {&straight, &bent}) {
    one->run();
    ASSERT_GT(one->windows.size(), 5U);
    for (std::size_t n = 1; n < one->windows.size(); ++n) {
      const FeedPiece& planned = one->windows[n - 1].tail.front();
      const FeedPiece& got = one->windows[n].committed.front();
      EXPECT_EQ(got.cell, planned.cell) << n;
      EXPECT_EQ(got.v, planned.v) << n;
      EXPECT_EQ(got.a, planned.a) << n;
    }
  }
}

TEST(RollingFeed, DependsOnTheSpansAndNotOnWhenTheyCame) {
  Rolled early, late;
  for (Rolled* one : {&early, &late}) one->add_bent(40, 30);
  early.run(true);
  late.run(false);
  const auto a = early.pieces(), b = late.pieces();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    EXPECT_EQ(a[n].duration, b[n].duration);
    EXPECT_EQ(a[n].v, b[n].v);
  }
}

TEST(RollingFeed, LeavesRoomForTheRateFilter) {
  MachineModel model = bench_machine();
  EXPECT_EQ(feed_settings(model).reserve.slope, 1);
  EXPECT_EQ(feed_settings(model).reserve.curvature, 10);
  model.override_ramp_s = 2;
  EXPECT_EQ(feed_settings(model).reserve.slope, 0.5);
  EXPECT_EQ(feed_settings(model).reserve.curvature, 5);
  const Rolled one(feed_settings(model), model);
  EXPECT_EQ(one.feed.limits().slope, 0.5);
  EXPECT_LT(one.feed.limits().jerk[0], model.joints[0].limits.jerk);
}

TEST(RollingFeed, KeepsAWindowAndWhatItCommitsInsideOfWhatTheSolverHolds) {
  struct Case {
    int wanted, window;
  };
  for (const Case& c : {Case{5, 20}, {50, 50}, {1000, JerkStep::kCells}}) {
    FeedSettings settings = without_reserve();
    settings.window_cells = c.wanted;
    settings.commit_cells = 1000;
    Rolled one(settings);
    one.add_straight(40, 3.2, 10, 80);
    one.run();
    EXPECT_EQ(one.windows.front().rest_cell, c.window);
    EXPECT_LE(one.windows.front().committed.back().cell, c.window - 10);
    EXPECT_FALSE(one.windows.front().tail.empty());
  }
}

TEST(RollingFeed, ASlowCellNearARestDoesNotMakeTheMotionCrawl) {
  for (const bool is_at_end : {false, true}) {
    Rolled one;
    one.add_straight(1, is_at_end ? 64 : 1.6, is_at_end ? 200 : 5, 80);
    one.add_straight(1, 0.32, 1, 4);
    one.add_straight(1, is_at_end ? 1.6 : 64, is_at_end ? 5 : 200, 80);
    one.run();
    EXPECT_LT(one.duration(), 2 * ideal_s(66, 80)) << (is_at_end ? "end" : "begin");
    EXPECT_EQ(one.feed.count().crawls + one.feed.count().kept, 0);
  }
}

TEST(RollingFeed, AStartKeepsTheSpeedOfTheElevenCellsBesideTheRest) {
  const auto speed_behind_start = [](int slow_cell) {
    Rolled one;
    one.add_straight(1, 0.32 * slow_cell, slow_cell, 80);
    one.add_straight(1, 0.32, 1, 15);
    one.add_straight(1, 64, 200, 80);
    one.run();
    return state_on(one.windows.front().committed.front(), 1).ds;
  };
  const double bound = speed_behind_start(11), free = speed_behind_start(12);
  EXPECT_LT(bound, 15.1) << "the twelfth cell from the rest on";
  EXPECT_GT(free, 18);
}

/// Beyond the old plan a tangent at a bound without jerk asks for less than the jerk there.
TEST(RollingFeed, GoesOnWhereThePlanBeforeSlowedDownForJerk) {
  MachineModel model = bench_machine();
  model.joints[1].limits.acceleration = 8.55;
  model.joints[1].limits.jerk = 62.7;
  FeedSettings settings;
  settings.reserve = {1.2, 0};
  Rolled one(settings, model);
  add_swing(one);
  one.run();
  const auto pieces = one.pieces();
  expect_joined(pieces);
  EXPECT_LE(one.use(pieces).worst(), kLimit);
  EXPECT_LT(one.duration(), 3.4);
  EXPECT_EQ(one.feed.count().kept + one.feed.count().crawls, 0);
  std::int64_t next = 0;
  for (const RolledWindow& window : one.windows) {
    EXPECT_EQ(window.rest_cell, std::min(next + 120, one.feed.grid().last())) << "as far as it may";
    next = window.committed.back().cell + 1;
  }
}

TEST(RollingFeed, SpendsNoMoreRoundsOfTheSolverThanItMay) {
  FeedSettings settings = without_reserve();
  Rolled plain(settings);
  plain.add_bent(40, 1000);
  plain.run();
  EXPECT_GT(plain.feed.count().max_rounds, 8);
  EXPECT_GE(plain.feed.count().rounds, plain.feed.count().max_rounds);
  EXPECT_GE(plain.feed.count().solves, plain.feed.count().windows);
  settings.max_rounds = 0;
  Rolled none(settings);
  none.add_bent(40, 1000);
  none.run();
  EXPECT_EQ(none.feed.count().solves, 0);
  EXPECT_EQ(none.feed.count().crawls, none.feed.count().windows);
  settings.max_rounds = 1;
  Rolled one(settings);
  one.add_bent(40, 1000);
  one.run();
  EXPECT_EQ(one.feed.count().solves, one.feed.count().windows) << "the first may begin";
}

TEST(RollingFeed, AFaultEndsThePathAndWhatIsBeforeIsStillPlanned) {
  MachineModel model = bench_machine();
  model.joints[0].limits.travel_max = 50.1;
  Rolled one(without_reserve(), model);
  one.add_straight(20, 3.2, 10, 80);
  one.begin();
  PathFault fault;
  std::size_t n = 0;
  for (; n < one.spans.size() && !is_fault(fault); ++n) fault = one.feed.push(one.spans[n]);
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(one.feed.fault().kind, PathFault::Kind::kTravel);
  EXPECT_EQ(one.feed.faulty_span(), 15U);
  EXPECT_NEAR(one.feed.faulty_x(), 2.1, 0.05);
  EXPECT_FALSE(one.feed.is_done());
  one.take_windows();
  ASSERT_FALSE(one.windows.empty());
  EXPECT_LT(one.windows.back().committed.back().cell, one.feed.grid().last());
}

TEST(RollingFeed, WaitsAtTheBeginForAsManyMoreCellsAsGradingMadeThere) {
  Rolled one;
  one.add_straight(400, 0.5, 0);
  one.begin();
  const int window = FeedSettings{}.window_cells;
  bool has_waited = false;
  for (const FeedSpan& span : one.spans) {
    ASSERT_FALSE(is_fault(one.feed.push(span)));
    const CellGrid& grid = one.feed.grid();
    const bool is_planned = one.feed.try_plan();
    EXPECT_EQ(is_planned, grid.last() >= window + grid.added_at_begin());
    has_waited = has_waited || (!is_planned && grid.last() >= window);
    if (is_planned) break;
  }
  EXPECT_GT(one.feed.grid().added_at_begin(), 10);
  EXPECT_TRUE(has_waited);
}

}  // namespace
}  // namespace meridian::test::rolling_feed
