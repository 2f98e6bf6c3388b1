// SPDX-License-Identifier: Apache-2.0
// Machines as they were measured: C and the tool axis miss each other by some seconds or minutes of
// arc, so that no tilt brings the tool onto C. They have a pole all the same (eq. 4.12).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"

namespace meridian::test::measured_pole {
namespace {

using Joint = ChainJoint;

/// A trunnion, C on A, whose C runs `offset` rad beside the tool axis towards the axis of A. With
/// `sign` -1 it is counted the other way round.
MachineModel trunnion(double offset, double sign = 1) {
  MachineModel model = bench_machine();
  model.family = MachineFamily::kChain;
  const std::array<Joint, 5> chain{
      Joint{3, true, true, sign * Vector3(std::sin(offset), 0, std::cos(offset)),
            Vector3(2, -1, 0)},
      Joint{4, true, true, Vector3::UnitX(), Vector3(0, 0.5, -40)},
      Joint{0, false, false, Vector3::UnitX(), Vector3::Zero()},
      Joint{1, false, false, Vector3::UnitY(), Vector3::Zero()},
      Joint{2, false, false, Vector3::UnitZ(), Vector3::Zero()}};
  model.chain = *describe_chain(chain, Vector3::UnitZ(), Vector3(0, 0, 300));
  return model;
}

/// Where the tool axis really points in W, by turns one after the other.
Vector3 true_axis(const MachineModel& model, const JointVector& q) {
  const auto turned = [&](const ChainKinematics::Rotary& joint, const Vector3& v) {
    return Vector3(Eigen::AngleAxisd(joint.sign * q[joint.joint], joint.axis) * v);
  };
  return turned(model.chain.a, turned(model.chain.b, model.chain.home_axis));
}

/// A tool axis `theta` off C.
Vector3 axis_beside_c(const MachineModel& model, double theta, double azimuth) {
  const Vector3 c = model.chain.a.axis, x = c.unitOrthogonal(), y = c.cross(x);
  return std::cos(theta) * c + std::sin(theta) * (std::cos(azimuth) * x + std::sin(azimuth) * y);
}

class MeasuredPole : public testing::TestWithParam<double> {};

TEST_P(MeasuredPole, JointsOfEveryAxisGiveItBackAndTheTipToo) {
  const MachineModel model = trunnion(GetParam());
  ASSERT_EQ(redundant_joint(model), 3);
  std::mt19937_64 random{11};
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int n = 0; n < 4000; ++n) {
    const double theta = std::pow(10.0, -8.5 + 8.6 * uniform(random));
    const ToolPose pose{Vector3(100 * uniform(random), 70, -30),
                        axis_beside_c(model, theta, 6.3 * uniform(random))};
    for (int branch = 0; branch < 2; ++branch) {
      const auto at = solve(model, 110, pose, branch, {});
      ASSERT_EQ(at.status, SolveStatus::kOk) << theta;
      const ToolPose back = forward(model, 110, at.q);
      ASSERT_LT((back.tip - pose.tip).norm(), 1e-10) << theta;
      ASSERT_LT((back.axis - pose.axis).norm(), 4e-15) << theta;
      const auto held = solve_held(model, 110, pose, at.q[3]);
      ASSERT_NEAR(std::remainder(held.q[4] - at.q[4], 2 * std::numbers::pi), 0, 1e-12) << theta;
    }
  }
}

TEST_P(MeasuredPole, TheToolAxisIsOffByTheOffsetAtThePoleAndByNothingFartherOff) {
  const double offset = std::abs(GetParam());
  const MachineModel model = trunnion(GetParam());
  for (const double widths : {0.0, 0.1, 1.0, 3.0, 10.0, 30.0, 100.0}) {
    const double theta = widths * chain::kPoleWidth * offset;
    if (theta > 1.5) continue;
    for (int n = 0; n < 24; ++n) {
      const ToolPose pose{Vector3(10, 0, 0), axis_beside_c(model, theta, 0.27 * n)};
      const auto at = solve(model, 110, pose, n % 2, {});
      const double off = (true_axis(model, at.q) - pose.axis).norm();
      const double chords = 2 * std::sin(0.5 * theta) / (chain::kPoleWidth * offset);
      const double expected = offset / (1 + chords * chords);
      EXPECT_NEAR(off, expected, 1e-3 * expected + 1e-15) << widths;
    }
  }
}

TEST_P(MeasuredPole, DerivativesAreThoseOfTheJoints) {
  const MachineModel model = trunnion(GetParam());
  const double width = chain::kPoleWidth * std::abs(GetParam());
  const Vector3 from = axis_beside_c(model, 0.7 * width, 0.3);
  const Vector3 normal = from.cross(axis_beside_c(model, 1.0, 2.0)).normalized();
  const auto joints = [&](double at) {
    const SinCos<Jet<3>> by = sin_cos(Jet<3>::variable(at));
    Pose<Jet<3>> pose;
    const Vector3 across = normal.cross(from);
    for (int i = 0; i < 3; ++i) {
      pose.tip[i] = Jet<3>(10.0 * i);
      pose.axis[i] = by.cos * from[i] + by.sin * across[i];
    }
    return solve(model, 110, pose, 0, {}).q;
  };
  const double h = 1e-4 * width;
  const auto before = joints(-h), here = joints(0), after = joints(h);
  for (std::size_t i = 0; i < 5; ++i) {
    double scale = 1;
    for (int order = 1; order <= 3; ++order) {
      const auto value = [&](const Jet<3>& q) {
        return order == 1 ? value_of(q) : q.derivative(order - 1);
      };
      const double difference = (value(after[i]) - value(before[i])) / (2 * h);
      EXPECT_NEAR(here[i].derivative(order), difference, 1e-6 * (scale + std::abs(difference)))
          << i << " order " << order;
      scale /= width;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Offsets, MeasuredPole, testing::Values(-1e-3, 1e-6, 2e-5, 1e-4, 1.9e-3));

TEST(MeasuredPole, IsThatOfTheMachineWhereTheyMeet) {
  const MachineModel met = trunnion(0), missed = trunnion(1e-9);
  const ToolPose pose{Vector3(10, 20, 30), axis_beside_c(met, 0.4, 1.1)};
  const auto a = solve(met, 110, pose, 0, {}), b = solve(missed, 110, pose, 0, {});
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(a.q[i], b.q[i], 1e-6) << i;
  EXPECT_EQ(met.chain.pole_offset_rad, 0);
  EXPECT_NEAR(missed.chain.pole_offset_rad, 1e-9, 1e-15);
}

TEST(MeasuredPole, IsTheSameWhereTheJointIsCountedTheOtherWayRound) {
  const MachineModel model = trunnion(1e-4), reversed = trunnion(1e-4, -1);
  for (const double theta : {0.0, 1e-5, 1e-3, 0.5}) {
    const ToolPose pose{Vector3(10, 20, 30), axis_beside_c(model, theta, 1.1)};
    for (int branch = 0; branch < 2; ++branch) {
      const auto a = solve(model, 110, pose, branch, {}),
                 b = solve(reversed, 110, pose, branch, {});
      ASSERT_EQ(a.status, b.status);
      EXPECT_NEAR(std::remainder(a.q[3] + b.q[3], 2 * std::numbers::pi), 0, 1e-9);
      EXPECT_NEAR(a.q[4], b.q[4], 1e-12);
    }
  }
}

TEST(MeasuredPole, IsNoneWhereTheyMissEachOtherByMore) {
  const MachineModel model = trunnion(2.1e-3);
  EXPECT_EQ(redundant_joint(model), -1);
  const ToolPose pose{Vector3::Zero(), model.chain.a.axis};
  EXPECT_EQ(solve(model, 110, pose, 0, {}).status, SolveStatus::kUnreachable);
}

}  // namespace
}  // namespace meridian::test::measured_pole
