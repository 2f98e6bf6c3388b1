// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_walls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "meridian/geometry/great_circle.hpp"
#include "unit/planner/singular/walled_path.hpp"

namespace meridian::test::pole_walls {
namespace {

TEST(PoleWalls, LeaveTheRedundantJointWhatTheToleranceLeaves) {
  for (const Lean& off : {Lean{0, 0}, Lean{0.0006, -0.0004}, Lean{-0.0003, 0.0009}}) {
    Walled path(0.0005, off);
    ASSERT_TRUE(path.look());
    int walls = 0, gates = 0;
    for (const PoleWalls::Node& node : path.walls.nodes()) {
      const double allowed = kUsed * kTolerance_rad;
      if (!node.is_wall) {
        ++gates;
        for (int k = 0; k < 16; ++k) EXPECT_LE(path.off_at(node.u, 0.4 * k), allowed * 1.001);
        continue;
      }
      ++walls;
      if (node.half < 1e-3) continue;
      for (const int side : {0, 1, 2}) {
        const double middle = PoleWalls::middle_of(node, side);
        EXPECT_NEAR(path.off_at(node.u, middle + node.half), allowed, 0.002 * allowed) << node.u;
        EXPECT_NEAR(path.off_at(node.u, middle - node.half), allowed, 0.002 * allowed) << node.u;
        EXPECT_LT(path.off_at(node.u, middle), 0.99 * allowed);
      }
    }
    EXPECT_GT(walls, 100);
    EXPECT_GT(gates, 2);
  }
}

TEST(PoleWalls, HaveTheExactWayOfEitherBranchInTheirMiddle) {
  Walled path(0.0005);
  ASSERT_TRUE(path.look());
  EXPECT_EQ(path.walls.nodes().front().u, 40);
  EXPECT_EQ(path.walls.nodes().back().u, 80);
  for (const PoleWalls::Node& node : path.walls.nodes()) {
    if (!node.is_wall) continue;
    for (int branch = 0; branch < 2; ++branch) {
      const double off = node.middle[branch] - path.joints_at(node.u, branch)[3];
      EXPECT_NEAR(std::remainder(off, kTurn_rad), 0, 1e-6) << node.u;
    }
    const double rho = path.pose_at(node.u).axis.head<2>().norm();
    EXPECT_NEAR(node.half, std::asin(kUsed * kTolerance_rad / rho), 1e-5);
    EXPECT_GT(node.middle[1], node.middle[0]) << "branches come in the order of their values";
    EXPECT_LT(node.middle[1], node.middle[0] + kTurn_rad);
  }
}

TEST(PoleWalls, AreSoCloseThatNothingHappensBetweenTwo) {
  for (const double beside : {0.0005, 0.0021, 0.01}) {
    Walled path(beside);
    ASSERT_TRUE(path.look());
    const auto nodes = path.walls.nodes();
    for (std::size_t n = 1; n < nodes.size(); ++n) {
      EXPECT_GT(nodes[n].u, nodes[n - 1].u);
      EXPECT_LE(nodes[n].u - nodes[n - 1].u, 1.0 / 6 + 1e-12);
      EXPECT_NEAR(nodes[n].t - nodes[n - 1].t, 0.8 / 50 * (nodes[n].u - nodes[n - 1].u), 1e-9)
          << "time at the programmed feed";
      if (nodes[n].is_wall && nodes[n - 1].is_wall) {
        EXPECT_LE(std::abs(nodes[n].middle[0] - nodes[n - 1].middle[0]), 0.3 + 1e-12);
      }
      const Vector3 a = path.pose_at(nodes[n - 1].u).axis, b = path.pose_at(nodes[n].u).axis;
      EXPECT_LE((b - a).norm(), 0.25 * (a.head<2>().norm() + kTolerance_rad) * 1.001);
    }
  }
}

TEST(PoleWalls, ArePinnedWhereTheExactWayBeginsOrEnds) {
  Walled exact(0.0005), rest(0.0005), held(0.0005);
  ASSERT_TRUE(exact.look());
  EXPECT_TRUE(exact.walls.nodes().front().is_pinned);
  EXPECT_TRUE(exact.walls.nodes().back().is_pinned);
  rest.pass.at_begin = rest.pass.at_end = PoleJoin::kRest;
  ASSERT_TRUE(rest.look());
  EXPECT_FALSE(rest.walls.nodes().front().is_pinned);
  EXPECT_FALSE(rest.walls.nodes().back().is_pinned);
  held.pass.at_end = PoleJoin::kHeld;
  held.pass.seen_end = 90;
  ASSERT_TRUE(held.look());
  EXPECT_EQ(held.walls.nodes().back().u, 90) << "as far as the stretch is known";
  const auto nodes = held.walls.nodes();
  EXPECT_TRUE(std::any_of(nodes.begin(), nodes.end(), [](const auto& n) { return n.u == 80; }));
}

TEST(PoleWalls, ThroughAGateTheShortestWayLeadsToTheOtherBranch) {
  Walled path(0.0005);
  ASSERT_TRUE(path.look());
  const double begin = path.pass.joints[3];
  const auto found = path.walls.find_courses(begin);
  ASSERT_GT(found.size(), 2U);
  const std::vector<PoleWalls::Course> courses(found.begin(), found.end());
  EXPECT_LT(courses[0].turned, 0.1);
  EXPECT_EQ(std::abs(courses[0].side) % 2, 1) << "out on the other branch";
  for (std::size_t n = 1; n < courses.size(); ++n) {
    EXPECT_GE(courses[n].turned, courses[n - 1].turned) << "the shortest first";
  }
  EXPECT_NEAR(courses[1].turned, std::numbers::pi, 0.2);
  for (const PoleWalls::Course& course : courses) {
    const auto windows = path.walls.windows_of(course);
    const auto nodes = path.walls.nodes();
    ASSERT_EQ(windows.size(), nodes.size());
    double value = begin, turned = 0;
    for (std::size_t n = 0; n < windows.size(); ++n) {
      EXPECT_EQ(windows[n].t, nodes[n].t);
      if (!nodes[n].is_wall) {
        EXPECT_TRUE(std::isinf(windows[n].low) && std::isinf(windows[n].high)) << "a gate";
      } else {
        EXPECT_NEAR(windows[n].high - windows[n].low, 2 * nodes[n].half, 1e-12);
      }
      const double next = std::clamp(value, windows[n].low, windows[n].high);
      turned += std::abs(next - value);
      value = next;
    }
    EXPECT_NEAR(value, course.value, 0.2) << "the end is pinned, its window is not";
    EXPECT_NEAR(turned, course.turned, 0.2);
    EXPECT_NEAR(PoleWalls::middle_of(nodes.back(), course.side), course.value, 1e-9);
  }
}

TEST(PoleWalls, WithoutAGateTheWayStaysOnItsBranch) {
  Walled path(0.006);
  ASSERT_TRUE(path.look());
  const auto courses = path.walls.find_courses(path.pass.joints[3]);
  ASSERT_EQ(courses.size(), 1U);
  EXPECT_EQ(courses[0].side, 0);
  EXPECT_NEAR(courses[0].turned, std::numbers::pi - 2 * std::atan(0.006 / 0.08), 0.05);
}

TEST(PoleWalls, LeadNowhereOutsideOfTravel) {
  Walled path(0.0005);
  const double begin = path.pass.joints[3];
  path.model.joints[3].is_endless = false;
  path.model.joints[3].limits.travel_min = begin - 0.5;
  path.model.joints[3].limits.travel_max = begin + 0.5;
  ASSERT_TRUE(path.look());
  const auto courses = path.walls.find_courses(begin);
  ASSERT_EQ(courses.size(), 1U);
  EXPECT_LT(courses[0].turned, 0.1);
  for (const StringWindow& window : path.walls.windows_of(courses[0])) {
    EXPECT_GE(window.low, begin - 0.5);
    EXPECT_LE(window.high, begin + 0.5);
  }
  path.model.joints[3].limits.travel_max = begin - 0.1;
  ASSERT_TRUE(path.look());
  EXPECT_TRUE(path.walls.find_courses(begin).empty());
}

TEST(PoleWalls, AreNearerWhereTheToleranceWasLeft) {
  Walled path(0.006);
  const auto share_at = [&](double u) {
    EXPECT_TRUE(path.look());
    for (const PoleWalls::Node& node : path.walls.nodes()) {
      if (node.u < u) continue;
      const double rho = path.pose_at(node.u).axis.head<2>().norm();
      return std::sin(node.half) * rho / kTolerance_rad;
    }
    return 0.0;
  };
  EXPECT_NEAR(share_at(52), kUsed, 1e-4);
  EXPECT_TRUE(path.walls.tighten(50, 55, 1));
  EXPECT_NEAR(share_at(52), 0.97, 1e-4);
  EXPECT_NEAR(share_at(49), kUsed, 1e-4);
  EXPECT_NEAR(share_at(56), kUsed, 1e-4);
  EXPECT_TRUE(path.walls.tighten(54, 57, 1)) << "the same round";
  EXPECT_NEAR(share_at(52), 0.97, 1e-4);
  EXPECT_NEAR(share_at(56), 0.97, 1e-4);
  EXPECT_TRUE(path.walls.tighten(54, 57, 2));
  EXPECT_NEAR(share_at(52), 0.97 * 0.97, 1e-4);
  path.walls.loosen();
  EXPECT_NEAR(share_at(52), kUsed, 1e-4);
  for (int n = 0; n < 256; ++n) EXPECT_TRUE(path.walls.tighten(3 * n, 3 * n + 1, 1));
  EXPECT_FALSE(path.walls.tighten(1000, 1001, 1)) << "at too many places";
}

TEST(PoleWalls, ASideIsABranchAndItsWholeTurns) {
  PoleWalls::Node node;
  node.middle = {0.5, 2.5};
  EXPECT_EQ(PoleWalls::middle_of(node, 0), 0.5);
  EXPECT_EQ(PoleWalls::middle_of(node, 1), 2.5);
  EXPECT_NEAR(PoleWalls::middle_of(node, 4), 0.5 + 2 * kTurn_rad, 1e-12);
  EXPECT_NEAR(PoleWalls::middle_of(node, 5), 2.5 + 2 * kTurn_rad, 1e-12);
  EXPECT_NEAR(PoleWalls::middle_of(node, -1), 2.5 - kTurn_rad, 1e-12);
  EXPECT_NEAR(PoleWalls::middle_of(node, -2), 0.5 - kTurn_rad, 1e-12);
}

}  // namespace
}  // namespace meridian::test::pole_walls
