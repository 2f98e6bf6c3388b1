// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/machines.hpp"
#include "unit/planner/singular/handed_path.hpp"

namespace meridian::test::pole_tolerance {
namespace {

/// Angle from `axis` to the nearest axis of the path about `u`, within 0.1 mm of u.
double off_path(const pole_corridor::Handed& handed, double u, const Vector3& axis) {
  double nearest = 1;
  for (int n = -50; n <= 50; ++n) {
    const double at = std::clamp(u + 0.002 * n, 0.0, static_cast<double>(handed.path.size()));
    const auto span = std::min(handed.path.size() - 1, static_cast<std::size_t>(at));
    const BandSpan& band = handed.path[span];
    nearest = std::min(nearest, angle_between(axis, pose_on(band.c, at - band.u0).axis));
  }
  return nearest;
}

TEST(PoleTolerance, IsKeptBetweenTheSamplesOfAPieceToo) {
  // Fast circles about the pole, then within 2 mm onto it.
  const auto lean = [](double u) {
    const double azimuth = 0.6 * std::min(u, 80.0);
    const double tilt = 0.02 * std::clamp(1 - (u - 80) / 2, 0.0, 1.0);
    return Lean{tilt * std::cos(azimuth), tilt * std::sin(azimuth)};
  };
  pole_corridor::Handed handed(bench_machine(), leaning_path(140, lean));
  handed.run();
  ASSERT_TRUE(handed.is_driven());
  JointVector q = handed.start.joints;
  double farthest = 0, at_u = 0;
  for (const JointSpan& span : handed.out) {
    PathPiece piece = make_spline(span);
    piece.tool_length_mm = pole_corridor::kTool_mm;
    for (int k = 0; k <= 64; ++k) {
      const double x = span.band.length * k / 64;
      q = joints_at(handed.model, piece, x, q).q;
      if (std::abs(span.band.u0 + x - 81) > 3) continue;  // far from there little is asked
      const Vector3 axis = forward(handed.model, pole_corridor::kTool_mm, q).axis;
      const double off = off_path(handed, span.band.u0 + x, axis);
      if (off > farthest) at_u = span.band.u0 + x;
      farthest = std::max(farthest, off);
    }
  }
  EXPECT_LE(farthest, pole_corridor::kTolerance_rad) << "at " << at_u;
  EXPECT_GT(farthest, 0.5 * pole_corridor::kTolerance_rad);
}

}  // namespace
}  // namespace meridian::test::pole_tolerance
