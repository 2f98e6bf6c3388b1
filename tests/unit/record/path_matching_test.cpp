// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/path/path_matching.hpp"

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
using Step = PathMatching::Step;

constexpr Tolerance kTolerance{0.1, 0.05};

[[nodiscard]] CheckedPath path_through(const std::vector<ToolPose>& vertices) {
  CheckedPath path(0, 0);
  std::uint32_t line = 0;
  for (const ToolPose& pose : vertices) {
    ClBlock block = cut_to(++line, pose.tip, 0, 10);
    block.axis = to_array(pose.axis);
    path.add(block, 0);
  }
  return path;
}

[[nodiscard]] std::vector<ToolPose> upright(const std::vector<Vector3>& tips) {
  std::vector<ToolPose> out;
  for (const Vector3& tip : tips) out.push_back({tip, Vector3::UnitZ()});
  return out;
}

/// Poses along straight lines through `vertices`, `per_line` on each.
[[nodiscard]] std::vector<ToolPose> along(const std::vector<ToolPose>& vertices, int per_line) {
  std::vector<ToolPose> out{vertices[0]};
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const ToolPose &a = vertices[i - 1], &b = vertices[i];
    for (int n = 1; n <= per_line; ++n) {
      const double t = static_cast<double>(n) / per_line;
      out.push_back({a.tip + t * (b.tip - a.tip), (a.axis + t * (b.axis - a.axis)).normalized()});
    }
  }
  return out;
}

/// Whether the path is followed from begin to end.
[[nodiscard]] bool is_followed(const CheckedPath& path, const std::vector<ToolPose>& recording,
                               const Tolerance& tolerance = kTolerance) {
  PathMatching matching(path.elements());
  for (const ToolPose& pose : recording) {
    static_cast<void>(matching.move({pose.tip, pose.axis}, tolerance));
  }
  return matching.finish() && !matching.is_broken();
}

/// The smallest factor on the tolerances with a monotone matching: max(cost, min(three before)),
/// over dense samples of both curves. Knows no free space.
[[nodiscard]] double min_factor(const std::vector<ToolPose>& path,
                                const std::vector<ToolPose>& recording) {
  std::vector<double> row;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    std::vector<double> next;
    for (std::size_t j = 0; j < path.size(); ++j) {
      const double cost =
          std::max((recording[i].tip - path[j].tip).norm() / kTolerance.tip_mm,
                   angle_between(recording[i].axis, path[j].axis) / kTolerance.axis_rad);
      double before = i == 0 && j == 0 ? 0 : Interval::kNone;
      if (i > 0) before = std::min(before, row[j]);
      if (j > 0) before = std::min(before, next[j - 1]);
      if (i > 0 && j > 0) before = std::min(before, row[j - 1]);
      next.push_back(std::max(cost, before));
    }
    row = next;
  }
  return row.back();
}

TEST(PathMatching, IsFoundWhereADynamicProgramFindsOne) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vector3(normal(random), normal(random), normal(random)); };
  int followed = 0;
  for (int n = 0; n < 60; ++n) {
    std::vector<ToolPose> vertices(4 + static_cast<std::size_t>(n) % 4);
    Vector3 tip = Vector3::Zero();
    for (ToolPose& vertex : vertices) {
      tip += any().cwiseProduct(Vector3(0.5, 0.15, 0.03));
      vertex = {tip, (Vector3::UnitZ() + 0.05 * (n % 4) * any()).normalized()};
    }
    vertices[2].tip = vertices[0].tip + 0.02 * any();  // comes back to where it was
    if (n % 3 == 2) vertices.back().tip = vertices[vertices.size() - 2].tip;
    std::vector<ToolPose> recording = along(vertices, 6);
    const double noise = n % 2 == 0 ? 0.05 : 0.02;
    for (ToolPose& pose : recording) {
      pose.tip += noise * any();
      pose.axis = (pose.axis + 0.3 * noise * any()).normalized();
    }
    const double min = min_factor(along(vertices, 60), along(recording, 8));
    SCOPED_TRACE(min);
    const CheckedPath path = path_through(vertices);
    const auto scaled = [](double by) {
      return Tolerance{by * kTolerance.tip_mm, by * kTolerance.axis_rad};
    };
    EXPECT_TRUE(is_followed(path, recording, scaled(1.02 * min + 2e-3)));
    EXPECT_FALSE(is_followed(path, recording, scaled(0.96 * min - 2e-3)));
    followed += is_followed(path, recording) ? 1 : 0;
  }
  EXPECT_GT(followed, 5);
  EXPECT_LT(followed, 55);
}

