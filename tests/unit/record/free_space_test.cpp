// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/path/free_space.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "meridian/geometry/great_circle.hpp"
#include "support/sample_recording.hpp"

namespace meridian::record {
namespace {

using test::cut_to;

constexpr Tolerance kReach{0.05, 0.02};

/// An arc into a helix, a line that turns the axis, a turn at rest, a point.
[[nodiscard]] std::vector<PathElement> elements() {
  CheckedPath path(100, 0);
  path.add(cut_to(1, {10, 0, 0}, 0, 10), 0);
  for (const double rise : {0.0, 6.0}) {
    ClBlock arc = cut_to(2, {10, 0, rise}, 0.4, 10);
    arc.is_arc = true;
    arc.centre_mm = {0, 0, 0};
    arc.normal = {0, 0, 1};
    arc.sweep_rad = 2 * std::numbers::pi;
    path.add(arc, 0);
  }
  path.add(cut_to(4, {10.3, 0.1, 6}, 0.5, 10), 0);
  path.add(cut_to(5, {10.3, 0.1, 6}, -2.5, 10), 0);
  path.add(cut_to(6, {10.3, 0.1, 6}, -2.5, 10), 0);
  return path.elements();
}

[[nodiscard]] double share_at(const PathElement& element, double t, const ToolPose& pose) {
  const ToolPose want = element.pose(t);
  return std::max((pose.tip - want.tip).norm() / kReach.tip_mm,
                  angle_between(pose.axis, want.axis) / kReach.axis_rad);
}

/// A pose up to about two tolerances off the element at a random parameter.
template <class Random>
[[nodiscard]] ToolPose beside(const PathElement& element, Random& random) {
  std::normal_distribution<double> off;
  const auto any = [&] { return Vector3(off(random), off(random), off(random)); };
  const double t = std::uniform_real_distribution<double>(-0.1, 1.1)(random);
  const ToolPose on = element.pose(std::clamp(t, 0.0, 1.0));
  const Vector3 tip = on.tip + 0.6 * kReach.tip_mm * any();
  return {tip, (on.axis + 0.6 * kReach.axis_rad * any()).normalized()};
}

TEST(FreeSpace, OnAnElementIsWhereTipAndAxisAreWithinToleranceTogether) {
  std::mt19937 random(4);
  int inside = 0, outside = 0;
  for (const PathElement& element : elements()) {
    for (int n = 0; n < 40; ++n) {
      const ToolPose pose = beside(element, random);
      const Interval free = free_on(element, pose, kReach);
      for (double t = 0; t <= 1; t += 1.0 / 256) {
        const double share = share_at(element, t, pose);
        if (std::abs(share - 1) < 1e-6) continue;
        ASSERT_EQ(share < 1, !free.is_empty() && free.low <= t && t <= free.high)
            << "share " << share << " at " << t << " of [" << free.low << ", " << free.high << "]";
        ++(share < 1 ? inside : outside);
      }
    }
  }
  EXPECT_GT(inside, 1000);
  EXPECT_GT(outside, 1000);
}

TEST(FreeSpace, TheBestMatchOfAnElementIsNoWorseThanAnyOther) {
  std::mt19937 random(5);
  for (const PathElement& element : elements()) {
    for (int n = 0; n < 40; ++n) {
      const ToolPose pose = beside(element, random);
      const Interval free = free_on(element, pose, kReach);
      if (free.is_empty()) continue;
      const PoseMatch best = best_on(element, free, pose, kReach);
      EXPECT_LE(best.share(kReach), 1 + 1e-9);
      for (double t = free.low; t <= free.high; t += 1.0 / 256) {
        ASSERT_LE(best.share(kReach), share_at(element, t, pose) + 1e-6) << t;
      }
    }
  }
}

TEST(FreeSpace, OfAChordIsWhereItPassesAVertexWithTipAndAxisTogether) {
  const ToolPose vertex{{1, 2, 3}, Vector3::UnitZ()};
  const ToolPose from{{0.9, 2.03, 3}, Vector3::UnitZ()}, to{{1.1, 2.03, 3}, Vector3::UnitZ()};
  const Interval passed = free_on_chord(vertex, from, to, kReach);
  EXPECT_NEAR(passed.low, 0.5 - 0.04 / 0.2, 1e-12) << "3, 4, 5";
  EXPECT_NEAR(passed.high, 0.5 + 0.04 / 0.2, 1e-12);
  const PoseMatch best = best_on_chord(vertex, from, to, passed, kReach);
  EXPECT_NEAR(best.tip_mm, 0.03, 1e-12);
  const Vector3 leant = Vector3(0.021, 0, 1).normalized();
  EXPECT_TRUE(free_on_chord(vertex, {from.tip, leant}, {to.tip, leant}, kReach).is_empty());
  const Vector3 aside(0, 0.03, 0);
  EXPECT_TRUE(
      free_on_chord(vertex, {from.tip + aside, from.axis}, {to.tip + aside, to.axis}, kReach)
          .is_empty());
}

TEST(FreeSpace, OfAPoseAtRestIsAllOfTheChordOrNothing) {
  const ToolPose vertex{{1, 2, 3}, Vector3::UnitZ()};
  const ToolPose near{{1, 2.01, 3}, Vector3::UnitZ()}, far{{1, 2.06, 3}, Vector3::UnitZ()};
  EXPECT_EQ(free_on_chord(vertex, near, near, kReach).low, 0);
  EXPECT_EQ(free_on_chord(vertex, near, near, kReach).high, 1);
  EXPECT_TRUE(free_on_chord(vertex, far, far, kReach).is_empty());
}

}  // namespace
}  // namespace meridian::record
