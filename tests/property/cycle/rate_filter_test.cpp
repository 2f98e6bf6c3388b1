// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/rate_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

/// Laws of the override over random targets, cycle times and phases: w in [0, 1], |w'| <= slope,
/// |w''| <= curvature, exact landing, no chatter, plan time the exact integral.
namespace meridian::test::rate_filter {
namespace {

constexpr double kRounding = 1e-9;  // relative; a tick's differences are rounded to 1e-12
constexpr unsigned kSeed = 20240611;
constexpr int kDraws = 400;

struct Tick {
  double w, slope, passed;
};

/// What a trial may complain about, counted, so that a broken filter can be shown to fail.
struct Complaints {
  int below_zero = 0, above_one = 0, too_steep = 0, too_curved = 0;
  int not_landed = 0, chatter = 0, backwards = 0;
};

/// Checks the ticks of one target, which lasted long enough to land.
void check_one_target(const std::vector<Tick>& ticks, const Tick& before, double target,
                      const RateBounds& bounds, double dt, Complaints& out) {
  Tick last = before;
  int turns = 0;
  for (const Tick& tick : ticks) {
    out.below_zero += tick.w < 0;
    out.above_one += tick.w > 1;
    out.backwards += tick.passed < 0;
    out.too_steep += std::abs(tick.slope) > bounds.slope * (1 + kRounding);
    out.too_curved += std::abs(tick.slope - last.slope) > bounds.curvature * dt * (1 + kRounding);
    turns += tick.slope * last.slope < 0;
    last = tick;
  }
  out.chatter += turns > 1;  // once to turn round, never again
  out.not_landed += last.w != target || last.slope != 0;
}

template <class Make>
Complaints try_filter(const Make& make, unsigned seed) {
  std::mt19937_64 draw(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  Complaints out;
  for (int n = 0; n < kDraws; ++n) {
    const RateBounds bounds{0.5 + 2 * unit(draw), 4 + 30 * unit(draw)};
    const double dt = 125e-6 * std::pow(32.0, unit(draw));
    auto filter = make(bounds);
    filter.reset(unit(draw));
    for (int k = 0; k < 6; ++k) {
      const double target = unit(draw) < 0.3 ? std::round(unit(draw)) : unit(draw);
      const bool is_left_alone = k == 5 || unit(draw) < 0.5;
      const double max = 1 / bounds.slope + 4 * bounds.slope / bounds.curvature + 10 * dt;
      const double time = is_left_alone ? max : max * unit(draw);
      filter.aim(target);
      const Tick before{filter.rate(), filter.slope(), 0};
      std::vector<Tick> ticks;
      for (double t = 0; t < time; t += dt) {
        const double passed = filter.advance(dt);
        ticks.push_back({filter.rate(), filter.slope(), passed});
      }
      if (is_left_alone) check_one_target(ticks, before, target, bounds, dt, out);
    }
  }
  return out;
}

TEST(RateFilter, KeepsItsLawsOverRandomTargetsCycleTimesAndPhases) {
  std::cout << "seed " << kSeed << ", " << kDraws << " draws of 6 targets\n";
  const Complaints c = try_filter([](const RateBounds& b) { return RateFilter(b); }, kSeed);
  EXPECT_EQ(c.below_zero, 0);
  EXPECT_EQ(c.above_one, 0);
  EXPECT_EQ(c.too_steep, 0);
  EXPECT_EQ(c.too_curved, 0);
  EXPECT_EQ(c.not_landed, 0);
  EXPECT_EQ(c.chatter, 0);
  EXPECT_EQ(c.backwards, 0);
}

/// The plain filter of many controllers: brakes when the square root law says so, a cycle late.
class PlainFilter {
 public:
  explicit PlainFilter(const RateBounds& bounds) : bounds_(bounds) {}
  void reset(double w) { w_ = w, slope_ = 0; }
  void aim(double target) { target_ = target; }
  double advance(double dt) {
    const double error = target_ - w_;
    const double wanted = std::copysign(
        std::min(bounds_.slope, std::sqrt(2 * bounds_.curvature * std::abs(error))), error);
    slope_ += std::clamp((wanted - slope_) / dt, -bounds_.curvature, bounds_.curvature) * dt;
    w_ += slope_ * dt;
    return w_ * dt;
  }
  [[nodiscard]] double rate() const { return w_; }
  [[nodiscard]] double slope() const { return slope_; }

 private:
  RateBounds bounds_;
  double w_ = 0, slope_ = 0, target_ = 0;
};

TEST(RateFilter, TheTrialCatchesAPlainFilterThatNeverLands) {
  const Complaints c = try_filter([](const RateBounds& b) { return PlainFilter(b); }, kSeed);
  EXPECT_GT(c.not_landed, kDraws / 2);
  EXPECT_GT(c.below_zero, 0);
  EXPECT_GT(c.chatter, 0);
}

TEST(RateFilter, IsMonotoneFromRestToASingleTarget) {
  std::cout << "seed " << kSeed + 1 << "\n";
  std::mt19937_64 draw(kSeed + 1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int n = 0; n < kDraws; ++n) {
    RateFilter filter;
    const double begin = unit(draw), target = unit(draw);
    const double dt = 125e-6 * std::pow(32.0, unit(draw));
    filter.reset(begin);
    filter.aim(target);
    double last = begin;
    while (!filter.is_settled()) {
      filter.advance(dt);
      ASSERT_GE((filter.rate() - last) * (target - begin), 0);
      last = filter.rate();
    }
    EXPECT_EQ(last, target);
  }
}

TEST(RateFilter, DifferencesOfPlanTimeStayInsideTheBounds) {
  std::cout << "seed " << kSeed + 2 << "\n";
  std::mt19937_64 draw(kSeed + 2);
  std::uniform_real_distribution<double> unit(0, 1);
  const RateBounds bounds;
  for (int n = 0; n < kDraws; ++n) {
    RateFilter filter(bounds);
    filter.reset(unit(draw));
    const double dt = 125e-6 * std::pow(32.0, unit(draw));
    const double rounding = 8 * 2.3e-16 * dt;
    double x1 = 0, x2 = 0;  // plan time of the last ticks
    for (int k = 0; k < 3000; ++k) {
      if (k % 400 == 0) filter.aim(unit(draw));
      const double x0 = filter.advance(dt);
      if (k > 0) {
        ASSERT_LE(std::abs(x0 - x1), bounds.slope * dt * dt * (1 + kRounding) + rounding);
      }
      if (k > 1) {
        ASSERT_LE(std::abs(x0 - 2 * x1 + x2),
                  bounds.curvature * dt * dt * dt * (1 + kRounding) + 4 * rounding);
      }
      x2 = x1;
      x1 = x0;
    }
  }
}

TEST(RateFilter, PassesTheSamePlanTimeAtEveryCycleTime) {
  std::cout << "seed " << kSeed + 3 << "\n";
  std::mt19937_64 draw(kSeed + 3);
  std::uniform_real_distribution<double> unit(0, 1);
  constexpr double kTolerance_s = 1e-12;  // sums of 1e4 steps of 1e-4 s, 50x margin
  for (int n = 0; n < kDraws; ++n) {
    RateFilter coarse, fine;
    const double begin = unit(draw);
    coarse.reset(begin);
    fine.reset(begin);
    double coarse_time = 0, fine_time = 0;
    for (int k = 0; k < 5; ++k) {
      const double target = unit(draw);
      coarse.aim(target);
      fine.aim(target);
      for (int i = 0; i < 60; ++i) {
        coarse_time += coarse.advance(4e-3);
        for (int m = 0; m < 32; ++m) fine_time += fine.advance(125e-6);
      }
      ASSERT_NEAR(coarse.rate(), fine.rate(), kTolerance_s);
    }
    EXPECT_NEAR(coarse_time, fine_time, kTolerance_s);
  }
}

TEST(RateFilter, IgnoresANaNAndLimitsTheTarget) {
  RateFilter filter;
  filter.aim(1.4);
  EXPECT_EQ(filter.target(), 1.0);
  filter.aim(std::nan(""));
  EXPECT_EQ(filter.target(), 1.0);
  filter.aim(-3);
  EXPECT_EQ(filter.target(), 0.0);
}

TEST(RateFilter, KnowsThePlanTimeThatBrakingTakes) {
  std::mt19937_64 draw(kSeed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int n = 0; n < kDraws; ++n) {
    const RateBounds bounds{0.2 + unit(draw), 4 + 30 * unit(draw)};
    RateFilter filter(bounds);
    filter.reset(unit(draw));
    filter.aim(unit(draw));
    (void)filter.advance(0.3 * unit(draw));
    const double predicted = filter.plan_time_to_rest();
    filter.aim(0);
    double passed = 0;
    while (!filter.is_settled()) passed += filter.advance(1e-3);
    EXPECT_NEAR(predicted, passed, 1e-12);
  }
}

TEST(RateFilter, KnowsTheRateFromWhichAPlanTimeIsEnoughToRest) {
  std::mt19937_64 draw(kSeed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int n = 0; n < kDraws; ++n) {
    const RateBounds bounds{0.2 + unit(draw), 4 + 30 * unit(draw)};
    RateFilter filter(bounds);
    const double rate = std::pow(unit(draw), 4);
    filter.reset(rate);
    EXPECT_NEAR(filter.rate_with_rest_in(filter.plan_time_to_rest()), rate, 1e-12);
  }
  EXPECT_EQ(RateFilter().rate_with_rest_in(0), 0);
  EXPECT_EQ(RateFilter().rate_with_rest_in(-1), 0);
}

/// What planner/rate_room.hpp takes for granted.
TEST(RateFilter, HasNoMoreSlopeThanItCanTakeBackBeforeOne) {
  std::mt19937 random(12);
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  for (const double ramp : {1.0, 3.0}) {
    const RateBounds bounds{1 / ramp, 10 / ramp};
    RateFilter filter(bounds);
    filter.reset(1);
    double closest = 0;
    for (int n = 0; n < 200000; ++n) {
      if (n % 37 == 0) filter.aim(real(0, 1) < 0.4 ? 1 : real(0, 1.1));
      (void)filter.advance(real(1e-4, 4e-3));
      const double max = std::sqrt(2 * bounds.curvature * (1 - filter.rate()));
      ASSERT_LE(std::abs(filter.slope()), std::min(bounds.slope, max) + 1e-6) << n;
      if (filter.rate() < 1) closest = std::max(closest, std::abs(filter.slope()) / max);
    }
    EXPECT_GT(closest, 0.99) << "it comes to rest at 1 by all of its curvature";
  }
}

/// So does a FaultStop's faster fall, for which limits beyond the others leave room.
TEST(RateFilter, FallsNoFasterThanItsOwnSlopeAndWhatAStopAdds) {
  std::mt19937 random(13);
  const auto real = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const RateBounds own{1, 10};
  for (int n = 0; n < 2000; ++n) {
    const double more = std::pow(10.0, real(-1, 2));
    RateFilter filter(own);
    filter.reset(real(0, 1));
    filter.aim(real(0, 1) < 0.5 ? 1 : real(0, 1));
    (void)filter.advance(real(0, 0.5));
    filter.stop({own.slope + more, own.curvature + more * own.curvature / own.slope});
    for (int k = 0; k < 400 && !filter.is_settled(); ++k) {
      (void)filter.advance(1e-3);
      const double max = std::min(own.slope, std::sqrt(2 * own.curvature * (1 - filter.rate())));
      ASSERT_LE(std::abs(filter.slope()), max + more + 1e-6) << n << " " << filter.rate();
    }
  }
}

}  // namespace
}  // namespace meridian::test::rate_filter
