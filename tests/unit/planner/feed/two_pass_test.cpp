// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/solver/two_pass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "unit/planner/feed/made_cells.hpp"

namespace meridian::test::two_pass_of_cells {
namespace {

constexpr int kCells = 40;

struct Passed {
  std::vector<double> backward, b;
};

Passed pass(const CellGrid& grid, const FeedLimits& limits, double b_begin, int cells = kCells,
            std::int64_t first = 0) {
  Passed out;
  out.backward.resize(static_cast<std::size_t>(cells) + 1);
  out.b = out.backward;
  two_pass(grid, limits, first, b_begin, out.backward, out.b);
  return out;
}

TEST(TwoPass, BrakesToRestAtTheEndAsLateAsAccelerationAllows) {
  MadeCells cells(kCells, 0.5, 1e9);
  const Passed got = pass(cells.grid, even_limits(1, 1e9, 50, 1e9), 1e9);
  for (int k = 0; k <= kCells; ++k) {
    EXPECT_NEAR(got.backward[k], 100 * 0.5 * (kCells - k), 1e-6) << k;
    EXPECT_NEAR(got.b[k], got.backward[k], 1e-6) << k;
  }
}

TEST(TwoPass, AcceleratesFromTheBeginAsAccelerationAllows) {
  MadeCells cells(kCells, 0.5, 1e9);
  const Passed got = pass(cells.grid, even_limits(1, 1e9, 50, 1e9), 30);
  for (int k = 0; k <= kCells; ++k) {
    EXPECT_NEAR(got.b[k], std::min(30 + 50.0 * k, 50.0 * (kCells - k)), 1e-6) << k;
  }
}

TEST(TwoPass, KeepsTheFeedOfEveryCell) {
  MadeCells cells(kCells, 0.5, 400);
  cells.grid[20].max_b = 90;
  const Passed got = pass(cells.grid, even_limits(1, 1e9, 50, 1e9), 0);
  EXPECT_NEAR(got.b[20], 90, 1e-9) << "at both of its ends";
  EXPECT_NEAR(got.b[21], 90, 1e-9);
  EXPECT_NEAR(got.b[19], 140, 1e-6);
  EXPECT_NEAR(got.b[22], 140, 1e-6);
  EXPECT_NEAR(got.b[12], 400, 1e-9);
}

TEST(TwoPass, AJointThatTurnsRoundBoundsTheSpeedByItsCurvatureAlone) {
  for (const bool is_end : {false, true}) {
    for (const double bend : {5.0, -5.0}) {
      MadeCells cells(kCells, 0.5, 1e9);
      CellSample& at = is_end ? cells.grid[20].at.back() : cells.grid[20].at.front();
      at.d1[0] = 0;
      at.d2[0] = bend;
      const Passed got = pass(cells.grid, even_limits(1, 1e9, 50, 1e9), 1e9);
      const std::size_t where = is_end ? 21 : 20;
      EXPECT_NEAR(got.b[where], 10, 1e-6) << "50 / 5";
      EXPECT_NEAR(got.b[where - 2], 110, 1e-6);
      EXPECT_NEAR(got.b[where + 2], is_end ? 110 : 110, 1e-6);
    }
  }
}

/// Joints that bend as they like: |½ q' b' + q'' b| at both ends of every cell.
void draw(CellGrid& grid, unsigned seed) {
  std::mt19937 random(seed);
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  for (std::int64_t k = grid.first(); k < grid.last(); ++k) {
    grid[k].h = real(0.2, 0.6);
    grid[k].max_b = real(100, 300);
    for (CellSample& at : grid[k].at) {
      at.d1 = {real(-1, 1), real(-1, 1), real(-1, 1)};
      at.d2 = {real(-0.3, 0.3), real(-0.3, 0.3), real(-0.3, 0.3)};
    }
  }
}

double largest_use(const CellGrid& grid, const FeedLimits& limits, std::int64_t cell, double b0,
                   double b1) {
  double largest = 0;
  for (const bool is_end : {false, true}) {
    const CellSample& at = is_end ? grid[cell].at.back() : grid[cell].at.front();
    for (int j = 0; j < limits.count; ++j) {
      const double accel =
          at.d1[j] * (b1 - b0) / (2 * grid[cell].h) + at.d2[j] * (is_end ? b1 : b0);
      largest = std::max(largest, std::abs(accel) / limits.acceleration[j]);
    }
  }
  return largest;
}

/// Whether from `b0` some speed behind the cell, at most `behind`, keeps acceleration.
bool goes_on(const CellGrid& grid, const FeedLimits& limits, std::int64_t cell, double b0,
             double after) {
  for (int n = 0; n <= 4000; ++n) {
    if (largest_use(grid, limits, cell, b0, after * n / 4000) <= 1 + 1e-9) return true;
  }
  return false;
}

TEST(TwoPass, IsTheFastestThatCanStillBrake) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    MadeCells cells(kCells);
    draw(cells.grid, seed);
    const FeedLimits limits = even_limits(3, 1e9, 40, 1e9);
    const Passed got = pass(cells.grid, limits, 20);
    for (int k = 0; k < kCells; ++k) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " cell " << k);
      const double here = got.backward[k], after = got.backward[k + 1];
      EXPECT_LE(here, cells.grid.max_b_at(k));
      EXPECT_LE(got.b[k], here * (1 + 1e-9) + 1e-9);
      EXPECT_TRUE(goes_on(cells.grid, limits, k, here * 0.998, after));
      const bool is_bound = here < 0.999 * cells.grid.max_b_at(k);
      if (is_bound) {
        EXPECT_FALSE(goes_on(cells.grid, limits, k, here * 1.002 + 1e-6, after));
      }
      // Forward: as fast as acceleration and what lies behind allow.
      const double next = got.b[k + 1];
      EXPECT_LE(next, after * (1 + 1e-9) + 1e-9);
      if (next < 0.999 * after && next > 1e-6) {
        EXPECT_GT(largest_use(cells.grid, limits, k, got.b[k], next * 1.001 + 1e-6), 1);
      }
    }
  }
}

TEST(TwoPass, SeesTheCellsOfItsWindowAlone) {
  MadeCells cells(60);
  draw(cells.grid, 3);
  const FeedLimits limits = even_limits(3, 1e9, 40, 1e9);
  MadeCells part(40);
  for (int k = 0; k < 40; ++k) part.grid[k] = cells.grid[k + 20];
  const Passed got = pass(cells.grid, limits, 20, 40, 20), alone = pass(part.grid, limits, 20);
  for (int k = 1; k <= 40; ++k) EXPECT_EQ(got.b[k], alone.b[k]) << k;
}

}  // namespace
}  // namespace meridian::test::two_pass_of_cells
