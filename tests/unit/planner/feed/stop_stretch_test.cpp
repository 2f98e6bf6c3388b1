// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/stop/stop_stretch.hpp"

#include <gtest/gtest.h>

#include <array>

#include "unit/planner/feed/made_cells.hpp"

namespace meridian::test::stop_stretch {
namespace {

constexpr double kH = 0.5;  // mm, of a cell

/// Three pieces of 10 ms in cells 4, 4 and 6 of a path whose cells begin at multiples of kH.
struct Pieces {
  Pieces() {
    for (int k = 0; k < 40; ++k) cells.grid[k].x = k * kH;
    const std::array<std::int64_t, 3> of_cell{4, 4, 6};
    for (std::size_t n = 0; n < 3; ++n) {
      pieces[n].cell = of_cell[n];
      times[n].duration = 0.01;
      times[n].s0 = static_cast<double>(of_cell[n]) * kH + (n == 1 ? 0.2 : 0.1);
      times[n].v = 10 + static_cast<double>(n);
      times[n].a = n == 1 ? -200 : 100;
    }
  }
  [[nodiscard]] StopStretch stretch(std::size_t count = 3) const {
    return {cells.grid, {pieces.data(), count}, {times.data(), count}};
  }

  MadeCells cells{40, kH};
  std::array<FeedPiece, 3> pieces;
  std::array<TimePiece, 3> times;
};

TEST(StopStretch, CountsItsPathFromTheBeginOfItsFirstCell) {
  const Pieces made;
  const StopStretch stretch = made.stretch();
  ASSERT_EQ(stretch.parts().size(), 3U);
  const auto parts = stretch.parts();
  EXPECT_EQ(parts[0].cell, 4);
  EXPECT_EQ(parts[0].cell_begin, 0);
  EXPECT_NEAR(parts[0].begin.s, 0.1, 1e-12);
  EXPECT_EQ(parts[1].cell_begin, 0);
  EXPECT_NEAR(parts[1].begin.s, 0.2, 1e-12);
  EXPECT_EQ(parts[2].cell, 6);
  EXPECT_NEAR(parts[2].cell_begin, 2 * kH, 1e-12);
  EXPECT_NEAR(parts[2].begin.s, 2 * kH + 0.1, 1e-12);
  EXPECT_EQ(parts[2].duration, 0.01);
  for (const std::size_t quarter : {1U, 2U, 3U}) {
    const double time = 0.0025 * static_cast<double>(quarter);
    EXPECT_NEAR(parts[0].between[quarter - 1].s, 0.1 + 10 * time + 0.5 * 100 * time * time, 1e-12);
    EXPECT_NEAR(parts[0].between[quarter - 1].ds, 10 + 100 * time, 1e-12);
  }
  EXPECT_NEAR(stretch.end().s, 2 * kH + 0.1 + 12 * 0.01 + 0.5 * 100 * 1e-4, 1e-12);
  EXPECT_NEAR(stretch.end().ds, 13, 1e-12);
}

TEST(StopStretch, BeginsInTheCellOfItsFirstPieceWhereTheNextIsInAnother) {
  const Pieces made;
  const StopStretch stretch(made.cells.grid, {made.pieces.data() + 1, 2},
                            {made.times.data() + 1, 2});
  EXPECT_EQ(stretch.parts()[0].cell, 4);
  EXPECT_EQ(stretch.parts()[0].cell_begin, 0);
  EXPECT_NEAR(stretch.parts()[0].begin.s, 0.2, 1e-12);
  EXPECT_NEAR(stretch.parts()[1].cell_begin, 2 * kH, 1e-12);
}

TEST(StopStretch, IsSlowerAtAnotherRateAndTakesLonger) {
  const Pieces made;
  const StopStretch full = made.stretch(), half = full.at_rate(0.5);
  for (std::size_t n = 0; n < 3; ++n) {
    const StopStretch::Part &a = full.parts()[n], &b = half.parts()[n];
    EXPECT_EQ(b.cell, a.cell);
    EXPECT_EQ(b.duration, 2 * a.duration);
    EXPECT_EQ(b.begin.s, a.begin.s);
    EXPECT_EQ(b.begin.ds, 0.5 * a.begin.ds);
    EXPECT_EQ(b.begin.dds, 0.25 * a.begin.dds);
    EXPECT_EQ(b.between[2].ds, 0.5 * a.between[2].ds);
  }
  EXPECT_EQ(half.end().ds, 0.5 * full.end().ds);
}

TEST(StopStretch, KnowsItsSlowestStateAndHardestDeceleration) {
  const Pieces made;
  EXPECT_EQ(made.stretch().min_velocity(), 10);
  EXPECT_EQ(made.stretch().max_deceleration(), 200);
  EXPECT_EQ(made.stretch(1).max_deceleration(), 0) << "it gains speed all along";
  Pieces braking;
  braking.times[2].a = -900;
  EXPECT_NEAR(braking.stretch().min_velocity(), 3, 1e-12) << "at its end";
  EXPECT_EQ(braking.stretch().max_deceleration(), 900);
}

}  // namespace
}  // namespace meridian::test::stop_stretch
