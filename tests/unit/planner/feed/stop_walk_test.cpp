// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/stop_walk.hpp"

#include <gtest/gtest.h>

#include <random>

namespace meridian::test::stop_walk {
namespace {

constexpr double kH = 0.05;  // mm, of a cell
/// At most, of ṡ² between two steps by the straight line between theirs, with its bound.
constexpr double kCurved = 1.011;

/// Speed squared of the stop where it is `s` on its path, by bisection of its time.
double v2_at(const StopLaw& law, double s) {
  double low = 0, high = law.duration();
  for (int n = 0; n < 80; ++n) {
    const double middle = 0.5 * (low + high);
    (law.at(middle).s < s ? low : high) = middle;
  }
  const double v = law.at(low).ds;
  return v * v;
}

TEST(StopWalk, BoundsTheSpeedInEveryCellFromItsBeginOn) {
  std::mt19937 random(3);
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  for (int n = 0; n < 500; ++n) {
    const PathState begin{real(0, kH), real(1, 100), real(-1500, 1500), 0};
    const StopMargin authority{real(200, 3000), real(10000, 90000)};
    const StopLaw law(begin, authority);
    StopWalk walk(begin, authority);
    double ahead = 1e300;
    for (double s = 0; walk.is_moving(); s += kH) {
      walk.enter();
      const double v2 = v2_at(law, std::max(s, begin.s));
      EXPECT_GE(kCurved * walk.max_v2(), v2) << "draw " << n << " at " << s;
      EXPECT_LE(walk.max_v2(), ahead) << "draw " << n << " at " << s;
      if (walk.is_braking()) ahead = walk.max_v2_ahead();
      walk.pass(kH);
    }
  }
}

TEST(StopWalk, BoundsTheSpeedHardlyAboveThatAtItsBegin) {
  StopWalk walk({0, 50, 0, 0}, {2000, 40000});
  walk.enter();
  EXPECT_TRUE(walk.is_braking());
  EXPECT_GT(walk.max_v2(), 50 * 50);
  EXPECT_LT(walk.max_v2(), 1.005 * 50 * 50);
}

TEST(StopWalk, BoundsTheSpeedThatAStopStillGains) {
  const PathState begin{0, 50, 1000, 0};
  const StopMargin authority{2000, 40000};
  StopWalk walk(begin, authority);
  walk.enter();
  EXPECT_FALSE(walk.is_braking());
  EXPECT_DOUBLE_EQ(walk.max_v2(), StopWalk::kBetweenSteps * 62.5 * 62.5);
}

TEST(StopWalk, EndsWhereTheStopDoes) {
  const PathState begin{0.02, 40, 0, 0};
  const StopMargin authority{1000, 30000};
  const double rest = begin.s + StopLaw(begin, authority).distance();
  StopWalk walk(begin, authority);
  int cells = 0;
  for (; walk.is_moving(); ++cells) {
    walk.enter();
    walk.pass(kH);
  }
  EXPECT_EQ(cells, static_cast<int>(rest / kH) + 1);
}

}  // namespace
}  // namespace meridian::test::stop_walk
