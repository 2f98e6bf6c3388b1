// SPDX-License-Identifier: Apache-2.0
#include "service/core/path/band_hull.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace meridian {
namespace {

constexpr double kBegin = 0.3;  // u of the span

/// Deviation in tolerances at one point.
double deviation_at(const BandPolyline& line, const PoseQuartic& c, double x) {
  const double u = kBegin + x;
  const std::int64_t i = line.segment_at(u, 0);
  const Vector6 point = line.at(u, i);
  double tip = 0, axis = 0;
  for (std::size_t d = 0; d < 6; ++d) {
    double value = c[d][4];
    for (std::size_t k = 4; k-- > 0;) value = value * x + c[d][k];
    (d < 3 ? tip : axis) += (value - point[d]) * (value - point[d]);
  }
  const BandVertex& end = line[i + 1];
  const double share = line.share_of(end);
  return std::max(std::sqrt(tip) / (share * line.tolerance().tip_mm),
                  std::sqrt(axis) / (share * line.axis_tolerance_of(end)));
}

/// Random polylines, few vertices or many, and quartics that stay near them or bulge away between.
TEST(BandHull, IsNeverBelowTheDeviationAndNotFarAbove) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> draw(-1, 1);
  int quick = 0, whole = 0;
  for (int n = 0; n < 400; ++n) {
    BandPolyline line;
    BandTolerance tolerance;
    line.begin({Vector3::Zero(), Vector3::UnitZ()}, tolerance);
    const double step = n % 2 == 0 ? 0.02 : 0.4, wave = n % 4 < 2 ? 1e-3 : 1e-2;
    ClBlock block;
    for (double x = step; x < 2; x += step) {
      block.tip_mm = {x, wave * draw(random), wave * draw(random)};
      block.axis = {0.1 * wave * draw(random), 0, 1};
      line.take(block);
    }
    line.finish();
    const double length = 0.6 + 0.4 * draw(random);
    PoseQuartic c{};
    for (std::size_t d = 0; d < 6; ++d) {
      for (std::size_t k = 0; k < 5; ++k) c[d][k] = 5e-3 * (d < 3 ? 1 : 0.1) * draw(random);
    }
    c[0][0] += kBegin;
    c[0][1] += 1;
    c[5][0] += 1;
    double largest = 0;
    for (int k = 0; k <= 1000; ++k) {
      largest = std::max(largest, deviation_at(line, c, length * k / 1000));
    }
    const double bound = bound_deviation(line, c, kBegin, kBegin + length, 0);
    const double hull = bound_by_hull(line, c, kBegin, kBegin + length, 0);
    EXPECT_GE(bound, largest * (1 - 1e-9)) << n;
    EXPECT_GE(hull, largest * (1 - 1e-9)) << n;
    EXPECT_LE(hull, std::max(0.99, 1.1 * largest)) << n;
    EXPECT_LE(bound, std::max(0.99, 1.1 * largest)) << n;
    ++(bound < 0.99 ? quick : whole);
  }
  EXPECT_GT(quick, 50);
  EXPECT_GT(whole, 50);
}

}  // namespace
}  // namespace meridian
