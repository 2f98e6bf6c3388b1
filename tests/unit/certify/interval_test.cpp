// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/certify/interval.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace meridian::certify {
namespace {

using Real = long double;  // 11 digits of a bit more than what is checked

struct Draws {
  std::mt19937_64 engine{20261};
  double uniform(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(engine);
  }
  /// Sets of all sizes, points among them.
  Interval set() {
    const double mid = uniform(-1, 1) * std::pow(10.0, uniform(-4, 4));
    return {mid, uniform(0, 1) < 0.3 ? 0 : std::abs(mid) * std::pow(10.0, uniform(-13, -0.1))};
  }
  Real member(const Interval& x) {
    const double which = uniform(-1.2, 1.2);
    constexpr Real kInside = 1 - 1e-6L;  // a member is rounded itself
    const Real share = which < -1 ? -kInside : which > 1 ? kInside : kInside * which;
    return static_cast<Real>(x.mid) + share * static_cast<Real>(x.rad);
  }
};

[[nodiscard]] bool holds(const Interval& x, Real value) {
  return std::abs(value - static_cast<Real>(x.mid)) <= static_cast<Real>(x.rad);
}

TEST(Interval, HoldsTheResultForEveryMemberOfItsOperands) {
  Draws draws;
  for (int n = 0; n < 20000; ++n) {
    const Interval a = draws.set(), b = draws.set();
    const Real x = draws.member(a), y = draws.member(b);
    ASSERT_TRUE(holds(a + b, x + y)) << n;
    ASSERT_TRUE(holds(a - b, x - y)) << n;
    ASSERT_TRUE(holds(a * b, x * y)) << n;
    if (std::isfinite((a / b).rad)) {
      ASSERT_TRUE(holds(a / b, x / y)) << n;
    }
    const auto [sine, cosine] = sin_cos_of(a);
    ASSERT_TRUE(holds(sine, std::sin(x))) << n;
    ASSERT_TRUE(holds(cosine, std::cos(x))) << n;
    ASSERT_LE(x, static_cast<Real>(upper(a)));
    ASSERT_GE(x, static_cast<Real>(lower(a)));
    ASSERT_LE(std::abs(x), static_cast<Real>(largest(a)));
    ASSERT_GE(std::abs(x), static_cast<Real>(smallest(a)));
    const Interval square = a * a + Interval(1e-12);
    if (std::isfinite(sqrt(square).rad)) {
      ASSERT_TRUE(holds(sqrt(square), std::sqrt(x * x + Real{1e-12}))) << n;
    }
    const Interval angle = atan2(b, a);
    if (!std::isfinite(angle.rad)) continue;
    const Real turns = std::round((std::atan2(y, x) - static_cast<Real>(angle.mid)) / 6.2831853L);
    ASSERT_TRUE(holds(angle, std::atan2(y, x) - turns * 6.283185307179586476925L)) << n;
  }
}

TEST(Interval, OfAPointIsAsWideAsAFewRoundings) {
  Draws draws;
  for (int n = 0; n < 1000; ++n) {
    const double x = draws.uniform(0.1, 10), y = draws.uniform(0.1, 10);
    const auto few = [](const Interval& z) { return z.rad <= 2e-15 * std::abs(z.mid) + 1e-290; };
    EXPECT_TRUE(few(Interval(x) + Interval(y)));
    EXPECT_TRUE(few(Interval(x) * Interval(y)));
    EXPECT_TRUE(few(Interval(x) / Interval(y)));
    EXPECT_TRUE(few(sqrt(Interval(x))));
    EXPECT_TRUE(few(atan2(Interval(y), Interval(x))));
  }
}

TEST(Interval, IsEverythingWhereAFunctionHasAMemberItIsNotSmoothAt) {
  const Interval through_zero(0.1, 0.2);
  EXPECT_FALSE(std::isfinite(inverse(through_zero).rad));
  EXPECT_FALSE(std::isfinite(sqrt(through_zero).rad));
  EXPECT_FALSE(std::isfinite(atan2(through_zero, through_zero).rad));
  EXPECT_FALSE(std::isfinite(sqrt(Interval(1e-18)).rad));  // where joints are held
  EXPECT_FALSE(std::isfinite(atan2(Interval(1e-9), Interval(1e-9)).rad));
  EXPECT_TRUE(std::isfinite(atan2(Interval(4e-9), Interval(0)).rad));
}

TEST(Interval, ThatIsNoNumberIsNeverBelowABound) {
  const Interval lost = kEverything * Interval(0);
  EXPECT_FALSE(upper(lost) <= 1e300);
  EXPECT_FALSE(largest(lost) <= 1e300);
  EXPECT_FALSE(lower(lost) > -1e300);
  EXPECT_FALSE(smallest(lost) > 0);
}

}  // namespace
}  // namespace meridian::certify
