// SPDX-License-Identifier: Apache-2.0
#include "meridian/path/pose_at.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace meridian {
namespace {

PathPiece tilted_line() {
  PathPiece piece;
  piece.length = 10;
  piece.tip_begin = {1, 2, 3};
  piece.tip_delta = {8, 0, 0};
  piece.axis_begin = {0, 0, 1};
  piece.axis_normal = {0, 1, 0};
  piece.axis_turn = 0.12;
  return piece;
}

TEST(PoseAt, PutsTipAndAxisAtTheSameShareOfTheirWay) {
  const ToolPose pose = pose_at(tilted_line(), 2.5);
  EXPECT_NEAR(pose.tip[0], 3.0, 1e-15);
  EXPECT_EQ(pose.tip[1], 2.0);
  EXPECT_NEAR(pose.axis[1], std::sin(0.03), 1e-16);
  EXPECT_NEAR(pose.axis.norm(), 1.0, 1e-15);
}

TEST(PoseAt, TurnsTheTipRightHandedAboutTheArcNormal) {
  PathPiece piece;
  piece.kind = PathKind::kArc;
  piece.length = std::numbers::pi;
  piece.arc_centre = {5, 5, 0};
  piece.arc_x = {2, 0, 0};
  piece.arc_y = {0, 2, 0};
  piece.arc_sweep = std::numbers::pi;
  piece.tip_delta = {0, 0, 4};
  const ToolPose pose = pose_at(piece, std::numbers::pi / 2);
  EXPECT_NEAR(pose.tip[0], 5.0, 1e-15);
  EXPECT_NEAR(pose.tip[1], 7.0, 1e-15);
  EXPECT_NEAR(pose.tip[2], 2.0, 1e-15);
}

TEST(PoseAt, GivesDerivativesAlongThePathThroughJets) {
  const auto pose = pose_at(tilted_line(), Jet<3>::variable(2.5));
  EXPECT_NEAR(pose.tip[0].derivative(1), 0.8, 1e-15);
  EXPECT_NEAR(pose.axis[1].derivative(1), 0.012 * std::cos(0.03), 1e-16);
  EXPECT_NEAR(pose.axis[2].derivative(2), -0.012 * 0.012 * std::cos(0.03), 1e-18);
}

TEST(PoseAt, LetsTheAzimuthGrowEvenlyBesideThePole) {
  // Great circle passing the z axis at 1e-3 rad on the x side, in direction y.
  const double offset = 1e-3;
  PathPiece piece;
  piece.is_azimuthal = true;
  piece.pole_offset = std::sin(offset);
  piece.azimuth_begin = -1.5;
  piece.azimuth_end = 1.2;
  const auto along = [&](double azimuth) {
    return std::atan2(piece.pole_offset * std::sin(azimuth), std::cos(azimuth));
  };
  piece.azimuth_from = along(-1.5);
  piece.axis_turn = along(1.2) - along(-1.5);
  piece.length = 2.7;
  const Vector3 nearest(std::sin(offset), 0, std::cos(offset));
  const Vector3 forth(0, 1, 0);
  const double from = piece.azimuth_from;
  piece.axis_begin = to_array(std::cos(from) * nearest + std::sin(from) * forth);
  piece.axis_normal = to_array(std::cos(from) * forth - std::sin(from) * nearest);
  piece.tip_delta = {1, 0, 0};
  for (const double s : {0.0, 0.4, 1.5, 2.2, 2.7}) {
    const ToolPose pose = pose_at(piece, s);
    EXPECT_NEAR(std::atan2(pose.axis[1], pose.axis[0]), -1.5 + s, 1e-12) << s;
    EXPECT_NEAR(pose.tip[0], (along(-1.5 + s) - from) / piece.axis_turn, 1e-12) << s;
  }
}

/// A spline piece 2 mm long with a different polynomial in every component.
PathPiece curved_spline() {
  PathPiece piece;
  piece.kind = PathKind::kSpline;
  piece.length = 2;
  piece.spline = {{{100, 1, 0.5, -0.25, 0.125},
                   {-40, 0.5, 0.25, 0.1, -0.05},
                   {7, -1, 0.3, 0.2, 0.1},
                   {0.1, 0.02, -0.01, 0.003, 0.001},
                   {-0.2, 0.01, 0.02, -0.002, 0.0005},
                   {0.97, -0.01, 0.002, 0.001, -0.0004}}};
  return piece;
}

TEST(PoseAt, FollowsTheQuarticsOfASplineWithAUnitAxis) {
  const PathPiece piece = curved_spline();
  const ToolPose pose = pose_at(piece, 1.5);
  EXPECT_NEAR(pose.tip[0], 100 + 1.5 + 0.5 * 2.25 - 0.25 * 3.375 + 0.125 * 5.0625, 1e-13);
  EXPECT_NEAR(pose.tip[2], 7 - 1.5 + 0.3 * 2.25 + 0.2 * 3.375 + 0.1 * 5.0625, 1e-14);
  EXPECT_NEAR(pose.axis.norm(), 1.0, 1e-15);
  const double o3 = 0.1 + 0.03 - 0.0225 + 0.003 * 3.375 + 0.001 * 5.0625;
  const double o4 = -0.2 + 0.015 + 0.045 - 0.002 * 3.375 + 0.0005 * 5.0625;
  EXPECT_NEAR(pose.axis[1] / pose.axis[0], o4 / o3, 1e-14);
  EXPECT_EQ(pose_at(piece, 0.0).tip[1], -40);
}

TEST(PoseAt, GivesDerivativesOfASplineThroughJets) {
  const PathPiece piece = curved_spline();
  const double s = 0.7, h = 1e-3;
  const auto pose = pose_at(piece, Jet<3>::variable(s));
  EXPECT_NEAR(pose.tip[0].derivative(3), 6 * -0.25 + 24 * 0.125 * s, 1e-13);
  for (int i = 0; i < 3; ++i) {
    const auto axis = [&](int steps) { return pose_at(piece, s + steps * h).axis[i]; };
    EXPECT_EQ(pose.axis[i].value(), axis(0));
    EXPECT_NEAR(pose.axis[i].derivative(1), (axis(1) - axis(-1)) / (2 * h), 1e-7);
    EXPECT_NEAR(pose.axis[i].derivative(2), (axis(1) - 2 * axis(0) + axis(-1)) / (h * h), 1e-7);
    EXPECT_NEAR(pose.axis[i].derivative(3),
                (axis(2) - 2 * axis(1) + 2 * axis(-1) - axis(-2)) / (2 * h * h * h), 1e-6);
  }
}

TEST(PoseAt, StaysAtTheBeginOfAPieceWithoutLength) {
  PathPiece piece = tilted_line();
  piece.length = 0;
  EXPECT_EQ(pose_at(piece, 0.0).tip[0], 1.0);
}

}  // namespace
}  // namespace meridian
