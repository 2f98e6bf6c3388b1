// SPDX-License-Identifier: Apache-2.0
#include "meridian/planner/joints_at.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/machines.hpp"

namespace meridian {
namespace {

constexpr double kTip_mm = 1e-10;  // reach 1e3 mm * eps = 2e-13, 500x margin

TEST(JointsAt, RunsEveryJointEvenlyOnAJointPiece) {
  const MachineModel model = test::lai_machine();
  PathPiece piece;
  piece.kind = PathKind::kJoint;
  piece.length = 4;
  piece.joints_begin = {0, 10, 20, 1, 0.5, 0};
  piece.joints_end = {8, 10, 0, 2, -0.5, 0};
  const auto at = joints_at(model, piece, Jet<3>::variable(1.0), piece.joints_begin);
  EXPECT_DOUBLE_EQ(at.q[0].derivative(0), 2);
  EXPECT_DOUBLE_EQ(at.q[0].derivative(1), 2);
  EXPECT_DOUBLE_EQ(at.q[2].derivative(0), 15);
  EXPECT_DOUBLE_EQ(at.q[4].derivative(1), -0.25);
  EXPECT_EQ(at.q[4].derivative(2), 0);
}

TEST(JointsAt, KeepsTipAndAxisWhileTurningOnThePole) {
  const MachineModel model = test::lai_machine();
  PathPiece piece;
  piece.kind = PathKind::kTurn;
  piece.length = 50;
  piece.tool_length_mm = 110;
  piece.tip_begin = {30, -20, 10};
  piece.axis_begin = {0, 0, 1};
  piece.free_begin = 0.2;
  piece.free_end = 2.2;
  for (const double s : {0.0, 13.0, 50.0}) {
    const auto at = joints_at(model, piece, s, JointVector{});
    EXPECT_DOUBLE_EQ(at.q[3], 0.2 + 2.0 * s / 50);
    const ToolPose pose = forward(model, 110, at.q);
    EXPECT_LT((pose.tip - Vector3(30, -20, 10)).norm(), kTip_mm);
    EXPECT_LT((pose.axis - Vector3(0, 0, 1)).norm(), 1e-14);
  }
}

TEST(JointsAt, CrossesThePoleWithoutATurnWhereTheRedundantJointIsDriven) {
  const MachineModel model = test::lai_machine();
  PathPiece piece;
  piece.length = 20;
  piece.tool_length_mm = 110;
  piece.tip_delta = {20, 0, 0};
  piece.axis_begin = {-std::sin(0.2), 0, std::cos(0.2)};
  piece.axis_normal = {std::cos(0.2), 0, std::sin(0.2)};
  piece.axis_turn = 0.4;
  piece.is_free_driven = true;
  piece.free_begin = piece.free_end = std::numbers::pi;  // branch 0 on the way in
  EXPECT_NEAR(joints_at(model, piece, 0.0, JointVector{}).q[4], 0.2, 1e-15);
  EXPECT_NEAR(joints_at(model, piece, 10.0, JointVector{}).q[4], 0.0, 1e-15);
  EXPECT_NEAR(joints_at(model, piece, 20.0, JointVector{}).q[4], -0.2, 1e-15);
  const auto jets = joints_at(model, piece, Jet<3>::variable(10.0), JointVector{});
  EXPECT_NEAR(jets.q[4].derivative(1), -0.02, 1e-15);
  EXPECT_EQ(jets.q[3].derivative(1), 0);
}

}  // namespace
}  // namespace meridian
