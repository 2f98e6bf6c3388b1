// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/surface/path_jobs.hpp"

namespace meridian::surface {
namespace {

/// Largest cusp between neighbouring lines, by what `height` makes of two contacts beside each
/// other.
template <class Height>
double largest_cusp(const SurfacePath& path, const Height& height) {
  double worst = 0;
  for (std::size_t i = 1; i < path.lines.size(); ++i) {
    const auto &a = path.lines[i - 1].contacts, &b = path.lines[i].contacts;
    worst = std::max(worst, height(a.front().shape.at, b.back().shape.at));
  }
  return worst;
}

TEST(Scallop, OnAPlaneIsTheSagittaOfTheBall) {
  const NurbsSurface plane = surface_of(test::plane(40, 30));
  const auto path = cover(ball_on(plane, 4), with_scallop(plane, 0.05));
  ASSERT_TRUE(path);
  const double cusp = largest_cusp(*path, [](const Vector3& a, const Vector3& b) {
    const double half = 0.5 * std::abs(b[1] - a[1]);
    return 4 - std::sqrt(16 - half * half);
  });
  EXPECT_LE(cusp, 0.05);
  EXPECT_GT(cusp, 0.04);
}

/// Cusp of balls of radius r beside each other on a circle of radius rho, on its outside or inside.
double cusp_on_circle(double rho, double r, double angle, bool is_outside) {
  const double middle = is_outside ? rho + r : rho - r;
  const double out = middle * std::cos(angle / 2), side = middle * std::sin(angle / 2);
  const double depth = std::sqrt(r * r - side * side);
  return is_outside ? out - depth - rho : rho - out - depth;
}

TEST(Scallop, OnACylinderIsThatOfBallsOnACircle) {
  const NurbsSurface cylinder = surface_of(test::cylinder(25, 30));
  for (const bool is_outside : {false, true}) {
    ContactRule rule = ball_on(cylinder, 4, is_outside);
    rule.runs_along_u = false;
    const auto path = cover(rule, with_scallop(cylinder, 0.03));
    ASSERT_TRUE(path);
    const double cusp = largest_cusp(*path, [&](const Vector3& a, const Vector3& b) {
      const double angle = std::abs(std::atan2(b[2], b[0]) - std::atan2(a[2], a[0]));
      return cusp_on_circle(25, 4, angle, is_outside);
    });
    EXPECT_LE(cusp, 0.03);
    EXPECT_GT(cusp, 0.024) << is_outside;
  }
}

TEST(Scallop, OnASphereIsThatOfBallsOnAGreatCircle) {
  const NurbsSurface sphere = surface_of(test::sphere(50));
  ContactRule rule = ball_on(sphere, 6, true);
  rule.runs_along_u = false;
  CoverOptions options = with_scallop(sphere, 0.02);
  options.range_u = {0, 0.9};  // its pole has no normal
  const auto path = cover(rule, options);
  ASSERT_TRUE(path) << path.error().what;
  const double cusp = largest_cusp(*path, [](const Vector3& a, const Vector3& b) {
    return cusp_on_circle(50, 6, std::abs(std::asin(b[2] / 50) - std::asin(a[2] / 50)), true);
  });
  EXPECT_LE(cusp, 0.02);
  EXPECT_GT(cusp, 0.016);
}

/// Distance from `point` to where the middle of the ball runs on the line at `place`.
double distance_to_pass(const ContactRule& rule, const CoverOptions& options, const Vector3& point,
                        double parameter) {
  const auto distance = [&](double u) {
    const auto c = find_contact(rule, u, parameter);
    return (c->shape.at + rule.cutter.radius_mm() * c->shape.normal - point).norm();
  };
  const auto [begin, end] = options.range_u;
  double best = begin;
  for (int i = 0; i <= 100; ++i) {
    const double u = begin + (end - begin) * i / 100;
    if (distance(u) < distance(best)) best = u;
  }
  double low = std::max(begin, best - (end - begin) / 100);
  double high = std::min(end, best + (end - begin) / 100);
  for (int i = 0; i < 30; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
  }
  return distance(0.5 * (low + high));
}

TEST(Scallop, LeavesNothingHigherThanItsBoundOnAWavyPatch) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const NurbsSurface surface = wavy(seed);
    const ContactRule rule = ball_on(surface, 3);
    CoverOptions options = with_scallop(surface, 0.05);
    const auto path = cover(rule, options);
    ASSERT_TRUE(path) << path.error().what;
    std::mt19937_64 draw(seed);
    std::uniform_real_distribution<double> any(0, 1);
    double highest = 0;
    for (int i = 0; i < 24; ++i) {
      const std::size_t line = 1 + draw() % (path->lines.size() - 1);
      const double a = path->lines[line - 1].parameter, b = path->lines[line].parameter;
      // Away from the ends of the lines, where material beside them is not this pass's.
      const double u =
          options.range_u[0] + (0.05 + 0.9 * any(draw)) * (options.range_u[1] - options.range_u[0]);
      const auto shape = shape_at(surface, u, a + any(draw) * (b - a), false);
      const Vector3 raised = shape->at + options.scallop_mm * shape->normal;
      const double nearest = std::min(distance_to_pass(rule, options, raised, a),
                                      distance_to_pass(rule, options, raised, b));
      EXPECT_LT(nearest, rule.cutter.radius_mm() + 1e-9) << seed << ' ' << u;
      highest = std::max(highest, nearest - rule.cutter.radius_mm() + options.scallop_mm);
    }
    EXPECT_GT(highest, 0.2 * options.scallop_mm) << "lines much closer than they need to be";
  }
}

}  // namespace
}  // namespace meridian::surface
