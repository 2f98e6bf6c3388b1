// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/SVD>

#include "meridian/kinematics/jacobian.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"
#include "support/random_poses.hpp"

namespace meridian {
namespace {

JointVector draw_joints(test::RandomPoses& draw) {
  return {draw.uniform(-400, 400), draw.uniform(-400, 400), draw.uniform(-400, 400),
          draw.uniform(-12, 12), draw.uniform(-1.04, 1.04)};
}

MachineModel turned_machine() {
  MachineModel model = test::lai_machine();
  model.X_MW.rotation << 0, -1, 0, 0.6, 0, -0.8, 0.8, 0, 0.6;
  model.X_MW.origin_mm = {5, 6, 7};
  return model;
}

TEST(Derivative, JacobianEqualsJetsOfTheForwardKinematics) {
  constexpr std::uint32_t kSeed = 12;
  SCOPED_TRACE(kSeed);
  test::RandomPoses draw(kSeed);
  const MachineModel model = turned_machine();
  for (int i = 0; i < 1000; ++i) {
    const JointVector q = draw_joints(draw);
    const Jacobian j = jacobian(model, 110, q);
    for (int column = 0; column < 5; ++column) {
      Joints<Jet<1>> jets;
      for (int k = 0; k < kMaxJoints; ++k) jets[k] = Jet<1>(q[k]);
      jets[column].c[1] = 1;
      const Pose<Jet<1>> pose = forward(model, 110, jets);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(j(k, column), pose.tip[k].derivative(1), 1e-11);
        EXPECT_NEAR(j(3 + k, column), pose.axis[k].derivative(1), 1e-14);
      }
    }
  }
}

TEST(Derivative, MeasureIsTheVolumeOfTheJacobian) {
  constexpr std::uint32_t kSeed = 13;
  SCOPED_TRACE(kSeed);
  test::RandomPoses draw(kSeed);
  const MachineModel model = turned_machine();
  for (int i = 0; i < 1000; ++i) {
    const JointVector q = draw_joints(draw);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(jacobian(model, 110, q)));
    EXPECT_NEAR(svd.singularValues().prod(), measure(model, q), 1e-9);
  }
}

/// Joints along tip(s) = a + b s, axis(s) on a great circle, as the cycle asks for them.
template <class S>
Solution<S> along(const MachineModel& model, const ToolPose& a, const ToolPose& b, const S& s,
                  const JointVector& reference) {
  const Vector3 side = (b.axis - a.axis * a.axis.dot(b.axis)).normalized();
  const auto [sine, cosine] = sin_cos(s);
  Pose<S> pose;
  for (int k = 0; k < 3; ++k) {
    pose.tip[k] = a.tip[k] + s * b.tip[k];
    pose.axis[k] = cosine * a.axis[k] + sine * side[k];
  }
  return solve(model, 110, pose, 0, reference);
}

TEST(Derivative, JetsOfTheInverseKinematicsEqualFiniteDifferences) {
  constexpr std::uint32_t kSeed = 14;
  SCOPED_TRACE(kSeed);
  test::RandomPoses draw(kSeed);
  const MachineModel model = test::lai_machine();
  for (int i = 0; i < 300; ++i) {
    const ToolPose a = draw.pose_with_tilt(draw.uniform(0.3, 1.0));
    const ToolPose b = draw.pose_with_tilt(draw.uniform(0.3, 1.0));
    const auto jets = along(model, a, b, Jet<3>::variable(0.0), JointVector{});
    const double h = 2e-3;
    JointVector at[5];
    for (int k = 0; k < 5; ++k) at[k] = along(model, a, b, (k - 2) * h, JointVector{}).q;
    for (int k = 0; k < 5; ++k) {  // unwrap theta1 where the path crosses ±pi
      for (int m = 0; m < 5; ++m) at[m][3] = nearest_winding(at[m][3], at[2][3]);
    }
    for (int j = 0; j < 5; ++j) {
      EXPECT_EQ(jets.q[j].value(), at[2][j]);
      const double d1 = (at[0][j] - 8 * at[1][j] + 8 * at[3][j] - at[4][j]) / (12 * h);
      const double d2 =
          (-at[0][j] + 16 * at[1][j] - 30 * at[2][j] + 16 * at[3][j] - at[4][j]) / (12 * h * h);
      const double d3 = (at[4][j] - 2 * at[3][j] + 2 * at[1][j] - at[0][j]) / (2 * h * h * h);
      const double scale = j < 3 ? 1e3 : 1;  // mm of reach, rad; truncation h^4, h^4, h^2
      EXPECT_NEAR(jets.q[j].derivative(1), d1, 3e-7 * scale) << i << " joint " << j;
      EXPECT_NEAR(jets.q[j].derivative(2), d2, 3e-6 * scale) << i << " joint " << j;
      EXPECT_NEAR(jets.q[j].derivative(3), d3, 3e-2 * scale) << i << " joint " << j;
    }
  }
}

TEST(Derivative, ForwardOfTheInverseKeepsTheDerivativesOfThePath) {
  constexpr std::uint32_t kSeed = 15;
  SCOPED_TRACE(kSeed);
  test::RandomPoses draw(kSeed);
  const MachineModel model = turned_machine();
  for (int i = 0; i < 2000; ++i) {
    const ToolPose a = pose_in_workpiece(model, draw.pose_with_tilt(draw.uniform(0.1, 1.0)));
    const ToolPose b = draw.pose_with_tilt(1.0);
    const auto s = along(model, a, b, Jet<3>::variable(0.0), JointVector{});
    const Pose<Jet<3>> pose = forward(model, 110, s.q);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(pose.tip[k].derivative(1), b.tip[k], 1e-7);
      EXPECT_NEAR(pose.tip[k].derivative(2), 0, 1e-6);
      EXPECT_NEAR(pose.tip[k].derivative(3), 0, 1e-5);
      EXPECT_NEAR(pose.axis[k].derivative(2), -a.axis[k], 1e-9);
    }
  }
}

}  // namespace
}  // namespace meridian
