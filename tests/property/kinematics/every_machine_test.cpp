// SPDX-License-Identifier: Apache-2.0
// A law for every shipped machine: the joints that solve() finds give tip and axis back.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "meridian/kinematics/jacobian.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/shipped_machines.hpp"

namespace meridian {
namespace {

constexpr double kTip_mm = 1e-9;  // reach 2e3 mm · eps = 4e-13, 2000 times margin
constexpr double kAxis = 1e-12;
constexpr int kPoses = 10'000;
constexpr unsigned kSeed = 20261121;

class EveryMachine : public testing::TestWithParam<std::string> {
 protected:
  MachineModel model = config::load_machine(test::shipped_file(GetParam()));
  std::mt19937_64 random{kSeed};

  double draw(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }

  /// Joints inside travel; every third draw has one rotary joint within 1e-1 to 1e-13 rad of a
  /// multiple of a quarter turn, where poles, stretched arms, aligned wrists and limits of reach
  /// are.
  JointVector draw_joints(int n) {
    JointVector q{};
    for (int i = 0; i < model.joint_count; ++i) {
      const JointSpec& joint = model.joints[i];
      q[i] =
          joint.is_endless ? draw(-10, 10) : draw(joint.limits.travel_min, joint.limits.travel_max);
    }
    if (n % 3 != 0) return q;
    const int i = static_cast<int>(draw(0, model.joint_count));
    if (!model.joints[i].is_rotary) return q;
    const double quarter = std::numbers::pi / 2;
    const double near = n % 2 == 0 ? 0.0 : std::pow(10.0, draw(-13, -1));
    q[i] = quarter * std::round(q[i] / quarter) + near;
    return q;
  }
};

TEST_P(EveryMachine, GivesTipAndAxisBackOnEveryBranchAtNearAndOffItsSingularSets) {
  RecordProperty("seed", static_cast<int>(kSeed));
  double worst_tip = 0, worst_axis = 0;
  int solved = 0;
  for (int n = 0; n < kPoses; ++n) {
    const JointVector q = draw_joints(n);
    const ToolPose pose = forward(model, model.tool_length_mm, q);
    int branches = 0;
    for (int branch = 0; branch < branch_count(model); ++branch) {
      const auto at = solve(model, model.tool_length_mm, pose, branch, q);
      if (at.status == SolveStatus::kUnreachable) continue;
      ++branches;
      const ToolPose back = forward(model, model.tool_length_mm, at.q);
      // inside the hold of a pole the axis is the nearest one, within the hold itself
      const double allowed = at.status == SolveStatus::kAtPole ? 2 * kPoleHold_rad : kAxis;
      worst_tip = std::max(worst_tip, (back.tip - pose.tip).norm());
      worst_axis = std::max(worst_axis, (back.axis - pose.axis).norm() / allowed);
    }
    EXPECT_GE(branches, 1) << "pose " << n << " has no solution";
    solved += branches;
  }
  EXPECT_LE(worst_tip, kTip_mm);
  EXPECT_LE(worst_axis, 1.0);
  std::printf("%s: %d solutions, tip %.1e mm, axis %.1e of what is allowed\n", GetParam().c_str(),
              solved, worst_tip, worst_axis);
}

TEST_P(EveryMachine, SomeBranchGivesTheJointsBack) {
  int found = 0, regular = 0;
  for (int n = 0; n < kPoses; ++n) {
    JointVector q = draw_joints(1);
    if (model.joint_count == 6) q[5] = 0;  // the spin rests where the reference has it
    const double scale = model.family == MachineFamily::kRobot ? 1e8 : 1.0;
    if (measure(model, q) < 1e-2 * scale) continue;
    ++regular;
    const ToolPose pose = forward(model, model.tool_length_mm, q);
    for (int branch = 0; branch < branch_count(model); ++branch) {
      const auto at = solve(model, model.tool_length_mm, pose, branch, q);
      double apart = 0;
      for (int i = 0; i < model.joint_count; ++i) apart = std::max(apart, std::abs(at.q[i] - q[i]));
      if (at.status != SolveStatus::kUnreachable && apart < 1e-7) {
        ++found;
        break;
      }
    }
  }
  EXPECT_GT(regular, kPoses / 2);
  EXPECT_EQ(found, regular);
}

INSTANTIATE_TEST_SUITE_P(Shipped, EveryMachine, testing::ValuesIn(test::shipped_machines()),
                         test::test_name);

}  // namespace
}  // namespace meridian
