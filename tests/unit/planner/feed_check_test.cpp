// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/solver/feed_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "service/core/planner/feed/cells/feed_rest.hpp"
#include "support/machines.hpp"

namespace meridian::test::feed_check {
namespace {

/// One joint with a limit of 1 each, without a rate filter.
FeedLimits unit_limits() {
  FeedLimits limits;
  limits.count = 1;
  limits.velocity[0] = limits.acceleration[0] = limits.jerk[0] = limits.full_jerk[0] = 1;
  return limits;
}

/// A cell in which u runs evenly and the joint's derivative number `order` is `of(k)` at place k.
template <class Of>
FeedUse use_at_even_speed(int order, const Of& of, double slope = 0, double curvature = 0) {
  FeedCell cell;
  cell.h = 0.1;
  for (int k = 0; k <= FeedCell::kSteps; ++k) {
    CellSample& at = cell.at[static_cast<std::size_t>(k)];
    at.max_b = 1;
    (order == 1 ? at.d1 : order == 2 ? at.d2 : at.d3)[0] = of(k);
  }
  FeedLimits limits = unit_limits();
  limits.slope = slope;
  limits.curvature = curvature;
  return use_of(limits, cell, {1, 0, 0});
}

double use_of_order(const FeedUse& use, int order) {
  return order == 1 ? use.velocity : order == 2 ? use.acceleration : use.jerk;
}

TEST(FeedCheck, SeesATopBetweenAnyTwoSamples) {
  for (int order = 1; order <= 3; ++order) {
    for (const double sign : {1.0, -1.0}) {
      for (double top = 0; top <= FeedCell::kSteps; top += 0.1) {
        SCOPED_TRACE(testing::Message() << "derivative " << order << ", top at " << top);
        const auto bump = [&](int k) { return sign * (1.02 - 0.02 * (k - top) * (k - top)); };
        EXPECT_NEAR(use_of_order(use_at_even_speed(order, bump), order), 1.02, 1e-12);
      }
    }
  }
}

TEST(FeedCheck, TakesNoTopThatLiesOutsideOfTheCell) {
  const auto rising = [](int k) { return 0.5 + 0.1 * k - 0.005 * k * k; };  // top at 10
  const double end = rising(FeedCell::kSteps);
  EXPECT_NEAR(use_at_even_speed(2, rising).acceleration, end, 1e-12);
  const auto falling = [&](int k) { return rising(FeedCell::kSteps - k); };
  EXPECT_NEAR(use_at_even_speed(2, falling).acceleration, end, 1e-12);
}

TEST(FeedCheck, CountsTheRateFilterAsAccelerationBetweenSamplesToo) {
  const auto bump = [](int k) { return 1 - 0.02 * (k - 3.5) * (k - 3.5); };
  EXPECT_NEAR(use_at_even_speed(1, bump, 0.25).acceleration, 0.25, 1e-12);
}

TEST(FeedCheck, CountsWhatAccelerationAndVelocityLeaveToTheRateFilterAsJerk) {
  const auto bump = [](int k) { return 1 - 0.02 * (k - 3.5) * (k - 3.5); };
  EXPECT_NEAR(use_at_even_speed(1, bump, 0.25, 0.1).jerk, 0.1, 1e-12);
  EXPECT_NEAR(use_at_even_speed(2, bump, 0.25, 0.1).jerk, 3 * 0.25, 1e-12);
  EXPECT_NEAR(use_at_even_speed(3, bump, 0.25, 0.1).jerk, 1, 1e-12);
  CellSample at;
  at.max_b = 100;
  at.d1[0] = 1;
  at.d2[0] = -2;
  FeedLimits limits = unit_limits();
  limits.slope = 0.25;
  limits.curvature = 0.1;
  FeedUse use;
  add_use(limits, at, 2, 3, 5, use);  // q̇ 2, q̈ 3 - 8, q⃛ 5 - 36
  EXPECT_NEAR(use.jerk, RateRoom::of_jerk(0.25, 0.1).largest(31, 3 * 5) + 0.1 * 2, 1e-12);
  EXPECT_NEAR(use.acceleration, RateRoom::of_acceleration(0.25, 0.1).largest(5, 2), 1e-12);
}

TEST(FeedCheck, SeesNoTopBesideAChangeOfTheJerksSign) {
  const auto swing = [](int k) { return std::cos(k + 2.7); };
  EXPECT_LT(use_at_even_speed(3, swing).jerk, 1.03) << "of |jerk| a parabola would rise to 1.13";
}

TEST(FeedCheck, TakesAStandstillForAUseWithoutBound) {
  FeedCell cell;
  cell.h = 1;
  EXPECT_GT(use_of(unit_limits(), cell, {1, -2, 0}).jerk, 1e6);
}

/// A joint that bends, and u̇, ü, u⃛: what it does is set by hand.
struct Bent {
  double d1 = 0.5, d2 = 0.25, d3 = 0.125, v = 2, a = 3, j = 5;
  [[nodiscard]] double acceleration() const { return d1 * a + d2 * v * v; }
  [[nodiscard]] double jerk() const { return d1 * j + 3 * d2 * v * a + d3 * v * v * v; }
  /// The jerk and what the rate filter asks for beside it, by bent_limits().
  [[nodiscard]] double jerk_with_rate() const {
    return RateRoom::of_jerk(0.3, 0.7).largest(std::abs(jerk()), 3 * std::abs(acceleration())) +
           0.7 * d1 * v;
  }
  [[nodiscard]] double acceleration_with_rate() const {
    return RateRoom::of_acceleration(0.3, 0.7).largest(std::abs(acceleration()), d1 * v);
  }
};

FeedLimits bent_limits() {
  FeedLimits limits = unit_limits();
  limits.velocity[0] = 10;
  limits.acceleration[0] = 20;
  limits.full_jerk[0] = 40;
  limits.slope = 0.3;
  limits.curvature = 0.7;
  return limits;
}

void expect_use(const FeedUse& use, const Bent& bent, double max_b) {
  EXPECT_NEAR(use.b, bent.v * bent.v / max_b, 1e-12);
  EXPECT_NEAR(use.velocity, bent.d1 * bent.v / 10, 1e-12);
  EXPECT_NEAR(use.acceleration, bent.acceleration_with_rate() / 20, 1e-12);
  EXPECT_NEAR(use.jerk, bent.jerk_with_rate() / 40, 1e-12);
}

TEST(FeedCheck, TakesEveryTermOfAJointThatBends) {
  const Bent bent;
  FeedCell cell;
  cell.h = 0.1;
  CellMotion motion;
  for (int k = 0; k <= FeedCell::kSteps; ++k) {
    cell.at[k].d1[0] = bent.d1;
    cell.at[k].d2[0] = bent.d2;
    cell.at[k].d3[0] = bent.d3;
    cell.at[k].max_b = 8;
    motion.v[k] = bent.v;
    motion.a[k] = bent.a;
    motion.j[k] = bent.j;
  }
  expect_use(use_of_motion(bent_limits(), cell, motion), bent, 8);
  FeedUse use;
  add_use(bent_limits(), cell.at[3], bent.v, bent.a, bent.j, use);
  expect_use(use, bent, 8);
  add_use(bent_limits(), cell.at[3], 0.1, 0, 0, use);
  expect_use(use, bent, 8);  // the larger one stays
}

TEST(FeedCheck, KnowsTheMotionOfALaw) {
  // b = 4 + 6 x - 10 x² over 0.4: at its end b = 4.8, b' = -2; u⃛ = b''/2 √b.
  FeedCell cell;
  cell.h = 0.4;
  const CellLaw law{4, 6, -2};
  for (const int at : {0, FeedCell::kSteps}) {
    for (CellSample& sample : cell.at) {
      sample = {};
      sample.max_b = 1e9;
    }
    cell.at[at].d1[0] = 0.5;
    cell.at[at].d2[0] = 0.25;
    cell.at[at].d3[0] = 0.125;
    Bent bent;
    bent.v = std::sqrt(at == 0 ? 4 : 4.8);
    bent.a = at == 0 ? 3 : -1;
    bent.j = -10 * bent.v;
    const FeedUse use = use_of(bent_limits(), cell, law);
    EXPECT_NEAR(use.velocity, bent.d1 * bent.v / 10, 1e-12);
    EXPECT_NEAR(use.acceleration, bent.acceleration_with_rate() / 20, 1e-12);
    EXPECT_NEAR(use.jerk, bent.jerk_with_rate() / 40, 1e-12);
  }
}

/// b = (x - least)² + left over a cell of length 1: every derivative but that of the law is 0.
FeedUse use_of_dip(double smallest, double left) {
  FeedCell cell;
  cell.h = 1;
  for (CellSample& at : cell.at) at.max_b = 10;
  return use_of(unit_limits(), cell,
                {smallest * smallest + left, -2 * smallest, 2 * (1 - smallest)});
}

TEST(FeedCheck, SeesAStandstillBetweenTwoSamples) {
  for (int k = 0; k < FeedCell::kSteps; ++k) {
    const double between = (k + 0.5) / FeedCell::kSteps;
    SCOPED_TRACE(between);
    // 1/16 from either sample: b is no less than 0.0039 - 0.003 at all of them.
    EXPECT_GT(use_of_dip(between, -0.003).jerk, 1e6);
    EXPECT_GT(use_of_dip(between, 0).jerk, 1e6) << "the law touches 0";
    EXPECT_EQ(use_of_dip(between, 1e-6).jerk, 0) << "it goes on, slowly";
  }
}

/// b has its top, 1, between two samples, at which it is 0.996.
TEST(FeedCheck, SeesAFeedThatIsPassedBetweenTwoSamples) {
  FeedCell cell;
  cell.h = 1;
  for (CellSample& at : cell.at) at.max_b = 0.998;
  const double top = 4.5 / FeedCell::kSteps;
  const CellLaw law{1 - top * top, 2 * top, 2 * top - 2};
  EXPECT_NEAR(use_of(unit_limits(), cell, law).b, 1 / 0.998, 1e-12);
}

TEST(FeedCheck, TakesNoStandstillThatLiesOutsideOfTheCell) {
  for (const double outside : {-1.0 / 16, 17.0 / 16}) {
    EXPECT_EQ(use_of_dip(outside, -0.003).jerk, 0) << outside;
  }
  FeedCell cell;
  cell.h = 1;
  for (CellSample& at : cell.at) at.max_b = 10;
  const CellLaw falling_faster{1, -0.1, -1.8};  // a top, and 0.05 left at the end
  EXPECT_EQ(use_of(unit_limits(), cell, falling_faster).jerk, 0);
}

/// The last resort is made from samples; a top that lies between them slows it too.
TEST(FeedCheck, SlowsTheLastResortForATopBetweenSamples) {
  const MachineModel model = bench_machine();
  const FeedLimits limits = unit_limits();
  CellGrid grid(model, limits, {});
  constexpr int kCells = 3;
  for (const bool has_top : {false, true}) {
    for (int n = 0; n < kCells; ++n) {
      FeedCell& cell = grid[n];
      cell = {};
      cell.h = 0.1;
      for (int k = 0; k <= FeedCell::kSteps; ++k) {
        CellSample& at = cell.at[static_cast<std::size_t>(k)];
        at.max_b = 1e6;
        at.d1[0] = 1;
        at.d3[0] = has_top && n == 1 && (k == 4 || k == 5) ? 1e5 : 0;  // and 12 % more between
      }
    }
    const Crawl sampled = crawl_over(grid, limits, 0, kCells);
    const Crawl safe = checked(limits, grid, 0, sampled);
    EXPECT_EQ(use_of(limits, grid, 0, sampled).worst() > 1, has_top);
    EXPECT_LE(use_of(limits, grid, 0, safe).worst(), 1 + 1e-12);
    EXPECT_EQ(safe.duration > sampled.duration, has_top);
  }
}

TEST(FeedCheck, IsBoundedByTheDerivativesOfItsCell) {
  std::mt19937 random(5);
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  FeedLimits limits = unit_limits();
  limits.slope = 0.2;
  limits.curvature = 0.1;
  double tightest = 1e9;
  for (int draw = 0; draw < 2000; ++draw) {
    FeedCell cell;
    cell.h = 0.1;
    cell.max_b = real(0.5, 2);
    const auto curve = [&](LimitedVector CellSample::*d, CellBound::Sides& sides) {
      const double at_begin = real(-1, 1), rise = real(-0.5, 0.5), bend = real(-0.5, 0.5);
      double low = 1e9, high = -1e9;
      for (int k = 0; k <= FeedCell::kSteps; ++k) {
        const double x = static_cast<double>(k) / FeedCell::kSteps;
        const double value = at_begin + x * (rise + x * bend);
        (cell.at[static_cast<std::size_t>(k)].*d)[0] = value;
        cell.at[static_cast<std::size_t>(k)].max_b = cell.max_b;
        low = std::min(low, value);
        high = std::max(high, value);
      }
      const double beyond = 0.125 * (high - low);
      sides.up[0] = std::max(0.0, high + beyond);
      sides.down[0] = std::max(0.0, beyond - low);
    };
    curve(&CellSample::d1, cell.bound.d1);
    curve(&CellSample::d2, cell.bound.d2);
    curve(&CellSample::d3, cell.bound.d3);
    cell.bound.rate = cell.bound.d1.up.max(cell.bound.d1.down);
    const CellLaw law{real(0.2, 1), real(-3, 3), real(-3, 3)};
    const FeedUse use = use_of(limits, cell, law), max = max_use_of(limits, cell, law);
    SCOPED_TRACE(testing::Message() << "draw " << draw);
    EXPECT_GE(max.velocity, use.velocity);
    EXPECT_GE(max.acceleration, 0.98 * use.acceleration);
    EXPECT_GE(max.jerk, 0.98 * use.jerk);
    EXPECT_GE(max.b, use.b * (1 - 1e-12));
    tightest = std::min(tightest, max.worst() / use.worst());
  }
  EXPECT_LT(tightest, 1.1) << "where everything comes together it is hardly more";
}

TEST(FeedCheck, IsItsBoundWhereNothingChanges) {
  FeedCell cell;
  cell.h = 0.1;
  cell.max_b = 4;
  for (CellSample& at : cell.at) {
    at.d1[0] = -0.5;
    at.max_b = 4;
  }
  cell.bound.d1.down[0] = cell.bound.rate[0] = 0.5;
  const FeedLimits limits = unit_limits();
  const FeedUse use = use_of(limits, cell, {1, 0, 0}), max = max_use_of(limits, cell, {1, 0, 0});
  EXPECT_DOUBLE_EQ(max.velocity, use.velocity);
  EXPECT_DOUBLE_EQ(max.b, use.b);
  EXPECT_EQ(max.acceleration, 0);
  EXPECT_EQ(max.jerk, 0);
}

TEST(FeedCheck, HasNoBoundWhereTheSpeedMayComeToNothing) {
  FeedCell cell;
  cell.h = 0.1;
  cell.max_b = 1;
  EXPECT_GT(max_use_of(unit_limits(), cell, {0.01, -1, 1}).worst(), 1e8);
  EXPECT_GT(max_use_of(unit_limits(), cell, {0.04, -1, 0}).worst(), 1e8);
  EXPECT_LT(max_use_of(unit_limits(), cell, {0.2, -1, 0}).worst(), 1e8);
}

}  // namespace
}  // namespace meridian::test::feed_check
