// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "unit/planner/feed/stop_margin_path.hpp"

namespace meridian::test::feed_stop_margin {
namespace {

/// Pieces of a whole cell each from `cell` on, the plan braking evenly from v.
struct Together {
  Together(Path& path, int cell, double v, double a) {
    for (std::size_t n = 0; n < pieces.size(); ++n) {
      pieces[n].cell = cell + static_cast<int>(n);
      TimePiece& time = times[n];
      time.is_tail = true;
      time.s0 = static_cast<double>(pieces[n].cell) * kH;
      time.v = v;
      time.a = a;
      const double next = std::sqrt(v * v + 2 * a * kH);
      time.duration = 2 * kH / (v + next);
      v = next;
    }
    path.margin.grant(pieces, times);
  }
  std::array<FeedPiece, 4> pieces;
  std::array<TimePiece, 4> times;
};

TEST(FeedStopMargin, IsSharedByPiecesThatFollowOneAnother) {
  for (const double bend : {0.0, 0.05, 0.15}) {
    for (const double a : {-600.0, 0.0, 400.0}) {
      SCOPED_TRACE(testing::Message() << bend << " " << a);
      Path path;
      for (int k = 0; k < kCells; ++k) path.set(k, 0.8 + 0.02 * (k % 5), bend, 0.01);
      const Together all(path, 20, 60, a);
      for (const TimePiece& time : all.times) {
        ASSERT_GT(time.stop_jerk, 0);
        EXPECT_EQ(time.stop_jerk, all.times[0].stop_jerk);
        EXPECT_EQ(time.fault_accel, all.times[0].fault_accel);
        EXPECT_EQ(time.stop_velocity, kAnyVelocity);
        EXPECT_LE(path.use(time, {time.stop_accel, time.stop_jerk}, false).worst, 1);
        EXPECT_LE(path.use(time, {time.fault_accel, time.fault_jerk}, true).worst, 1);
        path.margin.begin(path.cells.grid, kCells - 1);
        const TimePiece alone = path.grant(static_cast<int>(time.s0 / kH + 0.5), time.v, a, true);
        EXPECT_GT(time.stop_jerk, 0.8 * alone.stop_jerk) << "hardly less than each has alone";
        EXPECT_GT(time.fault_jerk, 0.8 * alone.fault_jerk);
      }
    }
  }
}

TEST(FeedStopMargin, IsEachPiecesOwnWhereNoneIsGoodForAll) {
  Path path;
  for (int k = 24; k < kCells; ++k) {
    path.cells.grid[k].max_b = 25 * 25;  // only the last piece cannot keep it
    for (CellSample& at : path.cells.grid[k].at) at.max_b = 25 * 25;
  }
  path.margin.begin(path.cells.grid, kCells - 1);
  const Together all(path, 20, 50, -300);
  EXPECT_EQ(all.times[0].stop_velocity, kAnyVelocity);
  EXPECT_LT(all.times[3].stop_velocity, 50);
}

}  // namespace
}  // namespace meridian::test::feed_stop_margin
