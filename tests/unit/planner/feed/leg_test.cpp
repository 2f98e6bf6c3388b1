// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/legs/leg.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "meridian/path/build_piece.hpp"

namespace meridian::test::leg {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kBelow = 1 - 1e-7;  // what rounding is left

/// A line of 40 mm whose axis stands still.
Leg leg_of(double feed_mm_per_s, double share_per_s = 0, double factor = 1) {
  Leg out;
  out.path = make_line({Vector3::Zero(), Vector3::UnitZ()}, {{40, 0, 0}, Vector3::UnitZ()});
  out.feed_mm_per_s = feed_mm_per_s;
  out.share_per_s = share_per_s;
  out.feed_factor = factor;
  return out;
}

TEST(Leg, HasItsProgrammedFeedWhateverTheFactor) {
  EXPECT_EQ(leg_of(25).tip_feed(), 25);
  EXPECT_EQ(leg_of(25, 0, 1.2).tip_feed(), 25);
  EXPECT_EQ(leg_of(0).tip_feed(), 0);
}

TEST(Leg, InInverseTimeHasTheFeedOfItsLengthUpToTheLargest) {
  EXPECT_EQ(leg_of(0, 0.5).tip_feed(), 20);
  EXPECT_EQ(leg_of(100, 0.5).tip_feed(), 20);
  EXPECT_EQ(leg_of(15, 0.5).tip_feed(), 15);
}

TEST(Leg, BoundsTheTipByFactorTimesFeedWhereTheFeedIsProgrammed) {
  EXPECT_EQ(leg_of(25, 0, 1.2).max_tip_speed(), 30);
  EXPECT_EQ(leg_of(100, 0.5, 1.2).max_tip_speed(), 100) << "the feed is the machine's largest";
  EXPECT_EQ(leg_of(0, 0, 1.2).max_tip_speed(), kInfinite);
  EXPECT_EQ(leg_of(0, 0.5).max_tip_speed(), kInfinite);
}

TEST(Leg, TurnsTipSpeedIntoASpeedOfThePath) {
  EXPECT_DOUBLE_EQ(leg_of(25, 0, 1.2).max_velocity(1 / 40.0), kBelow * 30);
  EXPECT_DOUBLE_EQ(leg_of(25).max_velocity(1 / 80.0), kBelow * 50) << "the tip goes half as fast";
  EXPECT_GT(leg_of(0).max_velocity(1 / 40.0), 1e300);
}

TEST(Leg, InInverseTimeIsNoFasterThanItsShare) {
  EXPECT_DOUBLE_EQ(leg_of(0, 0.5, 1.2).max_velocity(1 / 40.0), kBelow * 24);
  EXPECT_DOUBLE_EQ(leg_of(22, 0.5, 1.2).max_velocity(1 / 40.0), kBelow * 22);
}

TEST(Leg, WithoutATipToMoveIsBoundByNothingOrByItsShare) {
  Leg turn = leg_of(25, 0, 1);
  turn.path = make_turn({Vector3::Zero(), Vector3::UnitZ()}, 0, 1);
  EXPECT_EQ(turn.max_velocity(1 / 50.0), std::numeric_limits<double>::max());
  turn.share_per_s = 0.5;
  EXPECT_DOUBLE_EQ(turn.max_velocity(1 / 50.0), kBelow * 25);
  EXPECT_EQ(turn.max_velocity(0), std::numeric_limits<double>::max());
}

TEST(Leg, NamesItsTimesAsThePieceTheyRunOn) {
  Leg leg = leg_of(25, 0, 1.2);
  leg.window = 9;
  PathPiece piece = leg.path;
  piece.epoch = 3;
  piece.index = 17;
  piece.sequence = 5;
  piece.line = 105;
  const TimePiece time = leg.time_on(piece);
  EXPECT_EQ(time.kind, TimeKind::kMove);
  EXPECT_TRUE(time.is_from_rest);
  EXPECT_FALSE(time.is_tail);
  EXPECT_EQ(time.epoch, 3);
  EXPECT_EQ(time.window, 9U);
  EXPECT_EQ(time.path_index, 17U);
  EXPECT_EQ(time.sequence, 5U);
  EXPECT_EQ(time.line, 105U);
  EXPECT_EQ(time.feed_mm_per_s, 25);
  EXPECT_EQ(time.feed_factor, 1.2);
}

}  // namespace
}  // namespace meridian::test::leg
