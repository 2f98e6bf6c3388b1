// SPDX-License-Identifier: Apache-2.0
#include "service/core/path/band_polyline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

/// How much of the axis tolerance the band has along the pole of a machine that relaxes the axis.
namespace meridian::test::band_polyline {
namespace {

constexpr double kAxis_rad = 1.745e-3;
constexpr double kInside_rad = 0.9 * kOnPole_tolerances * kAxis_rad;
constexpr double kOutside_rad = 1.1 * kOnPole_tolerances * kAxis_rad;
constexpr double kFar_rad = 0.03;

Vector3 leaning(double by_rad) { return {std::sin(by_rad), 0, std::cos(by_rad)}; }

/// A straight path of 1 mm blocks whose axes lean from the pole by `leans_rad`.
std::unique_ptr<BandPolyline> line_through(const std::vector<double>& leans_rad,
                                           const Vector3& pole = Vector3::UnitZ()) {
  auto line = std::make_unique<BandPolyline>();
  BandTolerance tolerance;
  tolerance.axis_rad = kAxis_rad;
  tolerance.pole = to_array(pole);
  line->begin({Vector3::Zero(), leaning(leans_rad.front())}, tolerance);
  for (std::size_t n = 1; n < leans_rad.size(); ++n) {
    ClBlock block;
    block.sequence = n;
    block.tip_mm = {static_cast<double>(n), 0, 0};
    block.axis = to_array(leaning(leans_rad[n]));
    block.feed = 50;
    line->take(block);
    EXPECT_TRUE(line->is_ready());
  }
  return line;
}

/// Of the axis tolerance, on the segment from one lean to another.
double share_from_to(double from_rad, double to_rad, const Vector3& pole = Vector3::UnitZ()) {
  const auto line = line_through({from_rad, to_rad}, pole);
  return line->axis_tolerance_of((*line)[line->last()]) / kAxis_rad;
}

TEST(BandPolyline, TheBandHasHalfOfTheAxisToleranceBesideThePoleAndMoreOnIt) {
  EXPECT_DOUBLE_EQ(share_from_to(kFar_rad, kFar_rad + 0.01), 1);
  EXPECT_DOUBLE_EQ(share_from_to(kOutside_rad, 2 * kOutside_rad), kBesidePoleShare);
  EXPECT_DOUBLE_EQ(share_from_to(0, kInside_rad), kOnPoleShare);
  EXPECT_DOUBLE_EQ(share_from_to(kInside_rad, -kInside_rad), kOnPoleShare);
  EXPECT_GT(kOnPoleShare, kBesidePoleShare);
  EXPECT_LT(kOnPoleShare, kOnPole_tolerances);
}

TEST(BandPolyline, ASegmentIsOnThePoleOnlyWithBothOfItsEnds) {
  EXPECT_DOUBLE_EQ(share_from_to(0, kOutside_rad), kBesidePoleShare);
  EXPECT_DOUBLE_EQ(share_from_to(kOutside_rad, 0), kBesidePoleShare);
  EXPECT_DOUBLE_EQ(share_from_to(-kOutside_rad, kOutside_rad), kBesidePoleShare);
}

TEST(BandPolyline, TheOppositeOfThePoleIsThePoleToo) {
  const Vector3 below = -Vector3::UnitZ();
  EXPECT_DOUBLE_EQ(share_from_to(0, kInside_rad, below), kOnPoleShare);
  EXPECT_DOUBLE_EQ(share_from_to(kInside_rad, kOutside_rad, below), kBesidePoleShare);
}

TEST(BandPolyline, BetweenVerticesTheSmallestToleranceHoldsHoweverLongThePathIs) {
  std::vector<double> leans_rad;
  for (int n = 0; n < 30000; ++n) {
    const bool leaves = n % 5000 == 4000;
    const bool is_far = n / 3000 % 3 == 2;
    leans_rad.push_back((is_far ? kFar_rad : 0) + (leaves ? kOutside_rad : 1e-5 * (n % 7)));
  }
  const auto line = line_through(leans_rad);
  for (const std::int64_t reach : {1, 10, 500, 2 * static_cast<int>(kVertexReach)}) {
    for (std::int64_t n = 0; n + reach <= line->last(); n += 97) {
      double smallest = kAxis_rad;
      for (std::int64_t k = n + 1; k <= n + reach; ++k) {
        smallest = std::min(smallest, line->axis_tolerance_of((*line)[k]));
      }
      ASSERT_DOUBLE_EQ(line->axis_tolerance_between((*line)[n], (*line)[n + reach]), smallest)
          << "vertices " << n << " to " << n + reach;
    }
  }
}

}  // namespace
}  // namespace meridian::test::band_polyline
