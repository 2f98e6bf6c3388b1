// SPDX-License-Identifier: Apache-2.0
#include "service/surface/surface_path.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "service/surface/surface_report.hpp"
#include "support/surfaces.hpp"

namespace meridian::surface {
namespace {

using test::surface_of;

ContactRule ball_on(const NurbsSurface& surface, double radius_mm, bool is_flipped = false) {
  ContactRule rule;
  rule.surface = &surface;
  rule.cutter = {2 * radius_mm, radius_mm};
  rule.is_flipped = is_flipped;
  return rule;
}

CoverOptions whole(const NurbsSurface& surface) {
  CoverOptions options;
  options.range_u = surface.domain_u();
  options.range_v = surface.domain_v();
  return options;
}

NurbsSurface wavy(unsigned seed) {
  std::mt19937_64 draw(seed);
  return surface_of(test::wavy(draw));
}

TEST(SurfacePath, ByCountsIsAnEvenGridInAZigzag) {
  const NurbsSurface surface = wavy(1);
  CoverOptions options = whole(surface);
  options.points = 5;
  options.lines = 3;
  const auto path = cover(ball_on(surface, 2), options);
  ASSERT_TRUE(path);
  ASSERT_EQ(path->lines.size(), 3u);
  const auto [u0, u1] = surface.domain_u();
  const auto [v0, v1] = surface.domain_v();
  for (std::size_t line = 0; line < 3; ++line) {
    const auto& contacts = path->lines[line].contacts;
    ASSERT_EQ(contacts.size(), 5u);
    EXPECT_TRUE(path->lines[line].crossing.empty());
    for (std::size_t i = 0; i < 5; ++i) {
      const double share = static_cast<double>(line == 1 ? 4 - i : i) / 4;
      EXPECT_NEAR(contacts[i].u, u0 + share * (u1 - u0), 1e-15);
      EXPECT_NEAR(contacts[i].v, v0 + static_cast<double>(line) / 2 * (v1 - v0), 1e-15);
    }
  }
}

TEST(SurfacePath, OneWayAndAlongVRunsEveryLineForward) {
  const NurbsSurface surface = wavy(1);
  CoverOptions options = whole(surface);
  options.points = 4;
  options.lines = 3;
  options.is_zigzag = false;
  ContactRule rule = ball_on(surface, 2);
  rule.runs_along_u = false;
  const auto path = cover(rule, options);
  ASSERT_TRUE(path);
  for (const SurfacePath::Line& line : path->lines) {
    EXPECT_EQ(line.contacts.front().v, options.range_v[0]);
    EXPECT_EQ(line.contacts.back().v, options.range_v[1]);
    EXPECT_EQ(line.contacts.front().u, line.place);
    EXPECT_GT(line.contacts[1].feed.dot(line.contacts[2].shape.at - line.contacts[0].shape.at), 0);
  }
}

double distance_to_segment(const Vector3& p, const Vector3& a, const Vector3& b) {
  const double share = std::clamp((b - a).dot(p - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - share * (b - a)).norm();
}

/// Largest distance of exact contact and tip from the straight blocks, by 99 places in each.
double dense_error(const ContactRule& rule, const SurfacePath& path) {
  std::vector<Contact> way;
  for (const SurfacePath::Line& line : path.lines) {
    way.insert(way.end(), line.contacts.begin(), line.contacts.end());
    way.insert(way.end(), line.crossing.begin(), line.crossing.end());
  }
  double worst = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Contact &a = way[i - 1], &b = way[i];
    for (int k = 1; k < 100; ++k) {
      const double share = k / 100.0;
      const auto c = find_contact(rule, a.u + share * (b.u - a.u), a.v + share * (b.v - a.v));
      worst = std::max({worst, distance_to_segment(c->shape.at, a.shape.at, b.shape.at),
                        distance_to_segment(c->pose.tip, a.pose.tip, b.pose.tip)});
    }
  }
  return worst;
}

TEST(SurfacePath, KeepsTheChordErrorOnLinesAndCrossings) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const NurbsSurface surface = wavy(seed);
    CoverOptions options = whole(surface);
    options.lines = 3;
    options.chord_error_mm = seed % 2 == 0 ? 0.01 : 0.2;
    ContactRule rule = ball_on(surface, 3);
    rule.lead_rad = 0.1 * seed;
    rule.tilt_rad = -0.2;
    rule.runs_along_u = seed % 3 != 0;
    if (seed > 3) rule.cutter.corner_radius_mm = 1;
    const auto path = cover(rule, options);
    ASSERT_TRUE(path) << path.error().what;
    const double error = dense_error(rule, *path);
    EXPECT_LE(error, options.chord_error_mm) << seed;
    EXPECT_GT(error, 0.7 * options.chord_error_mm) << "steps shorter than they need to be " << seed;
  }
}