TEST(PathMatching, GoesThereAndBackOnTheSameLineAsOftenAsThePathDoes) {
  const Vector3 a(0, 0, 0), b(5, 0, 0), c(5, 3, 0);
  const CheckedPath twice = path_through(upright({a, b, a, b, c}));
  EXPECT_TRUE(is_followed(twice, along(upright({a, b, a, b, c}), 500)));
  EXPECT_FALSE(is_followed(twice, along(upright({a, b, c}), 500)));
  EXPECT_FALSE(is_followed(twice, along(upright({a, b, a, b, a, b, c}), 500)));
  EXPECT_FALSE(is_followed(path_through(upright({a, b, c})), along(upright({a, b, a, b, c}), 500)));
}

TEST(PathMatching, PassesDuplicatesAndTinyBlocks) {
  std::vector<ToolPose> vertices = upright({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}});
  for (int n = 1; n <= 2000; ++n) {
    vertices.push_back({{1 + 1e-3 * n, 1e-4 * (n % 3), 0}, Vector3::UnitZ()});
  }
  EXPECT_TRUE(is_followed(path_through(vertices), along(vertices, 2)));
  EXPECT_TRUE(is_followed(path_through(vertices), along({vertices.front(), vertices.back()}, 500)));
}

TEST(PathMatching, GoesRoundACircleAsOftenAsThePathDoes) {
  CheckedPath path(0, 0);
  path.add(cut_to(1, {10, 0, 0}, 0, 10), 0);
  ClBlock arc = cut_to(2, {10, 0, 0}, 0, 10);
  arc.is_arc = true;
  arc.sweep_rad = 2 * std::numbers::pi;
  path.add(arc, 0);
  path.add(arc, 0);
  for (const int rounds : {1, 2, 3}) {
    PathMatching matching(path.elements());
    double farthest = 0;
    for (int i = 0; i <= 500 * rounds; ++i) {
      const double angle = 2 * std::numbers::pi * i / 500, radius = 10.07;
      const Vector3 tip(radius * std::cos(angle), radius * std::sin(angle), 0);
      static_cast<void>(matching.move({tip, Vector3::UnitZ()}, kTolerance));
      farthest = std::max(farthest, matching.best().tip_mm);
    }
    EXPECT_EQ(matching.finish() && !matching.is_broken(), rounds == 2) << rounds;
    if (rounds == 2) {
      EXPECT_NEAR(farthest, 0.07, 1e-9);
    }
  }
}

TEST(PathMatching, NeedsAPlungeAndItsRetractThoughTheyAreOneLine) {
  const Vector3 a(0, 0, 0), down(0, 0, -4), b(3, 0, 0);
  const CheckedPath path = path_through(upright({a, down, a, b}));
  EXPECT_TRUE(is_followed(path, along(upright({a, down, a, b}), 300)));
  EXPECT_FALSE(is_followed(path, along(upright({a, b}), 300)));
  EXPECT_FALSE(is_followed(path, along(upright({a, down + Vector3(0, 0, 0.12), a, b}), 300)));
  EXPECT_TRUE(is_followed(path, along(upright({a, down + Vector3(0, 0, 0.08), a, b}), 300)));
}

TEST(PathMatching, DoesNotEndWhereAClosedPathBegins) {
  const Vector3 a(0, 0, 0), b(4, 0, 0), c(4, 4, 0);
  const CheckedPath path = path_through(upright({a, b, c, a}));
  EXPECT_TRUE(is_followed(path, along(upright({a, b, c, a}), 100)));
  EXPECT_FALSE(is_followed(path, along(upright({a, a}), 100)));
  EXPECT_FALSE(is_followed(path, along(upright({a, c, b, a}), 100)));
}

