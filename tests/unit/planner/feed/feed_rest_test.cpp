// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/feed_rest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/planner/feed/made_cells.hpp"

namespace meridian::test::feed_rest {
namespace {

/// A cell of length `h` in which one joint follows the path evenly.
FeedCell even_cell(double h, double max_b = 1e9) {
  FeedCell cell;
  cell.h = h;
  cell.max_b = max_b;
  for (CellSample& at : cell.at) {
    at.d1[0] = 1;
    at.max_b = max_b;
  }
  return cell;
}

TEST(FeedRest, LeavesRestWithNearlyAllOfTheJerk) {
  const RestCell rest = find_rest_cell(even_limits(1, 1e9, 1e9, 6000), even_cell(0.001), true, 1e9);
  EXPECT_LE(rest.jerk, 0.92 * 6000);
  EXPECT_GT(rest.jerk, 0.92 * 6000 * 0.97) << "to a fortieth";
  EXPECT_NEAR(rest.jerk * std::pow(rest.duration, 3) / 6, 0.001, 1e-15) << "over the cell";
  const double v = 0.5 * rest.jerk * rest.duration * rest.duration;
  EXPECT_NEAR(rest.state.b, v * v, 1e-12 * v * v);
  EXPECT_NEAR(rest.state.slope, 2 * rest.jerk * rest.duration, 1e-9) << "twice the acceleration";
}

TEST(FeedRest, KeepsAccelerationVelocityAndFeed) {
  const FeedCell cell = even_cell(0.5);
  const RestCell accel = find_rest_cell(even_limits(1, 1e9, 100, 1e9), cell, true, 1e9);
  EXPECT_LT(accel.jerk * accel.duration, 92);
  EXPECT_GT(accel.jerk * accel.duration, 92 * 0.98);
  const RestCell speed = find_rest_cell(even_limits(1, 8, 1e9, 1e9), cell, true, 1e9);
  EXPECT_LT(std::sqrt(speed.state.b), 0.92 * 8);
  EXPECT_GT(std::sqrt(speed.state.b), 0.92 * 8 * 0.98);
  const RestCell feed =
      find_rest_cell(even_limits(1, 1e9, 1e9, 1e9), even_cell(0.5, 49), true, 1e9);
  EXPECT_LT(feed.state.b, 0.92 * 49);
  EXPECT_GT(feed.state.b, 0.92 * 49 * 0.96);
}

TEST(FeedRest, CountsTheRateFilterAsAcceleration) {
  FeedLimits limits = even_limits(1, 1e9, 100, 1e9);
  limits.slope = 10;
  const RestCell rest = find_rest_cell(limits, even_cell(0.5), true, 1e9);
  const double used = rest.jerk * rest.duration + 10 * std::sqrt(rest.state.b);
  EXPECT_LT(used, 92);
  EXPECT_GT(used, 92 * 0.97);
}

TEST(FeedRest, LeavesTheRateItsOwnRoomOrTheLargest) {
  FeedLimits limits = even_limits(1, 1e9, 1e9, 6000);
  limits.slope = 10;
  limits.curvature = 100;
  limits.jerk[0] = 4000;
  const FeedCell cell = even_cell(0.001);
  const RestCell own = find_rest_cell(limits, cell, true, 1e9);
  const double a = own.jerk * own.duration, v = 0.5 * a * own.duration;
  EXPECT_LT(own.jerk + 3 * 10 * a + 100 * v, 0.92 * 6000);
  EXPECT_GT(own.jerk + 3 * 10 * a + 100 * v, 0.92 * 6000 * 0.97);
  const RestCell largest = find_rest_cell(limits, cell, true, 1e9, RestRoom::kLargest);
  EXPECT_LE(largest.jerk, 0.92 * 4000);
  EXPECT_LE(largest.jerk, own.jerk);
}

TEST(FeedRest, ReachesNoMoreThanFourFifthsOfWhatItIsAllowed) {
  const RestCell rest = find_rest_cell(even_limits(1, 1e9, 1e9, 1e9), even_cell(0.5), true, 50);
  EXPECT_LE(rest.state.b, 40);
  EXPECT_GT(rest.state.b, 9.9);
}

TEST(FeedRest, UsesTheShareOfATightCell) {
  FeedCell cell = even_cell(0.5);
  cell.tight = 0.5;
  const RestCell rest = find_rest_cell(even_limits(1, 1e9, 100, 1e9), cell, true, 1e9);
  EXPECT_LT(rest.jerk * rest.duration, 46);
  EXPECT_GT(rest.jerk * rest.duration, 46 * 0.98);
}

TEST(FeedRest, ComesToRestAsItLeavesItTheOtherWayRound) {
  FeedCell cell = even_cell(0.5), mirror = cell;
  for (int k = 0; k <= FeedCell::kSteps; ++k) {
    cell.at[k].d1[0] = 1 + 0.2 * k;
    cell.at[k].d2[0] = 0.4;
    cell.at[k].d3[0] = 0.1 * k;
    mirror.at[FeedCell::kSteps - k] = cell.at[k];
    mirror.at[FeedCell::kSteps - k].d2[0] *= -1;
  }
  const FeedLimits limits = even_limits(1, 1e9, 100, 2000);
  const RestCell start = find_rest_cell(limits, cell, true, 1e9);
  const RestCell stop = find_rest_cell(limits, mirror, false, 1e9);
  EXPECT_DOUBLE_EQ(start.jerk, stop.jerk);
  EXPECT_DOUBLE_EQ(start.state.b, stop.state.b);
  EXPECT_DOUBLE_EQ(start.state.slope, stop.state.slope);
}

TEST(FeedRest, KeepsUpTheSpeedThatCurvatureAllows) {
  MadeCells cells(40, 0.5, 1e6);
  const FeedLimits limits = even_limits(2, 1e9, 100, 2000);
  EXPECT_EQ(steady_b(cells.grid, limits, 0, 40), 1e6);
  cells.grid[7].at[4].max_b = 5e5;
  EXPECT_EQ(steady_b(cells.grid, limits, 0, 40), 5e5);
  cells.grid[9].at[8].d2[1] = -0.01;
  EXPECT_DOUBLE_EQ(steady_b(cells.grid, limits, 0, 40), kCurvatureShare * 100 / 0.01);
  cells.grid[11].at[0].d3[0] = -16;
  EXPECT_DOUBLE_EQ(steady_b(cells.grid, limits, 0, 40), kCurvatureShare * std::pow(125, 2.0 / 3));
  EXPECT_DOUBLE_EQ(steady_b(cells.grid, limits, 0, 11), kCurvatureShare * 100 / 0.01);
  EXPECT_EQ(steady_b(cells.grid, limits, 12, 40), 1e6);
}

TEST(Crawl, HasJerkOfOneSizeForAQuarterOfTheTimeEach) {
  // s(t) for +32, -32, -32, +32 over a quarter each, from rest to rest over 1 in 1.
  const auto at = [](double t) {
    double s = 0, v = 0, a = 0;
    constexpr int kSteps = 40000;
    for (int n = 0; n < static_cast<int>(std::lround(t * kSteps)); ++n) {
      const int quarter = 4 * n / kSteps;
      const double j = quarter == 0 || quarter == 3 ? 32 : -32, dt = 1.0 / kSteps;
      s += dt * (v + dt * (a / 2 + dt * j / 6));
      v += dt * (a + dt * j / 2);
      a += dt * j;
    }
    return std::array{s, v, a};
  };
  for (const double t : {0.1, 0.2, 0.3, 0.45, 0.6, 0.7, 0.85, 0.95}) {
    const auto [s, v, a] = at(t);
    const Crawl::Shape shape = Crawl::shape_at(s);
    EXPECT_NEAR(shape.t, t, 1e-7);
    EXPECT_NEAR(shape.v, v, 1e-6);
    EXPECT_NEAR(shape.a, a, 1e-5);
    EXPECT_EQ(shape.j, t < 0.25 || t > 0.75 ? 32 : -32);
  }
  EXPECT_EQ(Crawl::shape_at(0).v, 0);
  EXPECT_NEAR(Crawl::shape_at(0.5).v, 2, 1e-12);
  EXPECT_NEAR(Crawl::shape_at(1).t, 1, 1e-12);
}

TEST(Crawl, KeepsEveryLimitAndIsNoSlowerThanItNeeds) {
  MadeCells cells(40, 0.25, 1e9);
  struct Case {
    double velocity, acceleration, jerk, max_b, slope;
  };
  for (const Case& one : {Case{1, 1e9, 1e9, 1e9, 0},
                          {1e9, 1, 1e9, 1e9, 0},
                          {1e9, 1e9, 1, 1e9, 0},
                          {1e9, 1e9, 1e9, 1, 0},
                          {1e9, 2, 1e9, 1e9, 0.5}}) {
    for (int k = 0; k < 12; ++k) {
      for (CellSample& at : cells.grid[k].at) {
        at.max_b = one.max_b;
        at.d1[0] = 1.5;
        at.d2[0] = 0.2;
        at.d3[0] = -0.1;
      }
    }
    FeedLimits limits = even_limits(1, one.velocity, one.acceleration, one.jerk);
    limits.slope = one.slope;
    const Crawl crawl = crawl_over(cells.grid, limits, 2, 6);
    EXPECT_EQ(crawl.cells, 6);
    EXPECT_DOUBLE_EQ(crawl.length, 1.5);
    const FeedUse use = use_of(limits, cells.grid, 2, crawl);
    const double largest = std::max(use.worst(), use.b);
    EXPECT_LE(largest, 1.01);
    EXPECT_GT(largest, 0.85);
    const Crawl safe = checked(limits, cells.grid, 2, crawl);
    const FeedUse safe_use = use_of(limits, cells.grid, 2, safe);
    EXPECT_LE(std::max(safe_use.worst(), safe_use.b), 1 + 1e-12);
  }
}

TEST(Crawl, IsSlowerWhereACellIsTight) {
  MadeCells cells(40, 0.25, 1e9);
  const FeedLimits limits = even_limits(1, 1e9, 1e9, 100);
  const double free_s = crawl_over(cells.grid, limits, 0, 6).duration;
  cells.grid[3].tight = 0.5;
  EXPECT_NEAR(crawl_over(cells.grid, limits, 0, 6).duration, free_s * std::cbrt(2), 1e-9);
}

}  // namespace
}  // namespace meridian::test::feed_rest
