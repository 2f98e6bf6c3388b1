// SPDX-License-Identifier: Apache-2.0

/// Stops next to the rest of the plan, and next to the end of a cell.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "unit/planner/feed/stop_margin_path.hpp"

namespace meridian::test::feed_stop_margin {
namespace {

constexpr int kRestCell = 40;
constexpr double kRest_mm = kRestCell * kH;

/// Where a stop rests that begins at the end of a piece of 1 ms with all that the joint has.
double rest_of(const TimePiece& time) {
  const PathState end = state_at(time, time.duration);
  return end.s + StopLaw(end, {kAccel, kJerk}).distance();
}

/// A piece on the straight path whose last stop would rest `beyond` the rest of the plan.
TimePiece grant_ending(double beyond, bool is_tail) {
  Path path;
  path.margin.begin(path.cells.grid, kRestCell);
  constexpr int kCell = kRestCell - 3;
  TimePiece time;
  time.duration = 1e-3;
  time.s0 = (kCell + 0.25) * kH;
  double low = 1, high = 100;
  for (int n = 0; n < 100; ++n) {
    time.v = 0.5 * (low + high);
    (rest_of(time) < kRest_mm + beyond ? low : high) = time.v;
  }
  return path.grant(kCell, time.v, 0, is_tail);
}

TEST(FeedStopMargin, IsAllOfTheJointWhereTheStopRestsHardlyBeforeThePlanDoes) {
  constexpr double kHardly_mm = 1e-4;
  for (const bool is_tail : {false, true}) {
    const TimePiece before = grant_ending(-kHardly_mm, is_tail);
    EXPECT_NEAR(before.stop_jerk, kJerk, 1e-6);
    EXPECT_EQ(before.stop_velocity, kAnyVelocity);
    EXPECT_LT(grant_ending(kHardly_mm, is_tail).stop_velocity, kAnyVelocity) << "it would pass it";
  }
}

/// Pieces of a whole cell each up to the rest of the plan are granted one margin.
TEST(FeedStopMargin, OfPiecesTogetherEndsEveryStopBeforeThePlanDoes) {
  int together = 0;
  for (double v = 20; v < 60; v += 0.5) {
    SCOPED_TRACE(v);
    Path path;
    path.margin.begin(path.cells.grid, kRestCell);
    std::array<FeedPiece, 4> pieces;
    std::array<TimePiece, 4> times;
    for (std::size_t n = 0; n < pieces.size(); ++n) {
      pieces[n].cell = kRestCell - 6 + static_cast<int>(n);
      times[n].s0 = static_cast<double>(pieces[n].cell) * kH;
      times[n].v = v;
      times[n].duration = kH / v;
    }
    path.margin.grant(pieces, times);
    together += times[0].stop_jerk > 0 && times[0].stop_jerk == times[3].stop_jerk;
    for (const TimePiece& time : times) {
      if (time.stop_velocity < kAnyVelocity || !(time.stop_jerk > 0)) continue;
      const Path::Use use = path.use(time, {time.stop_accel, time.stop_jerk}, false);
      EXPECT_LE(use.farthest, kRest_mm + 1e-9);
    }
  }
  EXPECT_GT(together, 10);
}

/// The feed of the cell may fall towards its end, and the speed of a stop still rise up to there.
TEST(FeedStopMargin, KeepsTheFeedAtTheEndOfTheCellWhileAccelerationIsLetGo) {
  Path path;
  path.cells.grid[20].at.back().max_b = 50.5 * 50.5;
  EXPECT_LT(path.grant(20, 50, 1500, true).stop_velocity, 50);
  EXPECT_EQ(path.grant(20, 30, 1500, true).stop_velocity, kAnyVelocity);
}

}  // namespace
}  // namespace meridian::test::feed_stop_margin
