// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/feed_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/feed/cells/feed_rounding.hpp"
#include "unit/planner/feed/made_cells.hpp"
#include "unit/planner/feed/straight_grid.hpp"

namespace meridian::test::cell_grid {
namespace {

TEST(CellGrid, MakesTheCellsThatASpanAsksFor) {
  StraightGrid g;
  ASSERT_FALSE(is_fault(g.push(60, 48)));
  ASSERT_FALSE(is_fault(g.push(30, 24)));
  ASSERT_FALSE(is_fault(g.grid.finish()));
  ASSERT_EQ(g.grid.last(), 72);
  EXPECT_EQ(g.grid.first(), 0);
  EXPECT_TRUE(g.grid.is_complete());
  g.expect_gapless({60, 30});
  for (std::int64_t k = 0; k < 72; ++k) {
    EXPECT_EQ(g.grid[k].span, k < 48 ? 0U : 1U);
    EXPECT_NEAR(g.grid[k].h, 1.25, 1e-9);
    EXPECT_EQ(g.grid[k].tight, 1) << "far from any pole";
  }
  EXPECT_NEAR(g.grid.joints()[0], 90, 1e-9);
}

TEST(CellGrid, BeginsASpanWhereItsPathIsSaidToBegin) {
  StraightGrid g;
  g.at[0] = -7;
  FeedSpan span = g.next(60, 50);
  span.begin = 10;
  span.length = 50;
  g.grid.begin({3}, g.model.tool_length_mm);
  ASSERT_FALSE(is_fault(g.grid.push(span)));
  ASSERT_FALSE(is_fault(g.grid.finish()));
  EXPECT_NEAR(g.grid[0].x, 10, 1e-12);
  EXPECT_NEAR(g.grid.joints()[0], 53, 1e-9);
}

TEST(CellGrid, ACellTakesAboutTheTimeThatSettingsSay) {
  for (const double feed : {20.0, 100.0, 1000.0}) {
    for (const double cell_s : {0.004, 0.01}) {
      StraightGrid g(bench_machine(), {.cell_s = cell_s, .rest_s = 1, .feed_share = 0.9});
      FeedSpan span = g.next(30);
      span.u_speed_mm_per_s = feed;
      ASSERT_FALSE(is_fault(g.grid.push(span)));
      ASSERT_FALSE(is_fault(g.grid.finish()));
      const double speed = std::min(0.9 * feed, 300.0);
      const double wanted = std::ceil(30 / speed / cell_s - 1e-9);
      if (wanted < CellGrid::kMin) {
        EXPECT_GE(g.grid.last(), CellGrid::kMin);
        continue;
      }
      EXPECT_EQ(static_cast<double>(g.grid.last()), std::min(wanted, 400.0)) << feed;
    }
  }
}

TEST(CellGrid, AsksForTheTimeOfThePartOfThePathThatASpanCovers) {
  // 60 mm of line, the first 10 of which are well off the pole, the last beside it
  StraightGrid g(bench_machine(), {.rest_s = 1});
  const auto pose = [](double x, double tilt) {
    return ToolPose{Vector3(x, 10, -20), Vector3(std::sin(tilt), 0, std::cos(tilt))};
  };
  FeedSpan span;
  span.path = make_line(pose(0, 0.5), pose(60, 0.02));
  span.path.tool_length_mm = g.model.tool_length_mm;
  const JointVector start =
      solve(g.model, g.model.tool_length_mm, pose(0, 0.5), 0, JointVector{}).q;
  span.feed_mm_per_s = 10;
  span.length = span.path.length / 6;
  g.grid.begin(start, g.model.tool_length_mm);
  ASSERT_FALSE(is_fault(g.grid.push(span)));
  ASSERT_FALSE(is_fault(g.grid.finish()));
  const double seconds = 10 / (10 * 0.9985);
  EXPECT_EQ(g.grid.last(), std::ceil(seconds / 0.004));
}

TEST(CellGrid, CellsGrowFromTheRestsAtBothEndsOfAPath) {
  for (const int spans : {1, 6}) {
    StraightGrid g(bench_machine(), {.rest_s = 0.007, .feed_share = 1});
    std::vector<double> lengths(static_cast<std::size_t>(spans), 60.0 / spans);
    for (const double length : lengths) {
      FeedSpan span = g.next(length);
      span.u_speed_mm_per_s = 100;
      ASSERT_FALSE(is_fault(g.grid.push(span)));
    }
    ASSERT_FALSE(is_fault(g.grid.finish()));
    g.expect_gapless(lengths);
    const double d1 = std::abs(g.grid[0].at[0].d1[0]);
    const double first = g.limits.full_jerk[0] / d1 * std::pow(0.007, 3) / 6;
    const std::int64_t last = g.grid.last() - 1;
    EXPECT_LE(g.grid[0].h, first) << "what the joint comes in 7 ms";
    EXPECT_GT(g.grid[0].h, 0.5 * first);
    EXPECT_NEAR(g.grid[last].h, g.grid[0].h, 0.3 * first);
    double behind = 0, ahead = 0;
    for (std::int64_t k = 0; k <= last; ++k) {
      EXPECT_LE(g.grid[k].h, std::max(first, 0.15 * behind) + 1e-12) << k;
      EXPECT_LE(g.grid[last - k].h, std::max(first, 0.15 * ahead) + 1e-12) << k;
      behind += g.grid[k].h;
      ahead += g.grid[last - k].h;
    }
    EXPECT_GT(g.grid[last / 2].h, 10 * first) << "and at full speed they are as long as ever";
  }
}

TEST(CellGrid, NoCellIsMuchLongerThanItsNeighbour) {
  for (const bool is_short_last : {false, true}) {
    StraightGrid g;
    std::vector<double> lengths{80, 0.02, 80};
    if (is_short_last) lengths = {80, 80, 0.02};
    for (const double length : lengths) ASSERT_FALSE(is_fault(g.push(length, 20)));
    ASSERT_FALSE(is_fault(g.grid.finish()));
    g.expect_gapless(lengths);
    double longest = 0;
    for (std::int64_t k = 1; k < g.grid.last(); ++k) {
      const double ratio = g.grid[k].h / g.grid[k - 1].h;
      EXPECT_LE(std::max(ratio, 1 / ratio), 2.5 * (1 + 1e-9)) << k;
      longest = std::max(longest, g.grid[k].h);
    }
    EXPECT_NEAR(longest, 4, 1e-9) << "far from the short ones cells stay as they are";
  }
}

TEST(CellGrid, CellsBehindAShortOneThatIsMadeGrowFromThere) {
  StraightGrid g;
  std::vector<double> lengths{0.4};
  ASSERT_FALSE(is_fault(g.push(0.4, 40)));
  for (int n = 0; n < CellGrid::kAhead; ++n) {
    lengths.push_back(0.4);
    ASSERT_FALSE(is_fault(g.push(0.4, 4)));
  }
  ASSERT_EQ(g.grid.last(), 40) << "the first span is made before the long one comes";
  for (int n = 0; n < 4; ++n) {
    lengths.push_back(30);
    ASSERT_FALSE(is_fault(g.push(30, 10)));
  }
  ASSERT_FALSE(is_fault(g.grid.finish()));
  g.expect_gapless(lengths);
  for (std::int64_t k = 41; k < g.grid.last(); ++k) {
    EXPECT_LE(g.grid[k].h, 2.5 * g.grid[k - 1].h * (1 + 1e-9)) << k;
  }
}

TEST(CellGrid, MakesCellsOnceFourSpansFollow) {
  StraightGrid g;
  for (int n = 0; n < CellGrid::kAhead; ++n) {
    ASSERT_FALSE(is_fault(g.push(40, 40)));
    EXPECT_EQ(g.grid.last(), 0) << n;
  }
  ASSERT_FALSE(is_fault(g.push(40, 40)));
  EXPECT_EQ(g.grid.last(), 40);
  ASSERT_FALSE(is_fault(g.push(40, 40)));
  EXPECT_EQ(g.grid.last(), 80);
  EXPECT_EQ(g.grid[79].span, 1U);
  EXPECT_FALSE(g.grid.is_complete());
  ASSERT_FALSE(is_fault(g.grid.finish()));
  EXPECT_EQ(g.grid.last(), 240);
  EXPECT_TRUE(g.grid.is_complete());
}

TEST(CellGrid, DoesNotBeginBeforeItIsSureOfFortyCells) {
  StraightGrid g;
  for (int n = 0; n < 39; ++n) {
    ASSERT_TRUE(g.grid.has_room());
    ASSERT_FALSE(is_fault(g.push(1, 1)));
    EXPECT_EQ(g.grid.last(), 0) << n;
  }
  ASSERT_FALSE(is_fault(g.push(1, 1)));
  EXPECT_EQ(g.grid.last(), 40 - CellGrid::kAhead);
}

TEST(CellGrid, AShortPathHasCellsEnoughForAMotionToBeShaped) {
  for (const int cells : {1, 3, 39, 40}) {
    StraightGrid g;
    ASSERT_FALSE(is_fault(g.push(2, cells)));
    ASSERT_FALSE(is_fault(g.grid.finish()));
    int expected = cells;
    while (expected < CellGrid::kMin) expected *= 2;
    EXPECT_EQ(g.grid.last(), expected);
    g.expect_gapless({2});
  }
}

TEST(CellGrid, CellsWithoutRoomWaitUntilOthersAreDropped) {
  CellSettings settings;
  settings.kept_cells = 64;
  StraightGrid g(bench_machine(), settings);
  ASSERT_FALSE(is_fault(g.push(100, 100)));
  ASSERT_FALSE(is_fault(g.grid.finish()));
  EXPECT_EQ(g.grid.last(), 64);
  EXPECT_FALSE(g.grid.is_complete());
  g.grid.drop_before(30);
  EXPECT_EQ(g.grid.first(), 30);
  ASSERT_FALSE(is_fault(g.grid.make_cells()));
  EXPECT_EQ(g.grid.last(), 94);
  EXPECT_NEAR(g.grid[93].x, 93, 1e-9);
  g.grid.drop_before(20);
  EXPECT_EQ(g.grid.first(), 30) << "what is dropped stays so";
  g.grid.drop_before(1000);
  EXPECT_EQ(g.grid.first(), 94);
  ASSERT_FALSE(is_fault(g.grid.make_cells()));
  EXPECT_EQ(g.grid.last(), 100);
  EXPECT_TRUE(g.grid.is_complete());
}

TEST(CellGrid, SaysWhenNoMoreSpansFit) {
  StraightGrid g;
  int spans = 0;
  for (; g.grid.has_room(); ++spans) ASSERT_FALSE(is_fault(g.push(0.001, 1)));
  EXPECT_EQ(spans, 512 + CellGrid::kMin + CellGrid::kAhead + 4) << "cells, and spans that wait";
  g.grid.drop_before(100);
  ASSERT_FALSE(is_fault(g.grid.make_cells()));
  EXPECT_TRUE(g.grid.has_room()) << "what became cells waits no more";
}

/// A robot may be so slow beside a singular place that one span becomes thousands of cells. They
/// are made when the spans behind it are there: these have to find room.
TEST(CellGrid, TakesTheSpansBehindOneThatBecomesAsManyCellsAsItMay) {
  MachineModel robot = bench_machine();
  robot.family = MachineFamily::kRobot;  // its spans are joint moves
  StraightGrid g(robot);
  int spans = 0;
  for (; g.grid.has_room() && g.grid.last() == 0; ++spans) {
    FeedSpan span = g.next(5);
    span.u_speed_mm_per_s = 1e-4;
    ASSERT_FALSE(is_fault(g.grid.push(span)));
  }
  EXPECT_GT(g.grid.last(), 400) << "more than a span of even cells becomes, of " << spans;
  EXPECT_EQ(spans, CellGrid::kAhead + 1);
}

TEST(CellGrid, ACellBoundsTheDerivativesOfItsSamplesAndAnEighthOfTheirRangeMore) {
  StraightGrid g;
  const ToolPose from{Vector3(0, 30, -20), Vector3(0.3, 0.3, 1).normalized()};
  const ToolPose to{Vector3(20, -10, 0), Vector3(-0.2, 0.4, 1).normalized()};
  const FeedSpan span = g.begin_line(from, to, 40);
  ASSERT_FALSE(is_fault(g.grid.push(span)));
  ASSERT_FALSE(is_fault(g.grid.finish()));
  const FeedCell& cell = g.grid[17];
  const auto expect_bound = [&](LimitedVector CellSample::*d, const CellBound::Sides& sides) {
    for (int i = 0; i < 5; ++i) {
      double low = 1e300, high = -1e300;
      for (const CellSample& sample : cell.at) {
        low = std::min(low, (sample.*d)[i]);
        high = std::max(high, (sample.*d)[i]);
      }
      const double beyond = (high - low) / 8;
      EXPECT_DOUBLE_EQ(sides.up[i], std::max(0.0, high + beyond));
      EXPECT_DOUBLE_EQ(sides.down[i], std::max(0.0, beyond - low));
    }
  };
  expect_bound(&CellSample::d1, cell.bound.d1);
  expect_bound(&CellSample::d2, cell.bound.d2);
  expect_bound(&CellSample::d3, cell.bound.d3);
  double max_b = 1e300;
  for (const CellSample& sample : cell.at) max_b = std::min(max_b, sample.max_b);
  EXPECT_EQ(cell.max_b, max_b);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(cell.bound.rate[i], std::max(cell.bound.d1.up[i], cell.bound.d1.down[i]));
  }
  // The samples are those of the path, both ends included.
  JointVector reference = solve(g.model, g.model.tool_length_mm, from, 0, JointVector{}).q;
  for (int k = 0; k <= FeedCell::kSteps; ++k) {
    CellSample sample;
    const double x = cell.x + cell.h * k / FeedCell::kSteps;
    ASSERT_FALSE(is_fault(take_sample(g.model, g.limits, 0.9985, span, x, reference, sample)));
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(cell.at[k].d1[i], sample.d1[i], 1e-9);
  }
}

TEST(CellGrid, TheSpeedOfABoundaryIsThatOfTheSlowerCellBesideIt) {
  MadeCells cells(60);
  cells.grid[10].max_b = 25;
  EXPECT_EQ(cells.grid.max_b_at(10), 25);
  EXPECT_EQ(cells.grid.max_b_at(11), 25);
  EXPECT_EQ(cells.grid.max_b_at(12), 1e4);
  cells.grid[0].max_b = 9;
  EXPECT_EQ(cells.grid.max_b_at(0), 9);
  cells.grid[59].max_b = 4;
  EXPECT_EQ(cells.grid.max_b_at(60), 4);
  cells.grid.drop_before(11);
  EXPECT_EQ(cells.grid.max_b_at(11), 1e4) << "a cell that is dropped bounds nothing";
}

TEST(CellGrid, ForgetsWhatPlansLoweredFromACellOn) {
  StraightGrid g;
  ASSERT_FALSE(is_fault(g.push(60, 60)));
  ASSERT_FALSE(is_fault(g.grid.finish()));
  const double made_b = g.grid[0].max_b;
  for (int k = 0; k < 60; ++k) {
    g.grid[k].max_b *= 0.5;
    g.grid[k].tight = 0.7;
  }
  g.grid.restore_from(20);
  EXPECT_EQ(g.grid[19].max_b, 0.5 * made_b);
  EXPECT_EQ(g.grid[19].tight, 0.7);
  EXPECT_EQ(g.grid[20].max_b, made_b);
  EXPECT_EQ(g.grid[20].tight, 1);
  EXPECT_EQ(g.grid[59].max_b, made_b);
}

TEST(CellGrid, LeavesLessJerkToCellsBesideThePole) {
  StraightGrid g;
  const ToolPose from{Vector3(0, 0, -20), Vector3(0.1, 2e-7, 1).normalized()};
  const ToolPose to{Vector3(10, 0, -20), Vector3(3e-7, 2e-7, 1).normalized()};
  const FeedSpan span = g.begin_line(from, to, 60);
  (void)g.grid.push(span);
  (void)g.grid.finish();
  ASSERT_GT(g.grid.last(), 50);
  for (std::int64_t k = 0; k < g.grid.last(); ++k) {
    const FeedCell& cell = g.grid[k];
    const double shares[] = {
        share_beside_singularity(g.model, g.limits, span.path, cell.x, {}),
        share_beside_singularity(g.model, g.limits, span.path, cell.x + cell.h, {})};
    EXPECT_EQ(cell.tight, std::min({1.0, shares[0], shares[1]})) << k;
    EXPECT_EQ(cell.made_tight, cell.tight);
  }
}

}  // namespace
}  // namespace meridian::test::cell_grid
