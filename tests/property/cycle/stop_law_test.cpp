// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/stop/stop_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

/// The stop from random path states: exact rest, bounds by finite differences, least time.
namespace meridian::test::stop_law {
namespace {

constexpr unsigned kSeed = 20240612;
constexpr int kDraws = 2000;

struct Case {
  PathState begin;
  StopMargin authority;
};

/// A state that a motion inside the authority can be in and still come to rest without going
/// backwards: a² <= 2 j v where it already brakes.
Case draw_case(std::mt19937_64& draw) {
  std::uniform_real_distribution<double> unit(0, 1);
  Case out;
  const double accel = 10 * std::pow(500.0, unit(draw));
  out.authority = {accel, accel * (10 + 90 * unit(draw))};
  out.begin.s = 1000 * unit(draw);
  out.begin.ds = 300 * std::pow(unit(draw), 3);
  const double deepest =
      std::min(out.authority.accel, std::sqrt(2 * out.authority.jerk * out.begin.ds));
  out.begin.dds = -deepest + (deepest + out.authority.accel) * unit(draw);
  return out;
}

TEST(StopLaw, EndsExactlyAtRest) {
  std::cout << "seed " << kSeed << "\n";
  std::mt19937_64 draw(kSeed);
  for (int n = 0; n < kDraws; ++n) {
    const Case c = draw_case(draw);
    const StopLaw law(c.begin, c.authority);
    const PathState end = law.at(law.duration());
    EXPECT_EQ(end.ds, 0);
    EXPECT_EQ(end.dds, 0);
    EXPECT_NEAR(end.s, c.begin.s + law.distance(), 1e-12);
  }
}

TEST(StopLaw, StaysInsideAccelerationAndJerkAtEveryCycleTimeAndPhase) {
  std::cout << "seed " << kSeed + 1 << ", " << kDraws << " stops\n";
  std::mt19937_64 draw(kSeed + 1);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst_accel = 0, worst_jerk = 0;
  for (int n = 0; n < kDraws; ++n) {
    const Case c = draw_case(draw);
    const StopLaw law(c.begin, c.authority);
    const double dt = 125e-6 * std::pow(32.0, unit(draw));
    // ulp of s up to 8e3 mm, ulp of t up to 64 s at 300 mm/s; weights of a third difference: 8
    const double rounding = 8 * (9.1e-13 + 300 * 7.2e-15);
    double x[4] = {};
    int k = 0;
    for (double t = dt * unit(draw); t < law.duration() + 5 * dt; t += dt, ++k) {
      for (int i = 3; i > 0; --i) x[i] = x[i - 1];
      x[0] = law.at(t).s;
      if (k >= 1) {
        ASSERT_GE(x[0], x[1]);
      }
      if (k >= 2) {
        const double a = std::abs(x[0] - 2 * x[1] + x[2]);
        worst_accel = std::max(worst_accel, (a - rounding) / (c.authority.accel * dt * dt));
      }
      if (k >= 3) {
        const double j = std::abs(x[0] - 3 * x[1] + 3 * x[2] - x[3]);
        worst_jerk = std::max(worst_jerk, (j - 2 * rounding) / (c.authority.jerk * dt * dt * dt));
      }
    }
  }
  std::cout << "worst share of acceleration " << worst_accel << ", of jerk " << worst_jerk << "\n";
  EXPECT_LE(worst_accel, 1 + 1e-6);
  EXPECT_LE(worst_jerk, 1 + 1e-6);
}

/// Time of the stop that brakes down to `depth` and no deeper.
double time_with_depth(const Case& c, double depth) {
  const double j = c.authority.jerk, v = c.begin.ds, a = c.begin.dds;
  const double v_after = v + (a * a - depth * depth) / (2 * j);
  return (a + depth) / j + (v_after - depth * depth / (2 * j)) / depth + depth / j;
}

TEST(StopLaw, IsNotSlowerThanAnyStopWithLessDepth) {
  std::cout << "seed " << kSeed + 2 << "\n";
  std::mt19937_64 draw(kSeed + 2);
  for (int n = 0; n < kDraws; ++n) {
    const Case c = draw_case(draw);
    const StopLaw law(c.begin, c.authority);
    const double v = c.begin.ds, a = c.begin.dds, j = c.authority.jerk;
    const double deepest = std::min(c.authority.accel, std::sqrt(j * v + a * a / 2));
    for (int k = 1; k <= 20; ++k) {
      const double depth = std::max(-a, deepest * k / 20.0);
      EXPECT_LE(law.duration(), time_with_depth(c, depth) * (1 + 1e-9));
    }
  }
}

TEST(StopLaw, StopsACruiseInTheTextbookTime) {
  const StopLaw law({5, 100, 0, 0}, {1000, 20000});
  EXPECT_NEAR(law.duration(), 100.0 / 1000 + 1000.0 / 20000, 1e-15);
  EXPECT_NEAR(law.distance(), 100 * law.duration() / 2, 1e-12);
}

TEST(StopLaw, AtRestItStaysWhereItIs) {
  const StopLaw law({7, 0, 0, 0}, {1000, 20000});
  EXPECT_EQ(law.duration(), 0);
  EXPECT_EQ(law.at(0).s, 7);
}

TEST(StopLaw, EndsAtRestEvenWhereItBrakesTooHardAlready) {
  const StopLaw law({0, 1, -300, 0}, {1000, 20000});  // 300² > 2 · 20000 · 1
  EXPECT_GE(law.at(law.duration() / 2).ds, 0);
  EXPECT_NEAR(law.duration(), 2.0 / 300, 1e-15);
  EXPECT_EQ(law.at(law.duration()).ds, 0);
}

TEST(StopLaw, NeverPassesTheRestOfAPlanWithTheSameBounds) {
  // The plan: from cruise to rest by the same acceleration and jerk; the stop begins anywhere on
  // it.
  const StopMargin bounds{1000, 20000};
  const StopLaw plan({0, 100, 0, 0}, bounds);
  for (int n = 0; n < 1000; ++n) {
    const double begin = plan.duration() * n / 1000.0;
    const StopLaw stop(plan.at(begin), bounds);
    EXPECT_LE(stop.at(stop.duration()).s, plan.distance() + 1e-12) << begin;
  }
}

}  // namespace
}  // namespace meridian::test::stop_law
