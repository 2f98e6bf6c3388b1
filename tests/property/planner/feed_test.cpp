// SPDX-License-Identifier: Apache-2.0
// The feed over smooth paths: fast, inside every limit between the grid's points too, and always
// with a way to rest, whatever fails.
#include <gtest/gtest.h>

#include <bit>
#include <cstdio>

#include "meridian/cycle/rate_filter.hpp"
#include "property/planner/feed_paths.hpp"
#include "service/core/planner/feed/solver/two_pass.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"

namespace meridian::test::feed {
namespace {

constexpr double kLimit = 1 + 1e-6;
constexpr double kCycle_s = 250e-6;
const auto kNever = [](int) { return false; };

constexpr int kPaths = draws(60), kFailingPaths = draws(12);

MachineModel draw_machine(RandomPrograms& draw) {
  MachineModel model = draw.chance(0.5) ? lai_machine() : bench_machine();
  if (draw.chance(0.5)) {  // other ratios of the limits make other rows the active ones
    for (int i = 0; i < model.joint_count; ++i) {
      model.joints[i].limits.velocity *= draw.log_uniform(0.5, 2);
      model.joints[i].limits.acceleration *= draw.log_uniform(0.3, 5);
      model.joints[i].limits.jerk *= draw.log_uniform(0.3, 5);
    }
  }
  return model;
}

FeedPeaks check_run(const FeedPath& path, const FeedRun& run) {
  return check(path, sample_feed(path, run, [](int k) { return k * kCycle_s; }), kCycle_s);
}

FeedSettings without_reserve() {
  FeedSettings settings;
  settings.reserve = {0, 0};
  return settings;
}

TEST(RollingFeed, KeepsEveryLimitAtFourKilohertzOnRandomPaths) {
  FeedPeaks peaks;
  FeedCount count;
  double motion_s = 0;
  for (int n = 0; n < kPaths; ++n) {
    const auto seed = static_cast<std::uint64_t>(3100000 + n);
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomPrograms draw(seed);
    const FeedPath path = draw_path(draw_machine(draw), draw);
    FeedSettings settings = draw.chance(0.5) ? without_reserve() : FeedSettings{};
    settings.refinements = draw.chance(0.5) ? 1 : 2;
    const FeedRun run = run_feed(path, settings, true, kNever);
    ASSERT_EQ(run.fault.kind, PathFault::Kind::kNone) << "joint " << run.fault.joint;
    ASSERT_TRUE(run.ended_at_rest);
    const FeedPeaks use = check_run(path, run);
    ASSERT_LE(use.worst(), kLimit)
        << use.where << " v " << use.v << " a " << use.a << " j " << use.j << " feed " << use.feed;
    peaks.take(use);
    motion_s += run.duration_s();
    count.windows += run.count.windows;
    count.kept += run.count.kept;
    count.crawls += run.count.crawls;
  }
  std::printf(
      "%d paths, %.0f s; largest use v %.5f a %.5f j %.5f feed %.5f; %lld windows, %lld kept "
      "the old plan, %lld crawls\n",
      kPaths, motion_s, peaks.v, peaks.a, peaks.j, peaks.feed,
      static_cast<long long>(count.windows), static_cast<long long>(count.kept),
      static_cast<long long>(count.crawls));
  EXPECT_GT(peaks.j, 0.99) << "slower than it need be";
  EXPECT_LE(count.kept + count.crawls, count.windows / 50);
}

TEST(RollingFeed, DependsOnTheSpansAloneAndNotOnWhenTheyCame) {
  for (std::uint64_t seed = 3200000; seed < 3200006; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomPrograms draw(seed);
    const FeedPath path = draw_path(lai_machine(), draw);
    const FeedRun early = run_feed(path, {}, true, kNever);
    const FeedRun late = run_feed(path, {}, false, kNever);
    ASSERT_EQ(early.pieces.size(), late.pieces.size());
    for (std::size_t n = 0; n < early.pieces.size(); ++n) {
      const FeedPiece &a = early.pieces[n], &b = late.pieces[n];
      const double x[] = {a.duration, a.s0, a.v, a.a, a.j, a.k};
      const double y[] = {b.duration, b.s0, b.v, b.a, b.j, b.k};
      ASSERT_EQ(a.span, b.span);
      for (int i = 0; i < 6; ++i) {
        ASSERT_EQ(std::bit_cast<std::uint64_t>(x[i]), std::bit_cast<std::uint64_t>(y[i])) << n;
      }
    }
  }
}

TEST(RollingFeed, KeepsEveryLimitWhereWindowsHaveNoPlan) {
  double plain_s = 0;
  for (const double share : {0.0, 0.05, 0.3, 0.9, 1.0}) {
    FeedPeaks peaks;
    double motion_s = 0;
    std::int64_t kept = 0, crawls = 0;
    for (std::uint64_t seed = 3300000; seed < 3300000 + kFailingPaths; ++seed) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " share " << share);
      RandomPrograms draw(seed);
      const FeedPath path = draw_path(draw_machine(draw), draw);
      FeedSettings settings;
      settings.failing_share = share;
      const FeedRun run = run_feed(path, settings, true, kNever);
      ASSERT_TRUE(run.ended_at_rest);
      const FeedPeaks use = check_run(path, run);
      ASSERT_LE(use.worst(), kLimit) << use.where;
      peaks.take(use);
      motion_s += run.duration_s();
      kept += run.count.kept;
      crawls += run.count.crawls;
    }
    if (share == 0) plain_s = motion_s;
    std::printf(
        "failing %.2f: %.1f s, %.2f times; kept %lld, crawls %lld; largest use v %.4f a %.4f "
        "j %.4f\n",
        share, motion_s, motion_s / plain_s, static_cast<long long>(kept),
        static_cast<long long>(crawls), peaks.v, peaks.a, peaks.j);
    EXPECT_GT(kept + crawls, share > 0 ? 0 : -1);
    EXPECT_LT(motion_s, 6 * plain_s);
  }
}

