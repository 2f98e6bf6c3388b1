// SPDX-License-Identifier: Apache-2.0
#include "meridian/geometry/atan2.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace meridian {
namespace {

/// Units in the last place of `right` between it and `found`.
double ulps(double found, long double right) {
  const double size = std::abs(static_cast<double>(right));
  const double ulp = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
  return static_cast<double>(std::abs(found - right)) / ulp;
}

TEST(Atan2, IsWithinTwoAndAHalfUnitsInTheLastPlace) {
  constexpr std::uint32_t kSeed = 1;
  std::mt19937_64 engine{kSeed};
  std::uniform_real_distribution<double> unit(-1, 1), exponent(-30, 30);
  double worst = 0;
  for (int n = 0; n < 1'000'000; ++n) {
    double x = unit(engine), y = unit(engine);
    switch (n % 5) {
      case 0:  // any ratio, down to what a pole 1e-30 rad away gives
        y *= std::pow(10.0, exponent(engine));
        break;
      case 1:  // beside the diagonals
        y = (n % 2 == 0 ? x : -x) * (1 + 1e-3 * unit(engine));
        break;
      case 2:  // where the formula changes
        y = x * 0.41421356237309505 * (1 + 1e-12 * unit(engine));
        break;
      default:
        break;
    }
    worst = std::max(worst, ulps(atan2(y, x), std::atan2(static_cast<long double>(y),
                                                         static_cast<long double>(x))));
  }
  EXPECT_LT(worst, 2.5);
  EXPECT_GT(worst, 0.5) << "the comparison compares nothing";
}

TEST(Atan2, TakesZerosInfinitiesAndNanAsTheLibrary) {
  const double inf = std::numeric_limits<double>::infinity();
  const double values[] = {0.0, -0.0, 1.0, -1.0, inf, -inf, std::nan(""), 1e-310, -1e300};
  for (const double y : values) {
    for (const double x : values) {
      const double found = atan2(y, x), right = std::atan2(y, x);
      if (std::isnan(right)) {
        EXPECT_TRUE(std::isnan(found)) << y << ", " << x;
      } else {
        EXPECT_EQ(found, right) << y << ", " << x;
        EXPECT_EQ(std::signbit(found), std::signbit(right)) << y << ", " << x;
      }
    }
  }
}

TEST(Atan2, IsExactOnTheAxes) {
  constexpr double kHalfTurn = 3.14159265358979323846;
  EXPECT_EQ(atan2(0.0, -2.0), kHalfTurn);
  EXPECT_EQ(atan2(-0.0, -2.0), -kHalfTurn);
  EXPECT_EQ(atan2(3.0, 0.0), kHalfTurn / 2);
  EXPECT_EQ(atan2(-3.0, 0.0), -kHalfTurn / 2);
  EXPECT_EQ(atan2(1.0, 1.0), kHalfTurn / 4);
}

}  // namespace
}  // namespace meridian
