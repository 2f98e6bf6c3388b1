// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/feed_piece.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace meridian