TEST(RollingFeed, GoesOnFromTheEndOfAnyTailInsideTheLimits) {
  int starvations = 0;
  for (std::uint64_t seed = 3400000; seed < 3400016; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomPrograms draw(seed);
    const FeedPath path = draw_path(draw_machine(draw), draw);
    FeedSettings settings;
    settings.failing_share = draw.chance(0.3) ? 0.2 : 0;
    const FeedRun run = run_feed(path, settings, true, [&](int) {
      const bool is_starved = draw.chance(0.3);
      starvations += is_starved ? 1 : 0;
      return is_starved;
    });
    ASSERT_TRUE(run.ended_at_rest);
    const FeedPeaks use = check_run(path, run);
    ASSERT_LE(use.worst(), kLimit) << use.where;
  }
  EXPECT_GT(starvations, 15);
}

TEST(RollingFeed, RunsAtEveryRateThatTheFilterGivesInsideTheLimits) {
  FeedPeaks peaks;
  for (std::uint64_t seed = 3500000; seed < 3500016; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomPrograms draw(seed);
    const FeedPath path = draw_path(draw_machine(draw), draw);
    const FeedRun run = run_feed(path, {}, true, kNever);
    RateFilter rate;
    rate.reset(1);
    double plan_time = 0, next_change = 0;
    const auto time = [&](int k) {
      if (k * kCycle_s >= next_change) {
        rate.aim(draw.chance(0.3) ? 0.0 : draw.chance(0.5) ? 1.0 : draw.uniform(0, 1));
        next_change = k * kCycle_s + draw.uniform(0.02, 1.2);
      }
      return plan_time += rate.advance(kCycle_s);
    };
    const FeedPeaks use = check(path, sample_feed(path, run, time), kCycle_s);
    ASSERT_LE(use.worst(), kLimit)
        << use.where << " v " << use.v << " a " << use.a << " j " << use.j;
    peaks.take(use);
  }
  std::printf("at random rates: largest use v %.4f a %.4f j %.4f\n", peaks.v, peaks.a, peaks.j);
}

/// Time of the two-pass bound over the cells of a path: no motion inside velocity, feed and
/// acceleration takes less on that grid.
void find_bound_s(const FeedPath& path, const FeedSettings& settings, double& time) {
  const FeedLimits limits = make_feed_limits(path.model, settings.reserve);
  CellSettings cells_in_store = settings.cells;
  cells_in_store.cell_s = 0.008;  // all of the path in the grid at a time
  CellGrid grid(path.model, limits, cells_in_store);
  grid.begin(path.start, path.model.tool_length_mm);
  for (const BandSpan& span : path.spans) {
    ASSERT_TRUE(grid.has_room()) << "the grid is full";
    EXPECT_EQ(grid.push({span, path.branch, false, {}, 0}).kind, PathFault::Kind::kNone);
  }
  EXPECT_EQ(grid.finish().kind, PathFault::Kind::kNone);
  EXPECT_TRUE(grid.is_complete());
  const auto cells = static_cast<std::size_t>(grid.last());
  std::vector<double> backward(cells + 1), b(cells + 1);
  two_pass(grid, limits, 0, 0, backward, b);
  time = 0;
  for (std::size_t k = 0; k < cells; ++k) {
    time += 2 * grid[static_cast<std::int64_t>(k)].h / (std::sqrt(b[k]) + std::sqrt(b[k + 1]));
  }
}

