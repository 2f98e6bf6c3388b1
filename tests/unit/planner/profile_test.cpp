// SPDX-License-Identifier: Apache-2.0
#include "meridian/planner/profile.hpp"

#include <gtest/gtest.h>

#include <random>

namespace meridian {
namespace {

double log_uniform(std::mt19937_64& engine, double low, double high) {
  return low * std::pow(high / low, std::uniform_real_distribution<>(0, 1)(engine));
}

TEST(Profile, ReachesAllThreeLimitsOnALongWay) {
  const Profile p = rest_to_rest(100, {10, 50, 500});
  EXPECT_NEAR(p.peak_velocity(), 10, 1e-12);
  EXPECT_NEAR(p.peak_acceleration(), 50, 1e-12);
  EXPECT_NEAR(p.duration(), 100.0 / 10 + 10.0 / 50 + 50.0 / 500, 1e-12);
}

TEST(Profile, IsAllJerkOnAShortWay) {
  const Profile p = rest_to_rest(1e-4, {10, 50, 500});
  EXPECT_EQ(p.accel_time, 0);
  EXPECT_EQ(p.cruise_time, 0);
  EXPECT_NEAR(p.duration(), std::cbrt(32 * 1e-4 / 500), 1e-12);
}

TEST(Profile, KeepsItsLimitsAndMeetsInEveryPhase) {
  std::mt19937_64 engine(20260101);
  SCOPED_TRACE("seed 20260101");
  for (int n = 0; n < 20000; ++n) {
    const double length = log_uniform(engine, 1e-7, 1e4);
    const PathLimits limits{log_uniform(engine, 1e-4, 1e4), log_uniform(engine, 1e-2, 1e5),
                            log_uniform(engine, 1, 1e7)};
    const Profile p = rest_to_rest(length, limits);
    ASSERT_LE(p.peak_velocity(), limits.velocity * (1 + 1e-8));
    ASSERT_LE(p.peak_acceleration(), limits.acceleration * (1 + 1e-8));
    ASSERT_LE(p.jerk, limits.jerk * (1 + 1e-8));
    ASSERT_NEAR(p.length(), length, length * 1e-14);
    // Jerk is used in full: nothing is wasted.
    ASSERT_GE(p.jerk, limits.jerk * (1 - 1e-8));
    const ProfilePhases phases = phases_of(p, length);
    double s = 0, v = 0, a = 0;
    for (int i = 0; i < phases.count; ++i) {
      const ProfilePhase& q = phases.phase[i];
      ASSERT_NEAR(s, q.s, length * 1e-13);
      ASSERT_NEAR(v, q.v, p.peak_velocity() * 1e-12);
      ASSERT_NEAR(a, q.a, p.peak_acceleration() * 1e-12);
      const double t = q.duration;
      s = q.s + t * (q.v + t * (q.a / 2 + t * q.j / 6));
      v = q.v + t * (q.a + t * q.j / 2);
      a = q.a + t * q.j;
    }
    ASSERT_NEAR(s, length, length * 1e-14);
    ASSERT_NEAR(v, 0, p.peak_velocity() * 1e-12);
  }
}

TEST(Profile, LeavesTheReserveOfTheRateFilter) {
  std::mt19937_64 engine(20260102);
  SCOPED_TRACE("seed 20260102");
  int planned = 0;
  for (int n = 0; n < 20000; ++n) {
    const double length = log_uniform(engine, 1e-7, 1e4);
    const double v = log_uniform(engine, 1e-4, 1e3);
    const PathLimits limits{v, v * log_uniform(engine, 5, 100), v * log_uniform(engine, 100, 1e5)};
    const Profile p = rest_to_rest_with_reserve(length, limits);
    if (p.jerk == 0) continue;
    ++planned;
    const double reached = p.peak_velocity(), a = p.peak_acceleration();
    for (double less = 0; less <= 1; less += less < 0.06 ? 0.001 : 0.05) {  // 1 - w
      const double w = 1 - less;
      const double slope = std::min(kRateSlope_per_s, std::sqrt(2 * kRateCurvature_per_s2 * less));
      ASSERT_LE(w * w * a + slope * reached, limits.acceleration * (1 + 1e-8));
      ASSERT_LE(w * w * w * p.jerk + 3 * w * slope * a + kRateCurvature_per_s2 * reached,
                limits.jerk * (1 + 1e-8));
    }
  }
  EXPECT_GT(planned, 19000);
}

}  // namespace
}  // namespace meridian
