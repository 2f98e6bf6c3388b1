// SPDX-License-Identifier: Apache-2.0
// A 6R robot whose yaw and roll are driven together: axis and tip are the nearest that there are.
// Wrist points at, near and off the base axis, tools in line with the forearm, nearly and not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian {
namespace {

using robot::kBend, robot::kElbow, robot::kRoll, robot::kShoulder, robot::kYaw;

constexpr int kDrawn = 4000;
constexpr double kSame_rad = 1e-9;
constexpr int kBothDriven = robot::kYawDriven | robot::kRollDrivenToo;

class DrivenBoth : public testing::Test {
 protected:
  [[nodiscard]] double draw(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  [[nodiscard]] double as_little(double most) {
    return (draw(-1, 1) < 0 ? -1 : 1) * std::min(most, std::pow(10.0, draw(-13, 0)));
  }
  /// Elbow up; the wrist point and the bend as near to their singular places as one pleases.
  [[nodiscard]] JointVector joints() {
    JointVector q{};
    const double elbow = draw(0.5, 1.9);
    q[kYaw] = draw(-2.5, 2.5);
    q[kElbow] = -elbow;
    q[kShoulder] = 1.5707963267948966 + elbow / 2 + as_little(0.5);  // arms are equally long
    q[kRoll] = draw(-3, 3);
    q[kBend] = as_little(0.5);
    return q;
  }
  [[nodiscard]] Solution<double> solve_at(const Pose<double>& pose, double yaw, double roll,
                                          const JointVector& reference) const {
    return solve_driven(model_, tool_mm_, pose, yaw, roll, kBothDriven, reference);
  }

  MachineModel model_ = config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/robot-6r.toml");
  double tool_mm_ = model_.tool_length_mm;
  std::mt19937 random_{20261128};
};

TEST_F(DrivenBoth, GivesBackTheJointsWhereYawAndRollAreTheirs) {
  for (int n = 0; n < kDrawn; ++n) {
    const JointVector q = joints();
    const auto found = solve_at(forward(model_, tool_mm_, q), q[kYaw], q[kRoll], q);
    ASSERT_EQ(found.status, SolveStatus::kOk) << "pose " << n;
    for (int i = 0; i < model_.joint_count; ++i) {
      ASSERT_NEAR(found.q[i], q[i], kSame_rad) << "pose " << n << ", joint " << i;
    }
  }
}

TEST_F(DrivenBoth, LeavesTheTipInTheArmPlaneAndTheAxisWhereTheBendBringsItNearest) {
  for (int n = 0; n < kDrawn; ++n) {
    const JointVector q = joints();
    const Pose<double> pose = forward(model_, tool_mm_, q);
    const auto found = solve_at(pose, q[kYaw] + as_little(0.3), q[kRoll] + as_little(0.3), q);
    ASSERT_EQ(found.status, SolveStatus::kOk) << "pose " << n;
    const Pose<double> there = forward(model_, tool_mm_, found.q);
    const double yaw = found.q[kYaw];
    const Vector3 normal(-std::sin(yaw), std::cos(yaw), 0);
    const Pose<double> there_m = pose_in_machine(model_, there);
    const Pose<double> asked_m = pose_in_machine(model_, pose);
    const Vector3 off = there_m.tip - asked_m.tip;
    ASSERT_LT((off - off.dot(normal) * normal).norm(), 1e-6) << "pose " << n;
    for (const double by : {-0.1, -1e-3, 1e-3, 0.1}) {
      JointVector other = found.q;
      other[kBend] += by;
      const double nearest = there.axis.dot(pose.axis);
      ASSERT_LT(forward(model_, tool_mm_, other).axis.dot(pose.axis), nearest + 1e-9)
          << "pose " << n << ", bend off by " << by;
    }
  }
}

TEST_F(DrivenBoth, RefusesWhatTheArmDoesNotReach) {
  EXPECT_EQ(solve_at({{1e5, 0, 0}, {0, 0, 1}}, 0.1, 0.3, {}).status, SolveStatus::kUnreachable);
}

}  // namespace
}  // namespace meridian
