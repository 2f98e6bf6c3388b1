// SPDX-License-Identifier: Apache-2.0
#include "meridian/kinematics/kinematics.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "support/machines.hpp"

namespace meridian {
namespace {

constexpr double kTipTolerance_mm = 1e-12;  // reach 1e3 mm * eps = 2e-13
constexpr double kAngleTolerance_rad = 1e-15;

TEST(Kinematics, PutsAVerticalToolUnderTheHead) {
  const MachineModel model = test::lai_machine();
  const ToolPose pose = forward(model, 110, JointVector{10, 80, 30, 0, 0});
  EXPECT_NEAR(pose.tip[0], 10, kTipTolerance_mm);
  EXPECT_NEAR(pose.tip[1], 80 - 60, kTipTolerance_mm);
  EXPECT_NEAR(pose.tip[2], 400 - 30 - 250, kTipTolerance_mm);
  EXPECT_EQ(pose.axis, Vector3(0, 0, 1));
}

TEST(Kinematics, TiltsTheToolAboutTheSwivelAxis) {
  const MachineModel model = test::lai_machine();
  const ToolPose pose = forward(model, 110, JointVector{0, 60, 0, 0, std::numbers::pi / 6});
  EXPECT_NEAR(pose.tip[0], -250 * 0.5, kTipTolerance_mm);
  EXPECT_NEAR(pose.tip[1], 0, kTipTolerance_mm);
  EXPECT_NEAR(pose.axis[0], 0.5, kAngleTolerance_rad);
}

TEST(Kinematics, ALongerToolReachesFartherDown) {
  const MachineModel model = test::lai_machine();
  const JointVector q{10, 20, 30, 0.4, 0.5};
  const ToolPose a = forward(model, 110, q), b = forward(model, 150, q);
  EXPECT_LT((b.tip - (a.tip - 40 * a.axis)).norm(), kTipTolerance_mm);
}

TEST(Kinematics, BranchesTiltInOppositeDirections) {
  const MachineModel model = test::lai_machine();
  const ToolPose pose{{40, -30, 20}, Vector3(0.3, -0.2, 0.9).normalized()};
  const auto a = solve(model, 110, pose, 0, JointVector{});
  const auto b = solve(model, 110, pose, 1, JointVector{});
  EXPECT_EQ(a.status, SolveStatus::kOk);
  EXPECT_EQ(b.status, SolveStatus::kOk);
  EXPECT_GT(a.q[4], 0);
  EXPECT_NEAR(b.q[4], -a.q[4], kAngleTolerance_rad);
  EXPECT_NEAR(std::abs(b.q[3] - a.q[3]), std::numbers::pi, kAngleTolerance_rad);
}

TEST(Kinematics, FollowsTheWindingOfTheReference) {
  const MachineModel model = test::lai_machine();
  const ToolPose pose{{40, -30, 20}, Vector3(0.3, -0.2, 0.9).normalized()};
  const double azimuth = std::atan2(-0.2, 0.3);
  for (const double turns : {-7.0, -1.0, 0.0, 1.0, 12.0}) {
    const auto s = solve(model, 110, pose, 0, JointVector{0, 0, 0, turns * kTurn_rad, 0});
    EXPECT_NEAR(s.q[3], azimuth + turns * kTurn_rad, 1e-13);
  }
}

TEST(Kinematics, HoldsTheRedundantJointOnThePole) {
  const MachineModel model = test::lai_machine();
  for (const double held : {0.0, 1.1, -9.7}) {
    const ToolPose pose{{40, -30, 20}, {0, 0, 1}};
    const auto s = solve(model, 110, pose, 1, JointVector{0, 0, 0, held, 0.1});
    EXPECT_EQ(s.status, SolveStatus::kAtPole);
    EXPECT_EQ(s.q[3], held);
    EXPECT_EQ(s.q[4], 0);
    EXPECT_LT((forward(model, 110, s.q).tip - pose.tip).norm(), kTipTolerance_mm);
  }
}

TEST(Kinematics, HoldsNothingJustOutsideThePole) {
  const MachineModel model = test::lai_machine();
  const ToolPose pose{{40, -30, 20}, {0, 1.01e-9, 1}};
  const auto s = solve(model, 110, pose, 0, JointVector{0, 0, 0, 1.1, 0});
  EXPECT_EQ(s.status, SolveStatus::kOk);
  EXPECT_NEAR(s.q[3], std::numbers::pi / 2, kAngleTolerance_rad);
  EXPECT_NEAR(s.q[4], 1.01e-9, 1e-24);
}

TEST(Kinematics, TiltOnThePoleTakesTheSignThatFitsTheHeldJoint) {
  const MachineModel model = test::lai_machine();
  const ToolPose pose{{40, -30, 20}, {0.5e-9, 0, 1}};
  EXPECT_NEAR(solve(model, 110, pose, 0, JointVector{}).q[4], 0.5e-9, 1e-24);
  EXPECT_NEAR(solve(model, 110, pose, 0, JointVector{0, 0, 0, std::numbers::pi, 0}).q[4], -0.5e-9,
              1e-24);
}

TEST(Kinematics, RefusesAPoseThatIsNotANumberOrHasNoAxis) {
  const MachineModel model = test::lai_machine();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const ToolPose& pose :
       {ToolPose{{kNan, 0, 0}, {0, 0, 1}}, ToolPose{{0, 0, kInfinity}, {0.1, 0, 0.9}},
        ToolPose{{0, 0, 0}, {kNan, 0, 1}}, ToolPose{{0, 0, 0}, {0, 0, 0}}}) {
    EXPECT_EQ(solve(model, 110, pose, 0, JointVector{}).status, SolveStatus::kUnreachable);
    EXPECT_EQ(solve_held(model, 110, pose, 0.3).status, SolveStatus::kUnreachable);
  }
}

TEST(Kinematics, MeasuresTheDistanceToThePole) {
  MachineModel model = test::lai_machine();
  EXPECT_NEAR(pole_distance(model, {std::sin(0.3), 0, std::cos(0.3)}), 0.3, kAngleTolerance_rad);
  EXPECT_NEAR(pole_distance(model, {0, 1e-11, 1}), 1e-11, 1e-26);
  EXPECT_NEAR(pole_distance(model, {0, 1e-11, -1}), 1e-11, 1e-26);
  model.X_MW.rotation << 0, 0, 1, 0, 1, 0, -1, 0, 0;  // W lies on its side: +x of W is -z
  EXPECT_NEAR(pole_distance(model, {1, 0, 0}), 0, kAngleTolerance_rad);
}

TEST(Kinematics, NamesTheFirstJointOutsideTravel) {
  const MachineModel model = test::lai_machine();
  EXPECT_EQ(first_joint_outside_travel(model, {0, 0, 0, 0, 0}, 0), -1);
  EXPECT_EQ(first_joint_outside_travel(model, {0, 601, 0, 0, 2}, 0), 1);
  EXPECT_EQ(first_joint_outside_travel(model, {0, 601, 0, 0, 0}, 2), -1);
  EXPECT_EQ(first_joint_outside_travel(model, {0, 0, 0, 0, -1.06}, 0), 4);
  EXPECT_EQ(first_joint_outside_travel(model, {0, 0, 0, 13, 0}, 0), 3);
  EXPECT_EQ(first_joint_outside_travel(test::bench_machine(), {0, 0, 0, 1e6, 0}, 0), -1);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(first_joint_outside_travel(test::bench_machine(), {0, 0, 0, kNan, 0}, 0), 3);
}

TEST(Kinematics, WindsTheFirstPoseIntoTravel) {
  MachineModel model = test::lai_machine();
  model.joints[3].limits.travel_min = 0;
  model.joints[3].limits.travel_max = 6.2;
  JointVector q{1, 2, 3, -0.4, 0.2};
  wind_into_travel(model, JointVector{}, q);
  EXPECT_NEAR(q[3], -0.4 + kTurn_rad, kAngleTolerance_rad);
  EXPECT_EQ(q[4], 0.2);
  EXPECT_EQ(q[0], 1);
}

TEST(Kinematics, TurnsTheWorkpieceFrameWithItsRotation) {
  MachineModel model = test::lai_machine();
  model.X_MW.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // W turned by 90° about z
  model.X_MW.origin_mm = {100, 10, 5};
  const ToolPose pose{{7, 3, 2}, {0.6, 0, 0.8}};
  const auto s = solve(model, 110, pose, 0, JointVector{});
  EXPECT_NEAR(s.q[3], std::numbers::pi / 2, kAngleTolerance_rad);
  const ToolPose back = forward(model, 110, s.q);
  EXPECT_LT((back.tip - pose.tip).norm(), kTipTolerance_mm);
  EXPECT_LT((back.axis - pose.axis).norm(), kAngleTolerance_rad);
}

}  // namespace
}  // namespace meridian
