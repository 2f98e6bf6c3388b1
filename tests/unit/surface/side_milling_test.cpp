// SPDX-License-Identifier: Apache-2.0
// Ruled walls cut by the flank, against walls whose undercut and overcut are known.
#include "service/programs/surface/shape/side_milling.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace meridian::surface {
namespace {

constexpr double kRadius_mm = 5, kHalf_mm = 10;

std::vector<ToolPose> poses_along(const RuledWall& wall) {
  std::vector<ToolPose> out;
  for (int i = -60; i <= 460; ++i) out.push_back(flank_pose(wall, i / 400.0, kRadius_mm, 1));
  return out;
}

/// y = c x z about the middle of its height: the ruling at x leans by c x.
RuledWall saddle(double c) {
  return [c](double part) {
    const double x = 40 * (part - 0.5), lean = c * x * kHalf_mm, rate = 40 * c * kHalf_mm;
    return Ruling{{x, -lean, -kHalf_mm}, {x, lean, kHalf_mm}, {40, -rate, 0}, {40, rate, 0}};
  };
}

TEST(SideMilling, FitsAPlaneWallExactly) {
  const FlankFit fit = measure_flank(saddle(0), poses_along(saddle(0)), kRadius_mm);
  EXPECT_NEAR(fit.overcut_mm, 0, 1e-12);
  EXPECT_LT(fit.undercut_mm, 1e-3) << "between poses that are 0.1 mm apart";
  EXPECT_NEAR(fit.twist_rad, 0, 1e-12);
}

TEST(SideMilling, CutsIntoATwistedWallAsFarAsItsTwistSays) {
  // One axis at (0, y, z) a radius off the saddle: of its points at height z the nearest is
  // R / sqrt(1 + c^2 z^2) away.
  constexpr double kTwist = 0.03;  // 1/mm
  const RuledWall wall = saddle(kTwist);
  const FlankFit fit = measure_flank(wall, {flank_pose(wall, 0.5, kRadius_mm, 1)}, kRadius_mm);
  const double known = kRadius_mm * (1 - 1 / std::sqrt(1 + kTwist * kTwist * kHalf_mm * kHalf_mm));
  EXPECT_NEAR(fit.overcut_mm, known, 1e-3);
  EXPECT_NEAR(fit.twist_rad, 2 * std::atan(kTwist * kHalf_mm), 1e-3);
}

TEST(SideMilling, TouchesTheRulingInItsMiddle) {
  for (const double part : {0.0, 0.3, 1.0}) {
    const Ruling r = sample_wall(part);
    const ToolPose pose = flank_pose(sample_wall, part, kRadius_mm, 1);
    const Vector3 middle = 0.5 * (r.bottom + r.top);
    EXPECT_NEAR((middle - pose.tip).cross(pose.axis).norm(), kRadius_mm, 1e-12);
    EXPECT_LT((pose.axis - (r.top - r.bottom).normalized()).norm(), 1e-15);
    const double step = 1e-6;
    const Vector3 rate = (sample_wall(part + step).top - sample_wall(part - step).top) / (2 * step);
    EXPECT_LT((rate - r.top_rate).norm(), 1e-5);
  }
}

TEST(SideMilling, ReportsWhatTheSampleLeavesAndTakes) {
  const std::string report = side_milling_report();
  EXPECT_NE(report.find("undercut  at most 0.0"), std::string::npos) << report;
  EXPECT_NE(report.find("overcut   at most 0.0"), std::string::npos) << report;
  EXPECT_EQ(report.find("overcut   at most 0.000000"), std::string::npos) << report;
}

}  // namespace
}  // namespace meridian::surface
