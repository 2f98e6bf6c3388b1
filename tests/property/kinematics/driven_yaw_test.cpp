// SPDX-License-Identifier: Apache-2.0
// Robots whose yaw is driven: the axis is the pose's, the tip the nearest in the arm plane. Wrist
// points over, beside and far from the base axis, in front of it and behind.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <string>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/solve_driven.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian {
namespace {

using robot::kElbow, robot::kShoulder, robot::kYaw;

constexpr int kPoses = 4000;
constexpr double kTip_mm = 1e-9;
constexpr double kAngle_rad = 1e-11;

class DrivenYaw : public testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] double draw(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  /// Elbow up; the wrist point as near to the base axis as one pleases, on either side.
  [[nodiscard]] JointVector joints() {
    JointVector q{};
    const double elbow = draw(0.5, 1.9);
    const double off = (draw(-1, 1) < 0 ? -1 : 1) * std::pow(10.0, draw(-12, -0.3));
    q[kYaw] = draw(-2.5, 2.5);
    q[kElbow] = -elbow;
    q[kShoulder] = 1.5707963267948966 + elbow / 2 + off;  // arms are equally long
    for (int joint = 3; joint < model_.joint_count; ++joint) q[joint] = draw(0.2, 1.2);
    return q;
  }
  [[nodiscard]] int branch_of(const Pose<double>& pose, const JointVector& q) const {
    for (int branch = 0; branch < branch_count(model_); ++branch) {
      const auto found =
          solve_driven(model_, tool_mm_, pose, q[kYaw], branch | robot::kYawDriven, q);
      double off = 0;
      for (int i = 0; i < model_.joint_count; ++i) off = std::max(off, std::abs(found.q[i] - q[i]));
      if (found.status == SolveStatus::kOk && off < 1e-6) return branch;
    }
    return -1;
  }

  MachineModel model_ = config::load_machine(std::string(MERIDIAN_SOURCE_DIR "/deploy/machines/") +
                                             GetParam() + ".toml");
  double tool_mm_ = model_.tool_length_mm;
  std::mt19937 random_{20261127};
};

TEST_P(DrivenYaw, GivesBackTheJointsWhereTheYawIsTheirs) {
  for (int n = 0; n < kPoses; ++n) {
    const JointVector q = joints();
    const Pose<double> pose = forward(model_, tool_mm_, q);
    const int branch = branch_of(pose, q);
    ASSERT_GE(branch, 0) << "pose " << n;
    const auto found = solve_driven(model_, tool_mm_, pose, q[kYaw], branch | robot::kYawDriven, q);
    for (int i = 0; i < model_.joint_count; ++i) {
      ASSERT_NEAR(found.q[i], q[i], kAngle_rad) << "pose " << n << ", joint " << i;
    }
  }
}

TEST_P(DrivenYaw, KeepsTheAxisAndLeavesTheTipByTheWristPointOffTheArmPlane) {
  for (int n = 0; n < kPoses; ++n) {
    const JointVector q = joints();
    const Pose<double> pose = forward(model_, tool_mm_, q);
    const int branch = branch_of(pose, q);
    ASSERT_GE(branch, 0) << "pose " << n;
    const double by = draw(-1, 1);
    const auto found =
        solve_driven(model_, tool_mm_, pose, q[kYaw] + by, branch | robot::kYawDriven, q);
    ASSERT_EQ(found.status, SolveStatus::kOk) << "pose " << n;
    const Pose<double> there = forward(model_, tool_mm_, found.q);
    const double radius =
        robot::shoulder_distance(model_.robot, tool_mm_, pose_in_machine(model_, pose));
    ASSERT_LT(there.axis.cross(pose.axis).norm(), kAngle_rad) << "pose " << n;
    ASSERT_NEAR((there.tip - pose.tip).norm(), radius * std::abs(std::sin(by)), kTip_mm)
        << "pose " << n;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, DrivenYaw, testing::Values("robot-5r", "robot-6r"),
                         [](const testing::TestParamInfo<const char*>& machine) {
                           return machine.param[6] == '5' ? "FiveJoints" : "SixJoints";
                         });

}  // namespace
}  // namespace meridian
