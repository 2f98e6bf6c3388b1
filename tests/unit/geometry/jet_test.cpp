// SPDX-License-Identifier: Apache-2.0
#include "meridian/geometry/jet.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "meridian/geometry/vector3.hpp"

namespace meridian {
namespace {

constexpr double kTolerance = 1e-13;  // values of order 1..20, eps 2e-16, a few dozen roundings

/// A jet with every coefficient in play.
Jet<3> sample() { return Jet<3>::from_derivatives({0.7, -1.3, 2.1, 3.7}); }
Jet<3> other() { return Jet<3>::from_derivatives({1.9, 0.4, -0.8, 1.1}); }

void expect_near(const Jet<3>& a, const Jet<3>& b) {
  for (int k = 0; k <= 3; ++k) EXPECT_NEAR(a.derivative(k), b.derivative(k), kTolerance) << k;
}

TEST(Jet, KeepsTheDerivativesItWasMadeFrom) {
  EXPECT_EQ(sample().value(), 0.7);
  EXPECT_EQ(sample().derivative(1), -1.3);
  EXPECT_EQ(sample().derivative(2), 2.1);
  EXPECT_NEAR(sample().derivative(3), 3.7, kTolerance);
}

TEST(Jet, DifferentiatesAPolynomial) {
  const Jet<3> t = Jet<3>::variable(2);
  const Jet<3> f = 5.0 - 3.0 * t + t * t * t / 2.0 - (t - 1.0) * 4.0;
  EXPECT_DOUBLE_EQ(f.value(), -1);
  EXPECT_DOUBLE_EQ(f.derivative(1), -1);
  EXPECT_DOUBLE_EQ(f.derivative(2), 6);
  EXPECT_DOUBLE_EQ(f.derivative(3), 3);
}

TEST(Jet, DifferentiatesSineAndCosine) {
  const double x = 0.83;
  const auto [s, c] = sin_cos(Jet<3>::variable(x));
  expect_near(s, Jet<3>::from_derivatives({std::sin(x), std::cos(x), -std::sin(x), -std::cos(x)}));
  expect_near(c, Jet<3>::from_derivatives({std::cos(x), -std::sin(x), -std::cos(x), std::sin(x)}));
}

TEST(Jet, DifferentiatesTheSquareRoot) {
  const double x = 2.6;
  expect_near(sqrt(Jet<3>::variable(x)),
              Jet<3>::from_derivatives({std::sqrt(x), 0.5 * std::pow(x, -0.5),
                                        -0.25 * std::pow(x, -1.5), 0.375 * std::pow(x, -2.5)}));
}

TEST(Jet, DifferentiatesTheArcTangent) {
  const double x = -0.45, w = 1 + x * x;
  expect_near(atan2(Jet<3>::variable(x), Jet<3>(1.0)),
              Jet<3>::from_derivatives(
                  {std::atan(x), 1 / w, -2 * x / (w * w), (6 * x * x - 2) / (w * w * w)}));
}

TEST(Jet, DivisionUndoesMultiplication) { expect_near(sample() * other() / other(), sample()); }
TEST(Jet, SquareUndoesTheSquareRoot) { expect_near(sqrt(other()) * sqrt(other()), other()); }
TEST(Jet, ArcTangentUndoesSineAndCosine) {
  for (const double turn : {0.0, 1.4, -1.4, 2.4}) {  // every quadrant
    const Jet<3> a = sample() + turn;
    expect_near(atan2(sin(a) * 3.0, cos(a) * 3.0), a);
  }
}
TEST(Jet, ConstantOverAJetIsItsReciprocal) { expect_near((2.0 / other()) * other(), Jet<3>(2.0)); }
TEST(Jet, HypotIsTheLengthOfAPoint) {
  expect_near(hypot(sample(), other()) * hypot(sample(), other()),
              sample() * sample() + other() * other());
}
TEST(Jet, AbsoluteValueTurnsNegativeJetsOver) {
  expect_near(abs(-sample()), sample());
  expect_near(abs(sample()), sample());
}

TEST(Jet, ValueEqualsThePlainComputationBitForBit) {
  const auto f = [](auto x, auto y) {
    using std::atan2, std::sqrt;
    const auto [s, c] = sin_cos(x * 1.7 - y);
    return atan2(s * y, c + x) / sqrt(x * x + 0.3) - 2.0 / y;
  };
  EXPECT_EQ(f(sample(), other()).value(), f(sample().value(), other().value()));
}

TEST(Jet, LowOrderIsTheBeginningOfHighOrder) {
  const auto f = [](auto x) { return atan2(sin(x), sqrt(x * x + 2.0)) / (x + 3.0); };
  const Jet<3> high = f(Jet<3>::variable(0.4));
  const Jet<1> low = f(Jet<1>::variable(0.4));
  EXPECT_EQ(low.value(), high.value());
  EXPECT_NEAR(low.derivative(1), high.derivative(1), kTolerance);
}

TEST(Jet, WorksInsideEigenWithPlainNumbers) {
  const Vec3<Jet<3>> v{sample(), other(), Jet<3>(2.0)};
  const Vector3 a{1, 2, 3};
  const Vec3<Jet<3>> sum = a + v * 2.0 + sample() * a;
  expect_near(sum[1], 2.0 + 2.0 * other() + 2.0 * sample());
  expect_near(v.dot(v), sample() * sample() + other() * other() + 4.0);
  const Eigen::Matrix3d swap{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
  const Vec3<Jet<3>> swapped = swap * v;
  expect_near(swapped[0], other());
}

TEST(Jet, ComparesByValueAlone) {
  EXPECT_LT(sample(), other());
  EXPECT_EQ(sample(), Jet<3>(0.7));
  EXPECT_TRUE(isfinite(sample()));
  EXPECT_FALSE(isfinite(sqrt(Jet<3>::variable(0.0))));
}

}  // namespace
}  // namespace meridian
