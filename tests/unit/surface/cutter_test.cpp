// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/shape/cutter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "service/programs/surface/surface_report.hpp"
#include "support/surfaces.hpp"

namespace meridian::surface {
namespace {

const Vector3 kNormal{0, 0, 1}, kFeed{1, 0, 0};

TEST(Cutter, LeansByLeadTowardsTheFeedAndByTiltToItsRight) {
  EXPECT_LT((leant_axis(kNormal, kFeed, 0, 0) - kNormal).norm(), 1e-16);
  const Vector3 leading = leant_axis(kNormal, kFeed, 0.3, 0);
  EXPECT_LT((leading - Vector3{std::sin(0.3), 0, std::cos(0.3)}).norm(), 1e-15);
  const Vector3 tilted = leant_axis(kNormal, kFeed, 0, 0.3);
  EXPECT_LT((tilted - Vector3{0, -std::sin(0.3), std::cos(0.3)}).norm(), 1e-15);
}

TEST(Cutter, LeansByTwoTurnsOneAfterTheOther) {
  std::mt19937_64 draw(5);
  std::uniform_real_distribution<double> angle(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const Vector3 normal = Vector3{angle(draw), angle(draw), 1}.normalized();
    const Vector3 feed = normal.cross(Vector3{angle(draw), 1, 0}).normalized();
    const double lead = angle(draw), tilt = angle(draw);
    const Vector3 axis =
        Eigen::AngleAxisd(tilt, feed) * (Eigen::AngleAxisd(lead, normal.cross(feed)) * normal);
    EXPECT_LT((leant_axis(normal, feed, lead, tilt) - axis).norm(), 1e-15);
  }
}

TEST(Cutter, TouchesWithItsOwnSurfaceAndTheNormalThere) {
  std::mt19937_64 draw(6);
  std::uniform_real_distribution<double> any(-1, 1), corner(0.1, 5);
  for (int i = 0; i < 500; ++i) {
    const Cutter cutter{10, i % 10 == 0 ? 5 : corner(draw)};
    const Vector3 contact{any(draw), any(draw), any(draw)};
    const Vector3 normal = Vector3{any(draw), any(draw), 1.5}.normalized();
    const Vector3 axis = Vector3{any(draw), any(draw), 1.5}.normalized();
    const ToolPose pose = touching(cutter, contact, normal, axis);
    // The circle of the corner's middle: contact is one corner radius from it, against the normal.
    const Vector3 middle =
        contact + cutter.corner_radius_mm * normal - pose.tip - cutter.corner_radius_mm * axis;
    EXPECT_NEAR(middle.dot(axis), 0, 1e-14);
    EXPECT_NEAR(middle.norm(), cutter.radius_mm() - cutter.corner_radius_mm, 1e-14);
    if (!cutter.is_ball()) {
      EXPECT_LT(middle.dot(normal), 0) << "the corner behind the axis";
    }
  }
}

TEST(Cutter, ThatStandsFlatTouchesWithItsTip) {
  const Vector3 contact{1, 2, 3};
  EXPECT_EQ(touching({10, 0}, contact, kNormal, kNormal).tip, contact);
  EXPECT_EQ(touching({10, 2}, contact, kNormal, kNormal).tip, contact);
  EXPECT_LT((touching({10, 5}, contact, kNormal, kNormal).tip - contact).norm(), 1e-15);
}

SurfaceShape trough(double radius_mm) {  // along y, hollow
  const NurbsSurface cylinder = test::surface_of(test::cylinder(radius_mm, 30));
  return *shape_at(cylinder, 0.4, 0.5, false);
}

TEST(Cutter, OfASmallerRadiusThanAHollowDoesNotGouge) {
  const SurfaceShape hollow = trough(20);
  EXPECT_GT(clearance_curvature({39.98, 19.99}, hollow, hollow.normal), 0);
  EXPECT_NEAR(clearance_curvature({40, 20}, hollow, hollow.normal), 0, kGougeCurvature);
  EXPECT_LT(clearance_curvature({40.02, 20.01}, hollow, hollow.normal), 0);
}

TEST(Cutter, ThatStandsFlatGougesHollowsAndNothingElse) {
  const SurfaceShape hollow = trough(20);
  EXPECT_LT(clearance_curvature({10, 0}, hollow, hollow.normal), -kGougeCurvature);
  const NurbsSurface cylinder = test::surface_of(test::cylinder(20, 30));
  const SurfaceShape round = *shape_at(cylinder, 0.4, 0.5, true);
  EXPECT_GE(clearance_curvature({10, 0}, round, round.normal), -kGougeCurvature);
  const SurfaceShape flat = *shape_at(test::surface_of(test::plane(9, 9)), 0.4, 0.5, true);
  EXPECT_GE(clearance_curvature({10, 0}, flat, flat.normal), -kGougeCurvature);
}

TEST(Cutter, LeantAlongATroughShowsTheRadiusOfItsEllipse) {
  const SurfaceShape hollow = trough(40);
  // Across the feed a toroidal cutter is round with corner + (radius - corner) / sin(lead).
  const double lead = std::asin((30.0 - 2) / (40 - 2));
  const Vector3 along = Vector3::UnitY();
  const auto clearance = [&](double angle) {
    return clearance_curvature({60, 2}, hollow, leant_axis(hollow.normal, along, angle, 0));
  };
  EXPECT_NEAR(clearance(lead), 0, 1e-12);
  EXPECT_GT(clearance(lead + 0.01), 1e-6);
  EXPECT_LT(clearance(lead - 0.01), -1e-6);
  // A sharp corner leant the same way: radius / sin(lead) is the vertex of its ellipse.
  const Vector3 leant = leant_axis(hollow.normal, along, std::asin(30.0 / 40), 0);
  EXPECT_NEAR(clearance_curvature({60, 0}, hollow, leant), 0, 1e-9);
}

}  // namespace
}  // namespace meridian::surface
