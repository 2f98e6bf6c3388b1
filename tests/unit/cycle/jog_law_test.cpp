// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/jog/jog_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace meridian::test::jog_law {
namespace {

constexpr JogRates kRates{100, 1000, 20000};
constexpr double kPeriod_s = 1e-3;

JogAxis axis_at(double q, double low = -500, double high = 500) {
  JogAxis axis;
  axis.at.q = q;
  axis.rates = kRates;
  axis.low = low;
  axis.high = high;
  return axis;
}

TEST(JogLaw, MovesAPointUnderConstantJerk) {
  const JogPoint p = moved({1, 2, 3}, 6, 2);
  EXPECT_DOUBLE_EQ(p.q, 1 + 2 * 2 + 3 * 4 / 2.0 + 6 * 8 / 6.0);
  EXPECT_DOUBLE_EQ(p.v, 2 + 3 * 2 + 6 * 4 / 2.0);
  EXPECT_DOUBLE_EQ(p.a, 3 + 6 * 2);
}

TEST(JogLaw, ARampTakesTheTextbookTimeAndEndsExactly) {
  // 100 mm/s: 0.05 s to 1000 mm/s², 0.05 s of it, 0.05 s back.
  JogRamp ramp({0, 0, 0}, 100, kRates);
  JogPoint p;
  ramp.advance(p, 0.15 - 1e-6);
  EXPECT_LT(p.v, 100);
  ramp.advance(p, 2e-6);
  EXPECT_EQ(p.v, 100);
  EXPECT_EQ(p.a, 0);
  EXPECT_NEAR(p.q, 0.075 * 100, 1e-3);
  ramp.advance(p, 1);
  EXPECT_NEAR(p.q, 0.075 * 100 + 100 * (1 + 1e-6), 1e-9) << "and goes on evenly";
}

TEST(JogLaw, ARampIsTheSameInOneStepAsInMany) {
  for (const JogPoint& from : {JogPoint{3, 40, -600}, JogPoint{0, -80, 500}, JogPoint{0, 0, 0}}) {
    for (const double aim : {-100.0, 0.0, 35.0}) {
      JogRamp once(from, aim, kRates), often = once;
      JogPoint a = from, b = from;
      once.advance(a, 0.12);
      for (int n = 0; n < 120; ++n) often.advance(b, 1e-3);
      EXPECT_NEAR(a.q, b.q, 1e-10);
      EXPECT_NEAR(a.v, b.v, 1e-10);
      EXPECT_NEAR(a.a, b.a, 1e-8);
    }
  }
}

TEST(JogLaw, KnowsHowFarARampReachesToEitherSide) {
  for (const JogPoint& from : {JogPoint{3, 40, -900}, JogPoint{0, -80, 500}, JogPoint{1, 5, 1000},
                               JogPoint{2, -5, -1000}, JogPoint{0, 30, 0}, JogPoint{0, 1, 400}}) {
    for (const double aim : {0.0, -50.0, 50.0}) {
      const JogRamp ramp(from, aim, kRates);
      double low = from.q, high = from.q;
      const double end = ramp.spread(from, low, high);
      JogRamp walked = ramp;
      JogPoint p = from;
      double lowest = from.q, highest = from.q, last = from.q;
      for (int n = 0; n < 40000 && !(p.v == aim && p.a == 0); ++n) {
        walked.advance(p, 1e-5);
        if (p.v == aim && p.a == 0) break;
        lowest = std::min(lowest, p.q);
        highest = std::max(highest, p.q);
        last = p.q;
      }
      EXPECT_NEAR(low, lowest, 1e-3);
      EXPECT_NEAR(high, highest, 1e-3);
      EXPECT_LE(low, lowest + 1e-9);
      EXPECT_GE(high, highest - 1e-9);
      EXPECT_NEAR(end, last, 2e-3);
    }
  }
}

TEST(JogLaw, AskedForAVelocityItGetsThereAndStays) {
  JogAxis axis = axis_at(0);
  for (int n = 0; n < 200; ++n) follow(axis, 30, kPeriod_s);
  EXPECT_EQ(axis.at.v, 30);
  EXPECT_EQ(axis.at.a, 0);
  const double q = axis.at.q;
  follow(axis, 30, kPeriod_s);
  EXPECT_NEAR(axis.at.q - q, 0.03, 1e-12);
  EXPECT_FALSE(axis.is_ending);
  for (int n = 0; n < 200; ++n) follow(axis, 0, kPeriod_s);
  EXPECT_TRUE(axis.is_at_rest());
}

TEST(JogLaw, IsNoFasterThanTheRatesAndRestsForNoNumber) {
  JogAxis axis = axis_at(0);
  for (int n = 0; n < 300; ++n) follow(axis, 1e9, kPeriod_s);
  EXPECT_EQ(axis.at.v, 100);
  for (int n = 0; n < 400; ++n) follow(axis, -1e9, kPeriod_s);
  EXPECT_EQ(axis.at.v, -100);
  for (int n = 0; n < 300; ++n) follow(axis, std::nan(""), kPeriod_s);
  EXPECT_TRUE(axis.is_at_rest());
}

TEST(JogLaw, ComesToRestExactlyAtTheEndOfItsRoom) {
  for (const double sign : {1.0, -1.0}) {
    for (const double room : {0.001, 0.3, 5.0, 40.0}) {
      JogAxis axis = axis_at(0, sign > 0 ? -500 : -room, sign > 0 ? room : 500);
      double last = 0, highest = 0;
      for (int n = 0; n < 1500; ++n) {
        follow(axis, sign * 80, kPeriod_s);
        highest = std::max(highest, std::abs(axis.at.v));
        EXPECT_GE((axis.at.q - last) * sign, -1e-12);
        last = axis.at.q;
      }
      EXPECT_NEAR(axis.at.q, sign * room, 1e-9);
      EXPECT_TRUE(axis.is_at_rest());
      if (room == 40.0) {
        EXPECT_NEAR(highest, 80, 1e-9) << "no sooner than it has to";
      }
    }
  }
}

TEST(JogLaw, GoesOnAsLongAsBrakingStillEndsInTheRoom) {
  // From 80 mm/s braking takes 0.08 + 0.05 s and 5.2 mm.
  JogAxis axis = axis_at(0, -500, 40);
  while (!axis.is_ending) follow(axis, 80, kPeriod_s);
  EXPECT_NEAR(axis.at.q, 40 - 5.2, 80 * kPeriod_s);
  const double q = axis.at.q, v = axis.at.v, a = axis.at.a;
  EXPECT_TRUE(v < 80 || a < 0 || q < 40 - 5.2) << "what remains of the cycle is braking";
}

TEST(JogLaw, TurnsBackFromTheEndOfItsRoom) {
  JogAxis axis = axis_at(0, -500, 10);
  for (int n = 0; n < 1000; ++n) follow(axis, 80, kPeriod_s);
  ASSERT_NEAR(axis.at.q, 10, 1e-9);
  for (int n = 0; n < 500; ++n) follow(axis, -80, kPeriod_s);
  EXPECT_EQ(axis.at.v, -80);
  EXPECT_FALSE(axis.is_ending);
}

TEST(JogLaw, OutsideOfItsRoomItMovesInwardsAlone) {
  for (const double sign : {1.0, -1.0}) {
    JogAxis axis = axis_at(sign * 12, -10, 10);
    for (int n = 0; n < 500; ++n) follow(axis, sign * 50, kPeriod_s);
    EXPECT_NEAR(axis.at.q, sign * 12, 1e-9) << "not outwards";
    for (int n = 0; n < 30; ++n) follow(axis, -sign * 50, kPeriod_s);
    EXPECT_LT(axis.at.q * sign, 12);
    for (int n = 0; n < 3000; ++n) follow(axis, -sign * 50, kPeriod_s);
    EXPECT_NEAR(axis.at.q, -sign * 10, 1e-9) << "and no farther than to the other end";
    EXPECT_TRUE(axis.is_at_rest());
  }
}

TEST(JogLaw, MayBeWhereBrakingEndsInTheRoom) {
  const JogAxis axis = axis_at(0, -10, 10);
  EXPECT_TRUE(may_be_at(axis, {10, 0, 0}));
  EXPECT_FALSE(may_be_at(axis, {10.001, 0, 0}));
  EXPECT_FALSE(may_be_at(axis, {-10.001, 0, 0}));
  EXPECT_TRUE(may_be_at(axis, {10 - 5.21, 80, 0}));
  EXPECT_FALSE(may_be_at(axis, {10 - 5.19, 80, 0}));
  EXPECT_TRUE(may_be_at(axis, {-10 + 5.21, -80, 0}));
  EXPECT_FALSE(may_be_at(axis, {-10 + 5.19, -80, 0}));
  EXPECT_TRUE(may_be_at(axis, {-10 + 5.19, 80, 0})) << "away from the end";
  const JogAxis outside = axis_at(12, -10, 10);
  EXPECT_TRUE(may_be_at(outside, {11, -5, 0}));
  EXPECT_FALSE(may_be_at(outside, {11, 5, 0}));
  EXPECT_FALSE(may_be_at(outside, {13, -5, 0})) << "farther out than where it is";
  const JogAxis below = axis_at(-12, -10, 10);
  EXPECT_TRUE(may_be_at(below, {-11, 5, 0}));
  EXPECT_FALSE(may_be_at(below, {-11, -5, 0}));
  EXPECT_FALSE(may_be_at(below, {-13, 5, 0}));
}

TEST(JogLaw, BrakesWithTheRatesThatAreGiven) {
  JogAxis axis = axis_at(0);
  for (int n = 0; n < 300; ++n) follow(axis, 100, kPeriod_s);
  const double q = axis.at.q;
  brake(axis, {100, 2000, 80000});
  EXPECT_TRUE(axis.is_ending);
  EXPECT_EQ(axis.asked, 0);
  int n = 0;
  for (; n < 1000 && !axis.is_at_rest(); ++n) follow(axis, 0, kPeriod_s);
  const double time = 100.0 / 2000 + 2000.0 / 80000;
  EXPECT_NEAR(n * kPeriod_s, time, kPeriod_s);
  EXPECT_NEAR(axis.at.q - q, 100 * time / 2, 1e-9);
  JogAxis rest = axis_at(5);
  brake(rest, {1, 1, 1});
  EXPECT_EQ(rest.rates.jerk, kRates.jerk) << "what rests does not brake";
  EXPECT_FALSE(rest.is_ending);
}

TEST(JogLaw, KeepsRatesAndRoomWhateverIsAsked) {
  std::mt19937_64 random(5);
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  for (int n = 0; n < 20; ++n) {
    JogAxis axis = axis_at(real(-8, 8), -10, 10);
    double asked = 0;
    JogPoint last = axis.at;
    for (int k = 0; k < 3000; ++k) {
      if (real(0, 1) < 0.01) asked = real(-150, 150);
      follow(axis, asked, kPeriod_s);
      ASSERT_LE(std::abs(axis.at.q), 10 + 1e-12);
      ASSERT_LE(std::abs(axis.at.v), 100 * (1 + 1e-9));
      ASSERT_LE(std::abs(axis.at.a), 1000 * (1 + 1e-9));
      ASSERT_LE(std::abs(axis.at.a - last.a), 20000 * kPeriod_s * (1 + 1e-9));
      ASSERT_NEAR(axis.at.q - last.q, 0.5 * kPeriod_s * (axis.at.v + last.v), 2e-6);
      last = axis.at;
    }
  }
}

}  // namespace
}  // namespace meridian::test::jog_law