TEST(CellGrid, EndsAPathOnNoSliverOfACell) {
  std::vector<ToolPose> poses;
  const Vector3 axis = Vector3(0.1, 0.5, 1).normalized();
  for (int n = 0; n <= 60; ++n) poses.push_back({Vector3(n - 30, 60, 10), axis});
  FeedPath path{bench_machine(), make_spans(poses, 4.0, 80), {}, 0};
  path.start = solve(path.model, path.model.tool_length_mm, poses[0], 0, {}).q;
  const FeedSettings settings;
  const FeedLimits limits = make_feed_limits(path.model, settings.reserve);
  int ends = 0;
  for (std::size_t number = 2; number + 2 < path.spans.size(); ++number) {
    CellGrid grid(path.model, limits, settings.cells);
    grid.begin(path.start, path.model.tool_length_mm);
    for (const BandSpan& span : path.spans) {
      ASSERT_EQ(grid.push({span, path.branch, false, {}, 0}).kind, PathFault::Kind::kNone);
    }
    ASSERT_EQ(grid.finish().kind, PathFault::Kind::kNone);
    std::int64_t second = 0;  // cell of the span
    while (grid[second].span != number) ++second;
    if (grid[++second].span != number) continue;
    const double x = grid[second].x + 0.01 * grid[second].h;
    grid.end_at({path.spans[number], path.branch, false, {}, 0}, number, x, 0);
    const FeedCell& last = grid[grid.last() - 1];
    EXPECT_NEAR(last.x + last.h, x, 1e-12) << "of span " << number;
    EXPECT_GE(last.h, grid[grid.last() - 2].h / 2.5) << "of span " << number;
    ++ends;
  }
  EXPECT_GT(ends, 3);
}

TEST(RollingFeed, IsHardlySlowerThanTheBoundWithoutJerk) {
  // A sine of 40 mm, axis swaying along: long enough for the jerk at its ends to weigh little.
  std::vector<ToolPose> poses;
  for (int n = 0; n <= 240; ++n) {
    const double x = 0.5 * n;
    poses.push_back({Vector3(x - 60, 20 * std::sin(0.1 * x) + 60, 10),
                     Vector3(0.2 * std::sin(0.05 * x), 0.5, 1).normalized()});
  }
  FeedPath path{bench_machine(), make_spans(poses, 1.0, 80), {}, 0};
  path.start = solve(path.model, path.model.tool_length_mm, poses[0], 0, {}).q;
  const FeedSettings settings = without_reserve();
  const FeedRun run = run_feed(path, settings, true, kNever);
  double bound = 0;
  find_bound_s(path, settings, bound);
  std::printf("%.4f s, bound %.4f s\n", run.duration_s(), bound);
  EXPECT_GT(run.duration_s(), 0.999 * bound);
  EXPECT_LT(run.duration_s(), 1.04 * bound);
  EXPECT_EQ(run.count.kept + run.count.crawls + run.count.stops, 0);
}

TEST(RollingFeed, RefusesAPathThatLeavesTravel) {
  std::vector<ToolPose> poses;
  for (int n = 0; n <= 100; ++n) {
    poses.push_back({Vector3(20.0 * n, 60, 10), Vector3(0, 0.5, 1).normalized()});
  }
  FeedPath path{lai_machine(), make_spans(poses, 2.0, 80), {}, 0};
  path.start = solve(path.model, path.model.tool_length_mm, poses[0], 0, {}).q;
  const FeedRun run = run_feed(path, {}, true, kNever);
  EXPECT_EQ(run.fault.kind, PathFault::Kind::kTravel);
  EXPECT_GE(run.fault.joint, 0);
}

}  // namespace
}  // namespace meridian::test::feed
