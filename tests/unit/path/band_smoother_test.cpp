// SPDX-License-Identifier: Apache-2.0
#include "service/core/path/band_smoother.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "meridian/path/pose_at.hpp"

/// A window that nothing moves any more is smooth: what its other iterations would do is far below
/// the tolerances.
namespace meridian::test::band_smoother {
namespace {

constexpr double kTip_mm = 0.01, kAxis_rad = 1.745e-3;  // BandTolerance
constexpr double kSettled = BandTuning{}.settled;       // tolerances
constexpr int kIterations = BandTuning{}.iterations;

/// Corners of `turn` every 0.5 mm, right and left, with an axis that turns too.
std::vector<ClBlock> corners(double turn) {
  std::vector<ClBlock> blocks(5);
  double direction = 0;
  Vector3 tip = Vector3::Zero();
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    const double tilt = 0.1 * turn * std::sin(2.0 * static_cast<double>(n));
    blocks[n].sequence = n;
    blocks[n].tip_mm = to_array(tip);
    blocks[n].axis = {std::sin(tilt), 0, std::cos(tilt)};
    blocks[n].feed = 50;
    tip += 0.5 * Vector3(std::cos(direction), std::sin(direction), 0);
    direction += n % 2 == 0 ? turn : -turn;
  }
  return blocks;
}

/// The spans of `blocks` after `iterations` at most, until nothing moves farther than `settled`.
std::vector<BandSpan> smooth(const std::vector<ClBlock>& blocks, int iterations, double settled) {
  BandTuning tuning;
  tuning.iterations = iterations;
  tuning.settled = settled;
  BandSpline spline(tuning);
  spline.begin({to_vector(blocks[0].tip_mm), to_vector(blocks[0].axis)}, {});
  for (std::size_t n = 1; n < blocks.size(); ++n) EXPECT_TRUE(spline.push(blocks[n]));
  spline.finish();
  std::vector<BandSpan> spans;
  while (const BandSpan* span = spline.next()) spans.push_back(*span);
  EXPECT_TRUE(spline.is_done());
  EXPECT_EQ(spline.statistics().windows, 1U);
  return spans;
}

/// Largest distance of the two, in tolerances.
double distance_in_tolerances(const std::vector<BandSpan>& a, const std::vector<BandSpan>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) {
    EXPECT_EQ(a[n].length, b[n].length);
    for (int k = 0; k <= 8; ++k) {
      const double x = a[n].length * k / 8;
      const ToolPose p = pose_on(a[n].c, x), q = pose_on(b[n].c, x);
      largest = std::max(
          {largest, (p.tip - q.tip).norm() / kTip_mm, (p.axis - q.axis).norm() / kAxis_rad});
    }
  }
  return largest;
}

/// After how many iterations the window was left as it is, bit for bit.
std::optional<int> count_iterations(const std::vector<ClBlock>& blocks, double settled) {
  const auto spans = smooth(blocks, kIterations, settled);
  for (int n = 1; n <= kIterations; ++n) {
    if (distance_in_tolerances(smooth(blocks, n, 0), spans) == 0) return n;
  }
  return std::nullopt;
}

TEST(BandSmoother, EndsEarlyWhereAnIterationMovesHardlyAnything) {
  for (const double turn : {0.001, 0.003, 0.01}) {
    const auto count = count_iterations(corners(turn), kSettled);
    ASSERT_TRUE(count.has_value()) << turn;
    EXPECT_LT(*count, 12) << turn;
    EXPECT_GE(*count, 4) << turn;
  }
}

TEST(BandSmoother, AnEarlyEndIsTheSplineOfAllIterationsWithinASmallPartOfTheTolerance) {
  constexpr double kSame = 5 * kSettled;  // tolerances; 0.02 was seen
  for (const double turn : {0.001, 0.003, 0.01}) {
    const auto blocks = corners(turn);
    const auto early = smooth(blocks, kIterations, kSettled),
               whole = smooth(blocks, kIterations, 0);
    EXPECT_GT(distance_in_tolerances(early, whole), 0) << turn;
    EXPECT_LT(distance_in_tolerances(early, whole), kSame) << turn;
  }
}

TEST(BandSmoother, TheLessAnIterationMayMoveTheMoreOfThemItTakes) {
  const auto blocks = corners(0.01);
  const auto rough = count_iterations(blocks, 0.1), fine = count_iterations(blocks, 0.01);
  ASSERT_TRUE(rough && fine);
  EXPECT_LT(*rough, *fine);
  EXPECT_EQ(count_iterations(blocks, 0), kIterations) << "all of them";
}

TEST(BandSmoother, TakesAllIterationsWhereASharpCornerIsStillBeingRounded) {
  EXPECT_EQ(count_iterations(corners(0.3), kSettled), kIterations);
}

}  // namespace
}  // namespace meridian::test::band_smoother
