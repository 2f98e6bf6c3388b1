// SPDX-License-Identifier: Apache-2.0
#include "service/core/path/quartic.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace meridian::test::quartic {
namespace {

constexpr SpanKnots kUneven{-3, -1.5, -1, 0.5, 2, 2.25, 4, 5};

/// The value of basis function `k` of degree `degree` over all knots, by its definition.
double basis(const SpanKnots& t, std::size_t k, std::size_t degree, double u) {
  if (degree == 0) return k < 7 && t[k] <= u && u < t[k + 1] ? 1 : 0;
  double sum = 0;
  if (t[k + degree] > t[k]) {
    sum += (u - t[k]) / (t[k + degree] - t[k]) * basis(t, k, degree - 1, u);
  }
  if (t[k + degree + 1] > t[k + 1]) {
    sum +=
        (t[k + degree + 1] - u) / (t[k + degree + 1] - t[k + 1]) * basis(t, k + 1, degree - 1, u);
  }
  return sum;
}

TEST(Quartic, BasisSumsToOneAndIsNowhereNegative) {
  for (const double u : {0.5, 0.9, 1.7, 2.0}) {
    double n[5];
    find_basis(kUneven, u, n);
    double sum = 0;
    for (const double value : n) {
      EXPECT_GE(value, -1e-15) << u;
      sum += value;
    }
    EXPECT_NEAR(sum, 1, 1e-14) << u;
  }
}

TEST(Quartic, BasisIsThatOfItsDefinition) {
  for (const double u : {0.6, 1.1, 1.9}) {
    double n[5];
    find_basis(kUneven, u, n);
    // Of the five, those whose support lies inside of the eight knots.
    for (std::size_t k = 1; k <= 3; ++k) EXPECT_NEAR(n[k], basis(kUneven, k - 1, 4, u), 1e-14) << k;
  }
}

TEST(Quartic, SpanIsTheSumOfItsControlPoints) {
  std::array<Vector6, 5> points;
  for (std::size_t j = 0; j < 5; ++j) {
    for (std::size_t d = 0; d < 6; ++d) {
      points[j][d] = std::sin(1.7 * static_cast<double>(j) + static_cast<double>(d));
    }
  }
  const PoseQuartic quartic = find_quartic(kUneven, points);
  for (const double u : {0.5, 0.8, 1.4, 2.0}) {
    double n[5];
    find_basis(kUneven, u, n);
    const double x = u - 0.5;
    for (std::size_t d = 0; d < 6; ++d) {
      double by_basis = 0, by_powers = 0;
      for (std::size_t j = 0; j < 5; ++j) by_basis += n[j] * points[j][d];
      for (std::size_t k = 5; k-- > 0;) by_powers = by_powers * x + quartic[d][k];
      EXPECT_NEAR(by_powers, by_basis, 1e-13) << u << " " << d;
    }
  }
}

}  // namespace
}  // namespace meridian::test::quartic
