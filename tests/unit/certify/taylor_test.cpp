// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/certify/taylor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "meridian/planner/time_law.hpp"
#include "service/analysis/certify/enclosed_law.hpp"

namespace meridian::certify {
namespace {

constexpr int kN = 5;

/// Every operation at once, smooth for |t| < 1.
template <class S>
S made_of_all(const S& t) {
  using std::sqrt;
  const S x = 2.0 + t * 0.5 - t * t, y = (t - 0.3) * 1.5 / (4.0 + t);
  const auto [sine, cosine] = sin_cos(S(x * y + 0.2));
  const S root = sqrt(S(x * x + y * y));
  return atan2(S(y + sine), S(-x)) + root / (3.0 - cosine) - sine * cosine * 0.7;
}

/// All t within `reach` of `middle`.
[[nodiscard]] Taylor<kN> time_about(double middle, double reach) {
  Taylor<kN> t;
  t.set(0, Interval(middle, reach));
  t.set(1, Interval(1));
  return t;
}

TEST(Taylor, HoldsTheJetsOfEveryInstantOfAStretch) {
  std::mt19937_64 engine(7);
  for (int n = 0; n < 400; ++n) {
    const double middle = std::uniform_real_distribution<>(-0.8, 0.8)(engine);
    const double reach = std::pow(10.0, std::uniform_real_distribution<>(-6, -1.2)(engine));
    const Taylor<kN> all = made_of_all(time_about(middle, reach));
    for (int m = -8; m <= 8; ++m) {
      const Jet<kN> one = made_of_all(Jet<kN>::variable(middle + reach * m / 8.0));
      for (int k = 1; k <= kN; ++k) {
        constexpr double kRounding = 1e-12;  // of the jet itself, coefficients are near 1
        EXPECT_LE(std::abs(one.c[static_cast<std::size_t>(k)] - all[k].mid), all[k].rad + kRounding)
            << "seed 7, draw " << n << ", order " << k;
      }
    }
  }
}

TEST(Taylor, OfAnInstantIsTheJetButForRounding) {
  const Taylor<kN> at = made_of_all(time_about(0.25, 0));
  const Jet<kN> jet = made_of_all(Jet<kN>::variable(0.25));
  for (int k = 0; k <= kN; ++k) {
    EXPECT_NEAR(at[k].mid, jet.c[static_cast<std::size_t>(k)], 1e-13) << k;
    EXPECT_LT(at[k].rad, 1e-12) << k;
  }
}

TEST(Taylor, WidensNoFasterThanTheStretch) {
  const double near = made_of_all(time_about(0.25, 1e-6))[3].rad;
  const double far = made_of_all(time_about(0.25, 1e-4))[3].rad;
  EXPECT_NEAR(far / near, 100, 3);
}

TEST(Taylor, OfADerivativeKnowsItsLastCoefficientNot) {
  const Taylor<kN> slope = derivative_of(made_of_all(time_about(0.25, 0)));
  const Jet<kN> jet = made_of_all(Jet<kN>::variable(0.25));
  for (int k = 0; k < kN; ++k) {
    EXPECT_NEAR(slope[k].mid, (k + 1) * jet.c[static_cast<std::size_t>(k) + 1], 1e-12);
  }
  EXPECT_FALSE(std::isfinite(slope[kN].rad));
}

/// The law's own derivatives by a longer number; |k| t² up to 1.
struct LongState {
  long double s, v, a;
};
[[nodiscard]] LongState long_state(const TimePiece& piece, long double t) {
  const long double k = piece.k, root = std::sqrt(std::abs(k));
  const long double x = root * t;
  const long double c0 = k > 0 ? std::cosh(x) : std::cos(x);
  const long double s1 = k == 0 ? t : (k > 0 ? std::sinh(x) : std::sin(x)) / root;
  const long double c2 = k == 0 ? t * t / 2 : (c0 - 1) / k;
  const long double d3 = k == 0 ? t * t * t / 6 : (s1 - t) / k;
  return {piece.s0 + piece.v * s1 + piece.a * c2 + piece.j * d3,
          piece.v * c0 + piece.a * s1 + piece.j * c2,
          piece.a * c0 + piece.j * s1 + k * piece.v * s1};
}

TEST(EnclosedLaw, HoldsTheStateAtEveryInstantOfAStretch) {
  std::mt19937_64 engine(11);
  const auto uniform = [&engine](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(engine);
  };
  for (int n = 0; n < 2000; ++n) {
    TimePiece piece;
    piece.duration = std::pow(10.0, uniform(-4, 0));
    piece.s0 = uniform(0, 50);
    piece.v = uniform(0, 100);
    piece.a = uniform(-500, 500);
    piece.j = uniform(-1e4, 1e4);
    piece.k = n % 3 == 0 ? 0 : uniform(-0.9, 0.9) / (piece.duration * piece.duration);
    const EnclosedLaw law(piece);
    const double middle = uniform(0.2, 0.8) * piece.duration, reach = 0.2 * piece.duration;
    const EnclosedState all = law.about(law.at(middle), reach);
    const Taylor<kN> expanded = law.expand<kN>(all);
    for (int m = -5; m <= 5; ++m) {
      const LongState one = long_state(
          piece, static_cast<long double>(middle) + static_cast<long double>(reach) * m / 5);
      const auto is_in = [](const Interval& x, long double value) {
        constexpr long double kCancelled = 1e-11L;  // of the long state, (cosh - 1)/k
        return std::abs(value - static_cast<long double>(x.mid)) <=
               static_cast<long double>(x.rad) + kCancelled * (1 + std::abs(value));
      };
      ASSERT_TRUE(is_in(all.s, one.s)) << n;
      ASSERT_TRUE(is_in(all.v, one.v)) << n;
      ASSERT_TRUE(is_in(all.a, one.a)) << n;
      ASSERT_TRUE(is_in(expanded[3] * Interval(6), piece.j + piece.k * one.v)) << n;
      ASSERT_TRUE(is_in(expanded[4] * Interval(24), piece.k * one.a)) << n;
    }
    EXPECT_NEAR(law.at(piece.duration).s.mid, state_at(piece, piece.duration).s, 1e-11);
    EXPECT_LT(law.at(piece.duration).s.rad, 1e-11);
  }
}

TEST(EnclosedLaw, IsEverythingWhereItsSeriesIsNotMeantFor) {
  TimePiece piece;
  piece.k = 100;
  EXPECT_FALSE(std::isfinite(EnclosedLaw(piece).at(1).s.rad));
}

}  // namespace
}  // namespace meridian::certify
