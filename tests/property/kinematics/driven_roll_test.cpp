// SPDX-License-Identifier: Apache-2.0
// A 6R robot whose roll is driven: the tip is the pose's, the axis the nearest that the wrist has
// with that roll. Arms well inside their reach, wrists at, near and off their singularity.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/solve_driven.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian {
namespace {

using robot::kBend, robot::kElbow, robot::kRoll, robot::kShoulder, robot::kSpin, robot::kYaw;

constexpr int kPoses = 4000;
constexpr double kTip_mm = 1e-6;  // what twelve rounds leave where the roll is far off
constexpr double kAngle_rad = 1e-9;

double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

class DrivenRoll : public testing::Test {
 protected:
  [[nodiscard]] double draw(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  /// Elbow up, 30 to 130 degrees bent; the bend up to 30 degrees, or as little as one pleases.
  [[nodiscard]] JointVector joints() {
    JointVector q{};
    q[kYaw] = draw(-2.5, 2.5);
    q[kShoulder] = draw(0.6, 1.6);
    q[kElbow] = -draw(0.5, 2.2);
    q[kRoll] = draw(-3, 3);
    q[kBend] = (draw(-1, 1) < 0 ? -1 : 1) * std::min(0.5, std::pow(10.0, draw(-12, 0)));
    return q;
  }

  /// The branch of `q`: the one that gives it back.
  [[nodiscard]] int branch_of(const Pose<double>& pose, const JointVector& q) const {
    for (int branch = 0; branch < branch_count(model_); ++branch) {
      const auto found = solve_driven(model_, tool_mm_, pose, q[kRoll], branch, q);
      if (found.status == SolveStatus::kOk && std::abs(found.q[kElbow] - q[kElbow]) < 1e-6 &&
          std::abs(found.q[kYaw] - q[kYaw]) < 1e-6) {
        return branch;
      }
    }
    return -1;
  }

  MachineModel model_ = config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/robot-6r.toml");
  double tool_mm_ = model_.tool_length_mm;
  std::mt19937 random_{20261125};
};

TEST_F(DrivenRoll, GivesBackTheJointsWhereTheRollIsTheirs) {
  for (int n = 0; n < kPoses; ++n) {
    const JointVector q = joints();
    const Pose<double> pose = forward(model_, tool_mm_, q);
    const int branch = branch_of(pose, q);
    ASSERT_GE(branch, 0) << "pose " << n;
    const auto found = solve_driven(model_, tool_mm_, pose, q[kRoll], branch, q);
    for (const int joint : std::array<int, 4>{kYaw, kShoulder, kElbow, kBend}) {
      ASSERT_NEAR(found.q[joint], q[joint], kAngle_rad) << "pose " << n << ", joint " << joint;
    }
    ASSERT_EQ(found.q[kRoll], q[kRoll]);
  }
}

TEST_F(DrivenRoll, KeepsTheTipAndTakesTheNearestAxis) {
  for (int n = 0; n < kPoses; ++n) {
    const JointVector q = joints();
    const Pose<double> pose = forward(model_, tool_mm_, q);
    const int branch = branch_of(pose, q);
    ASSERT_GE(branch, 0) << "pose " << n;
    const double off = draw(-3, 3);
    const auto found = solve_driven(model_, tool_mm_, pose, q[kRoll] + off, branch, q);
    ASSERT_EQ(found.status, SolveStatus::kOk) << "pose " << n;
    const Pose<double> got = forward(model_, tool_mm_, found.q);
    ASSERT_LT((got.tip - pose.tip).norm(), kTip_mm) << "pose " << n;
    const double away = angle_between(got.axis, pose.axis);
    for (const double by : {-0.1, -1e-3, -1e-5, 1e-5, 1e-3, 0.1}) {
      JointVector other = found.q;
      other[kBend] += by;
      const double other_away = angle_between(forward(model_, tool_mm_, other).axis, pose.axis);
      ASSERT_GT(other_away, away - kAngle_rad) << "pose " << n << ", bend off by " << by;
    }
  }
}

TEST_F(DrivenRoll, RefusesWhatTheArmDoesNotReach) {
  const Pose<double> far{{1e5, 0, 0}, {0, 0, 1}};
  for (int branch = 0; branch < branch_count(model_); ++branch) {
    EXPECT_EQ(solve_driven(model_, tool_mm_, far, 0.3, branch, {}).status,
              SolveStatus::kUnreachable);
  }
}

}  // namespace
}  // namespace meridian
