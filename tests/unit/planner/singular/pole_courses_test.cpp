// SPDX-License-Identifier: Apache-2.0

/// The routes past all walls beside the pole: from where, past how many, and which is the shortest.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "unit/planner/singular/walled_path.hpp"

namespace meridian::test::pole_courses {
namespace {

using pole_walls::Walled;

TEST(PoleCourses, LeadOnFromTheBranchAndWindingInForce) {
  for (const int branch : {0, 1}) {
    for (const int turns : {-2, 0, 3}) {
      SCOPED_TRACE(testing::Message() << "branch " << branch << ", turns " << turns);
      Walled path(0.0005);
      ASSERT_TRUE(path.look());
      const PoleWalls::Node& first = path.walls.nodes().front();
      const double value = PoleWalls::middle_of(first, branch + 2 * turns);
      const auto courses = path.walls.find_courses(value);
      ASSERT_GT(courses.size(), 2U);
      EXPECT_LT(courses[0].turned, 0.1);
      EXPECT_NEAR(courses[0].value, value, 0.1) << "on the same winding";
      EXPECT_NE((courses[0].side - branch) % 2, 0) << "through the gate to the other branch";
      const StringWindow window = path.walls.windows_of(courses[0]).front();
      EXPECT_NEAR(0.5 * (window.low + window.high), value, 1e-9);
    }
  }
}

/// Twice through gates: from a far azimuth to the pole, off it by `turns` and back, and off again.
Walled twice_through(double first, double second, double begin_turn) {
  const auto lean = [=](double u) {
    const double azimuth = u < 50 ? begin_turn : u < 70 ? begin_turn + first : begin_turn + second;
    const double far = u < 50 ? 50 - u : u < 70 ? 10 - std::abs(u - 60) : u - 70;
    const double rho = 0.0012 * far;
    return Lean{rho * std::cos(azimuth), rho * std::sin(azimuth)};
  };
  return {120, lean, 40, 80};
}

/// Nodes [first, last) of every wall.
std::vector<std::pair<std::size_t, std::size_t>> runs_of(std::span<const PoleWalls::Node> nodes) {
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (!nodes[n].is_wall && !nodes[n].is_pinned) continue;
    if (runs.empty() || runs.back().second != n) runs.emplace_back(n, n);
    runs.back().second = n + 1;
  }
  return runs;
}

/// The least turn on any sides of all walls but the first, which is passed on the side in force.
double shortest_turn(std::span<const PoleWalls::Node> nodes, double value) {
  double best = std::numeric_limits<double>::infinity();
  const auto runs = runs_of(nodes);
  const auto follow = [&](const auto& self, std::size_t run, double at, double turned) -> void {
    if (run == runs.size()) {
      best = std::min(best, turned);
      return;
    }
    for (int side = -8; side <= 8; ++side) {
      const auto [first, last] = runs[run];
      if (run == 0 && std::abs(PoleWalls::middle_of(nodes[first], side) - at) > 1e-6) continue;
      double next = at, by = turned;
      for (std::size_t n = first; n < last; ++n) {
        const double half = nodes[n].is_pinned ? 0 : nodes[n].half;
        const double middle = PoleWalls::middle_of(nodes[n], side);
        const double clamped = std::clamp(next, middle - half, middle + half);
        by += std::abs(clamped - next);
        next = clamped;
      }
      self(self, run + 1, next, by);
    }
  };
  follow(follow, 0, value, 0);
  return best;
}

TEST(PoleCourses, AreLedByTheShortestOfAllSides) {
  for (const double first : {0.7, -1.4, 2.2, 3.0}) {
    for (const double second : {0.0, 1.5, 2.9}) {
      for (int eighth = 0; eighth < 8; ++eighth) {
        const double begin_turn = eighth * kTurn_rad / 8 + 0.1;
        SCOPED_TRACE(testing::Message() << first << " " << second << " " << begin_turn);
        Walled path = twice_through(first, second, begin_turn);
        ASSERT_TRUE(path.look());
        ASSERT_EQ(runs_of(path.walls.nodes()).size(), 3U);
        const double value = path.pass.joints[3];
        const auto courses = path.walls.find_courses(value);
        ASSERT_FALSE(courses.empty());
        EXPECT_NEAR(courses[0].turned, shortest_turn(path.walls.nodes(), value), 1e-9);
      }
    }
  }
}

TEST(PoleCourses, AreFoundAlongHalfAMetreAndNoneWhereThereAreTooManyPlaces) {
  const auto lean = [](double u) { return Lean{0.006 + 1e-6 * u, 0.0005}; };
  Walled half_a_metre(700, lean, 100, 600);
  ASSERT_TRUE(half_a_metre.look());
  EXPECT_GT(half_a_metre.walls.nodes().size(), 3000U);
  EXPECT_EQ(half_a_metre.walls.find_courses(half_a_metre.pass.joints[3]).size(), 1U);
  Walled longer(1000, lean, 100, 900);
  EXPECT_FALSE(longer.look());
}

}  // namespace
}  // namespace meridian::test::pole_courses