TEST(SurfacePath, StepsOnACircleAsItsSagittaAllows) {
  const NurbsSurface cylinder = surface_of(test::cylinder(25, 30));
  CoverOptions options = whole(cylinder);
  options.lines = 2;
  options.chord_error_mm = 0.01;
  const auto path = cover(ball_on(cylinder, 3), options);
  ASSERT_TRUE(path);
  const double least = 0.5 * std::numbers::pi / (2 * std::acos(1 - 0.01 / 25));
  const auto blocks = static_cast<double>(path->lines[0].contacts.size() - 1);
  EXPECT_GE(blocks, std::ceil(least));
  EXPECT_LE(blocks, 1.1 * least + 1);
}

TEST(SurfacePath, OnAPlaneNeedsNoMoreThanItsEnds) {
  const NurbsSurface plane = surface_of(test::plane(40, 30));
  CoverOptions options = whole(plane);
  options.lines = 2;
  options.chord_error_mm = 0.001;
  const auto path = cover(ball_on(plane, 3), options);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->lines[0].contacts.size(), 2u);
}

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

CoverOptions with_scallop(const NurbsSurface& surface, double scallop_mm) {
  CoverOptions options = whole(surface);
  options.points = 2;
  options.scallop_mm = scallop_mm;
  return options;
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
                        double place) {
  const auto distance = [&](double u) {
    const auto c = find_contact(rule, u, place);
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
      const double a = path->lines[line - 1].place, b = path->lines[line].place;
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

TEST(SurfacePath, StopsWhereTheSurfaceHasNoNormal) {
  const NurbsSurface sphere = surface_of(test::sphere(50));
  for (const bool is_bounded : {false, true}) {
    CoverOptions options = whole(sphere);
    options.points = is_bounded ? 0 : 5;
    options.chord_error_mm = is_bounded ? 0.1 : 0;
    options.lines = 3;
    const auto path = cover(ball_on(sphere, 3, true), options);
    ASSERT_FALSE(path);
    EXPECT_NE(path.error().what.find("no normal at u = 1, v = 0"), std::string::npos)
        << path.error().what;
    EXPECT_NE(path.error().remedy.find("range_u"), std::string::npos);
  }
  CoverOptions options = with_scallop(sphere, 0.01);
  EXPECT_FALSE(cover(ball_on(sphere, 3, true), options));
}

TEST(SurfacePath, RefusesBoundsThatCannotBeKept) {
  const NurbsSurface cylinder = surface_of(test::cylinder(25, 30));
  CoverOptions options = with_scallop(cylinder, 0.01);
  ContactRule rule = ball_on(cylinder, 4, true);
  rule.cutter.corner_radius_mm = 0;
  rule.tilt_rad = 0.3;  // sideways on a sharp corner: a cusp as high as the step
  const auto path = cover(rule, options);
  ASSERT_FALSE(path);
  EXPECT_NE(path.error().what.find("keeps the scallop"), std::string::npos) << path.error().what;
  rule.tilt_rad = 0;
  options.scallop_mm = 0;
  options.lines = 40'000;
  options.points = 40;
  const auto many = cover(rule, options);
  ASSERT_FALSE(many);
  EXPECT_NE(many.error().what.find("contacts"), std::string::npos) << many.error().what;
}

TEST(SurfaceReport, CountsContactsThatGougeAndTellsTheSmallestRadii) {
  PatchJob job;
  job.surface = std::make_shared<const NurbsSurface>(surface_of(test::cylinder(25, 30)));
  job.cover = whole(*job.surface);
  job.cover.points = 5;
  job.cover.lines = 2;
  job.program.feed_mm_per_s = 10;
  job.rule = ball_on(*job.surface, 26);
  const SurfaceReport hollow = measure(job, *cover(job.rule, job.cover));
  EXPECT_EQ(hollow.contacts, 10u);
  EXPECT_EQ(hollow.gouges, 10u);
  EXPECT_NEAR(hollow.concave_radius_mm, 25, 1e-10);
  EXPECT_TRUE(std::isinf(hollow.convex_radius_mm));
  EXPECT_NE(to_text(hollow, job).find("WARNING: 10 of 10"), std::string::npos);
  job.rule.is_flipped = true;
  const SurfaceReport round = measure(job, *cover(job.rule, job.cover));
  EXPECT_EQ(round.gouges, 0u);
  EXPECT_NEAR(round.convex_radius_mm, 25, 1e-10);
  EXPECT_TRUE(std::isinf(round.concave_radius_mm));
  EXPECT_NEAR(round.crossing_chord_error_mm, 0, 1e-12);
  // Even in the parameter is not even in the angle: the middle chords are the longest.
  const double angle = 2 * std::atan2(1 - 1 / std::sqrt(2.0), 1 + 1 / std::sqrt(2.0));
  EXPECT_GT(round.chord_error_mm, 0.5 * 25 * (1 - std::cos(angle / 2)));
  EXPECT_NEAR(round.length_mm, 2 * 25 * std::numbers::pi / 2 + 30, 0.6);
}

}  // namespace
}  // namespace meridian::surface
