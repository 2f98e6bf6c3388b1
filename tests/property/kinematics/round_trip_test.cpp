// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"
#include "support/random_poses.hpp"

namespace meridian {
namespace {

constexpr int kPoses = 10'000;
constexpr double kTipTolerance_mm = 1e-9;  // promise of the design; reach 1e3 mm * eps = 2e-13
constexpr double kAxisTolerance_rad = 1e-12;

/// A machine with an oblique workpiece frame, so that nothing cancels by luck.
MachineModel oblique_machine() {
  MachineModel model = test::lai_machine();
  model.X_MW.rotation = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                         Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitY()))
                            .toRotationMatrix();
  model.X_MW.origin_mm = {31, -57, 12};
  return model;
}

TEST(RoundTrip, GivesBackTipAndAxisOnBothBranches) {
  constexpr std::uint32_t kSeed = 20240601;
  SCOPED_TRACE(kSeed);
  test::RandomPoses draw(kSeed);
  double tip_error = 0, axis_error = 0;
  int at_pole = 0;
  for (int i = 0; i < kPoses; ++i) {
    const MachineModel model = i % 2 == 0 ? test::lai_machine() : oblique_machine();
    const double tool = draw.uniform(20, 200);
    ToolPose pose = draw.next();
    if (i % 2 == 1) pose = pose_in_workpiece(model, pose);
    const JointVector reference{0, 0, 0, draw.uniform(-60, 60), draw.uniform(-1, 1)};
    for (int branch = 0; branch < branch_count(model); ++branch) {
      const auto s = solve(model, tool, pose, branch, reference);
      ASSERT_NE(s.status, SolveStatus::kUnreachable);
      const ToolPose back = forward(model, tool, s.q);
      tip_error = std::max(tip_error, (back.tip - pose.tip).norm());
      const double allowed = s.status == SolveStatus::kAtPole ? kPoleHold_rad : 0;
      axis_error = std::max(axis_error, angle_between(back.axis, pose.axis) - allowed);
      at_pole += s.status == SolveStatus::kAtPole;
    }
  }
  EXPECT_LT(tip_error, kTipTolerance_mm);
  EXPECT_LT(axis_error, kAxisTolerance_rad);
  EXPECT_GT(at_pole, kPoses / 3);
  RecordProperty("tip_error_mm", std::to_string(tip_error * 1e12) + "e-12");
  std::printf("tip error %.3g mm, axis error %.3g rad, %d solutions at the pole\n", tip_error,
              axis_error, at_pole);
}

TEST(RoundTrip, RecoversTheJointsThatAPoseCameFrom) {
  constexpr std::uint32_t kSeed = 77;
  SCOPED_TRACE(kSeed);
  test::RandomPoses draw(kSeed);
  const MachineModel model = oblique_machine();
  for (int i = 0; i < kPoses; ++i) {
    const JointVector q{draw.uniform(-400, 400), draw.uniform(-400, 400), draw.uniform(-400, 400),
                        draw.uniform(-12, 12), draw.uniform(0.01, 1.04) * (i % 2 == 0 ? 1 : -1)};
    JointVector reference = q;
    reference[3] += draw.uniform(-3, 3);
    const auto s = solve(model, 110, forward(model, 110, q), i % 2, reference);
    for (int j = 0; j < 5; ++j) EXPECT_NEAR(s.q[j], q[j], 1e-9) << "joint " << j;
  }
}

TEST(RoundTrip, TipIsExactForAnyHeldTurn) {
  constexpr std::uint32_t kSeed = 4711;
  SCOPED_TRACE(kSeed);
  test::RandomPoses draw(kSeed);
  const MachineModel model = oblique_machine();
  double tip_error = 0;
  for (int i = 0; i < kPoses; ++i) {
    const ToolPose pose = draw.next();
    const double held = draw.uniform(-20, 20);
    const auto s = solve_held(model, 110, pose, held);
    EXPECT_EQ(s.q[3], held);
    tip_error = std::max(tip_error, (forward(model, 110, s.q).tip - pose.tip).norm());
  }
  EXPECT_LT(tip_error, kTipTolerance_mm);
}

TEST(RoundTrip, HeldTurnNearThePoleCostsNoMoreAxisThanThePoleIsAway) {
  constexpr std::uint32_t kSeed = 815;
  SCOPED_TRACE(kSeed);
  test::RandomPoses draw(kSeed);
  const MachineModel model = test::lai_machine();
  for (int i = 0; i < kPoses; ++i) {
    const double tilt = std::pow(10.0, draw.uniform(-11, -0.5));
    const ToolPose pose = draw.pose_with_tilt(tilt);
    const auto s = solve_held(model, 110, pose, draw.uniform(-9, 9));
    EXPECT_LE(angle_between(forward(model, 110, s.q).axis, pose.axis), tilt * (1 + 1e-9) + 1e-15);
  }
}

TEST(RoundTrip, ANeighbouringPoseGivesNeighbouringJoints) {
  constexpr std::uint32_t kSeed = 99;
  SCOPED_TRACE(kSeed);
  test::RandomPoses draw(kSeed);
  const MachineModel model = test::bench_machine();
  const int steps = 20'000;  // five turns of the tool axis about the pole, 0.2 rad off it
  JointVector q =
      solve(model, 100, ToolPose{{50, 0, 0}, {std::sin(0.2), 0, std::cos(0.2)}}, 1, JointVector{})
          .q;
  const double begin = q[3];
  for (int i = 1; i <= steps; ++i) {
    const double azimuth = 5 * kTurn_rad * i / steps;
    const Vector3 axis(std::sin(0.2) * std::cos(azimuth), std::sin(0.2) * std::sin(azimuth),
                       std::cos(0.2));
    const JointVector before = q;
    q = solve(model, 100, ToolPose{{50, 0, 0}, axis}, 1, before).q;
    EXPECT_LT(std::abs(q[3] - before[3]), 2e-3);
    EXPECT_LT(std::abs(q[0] - before[0]), 0.1);
  }
  EXPECT_NEAR(q[3] - begin, 5 * kTurn_rad, 1e-12);
}

}  // namespace
}  // namespace meridian
