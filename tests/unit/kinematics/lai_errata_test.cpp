// SPDX-License-Identifier: Apache-2.0
// The consequences that docs/kinematics.md names for the errata of the paper, computed.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "meridian/kinematics/jacobian.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"
#include "support/random_poses.hpp"

namespace meridian {
namespace {

constexpr double kTolerance_mm = 1e-10;
constexpr LaiTable kTable{.b1 = 100, .a2 = 420, .a3 = 10, .l3 = 80, .l4 = 30, .b5 = 20, .l5 = 140};
constexpr double kTool_mm = 110;

/// L(1): Tz(b) Rz(theta) Tx(a) Rx(alpha) Tz(l).
Eigen::Isometry3d link(double b, double theta, double a, double alpha, double l) {
  return Eigen::Translation3d(0, 0, b) * Eigen::AngleAxisd(theta, Vector3::UnitZ()) *
         Eigen::Translation3d(a, 0, 0) * Eigen::AngleAxisd(alpha, Vector3::UnitX()) *
         Eigen::Translation3d(0, 0, l);
}

/// Product of the table; `sign` -1 as corrected, +1 as printed.
Eigen::Isometry3d product(const JointVector& q, double sign) {
  const auto [b3, b2, b4, theta1, theta2, unused] = q;
  return link(-kTable.b1, theta1, 0, -std::numbers::pi / 2, 0) *
         link(b2, -std::numbers::pi / 2, kTable.a2, -std::numbers::pi / 2, 0) *
         link(b3, std::numbers::pi / 2, kTable.a3, std::numbers::pi / 2, kTable.l3) *
         link(-b4, std::numbers::pi / 2, 0, -std::numbers::pi / 2, sign * kTable.l4) *
         link(-kTable.b5, theta2, 0, std::numbers::pi / 2, sign * kTable.l5) *
         link(0, 0, 0, 0, sign * kTool_mm);
}

JointVector draw_joints(test::RandomPoses& draw) {
  return {draw.uniform(-300, 300), draw.uniform(-300, 300), draw.uniform(-300, 300),
          draw.uniform(-3, 3), draw.uniform(-1, 1)};
}

MachineModel machine() {
  MachineModel model = test::bench_machine();
  model.lai = lai_from_table(kTable);
  return model;
}

TEST(LaiErrata, CorrectedTableIsTheForwardKinematics) {
  test::RandomPoses draw(1);
  for (int i = 0; i < 200; ++i) {
    const JointVector q = draw_joints(draw);
    const ToolPose pose = forward(machine(), kTool_mm, q);
    const Eigen::Isometry3d chain = product(q, -1);
    EXPECT_LT((chain.translation() - pose.tip).norm(), kTolerance_mm);
    EXPECT_LT((chain.linear().col(2) - pose.axis).norm(), 1e-14);
  }
}

TEST(LaiErrata, PrintedTableHasTheRightAxisAndATipHalfAMetreOff) {
  test::RandomPoses draw(2);
  const double l = kTable.l5 + kTool_mm;
  for (int i = 0; i < 200; ++i) {
    const JointVector q = draw_joints(draw);
    const double s1 = std::sin(q[3]), c1 = std::cos(q[3]);
    const double s2 = std::sin(q[4]), c2 = std::cos(q[4]);
    const Eigen::Isometry3d printed = product(q, 1);
    const ToolPose pose = forward(machine(), kTool_mm, q);
    const Vector3 off(-2 * kTable.l4 * s1 + 2 * l * c1 * s2, 2 * kTable.l4 * c1 + 2 * l * s1 * s2,
                      2 * l * c2);
    EXPECT_LT((printed.linear().col(2) - pose.axis).norm(), 1e-14);
    EXPECT_LT((printed.translation() - pose.tip - off).norm(), kTolerance_mm);
    EXPECT_NEAR(off.squaredNorm(), 4 * (kTable.l4 * kTable.l4 + l * l), 1e-9);  // 503.6 mm
  }
}

TEST(LaiErrata, PrintedArcTangentMirrorsEveryAxisThatLeansBackwards) {
  test::RandomPoses draw(3);
  for (int i = 0; i < 300; ++i) {
    const ToolPose pose = draw.pose_with_tilt(draw.uniform(0.1, 1.0));
    const double theta1 = std::atan(pose.axis[1] / pose.axis[0]);  // L(8) as printed
    const double theta2 = std::acos(pose.axis[2]);                 // L(9) as printed
    const Vector3 axis(std::cos(theta1) * std::sin(theta2), std::sin(theta1) * std::sin(theta2),
                       std::cos(theta2));
    const double sign = pose.axis[0] < 0 ? -1 : 1;
    EXPECT_LT((axis - Vector3(sign * pose.axis[0], sign * pose.axis[1], pose.axis[2])).norm(),
              1e-13);
  }
}

TEST(LaiErrata, PrintedArcCosineLosesSmallTilts) {
  for (const double tilt : {1e-8, 1e-9}) {
    EXPECT_EQ(std::acos(std::cos(tilt)), 0);
    const auto s =
        solve(machine(), kTool_mm, ToolPose{{0, 0, 0}, {std::sin(tilt), 0, 1}}, 0, JointVector{});
    EXPECT_NEAR(s.q[4] / tilt, 1, 1e-15);
  }
  EXPECT_NEAR(std::acos(std::cos(1e-4)) / 1e-4, 1, 1e-7);
  EXPECT_GT(std::abs(std::acos(std::cos(1e-4)) / 1e-4 - 1), 1e-12);
}

TEST(LaiErrata, TheHorizonIsRegularAndOnlyThePoleIsSingular) {
  const JointVector horizon{120, -80, 30, 0.7, std::numbers::pi / 2};
  EXPECT_NEAR(measure(machine(), horizon), 1, 1e-15);
  const Jacobian j = jacobian(machine(), kTool_mm, horizon);
  EXPECT_NEAR((j.topRows<5>()).determinant(), 0, 1e-10);  // the block without the Kz row
  EXPECT_EQ(measure(machine(), {120, -80, 30, 0.7, 0}), 0);
}

TEST(LaiErrata, PrintedSignsOfTheJacobianTurnTheTableColumnOver) {
  const JointVector q{120, -80, 30, 0.7, 0.4};
  const double l = kTable.l5 + kTool_mm, s2 = std::sin(q[4]);
  const double s1 = std::sin(q[3]), c1 = std::cos(q[3]);
  const double e = kTable.a3 + kTable.b5 + kTable.l4;
  const double right = -l * c1 * s2 + e * s1 + q[0] * c1 - q[1] * s1;
  EXPECT_NEAR(jacobian(machine(), kTool_mm, q)(1, 3), right, 1e-12);
}

TEST(LaiErrata, JointRatesNearThePoleGrowWithItsDistance) {
  // Tip fixed at 180 mm from the C axis, tool axis passing the pole at 1e-2 rad with 1 rad/s.
  const Jet<1> angle = Jet<1>::variable(0.0);
  const auto [sine, cosine] = sin_cos(angle);
  const Pose<Jet<1>> pose{{Jet<1>(150.0), Jet<1>(100.0), Jet<1>(0.0)},
                          {cosine * std::sin(0.01), sine, cosine * std::cos(0.01)}};
  const auto s = solve(machine(), kTool_mm, pose, 0, JointVector{});
  const double reach = std::hypot(150.0, 100.0);
  EXPECT_NEAR(s.q[3].derivative(1), 100, 0.01);
  EXPECT_NEAR(std::hypot(s.q[0].derivative(1), s.q[1].derivative(1)), reach * 100, reach * 0.01);
}

}  // namespace
}  // namespace meridian