TEST(PathMatching, LetsTheToolGoBackByNoMoreThanTheTolerancesExplain) {
  const Vector3 a(0, 0, 0), b(4, 0, 0), c(8, 0, 0);
  const CheckedPath path = path_through(upright({a, c}));
  const auto back_by = [&](double mm) {
    return along(upright({a, b, b - Vector3(mm, 0, 0), c}), 400);
  };
  EXPECT_TRUE(is_followed(path, back_by(0.19))) << "a tolerance ahead, then one behind";
  EXPECT_FALSE(is_followed(path, back_by(0.21)));
}

TEST(PathMatching, SaysHowFarAVertexWasMissedAndGoesOnBehindIt) {
  const Vector3 a(0, 0, 0), b(4, 0, 0), c(4, 3, 0), d(8, 0, 0);
  const CheckedPath path = path_through(upright({a, b, c, b, d}));
  PathMatching matching(path.elements());
  int resumed = 0;
  for (const ToolPose& pose : along(upright({a, b, d}), 400)) {
    resumed += matching.move({pose.tip, pose.axis}, kTolerance) == Step::kResumed ? 1 : 0;
  }
  EXPECT_EQ(resumed, 1);
  EXPECT_TRUE(matching.is_broken());
  EXPECT_TRUE(matching.finish());
  ASSERT_GE(matching.passed().size(), 4U);
  EXPECT_LT(matching.passed()[1].share, 1e-9);
  EXPECT_NEAR(matching.passed()[2].tip_mm, 3, 1e-9);
}

TEST(PathMatching, GoesOnWhereAToolThatWasNowhereNearComesBack) {
  const Vector3 a(0, 0, 0), b(4, 0, 0), c(8, 0, 0), up(4, 0, 9);
  const CheckedPath path = path_through(upright({a, c}));
  PathMatching matching(path.elements());
  double farthest = 0;
  for (const ToolPose& pose : along(upright({a, b, up, b, c}), 400)) {
    static_cast<void>(matching.move({pose.tip, pose.axis}, kTolerance));
    farthest = std::max(farthest, matching.best().tip_mm);
  }
  EXPECT_NEAR(farthest, 9, 1e-3);
  EXPECT_TRUE(matching.is_broken());
  EXPECT_TRUE(matching.finish());
}

TEST(PathMatching, AllowsForNoMoreThanCanBeCutInMissingCycles) {
  const Vector3 a(0, 0, 0), b(4, 0, 0), c(4, 4, 0);
  const CheckedPath path = path_through(upright({a, b, c}));
  for (const double time_s : {0.1, 0.3}) {  // of 2 mm at 10 mm/s
    PathMatching matching(path.elements());
    for (const ToolPose& pose : along(upright({a, {3, 0, 0}}), 300)) {
      static_cast<void>(matching.move({pose.tip, pose.axis}, kTolerance));
    }
    const PathMatching::Gap gap{time_s, 1, 1000, 10};
    static_cast<void>(matching.cross({{4, 1, 0}, Vector3::UnitZ()}, kTolerance, gap));
    for (const ToolPose& pose : along(upright({{4, 1, 0}, c}), 300)) {
      static_cast<void>(matching.move({pose.tip, pose.axis}, kTolerance));
    }
    EXPECT_EQ(matching.finish() && !matching.is_broken(), time_s > 0.2);
  }
}

TEST(PathMatching, HoldsOneColumnHoweverLongThePathIs) {
  std::vector<ToolPose> vertices;
  for (int n = 0; n <= 20'000; ++n) vertices.push_back({{0.05 * n, 0, 0}, Vector3::UnitZ()});
  const CheckedPath path = path_through(vertices);
  PathMatching matching(path.elements());
  std::size_t widest = 0;
  for (const ToolPose& pose : along(vertices, 2)) {
    static_cast<void>(matching.move({pose.tip, pose.axis}, kTolerance));
    widest = std::max(widest, matching.highest().element - matching.lowest().element + 1);
    widest = std::max(widest, matching.open().size());
    matching.passed().clear();
  }
  EXPECT_TRUE(matching.finish());
  EXPECT_LE(widest, 8U);
}

}  // namespace
}  // namespace meridian::record
