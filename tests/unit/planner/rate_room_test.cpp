// SPDX-License-Identifier: Apache-2.0
#include "meridian/planner/rate_room.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "meridian/cycle/rate_filter.hpp"

namespace meridian::test::rate_room {
namespace {

/// Largest (1-ε)ⁿ own + |w'| below, by samples of ε.
double sampled(int order, const RateBounds& bounds, double own, double below) {
  constexpr int kSteps = 4000;
  double largest = 0;
  for (int n = 0; n <= kSteps; ++n) {
    const double less = std::pow(static_cast<double>(n) / kSteps, 2);
    const double slope = std::min(bounds.slope, std::sqrt(2 * bounds.curvature * less));
    const double share = order == 2 ? std::pow(1 - less, 2) : std::pow(1 - less, 3);
    const double rate = order == 2 ? 1 : 1 - less;  // 3 w w' q̈ of the jerk
    largest = std::max(largest, share * own + rate * slope * below);
  }
  return largest;
}

RateRoom room_of(int order, const RateBounds& bounds) {
  return order == 2 ? RateRoom::of_acceleration(bounds.slope, bounds.curvature)
                    : RateRoom::of_jerk(bounds.slope, bounds.curvature);
}

struct Draw {
  int order = 2;
  RateBounds bounds;
  double own = 0, below = 0;
};

/// Ramps of 1 to 10 s and some that are more curved, and what a motion has from nothing to all.
std::vector<Draw> draws() {
  std::mt19937 random(11);
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  std::vector<Draw> out;
  for (int n = 0; n < 2000; ++n) {
    Draw draw;
    draw.order = n % 2 == 0 ? 2 : 3;
    const double ramp = std::pow(10.0, real(0, 1)), curved = n % 5 == 0 ? real(1, 100) : 10;
    draw.bounds = {1 / ramp, curved / ramp};
    draw.own = n % 7 == 0 ? 0 : std::pow(10.0, real(-2, 3));
    draw.below = n % 11 == 0 ? 0 : std::pow(10.0, real(-2, 3));
    out.push_back(draw);
  }
  return out;
}

TEST(RateRoom, IsNoSmallerThanWhatAnyRateAddsAndLittleLarger) {
  for (const auto& [order, bounds, own, below] : draws()) {
    SCOPED_TRACE(testing::Message() << order << ": " << own << ", " << below);
    const double exact = sampled(order, bounds, own, below);
    const double largest = room_of(order, bounds).largest(own, below);
    const double end = bounds.slope * bounds.slope / (2 * bounds.curvature);
    EXPECT_GE(largest, exact * (1 - 1e-6));
    EXPECT_LE(largest, exact + 2 * end * (bounds.slope * below + 3 * end * own) + 1e-12);
    EXPECT_LE(largest, own + bounds.slope * below + 1e-12);
  }
}

TEST(RateRoom, FindsTheLargestThatALimitLeaves) {
  for (const auto& [order, bounds, limit, below] : draws()) {
    SCOPED_TRACE(testing::Message() << order << ": " << limit << ", " << below);
    const RateRoom room = room_of(order, bounds);
    const double own = room.within(limit, below);
    if (limit < bounds.slope * below) {
      EXPECT_LT(own, 0);
      continue;
    }
    EXPECT_NEAR(room.largest(own, below), limit, 1e-9 * (1 + limit));
  }
}

TEST(RateRoom, IsTouchedByItsTangentAndNeverBelowIt) {
  for (const auto& [order, bounds, limit, below] : draws()) {
    SCOPED_TRACE(testing::Message() << order << ": " << limit << ", " << below);
    const RateRoom room = room_of(order, bounds);
    const double own = room.within(limit, below);
    if (!(own > 0)) continue;
    const auto [share, slope] = room.tangent(limit, below);
    EXPECT_NEAR(share * own + slope * below, limit, 1e-9 * (1 + limit));
    for (const double other : {0.0, 0.5 * below, 2 * below, 10 * below}) {
      const double there = room.within(limit, other);
      EXPECT_LE(share * there + slope * other, limit + 1e-9 * (1 + limit)) << other;
    }
  }
}

TEST(RateRoom, IsAllOfTheSlopeWhereTheCurvatureIsSmall) {
  for (const double curvature : {0.0, 0.05}) {
    const RateRoom room = RateRoom::of_jerk(0.25, curvature);
    EXPECT_EQ(room.largest(3, 8), 5);
    EXPECT_EQ(room.within(5, 8), 3);
    EXPECT_EQ(room.tangent(5, 8).share, 1);
    EXPECT_EQ(room.tangent(5, 8).slope, 0.25);
  }
  EXPECT_EQ(RateRoom::of_acceleration(0, 0).largest(3, 8), 3);
}

}  // namespace
}  // namespace meridian::test::rate_room
