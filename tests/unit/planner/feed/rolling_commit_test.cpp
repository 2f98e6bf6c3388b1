// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/rolling/rolling_feed.hpp"

/// What stands of a planned window, its tail, and what stands in for a plan.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "meridian/planner/motion_port.hpp"
#include "unit/planner/feed/rolled_feed.hpp"

namespace meridian::test::rolling_commit {
namespace {

void expect_same(const FeedPiece& a, const FeedPiece& b) {
  EXPECT_EQ(a.span, b.span);
  EXPECT_EQ(a.cell, b.cell);
  EXPECT_EQ(a.s0, b.s0);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.a, b.a);
  EXPECT_EQ(a.duration, b.duration);
}

TEST(RollingCommit, CommitsTheCellsThatSettingsSay) {
  FeedSettings settings = without_reserve();
  settings.commit_cells = settings.max_commit_cells = 30;
  Rolled one(settings);
  one.add_straight(40, 3.2, 10, 80);
  one.run();
  std::int64_t next = 1;  // from rest the cell at the rest is one more
  for (std::size_t n = 0; n + 1 < one.windows.size(); ++n) {
    next += 30;
    EXPECT_EQ(one.windows[n].committed.back().cell, next - 1) << n;
    EXPECT_EQ(one.windows[n].tail.front().cell, next) << n;
  }
}

/// Cells that the window at `n` of a straight of 80 mm committed, whose braking takes `braking_s`
/// of the 0.3 s of a window.
std::int64_t committed_by(double braking_s, std::size_t n) {
  MachineModel model = bench_machine();
  for (int i = 0; i < 3; ++i) {
    model.joints[i].limits.acceleration = 32 / braking_s;
    model.joints[i].limits.jerk = 1e6;
  }
  FeedSettings settings = without_reserve();
  settings.commit_cells = 25;
  settings.max_commit_cells = 50;
  Rolled one(settings, model);
  one.add_straight(80, 2.0, 10, 80);  // 2.5 ms a cell
  one.run();
  EXPECT_GT(one.windows.size(), n + 1);
  return one.windows[n].committed.back().cell - one.windows[n - 1].committed.back().cell;
}

TEST(RollingCommit, CommitsMoreCellsWhereBrakingIsFarButNoMoreThanItMay) {
  EXPECT_EQ(committed_by(0.02, 4), 50);
}

TEST(RollingCommit, CommitsNoCellsNearTheBraking) {
  // 0.12 s before its end a window of 120 cells of 2.5 ms brakes.
  const std::int64_t cells = committed_by(0.12, 4);
  EXPECT_GT(cells, 25);
  EXPECT_LT(cells, 50);
  EXPECT_EQ(committed_by(0.2, 4), 25);
}

TEST(RollingCommit, ATailIsShortEnoughToBeSkippedInOneCall) {
  FeedSettings settings = without_reserve();
  settings.window_cells = JerkStep::kCells;
  settings.commit_cells = settings.max_commit_cells = 10;
  Rolled one(settings);
  one.add_straight(60, 3.2, 10, 80);
  one.run();
  for (const RolledWindow& w : one.windows) {
    EXPECT_LE(w.tail.size(), MotionReader::kMaxDrops - 8);
    if (!w.tail.empty()) {
      EXPECT_EQ(w.tail.front().cell, w.committed.back().cell + 1) << "cut between cells";
    }
  }
}

TEST(RollingCommit, AWindowWithoutAPlanGoesOnWithTheTailOfTheOneBefore) {
  FeedSettings settings = without_reserve();
  settings.failing_share = 0.4;
  Rolled one(settings);
  one.add_straight(150, 3.2, 10, 80);
  one.run();
  const FeedCount& count = one.feed.count();
  EXPECT_GT(count.kept, 2);
  EXPECT_LT(count.kept, count.windows);
  std::int64_t kept = 0, stops = 0;
  double v = 0, a = 0;
  for (std::size_t n = 0; n < one.windows.size(); ++n) {
    const RolledWindow& w = one.windows[n];
    std::vector<FeedPiece> run = w.committed;
    run.insert(run.end(), w.tail.begin(), w.tail.end());
    expect_joined(run, v, a);
    v = w.tail.empty() ? 0 : state_on(w.committed.back(), 1).ds;
    a = w.tail.empty() ? 0 : state_on(w.committed.back(), 1).dds;
    stops += w.tail.empty() && n + 1 < one.windows.size();
    EXPECT_EQ(n > 0 && one.windows[n - 1].tail.empty(), n > 0 && w.is_from_rest);
    if (n == 0 || one.windows[n - 1].rest_cell != w.rest_cell) continue;
    ++kept;
    const std::vector<FeedPiece>& tail = one.windows[n - 1].tail;
    ASSERT_EQ(run.size(), tail.size());
    for (std::size_t k = 0; k < run.size(); ++k) expect_same(run[k], tail[k]);
  }
  EXPECT_EQ(kept, count.kept);
  EXPECT_EQ(stops, count.stops + count.crawls);
  expect_joined(one.pieces());
}

TEST(RollingCommit, CrawlsFromRestToRestWhereNoWindowHasAPlan) {
  FeedSettings settings = without_reserve();
  settings.failing_share = 1;
  Rolled one(settings);
  one.add_straight(6, 16, 10);
  one.run();
  std::int64_t next = 0;
  for (const RolledWindow& w : one.windows) {
    EXPECT_TRUE(w.is_from_rest);
    EXPECT_TRUE(w.tail.empty());
    EXPECT_EQ(w.committed.front().cell, next);
    EXPECT_EQ(w.committed.back().cell, w.rest_cell - 1);
    expect_joined(w.committed);
    EXPECT_LE(one.use(w.committed).worst(), 1 + 1e-6);
    next = w.rest_cell;
  }
  EXPECT_EQ(next, 60);
  EXPECT_EQ(one.feed.count().crawls, static_cast<std::int64_t>(one.windows.size()));
  EXPECT_EQ(one.windows[0].rest_cell, 48) << "the longest is the fastest on an even path";
}

TEST(RollingCommit, CrawlsOverTheCellsInWhichItIsFastest) {
  FeedSettings settings = without_reserve();
  settings.failing_share = 1;
  Rolled one(settings);
  one.add_straight(1, 4.8, 6, 80);
  one.add_straight(1, 0.8, 1, 0.01);
  one.add_straight(10, 8, 10, 80);
  one.run();
  EXPECT_EQ(one.windows[0].rest_cell, 6);
  expect_joined(one.windows[0].committed);
}

TEST(RollingCommit, GoesOnFromRestWhereTheMachineRanATail) {
  Rolled one;
  one.add_straight(60, 3.2, 10, 80);
  one.begin();
  std::size_t n = 0;
  while (n < 30) ASSERT_FALSE(is_fault(one.feed.push(one.spans[n++])));
  ASSERT_TRUE(one.feed.try_plan());
  const std::int64_t rest = one.feed.window().rest_cell;
  one.feed.resume_from(rest);
  while (n < one.spans.size()) {
    one.take_windows();
    ASSERT_FALSE(is_fault(one.feed.push(one.spans[n++])));
  }
  ASSERT_FALSE(is_fault(one.feed.finish()));
  one.take_windows();
  EXPECT_TRUE(one.feed.is_done());
  EXPECT_TRUE(one.windows[0].is_from_rest);
  EXPECT_EQ(one.windows[0].committed.front().cell, rest);
  expect_joined(one.pieces());
}

TEST(RollingCommit, ResumesNowhereOutsideOfTheCellsThatAreThere) {
  for (const std::int64_t cell : {std::int64_t{-1}, std::int64_t{10000}}) {
    Rolled one;
    one.add_straight(60, 3.2, 10, 80);
    one.begin();
    for (int n = 0; n < 40; ++n) ASSERT_FALSE(is_fault(one.feed.push(one.spans[n])));
    ASSERT_TRUE(one.feed.try_plan());
    const std::int64_t next = one.feed.window().committed.back().cell + 1;
    one.feed.resume_from(cell);
    ASSERT_TRUE(one.feed.try_plan());
    EXPECT_FALSE(one.feed.window().is_from_rest);
    EXPECT_EQ(one.feed.window().committed.front().cell, next);
  }
}

TEST(RollingCommit, APathIsDoneWhenAllOfItIsCommitted) {
  Rolled one;
  one.add_straight(30, 3.2, 10, 80);
  one.begin();
  for (const FeedSpan& span : one.spans) ASSERT_FALSE(is_fault(one.feed.push(span)));
  EXPECT_FALSE(one.feed.is_done());
  ASSERT_FALSE(is_fault(one.feed.finish()));
  while (!one.feed.is_done()) ASSERT_TRUE(one.feed.try_plan());
  EXPECT_FALSE(one.feed.try_plan());
  EXPECT_EQ(one.feed.window().rest_cell, 300);
  EXPECT_EQ(one.feed.count().stops, 0) << "the end of a path is no stop";
  one.begin();
  EXPECT_FALSE(one.feed.is_done());
  EXPECT_TRUE(one.feed.window().committed.empty());
  EXPECT_FALSE(one.feed.window().is_from_rest) << "there is none yet";
}

}  // namespace
}  // namespace meridian::test::rolling_commit
