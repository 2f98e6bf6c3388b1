// SPDX-License-Identifier: Apache-2.0

/// The smooth path against the programmed one, both ways, by a measure that knows nothing of how
/// the smoother works.

#include <gtest/gtest.h>

#include <cstdio>

#include "meridian/path/build_piece.hpp"
#include "property/path/band_check.hpp"
#include "property/path/hostile_path.hpp"

namespace meridian::test {
namespace {

/// Largest matched distance of `per_span` points of every span.
double largest_distance(const BandRun& run, const ProgrammedPath& path,
                        const BandTolerance& tolerance, int per_span) {
  double largest = 0;
  for (const BandSpan& span : run.spans) {
    for (int n = 0; n <= per_span; ++n) {
      const double x = span.length * n / per_span;
      const double off = path.distance_to(pose_on(span.c, x), span.u0 + x, tolerance);
      largest = std::max(largest, off);
    }
  }
  return largest;
}

/// Largest distance of a block's pose from the path where the spline says that the block ends.
double largest_at_ends(const BandRun& run, const std::vector<ClBlock>& blocks,
                       const BandTolerance& tolerance) {
  double largest = 0;
  std::size_t next = 0;
  double u = 0;
  for (const ClBlock& block : blocks) {
    while (next < run.ends.size() && run.ends[next].sequence <= block.sequence) {
      u = run.ends[next++].u;
    }
    largest = std::max(largest, distance(pose_of(block), pose_at_u(run, u), tolerance));
  }
  return largest;
}

void expect_inside(const std::vector<ClBlock>& blocks, const BandTolerance& tolerance,
                   const BandTuning& tuning, BandStatistics* sum) {
  BandSpline spline(tuning);
  const BandRun run = run_band(spline, blocks, tolerance, [](std::size_t) { return true; });
  ASSERT_FALSE(spline.has_failed());
  ASSERT_TRUE(spline.is_done());
  const ProgrammedPath path(blocks);
  EXPECT_LE(largest_distance(run, path, tolerance, 7), 1.0);
  EXPECT_LE(largest_at_ends(run, blocks, tolerance), 1.0);
  EXPECT_LE(distance(pose_at_u(run, 0), pose_of(blocks.front()), tolerance), 1e-9);
  EXPECT_LE(distance(pose_at_u(run, run.end()), pose_of(blocks.back()), tolerance), 2e-4);
  sum->windows += spline.statistics().windows;
  sum->pulled_windows += spline.statistics().pulled_windows;
  sum->reset_windows += spline.statistics().reset_windows;
  sum->largest = std::max(sum->largest, spline.statistics().largest);
  sum->largest_mean = std::max(sum->largest_mean, spline.statistics().largest_mean);
}

TEST(BandTolerance, IsKeptBothWaysOnHostilePaths) {
  BandStatistics sum;
  BandTuning tuning;
  tuning.bounds_mean = true;
  for (std::uint32_t seed = 1; seed <= 25; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    expect_inside(HostilePath(seed).make(16), {}, tuning, &sum);
  }
  std::printf("%llu windows, %llu pulled; mean spline %.3f, smoothed %.3f tolerances\n",
              static_cast<unsigned long long>(sum.windows),
              static_cast<unsigned long long>(sum.pulled_windows), sum.largest_mean, sum.largest);
  EXPECT_LE(sum.pulled_windows, sum.windows / 100);
  EXPECT_LE(sum.largest_mean, 0.8);  // so the proved points are far inside
}

TEST(BandTolerance, LeavesHalfOfTheAxisBesideThePole) {
  BandStatistics sum;
  BandTolerance tolerance;
  tolerance.pole = Array3{0, 0, 1};
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto blocks = HostilePath(seed, 0.0, 0.015).make(12);
    expect_inside(blocks, tolerance, {}, &sum);
    const BandRun run = run_band(blocks, tolerance);
    BandTolerance half = tolerance;
    half.axis_rad *= 0.5;
    EXPECT_LE(largest_distance(run, ProgrammedPath(blocks), half, 7), 1.0);
  }
}

TEST(BandTolerance, IsKeptAtOtherSizes) {
  BandStatistics sum;
  for (const double scale : {0.1, 1.0, 20.0}) {
    for (std::uint32_t seed = 100; seed < 105; ++seed) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " scale " << scale);
      BandTolerance tolerance;
      tolerance.tip_mm = 0.01 * scale;
      tolerance.axis_rad = 0.0005;
      expect_inside(HostilePath(seed).make(10), tolerance, {}, &sum);
    }
  }
}

/// The guarantee does not rest on what the smoother finds: one that aims outside is pulled back.
TEST(BandTolerance, IsKeptBySmoothersThatAimOutside) {
  for (const double radius : {1.1, 1.3, 2.0}) {
    BandStatistics sum;
    BandTuning tuning;
    tuning.radius = radius;
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << " radius " << radius);
      expect_inside(HostilePath(seed).make(12), {}, tuning, &sum);
    }
    std::printf("radius %.1f: %llu of %llu windows pulled back, %llu whole\n", radius,
                static_cast<unsigned long long>(sum.pulled_windows),
                static_cast<unsigned long long>(sum.windows),
                static_cast<unsigned long long>(sum.reset_windows));
    EXPECT_GT(sum.pulled_windows, 10U);
  }
}

TEST(BandTolerance, HoldsAgainstTheArcItselfWhereOneIsProgrammed) {
  const BandTolerance tolerance;
  std::vector<ClBlock> blocks(2);
  blocks[0].axis = {0, 0.1, std::sqrt(0.99)};
  blocks[1] = blocks[0];
  blocks[1].sequence = 1;
  blocks[1].is_arc = true;
  blocks[1].centre_mm = {30, 0, 0};
  blocks[1].sweep_rad = 5;
  blocks[1].tip_mm = {30 - 30 * std::cos(5.0), -30 * std::sin(5.0), 4};
  blocks[1].axis = {0.1, 0, std::sqrt(0.99)};
  blocks[1].feed = 50;
  blocks[1].feed_meaning = FeedMeaning::kTip;
  const PathPiece arc = make_arc(pose_of(blocks[0]), pose_of(blocks[1]), blocks[1]);
  const BandRun run = run_band(blocks, tolerance);
  ASSERT_FALSE(run.spans.empty());
  EXPECT_NEAR(run.end(), arc.length, 0.01);
  EXPECT_EQ(run.ends.size(), 1U);
  for (double u = 0; u <= run.end(); u += 0.037) {
    const ToolPose on_arc = pose_at(arc, arc.length * u / run.end());
    EXPECT_LE(distance(pose_at_u(run, u), on_arc, tolerance), 1.0) << u;
  }
}

}  // namespace
}  // namespace meridian::test
