// SPDX-License-Identifier: Apache-2.0
// A 6R robot whose yaw and roll are both driven, its wrist point over or beside the base axis and
// the tool in line with the forearm or beside it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/solve_driven.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian {
namespace {

using robot::kBend, robot::kElbow, robot::kRoll, robot::kShoulder, robot::kYaw;

constexpr int kPoses = 4000;
constexpr double kTip_mm = 1e-6;  // what twelve rounds leave where the roll is off
constexpr double kAngle_rad = 1e-11;

class DrivenYawAndRoll : public testing::Test {
 protected:
  [[nodiscard]] double draw(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  [[nodiscard]] double draw_near_zero() {
    return (draw(-1, 1) < 0 ? -1 : 1) * std::pow(10.0, draw(-12, -0.5));
  }
  /// Elbow up; the wrist point and the tool as near to their singularities as one pleases.
  [[nodiscard]] JointVector joints() {
    JointVector q{};
    const double elbow = draw(0.5, 1.9);
    q[kYaw] = draw(-2.5, 2.5);
    q[kElbow] = -elbow;
    q[kShoulder] = 1.5707963267948966 + elbow / 2 + draw_near_zero();  // arms are equally long
    q[kRoll] = draw(-3, 3);
    q[kBend] = draw_near_zero();
    return q;
  }
  [[nodiscard]] Solution<double> solve_both(const ToolPose& pose, const JointVector& q) const {
    return solve_driven(model_, tool_mm_, pose, q[kYaw], q[kRoll], robot::kYawAndRollDriven, q);
  }

  MachineModel model_ = config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/robot-6r.toml");
  double tool_mm_ = model_.tool_length_mm;
  std::mt19937 random_{20261129};
};

TEST_F(DrivenYawAndRoll, GivesBackTheJointsWhereBothAreTheirs) {
  for (int n = 0; n < kPoses; ++n) {
    const JointVector q = joints();
    const auto found = solve_both(forward(model_, tool_mm_, q), q);
    ASSERT_EQ(found.status, SolveStatus::kOk);
    for (int i = 0; i < model_.joint_count; ++i) {
      ASSERT_NEAR(found.q[i], q[i], kAngle_rad) << "pose " << n << ", joint " << i;
    }
  }
}

/// Where a pass ends, and only the yaw goes on driven, no joint may jump.
TEST_F(DrivenYawAndRoll, AreTheJointsOfTheDrivenYawWithItsRoll) {
  for (int n = 0; n < kPoses; ++n) {
    JointVector q = joints();
    q[kBend] = std::abs(q[kBend]) + 1e-4;  // its roll is known to 1e-12 rad
    const ToolPose pose = forward(model_, tool_mm_, q);
    q[kYaw] += draw(-1, 1) * 1e-5;
    const auto wanted = solve_driven(model_, tool_mm_, pose, q[kYaw], robot::kYawDriven, q);
    const auto found = solve_both(pose, wanted.q);
    for (int i = 0; i < model_.joint_count; ++i) {
      ASSERT_NEAR(found.q[i], wanted.q[i], kAngle_rad) << "pose " << n << ", joint " << i;
    }
  }
}

TEST_F(DrivenYawAndRoll, KeepsTheTipInTheArmPlaneWithAnyRoll) {
  for (int n = 0; n < kPoses; ++n) {
    JointVector q = joints();
    const ToolPose pose = forward(model_, tool_mm_, q);
    q[kRoll] += draw(-1, 1) * 0.1;
    const auto found = solve_both(pose, q);
    ASSERT_EQ(found.status, SolveStatus::kOk);
    const Vector3 off = forward(model_, tool_mm_, found.q).tip - pose.tip;
    const Vector3 off_in_machine = model_.X_MW.rotation * off;
    const double reach =
        std::cos(q[kYaw]) * off_in_machine.x() + std::sin(q[kYaw]) * off_in_machine.y();
    ASSERT_LT(std::hypot(reach, off_in_machine.z()), kTip_mm) << "pose " << n;
  }
}

TEST_F(DrivenYawAndRoll, RefusesWhatTheArmDoesNotReach) {
  const ToolPose far{{1e5, 0, 0}, {0, 0, 1}};
  EXPECT_EQ(solve_both(far, {}).status, SolveStatus::kUnreachable);
}

}  // namespace
}  // namespace meridian
