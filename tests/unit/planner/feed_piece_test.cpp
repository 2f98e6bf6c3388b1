// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/rolling/feed_piece.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "meridian/planner/time_law.hpp"
#include "unit/planner/feed/made_cells.hpp"

namespace meridian {
namespace {

FeedCell cell_of_length(double h) {
  FeedCell cell{};
  cell.h = h;
  return cell;
}

TEST(FeedPieces, CoverACellAtEvenSpeedInOnePiece) {
  FeedPieces pieces(4);
  pieces.add(cell_of_length(0.5), 7, {4, 0, 0});
  ASSERT_EQ(pieces.all().size(), 1U);
  EXPECT_DOUBLE_EQ(pieces.all()[0].v, 2);
  EXPECT_DOUBLE_EQ(pieces.all()[0].duration, 0.25);
  EXPECT_EQ(pieces.all()[0].cell, 7);
}

TEST(FeedPieces, AreManyWhereTheSpeedChangesManyTimesOverInACell) {
  FeedPieces pieces(4);
  pieces.add(cell_of_length(1), 0, {1e-12, 0, 2});  // u̇² = 1e-12 + x²
  EXPECT_EQ(pieces.all().size(), 64U);
  EXPECT_FALSE(pieces.is_cut_short());
  double length = 0;
  for (const FeedPiece& piece : pieces.all()) length = std::max(length, piece.s0);
  EXPECT_NEAR(length, 63.0 / 64, 1e-12);
}

TEST(FeedPieces, SayWhereOneFoundNoRoom) {
  FeedPieces pieces(1);  // and two cells at its ends
  pieces.add(cell_of_length(1), 0, {1e-12, 0, 2});
  EXPECT_FALSE(pieces.is_cut_short());
  pieces.add(cell_of_length(1), 1, {1e-12, 0, 2});
  EXPECT_TRUE(pieces.is_cut_short());
  EXPECT_EQ(pieces.all().size(), 96U);
  pieces.clear();
  EXPECT_FALSE(pieces.is_cut_short());
  pieces.add(cell_of_length(1), 0, {4, 0, 0});
  EXPECT_EQ(pieces.all().size(), 1U);
}

PathState end_of(const FeedPiece& piece) {
  TimePiece law;
  put_law(piece, law);
  return state_at(law, piece.duration);
}

/// u̇, ü at `x` of a cell under `law`.
PathState of_law(const FeedCell& cell, const CellLaw& law, double x) {
  const double second = (law.slope_end - law.slope) / cell.h;
  const double b = law.b + law.slope * x + second * x * x / 2;
  return {cell.x + x, std::sqrt(b), (law.slope + second * x) / 2, 0};
}

TEST(FeedPieces, RunTheLawOfTheCellFromItsBeginToItsEnd) {
  FeedCell cell = cell_of_length(0.5);
  cell.x = 3;
  cell.span = 9;
  const CellLaw laws[] = {{4, 3, -5}, {1, 2, 2}, {9, -6, -4}, {2, 0, 10}, {30, -60, -15}};
  for (const CellLaw& law : laws) {
    FeedPieces pieces(4);
    pieces.add(cell, 7, law);
    double x = 0, time = 0;
    for (const FeedPiece& piece : pieces.all()) {
      EXPECT_EQ(piece.span, 9U);
      EXPECT_EQ(piece.cell, 7);
      EXPECT_EQ(piece.j, 0);
      EXPECT_LE(std::abs(piece.k) * piece.duration * piece.duration, 1.0);
      const PathState at = of_law(cell, law, x);
      EXPECT_NEAR(piece.s0, at.s, 1e-12);
      EXPECT_NEAR(piece.v, at.ds, 1e-9 * at.ds);
      EXPECT_NEAR(piece.a, at.dds, 1e-9 * (1 + std::abs(at.dds)));
      const PathState end = end_of(piece);
      x = end.s - cell.x;
      EXPECT_NEAR(end.ds, of_law(cell, law, x).ds, 1e-9 * (1 + end.ds));
      time += piece.duration;
    }
    EXPECT_NEAR(x, 0.5, 1e-12);
    double expected = 0;  // ∫ dx/√b, midpoints
    for (int n = 0; n < 20000; ++n) {
      expected += 0.5 / 20000 / of_law(cell, law, (n + 0.5) * 0.5 / 20000).ds;
    }
    EXPECT_NEAR(time, expected, 1e-5 * expected);
  }
}

TEST(FeedPieces, AreNoMoreThanTheSeriesOfTheLawNeeds) {
  for (double second = -7; second < 60; second += second < 0 ? 1 : 0.1 + 0.05 * second) {
    FeedPieces pieces(4);
    const CellLaw law{4, second < 0 ? -second : 0, second < 0 ? 0 : second};
    pieces.add(cell_of_length(1), 0, law);
    const double time =
        std::accumulate(pieces.all().begin(), pieces.all().end(), 0.0,
                        [](double sum, const FeedPiece& piece) { return sum + piece.duration; });
    const double needed = std::sqrt(0.5 * std::abs(second) * time * time / 0.9);
    std::size_t parts = 1, parts_of_more = 1;  // beside a power of 2 either will do
    while (static_cast<double>(parts) < 0.995 * needed) parts *= 2;
    while (static_cast<double>(parts_of_more) < 1.005 * needed) parts_of_more *= 2;
    EXPECT_GE(pieces.all().size(), parts) << second;
    EXPECT_LE(pieces.all().size(), parts_of_more) << second;
  }
}

TEST(FeedPieces, BeginAMotionFromRestAndEndItAtRest) {
  FeedCell cell = cell_of_length(1.0 / 6);
  cell.x = 2;
  cell.span = 4;
  const RestCell rest{{0.25, 0}, 1, 1};  // u = t³/6
  FeedPieces pieces(4);
  pieces.add(cell, 1, rest, true);
  pieces.add(cell, 2, rest, false);
  ASSERT_EQ(pieces.all().size(), 2U);
  const FeedPiece &start = pieces.all()[0], &stop = pieces.all()[1];
  EXPECT_EQ(start.v, 0);
  EXPECT_EQ(start.a, 0);
  EXPECT_EQ(start.cell, 1);
  const PathState moving = end_of(start), still = end_of(stop);
  EXPECT_NEAR(moving.s, 2 + 1.0 / 6, 1e-15);
  EXPECT_NEAR(moving.ds, 0.5, 1e-15);
  EXPECT_NEAR(stop.v, 0.5, 1e-15);
  EXPECT_NEAR(stop.a, -1, 1e-15);
  EXPECT_EQ(stop.s0, 2);
  EXPECT_NEAR(still.s, 2 + 1.0 / 6, 1e-15);
  EXPECT_NEAR(still.ds, 0, 1e-15);
  EXPECT_NEAR(still.dds, 0, 1e-15);
}

TEST(FeedPieces, CrawlFromRestToRestAsOneMotionOverAllItsCells) {
  test::MadeCells made(40);
  for (int n = 0; n < 5; ++n) made.grid[n + 2].h = 0.2 + 0.1 * n;  // 2 mm
  for (int n = 0; n < 5; ++n) made.grid[n + 2].x = 10.0 * n;
  const Crawl crawl{5, 2.0, 4.0};
  FeedPieces pieces(8);
  pieces.add(made.grid, 2, crawl);
  double t = 0, u = 0, v = 0, a = 0, largest_jerk = 0, left_in_cell = 0;
  std::int64_t cell = 1;
  for (const FeedPiece& piece : pieces.all()) {
    if (piece.cell != cell) {
      EXPECT_NEAR(left_in_cell, 0, 1e-12) << cell;
      cell = piece.cell;
      EXPECT_NEAR(piece.s0, made.grid[cell].x, 1e-12);
      left_in_cell = made.grid[cell].h;
    }
    EXPECT_NEAR(piece.s0, made.grid[cell].x + made.grid[cell].h - left_in_cell, 1e-12);
    EXPECT_NEAR(piece.v, v, 1e-9);
    EXPECT_NEAR(piece.a, a, 1e-9);
    EXPECT_EQ(piece.k, 0);
    const PathState end = end_of(piece);
    left_in_cell -= end.s - piece.s0;
    u += end.s - piece.s0;
    v = end.ds;
    a = end.dds;
    t += piece.duration;
    // Jerk +J, -J, -J, +J, a quarter of the duration each; all of it is 32 d / t³.
    const double at = t - piece.duration / 2;
    EXPECT_NEAR(piece.j, (at < 1 || at > 3 ? 1 : -1), 1e-9) << at;
    largest_jerk = std::max(largest_jerk, std::abs(piece.j));
  }
  EXPECT_EQ(cell, 6);
  EXPECT_NEAR(left_in_cell, 0, 1e-12);
  EXPECT_NEAR(u, 2, 1e-12);
  EXPECT_NEAR(t, 4, 1e-12);
  EXPECT_NEAR(v, 0, 1e-9);
  EXPECT_NEAR(a, 0, 1e-9);
  EXPECT_EQ(pieces.all().size(), 8U) << "five cells and three ends of phases";
}

}  // namespace
}  // namespace meridian
