// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "unit/planner/feed/stop_margin_path.hpp"

namespace meridian::test::feed_stop_margin {
namespace {

TEST(FeedStopMargin, IsAllOfTheJointWhereThePathIsStraight) {
  Path path;
  const TimePiece time = path.grant(10, 50);
  EXPECT_NEAR(time.stop_jerk, kJerk, 1e-6);
  EXPECT_NEAR(time.stop_accel, 1.02 * std::sqrt(kJerk * 50), 1e-6) << "no more than it needs";
  EXPECT_NEAR(time.fault_jerk, kFaultJerk, 1e-6);
  EXPECT_NEAR(time.fault_accel, 1.02 * std::sqrt(kFaultJerk * 50), 1e-6);
  EXPECT_EQ(time.stop_velocity, kAnyVelocity);
  EXPECT_EQ(time.fault_velocity, kAnyVelocity);
  EXPECT_NEAR(time.slow_velocity, 50 * kSlow, 1e-9);
  EXPECT_NEAR(time.slow_stop_jerk, kJerk, 1e-6);
  EXPECT_NEAR(time.slow_stop_accel, 1.02 * std::sqrt(kJerk * 50 * kSlow), 1e-6);
  EXPECT_NEAR(time.slow_fault_jerk, kFaultJerk, 1e-6);
  EXPECT_NEAR(time.slow_fault_accel, 1.02 * std::sqrt(kFaultJerk * 50 * kSlow), 1e-6);
  path.expect_safe(time);
}

TEST(FeedStopMargin, IsNoMoreThanTheJointHasWhereTheSpeedWouldNeedMore) {
  Path path;
  const TimePiece time = path.grant(10, 200);
  EXPECT_NEAR(time.stop_accel, kAccel, 1e-6);
  EXPECT_NEAR(time.fault_accel, kFaultAccel, 1e-6);
  path.expect_safe(time);
}

TEST(FeedStopMargin, IsThatOfACellAheadWhichAStopReaches) {
  Path path;
  for (int k = 16; k < kCells; ++k) path.set(k, 3);
  const TimePiece near = path.grant(14, 50);
  path.expect_safe(near);
  EXPECT_GT(near.stop_jerk, 0.9 * kJerk / 3);
  EXPECT_LT(near.stop_jerk, 1.01 * kJerk / 3);
  path.margin.begin(path.cells.grid, kCells - 1);
  const TimePiece far = path.grant(2, 50);  // 7 mm before it
  EXPECT_NEAR(far.stop_jerk, kJerk, 1e-6);
}

TEST(FeedStopMargin, LeavesRoomForWhatThePathBends) {
  for (const double sign : {1.0, -1.0}) {
    for (const double rising : {-800.0, 0.0, 800.0}) {
      SCOPED_TRACE(testing::Message() << sign << " " << rising);
      Path path;
      for (int k = 0; k < kCells; ++k) path.set(k, sign * 0.8, 0.15, 0.02);
      const TimePiece time = path.grant(20, 60, rising);
      path.expect_safe(time);
      ASSERT_GT(time.stop_jerk, 0);
      EXPECT_GT(path.use(time, {time.stop_accel, time.stop_jerk}, false).worst, 0.6);
      EXPECT_GT(path.use(time, {time.fault_accel, time.fault_jerk}, true).worst, 0.6);
      EXPECT_GE(time.stop_accel, 0.9 * std::max(0.0, -rising)) << "it eases off hardly";
      EXPECT_GT(time.slow_stop_jerk, time.stop_jerk);
    }
  }
}

TEST(FeedStopMargin, EndsBeforeThePlanDoes) {
  // The plan itself comes to rest 0.96 mm ahead: a stop with less would pass it.
  Path path;
  for (int cell = 10; cell < 40; ++cell) {
    path.margin.begin(path.cells.grid, cell + 3);
    const double end = (cell + 3) * kH;
    const TimePiece time = path.grant(cell, 30, -400);
    if (!(time.stop_jerk > 0)) continue;
    EXPECT_LE(path.use(time, {time.stop_accel, time.stop_jerk}, false).farthest, end + 1e-9);
    EXPECT_LE(path.use(time, {time.fault_accel, time.fault_jerk}, true).farthest, end + 1e-9);
  }
  path.margin.begin(path.cells.grid, 11);
  const TimePiece none = path.grant(10, 100, 0, true);
  EXPECT_EQ(none.stop_jerk, 0) << "nothing stops within 0.4 mm";
  EXPECT_EQ(none.stop_accel, 0);
  EXPECT_EQ(none.stop_velocity, 0);
}

/// A hold that keeps a tail comes to it at a lower rate: what is sought at 0.85 and 0.6 only.
TEST(FeedStopMargin, IsSoughtForSlowerMachinesInATailWhereTheFullRateHasNone) {
  Path path;
  for (int k = 0; k < kCells; ++k) path.set(k, 1, 0.4, 0.1);
  TimePiece tail, cut;
  double speed = 40;
  for (; speed < 120; ++speed) {
    path.margin.begin(path.cells.grid, kCells - 1);
    cut = path.grant(10, speed);
    path.margin.begin(path.cells.grid, kCells - 1);
    tail = path.grant(10, speed, 0, true);
    if (tail.stop_velocity < kAnyVelocity && tail.stop_jerk > 0) break;
  }
  ASSERT_LT(speed, 120);
  EXPECT_NEAR(tail.stop_velocity, 0.85 * speed, 1e-6);
  EXPECT_LE(tail.stop_velocity, cut.stop_velocity);
  EXPECT_GT(tail.slow_stop_jerk, 0);
  path.expect_safe(tail);
}

/// From there every law lets go of the deceleration at once, by the one jerk that ends it at rest.
TEST(FeedStopMargin, IsNoneWhereBrakingThatIsDeepAlreadyEndsWithMoreJerkThanThereIs) {
  for (const double share : {0.5, 0.7, 1.05, 2.0}) {
    SCOPED_TRACE(share);
    Path path;
    const double speed = 2, jerk = share * kJerk;
    const TimePiece time = path.grant(10, speed, -std::sqrt(2 * speed * jerk), true);
    EXPECT_EQ(time.stop_velocity == kAnyVelocity, share < 1);
    EXPECT_GT(time.fault_jerk, 0) << "which has more jerk";
  }
}

/// A hold that finds nothing at the full rate comes to a lower one with the rate falling as fast as
/// it may: that adds to the deceleration, and so to the jerk that ends it.
TEST(FeedStopMargin, KeepsTheJerkOfDeepBrakingWhereTheRateFalls) {
  constexpr double kRateSlope = 1, kFullJerk = kJerk / 0.99;
  int granted = 0;
  for (double share = 0.8; share < 4; share *= 1.02) {
    for (const double speed : {2.0, 10.0, 50.0}) {
      SCOPED_TRACE(testing::Message() << share << " " << speed);
      Path path;
      const double a = -std::sqrt(2 * speed * share * kJerk);
      const TimePiece time = path.grant(10, speed, a);
      const PathState end = state_at(time, time.duration);
      if (!(end.ds > 0)) continue;
      const auto expect_kept = [&](double velocity, const StopMargin& margin) {
        if (!(margin.jerk > 0)) return;
        for (double w = std::min(1.0, velocity / end.ds); w > 0.02; w *= 0.9) {
          const double slope = std::min(kRateSlope, std::sqrt(20 * (1 - w)));
          const StopLaw law({0, w * end.ds, w * w * end.dds - slope * end.ds, 0}, margin);
          EXPECT_LE(law.at(0.9 * law.duration()).ddds, kFullJerk * (1 + 1e-9)) << w;
          ++granted;
        }
      };
      expect_kept(time.stop_velocity, {time.stop_accel, time.stop_jerk});
      expect_kept(time.slow_velocity, {time.slow_stop_accel, time.slow_stop_jerk});
    }
  }
  EXPECT_GT(granted, 100);
}

TEST(FeedStopMargin, IsSoughtForSlowerMachinesWhereTheFullSpeedLeavesNone) {
  Path path;
  // At 60 mm/s the bend takes all of the jerk; at 50 there is some left.
  const double d3 = 60000 / std::pow(60, 3);
  for (int k = 0; k < kCells; ++k) path.set(k, 1, 0, d3);
  const TimePiece time = path.grant(20, 60);
  ASSERT_GT(time.stop_jerk, 0);
  EXPECT_LT(time.stop_velocity, 60);
  EXPECT_GT(time.stop_velocity, 40);
  const double rate = time.stop_velocity / 60;
  EXPECT_LE(path.use(time, {time.stop_accel, time.stop_jerk}, false, rate).worst, 1);
  path.margin.begin(path.cells.grid, kCells - 1);
  const TimePiece tail = path.grant(20, 60, 0, true);
  EXPECT_NEAR(tail.stop_velocity, 0.85 * 60, 1e-6)
      << "sought coarsely: a tail comes to rest anyway";
}

TEST(FeedStopMargin, HasNothingForSlowMachinesInATailWhereTheFullRateHasSome) {
  Path path;
  const TimePiece time = path.grant(10, 50, 0, true);
  EXPECT_NEAR(time.stop_jerk, kJerk, 1e-6);
  EXPECT_NEAR(time.slow_velocity, 50 * kSlow, 1e-9);
  EXPECT_EQ(time.slow_stop_jerk, 0);
  EXPECT_EQ(time.slow_fault_jerk, 0);
  EXPECT_EQ(time.slow_stop_accel, 0);
  EXPECT_EQ(time.slow_fault_accel, 0);
}

TEST(FeedStopMargin, SaysWhatTheCellsThatASlowStopReachesAllowNextToRest) {
  Path path;
  for (int k = 0; k < kCells; ++k) path.set(k, 0.8, 0.15, 0.02);
  const TimePiece bent = path.grant(10, 60);
  ASSERT_GT(bent.slow_stop_jerk, 0);
  EXPECT_LT(bent.slow_stop_jerk, 0.99 * kJerk / 0.8);
  EXPECT_NEAR(bent.rest_stop_jerk, kJerk / 0.8, 1e-6);
  EXPECT_NEAR(bent.rest_stop_accel, kAccel / 0.8, 1e-6);
  EXPECT_NEAR(bent.rest_fault_jerk, kFaultJerk / 0.8, 1e-6);
  EXPECT_NEAR(bent.rest_fault_accel, kFaultAccel / 0.8, 1e-6);
  path.set(11, 1.6, 0.15, 0.02);
  const TimePiece near = path.grant(10, 60);
  EXPECT_NEAR(near.rest_stop_jerk, kJerk / 1.6, 1e-6) << "a stop comes into the next cell";
  EXPECT_NEAR(near.rest_stop_accel, kAccel / 1.6, 1e-6);
  path.set(11, 0.8, 0.15, 0.02);
  path.set(20, 1.6, 0.15, 0.02);
  EXPECT_NEAR(path.grant(10, 60).rest_stop_jerk, kJerk / 0.8, 1e-6) << "5 mm are too far for one";
  path.cells.grid[11].made_tight = 0.5;
  path.margin.begin(path.cells.grid, kCells - 1);
  EXPECT_NEAR(path.grant(10, 60).rest_stop_jerk, 0.5 * kJerk / 0.8, 1e-6);
  EXPECT_EQ(path.grant(10, 60, 0, true).rest_stop_jerk, 0) << "a tail has none";
}

TEST(FeedStopMargin, KeepsTheFeedWhileAccelerationIsLetGo) {
  Path path;
  for (int k = 20; k < kCells; ++k) {
    path.cells.grid[k].max_b = 50.5 * 50.5;
    for (CellSample& at : path.cells.grid[k].at) at.max_b = 50.5 * 50.5;
  }
  // At 1500 mm/s² a stop still gains a²/2j = 19 mm/s: in no cell is so much allowed.
  EXPECT_LT(path.grant(20, 50, 1500, true).stop_velocity, 50);
  EXPECT_LT(path.grant(19, 50, 1500, true).stop_velocity, 50) << "it reaches into the next cell";
  EXPECT_EQ(path.grant(20, 30, 1500, true).stop_velocity, kAnyVelocity);
  EXPECT_EQ(path.grant(12, 30, 1500, true).stop_velocity, kAnyVelocity);
}

TEST(FeedStopMargin, GrowsByAQuarterFromPieceToPieceAtMost) {
  Path path;
  path.set(10, 4);
  const TimePiece hard = path.grant(10, 50);
  EXPECT_NEAR(hard.stop_jerk, kJerk / 4, 0.05 * kJerk / 4);
  const TimePiece next = path.grant(11, 50);
  EXPECT_NEAR(next.stop_jerk, 1.25 * hard.stop_jerk, 1e-6);
  EXPECT_LE(next.stop_accel, 1.25 * hard.stop_accel + 1e-6);
  EXPECT_NEAR(next.slow_stop_jerk, kJerk, 1e-6) << "those of slow machines stand by themselves";
  path.margin.begin(path.cells.grid, kCells - 1);
  EXPECT_NEAR(path.grant(11, 50).stop_jerk, kJerk, 1e-6) << "a window begins afresh";
}

TEST(FeedStopMargin, UsesLessJerkWhereRoundingShowsBesideThePole) {
  Path path;
  for (int k = 0; k < kCells; ++k) path.cells.grid[k].made_tight = 0.5;
  const TimePiece time = path.grant(10, 50);
  EXPECT_GT(time.stop_jerk, 0.9 * 0.5 * kJerk);
  EXPECT_LE(time.stop_jerk, 0.5 * kJerk * (1 + 1e-9));
}

TEST(FeedStopMargin, LeavesRoomForTheRateOfPlanTime) {
  // Slower machines may still gain speed: slope times ṡ counts as acceleration in the first cell.
  Path path;
  for (int k = 0; k < kCells; ++k) path.set(k, 1, 0.2, 0);
  const TimePiece at_once = path.grant(20, 100);
  path.cells.model.override_ramp_s = 100;
  FeedStopMargin slow(path.cells.model);
  slow.begin(path.cells.grid, kCells - 1);
  TimePiece time;
  time.duration = 1e-3;
  time.s0 = 20.25 * kH;
  time.v = 100;
  FeedPiece piece;
  piece.cell = 20;
  slow.grant(piece, time);
  EXPECT_GE(time.stop_accel, at_once.stop_accel);
  EXPECT_GE(time.stop_jerk, at_once.stop_jerk);
}

}  // namespace
}  // namespace meridian::test::feed_stop_margin
