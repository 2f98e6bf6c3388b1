// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/surface_path.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "service/programs/surface/surface_report.hpp"
#include "unit/surface/path_jobs.hpp"

namespace meridian::surface {
namespace {

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
    EXPECT_EQ(line.contacts.front().u, line.parameter);
    EXPECT_GT(line.contacts[1].feed.dot(line.contacts[2].shape.at - line.contacts[0].shape.at), 0);
  }
}

double distance_to_segment(const Vector3& p, const Vector3& a, const Vector3& b) {
  const double share = std::clamp((b - a).dot(p - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - share * (b - a)).norm();
}

/// Largest distance of exact contact and tip from the straight blocks, by 99 points in each.
double dense_error(const ContactRule& rule, const SurfacePath& path) {
  std::vector<Contact> points;
  for (const SurfacePath::Line& line : path.lines) {
    points.insert(points.end(), line.contacts.begin(), line.contacts.end());
    points.insert(points.end(), line.crossing.begin(), line.crossing.end());
  }
  double worst = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Contact &a = points[i - 1], &b = points[i];
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
  const double min = 0.5 * std::numbers::pi / (2 * std::acos(1 - 0.01 / 25));
  const auto blocks = static_cast<double>(path->lines[0].contacts.size() - 1);
  EXPECT_GE(blocks, std::ceil(min));
  EXPECT_LE(blocks, 1.1 * min + 1);
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

TEST(SurfacePath, RunsOverKnotsOfArcsAndStopsAtACrease) {
  // Two quarter arcs that meet at u = 0.5, smoothly or with a corner.
  NurbsNet net = test::cylinder(25, 30);
  net.rows = 5;
  net.knots_u = {0, 0, 0, 0.5, 0.5, 1, 1, 1};
  for (const bool is_creased : {false, true}) {
    NurbsNet two = net;
    for (const Vector3& p : {Vector3{-25, 0, 25}, Vector3{-25, 0, is_creased ? 20.0 : 0.0}}) {
      for (const double y : {0.0, 30.0}) {
        two.points.emplace_back(p[0], y, p[2] + (is_creased ? 15 : 0));
        two.weights.push_back(two.points.size() > 8 ? 1 : std::sqrt(0.5));
      }
    }
    const NurbsSurface surface = surface_of(two);
    CoverOptions options = whole(surface);
    options.lines = 2;
    options.chord_error_mm = 0.01;
    const auto path = cover(ball_on(surface, 3), options);
    EXPECT_EQ(path.has_value(), !is_creased);
    if (path) {
      EXPECT_LE(dense_error(ball_on(surface, 3), *path), 0.01);
    } else {
      EXPECT_NE(path.error().what.find("crease of"), std::string::npos) << path.error().what;
      EXPECT_NE(path.error().what.find("u = 0.5"), std::string::npos) << path.error().what;
      options.range_u = {0.5, 1};
      EXPECT_TRUE(cover(ball_on(surface, 3), options));
    }
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

TEST(SurfaceReport, CountsContactsThatGougeAndReportsTheSmallestRadii) {
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
