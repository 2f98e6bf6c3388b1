// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/stop/stop_walk.hpp"

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

TEST(StopWalk, StaysBelowALaterOneOfThePlanWhereItSaysSo) {
  std::mt19937 random(7);
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  int below = 0, steady = 0;
  for (int n = 0; n < 2000; ++n) {
    // A piece of a plan, and the stops from both of its ends.
    const double duration = real(1e-3, 1e-2), j = n % 2 == 0 ? 0 : real(-40000, 40000);
    const PathState begin{0, real(2, 100), n % 4 < 2 ? 0 : real(-1500, 1500), j};
    const PathState end{duration * (begin.ds + duration * (begin.dds / 2 + duration * j / 6)),
                        begin.ds + duration * (begin.dds + duration * j / 2),
                        begin.dds + duration * j, 0};
    if (!(end.ds > 1)) continue;
    const StopMargin authority{real(200, 3000), real(10000, 90000)};
    const StopWalk first(begin, authority), next(end, authority);
    if (j == 0 && begin.dds == 0) ++steady;
    if (!first.stays_below(next, duration)) continue;
    ++below;
    const StopLaw law(begin, authority), later(end, authority);
    EXPECT_LE(begin.s + law.distance(), end.s + later.distance() + 1e-9) << "draw " << n;
    for (int k = 0; k <= 40; ++k) {
      const double s = end.s + law.distance() * k / 40;
      EXPECT_LE(v2_at(law, s), v2_at(later, s) + 1e-6) << "draw " << n << " at " << s;
    }
  }
  EXPECT_GT(steady, 400);
  EXPECT_GT(below, steady) << "at an even speed always, and where the plan brakes less than it";
}

TEST(StopWalk, StaysBelowNoStopOfAPlanThatBrakesHarder) {
  const StopMargin authority{1000, 30000};
  const StopWalk first({0, 50, -2000, 0}, authority);
  const StopWalk next({0.48, 46, -2000, 0}, authority);
  EXPECT_FALSE(first.stays_below(next, 0.01));
}

TEST(StopWalk, StaysBelowNoneWhereOneOfThemLetsGoAtOnce) {
  // Slower and decelerating harder, but 1100 mm/s² are more than it may use.
  const StopMargin authority{1000, 30000};
  const StopWalk letting_go({0, 50, -1100, 0}, authority);
  const StopWalk next({0.5, 48, 0, 0}, authority);
  EXPECT_FALSE(letting_go.stays_below(next, 0.01));
  EXPECT_TRUE(StopWalk({0, 50, -900, 0}, authority).stays_below(next, 0.01));
  const StopWalk later({0.5, 48, -1100, 0}, authority);
  EXPECT_FALSE(StopWalk({0, 47, -999, 0}, authority).stays_below(later, 0.01));
}

TEST(StopWalk, StandsForAnotherStopToo) {
  StopWalk walk({0, 50, 0, 0}, {2000, 40000});
  const double own = walk.largest_product();
  walk.raise_product(0.5 * own);
  EXPECT_EQ(walk.largest_product(), own);
  walk.raise_product(2 * own);
  EXPECT_EQ(walk.largest_product(), 2 * own);
}

TEST(StopWalk, HasTheJerkOfItsAuthorityOrOfAnotherStop) {
  StopWalk walk({0, 20, -100, 0}, {500, 9000});
  EXPECT_EQ(walk.bounds().accel, 500);
  EXPECT_EQ(walk.bounds().jerk, 9000);
  walk.raise_jerk(8000);
  EXPECT_EQ(walk.bounds().jerk, 9000);
  walk.raise_jerk(12000);
  EXPECT_EQ(walk.bounds().jerk, 12000);
  EXPECT_EQ(walk.authority().jerk, 9000);
}

TEST(StopWalk, BeginsInACellThatBeginsElsewhere) {
  const StopMargin authority{1000, 30000};
  StopWalk near({0.02, 40, 0, 0}, authority), far({1.02, 40, 0, 0}, authority, 1.0);
  for (; near.is_moving(); near.pass(kH), far.pass(kH)) {
    ASSERT_TRUE(far.is_moving());
    near.enter();
    far.enter();
    EXPECT_NEAR(far.s(), near.s() + 1, 1e-12);
    EXPECT_NEAR(far.max_v2(), near.max_v2(), 1e-6);
  }
  EXPECT_FALSE(far.is_moving());
}

}  // namespace
}  // namespace meridian::test::stop_walk
