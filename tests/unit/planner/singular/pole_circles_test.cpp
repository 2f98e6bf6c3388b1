// SPDX-License-Identifier: Apache-2.0

/// Circles about the pole ahead of a stretch on it or past it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/machines.hpp"
#include "unit/planner/singular/handed_path.hpp"

namespace meridian::test::pole_circles {
namespace {

using pole_corridor::expect_whole;
using pole_corridor::follow;
using pole_corridor::FollowedPath;
using pole_corridor::Handed;
using pole_corridor::kTolerance_rad;

TEST(PoleCircles, LeadOntoThePoleHoweverFastTheRedundantJointTurnsBefore) {
  constexpr double kTilt = 0.03, kPerMm_rad = 0.43;
  for (const double lead_in_mm : {3.0, 8.0}) {
    const auto lean = [=](double u) {
      const double azimuth = kPerMm_rad * std::min(u, 80.0);
      const double tilt = kTilt * std::clamp(1 - (u - 80) / lead_in_mm, 0.0, 1.0);
      return Lean{tilt * std::cos(azimuth), tilt * std::sin(azimuth)};
    };
    Handed handed(bench_machine(), leaning_path(110, lean));
    handed.run();
    ASSERT_FALSE(handed.corridor.has_failed());
    expect_whole(handed);
    const FollowedPath followed = follow(handed);
    EXPECT_LT(followed.jump, 1e-6);
    EXPECT_LE(followed.farthest_rad, kTolerance_rad);
    EXPECT_NEAR(followed.turn, 80 * kPerMm_rad, 0.5) << "and no turn more than the circles";
  }
}

TEST(PoleCircles, AreFollowedUpToAStretchThatComesBehindThem) {
  constexpr double kTilt = 0.2;
  for (const double turns : {1.5, -1.5}) {
    const double whole = turns * kTurn_rad;
    const auto lean = [=](double u) {
      const double azimuth = whole * std::min(u, 200.0) / 200;
      const double along = kTilt * (1 - std::max(0.0, u - 200) / 50), beside = u < 200 ? 0 : 0.0005;
      return Lean{along * std::cos(azimuth) - beside * std::sin(azimuth),
                  along * std::sin(azimuth) + beside * std::cos(azimuth)};
    };
    Handed handed(bench_machine(), leaning_path(300, lean));
    handed.run();
    expect_whole(handed);
    EXPECT_TRUE(handed.is_driven());
    const FollowedPath followed = follow(handed);
    EXPECT_LT(followed.jump, 1e-6) << "on the winding that the circles led to";
    EXPECT_LE(followed.farthest_rad, kTolerance_rad);
    EXPECT_NEAR(followed.turn, std::abs(whole), 0.5);
    EXPECT_NE(handed.out.back().branch, handed.out.front().branch);
  }
}

}  // namespace
}  // namespace meridian::test::pole_circles
