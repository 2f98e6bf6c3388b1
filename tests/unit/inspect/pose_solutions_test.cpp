// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/pose_solutions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "meridian/kinematics/tip_over_base.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/shipped_machines.hpp"

namespace meridian::inspect {
namespace {

class PoseOfEveryShipped : public testing::TestWithParam<std::string> {
 protected:
  const MachineModel model_ = config::load_machine(test::shipped_file(GetParam()));

  JointVector drawn(std::mt19937_64& draw) const {
    JointVector q{};
    for (int i = 0; i < model_.joint_count; ++i) {
      const JointSpec& joint = model_.joints[i];
      const double low = joint.is_endless ? -std::numbers::pi : joint.limits.travel_min;
      const double high = joint.is_endless ? std::numbers::pi : joint.limits.travel_max;
      q[i] = std::uniform_real_distribution<double>(low, high)(draw);
    }
    return q;
  }
};

TEST_P(PoseOfEveryShipped, IsGivenBackByEveryBranchAndEveryWinding) {
  std::mt19937_64 draw(11);
  for (int n = 0; n < 200; ++n) {
    const ToolPose pose = forward(model_, model_.tool_length_mm, drawn(draw));
    const auto solutions = solve_all(model_, pose);
    ASSERT_FALSE(solutions.empty());
    for (const PoseSolution& solution : solutions) {
      for (int joint = 0; joint < model_.joint_count; ++joint) {
        const Windings windings = windings_at(model_, solution.q, joint);
        for (int turns = -windings.down; turns <= windings.up; ++turns) {
          JointVector q = solution.q;
          q[joint] += turns * kTurn_rad;
          const ToolPose back = forward(model_, model_.tool_length_mm, q);
          EXPECT_LT((back.tip - pose.tip).norm(), 1e-6);
          EXPECT_LT((back.axis - pose.axis).norm(), 1e-8);
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Machine, PoseOfEveryShipped, testing::ValuesIn(test::shipped_machines()),
                         test::test_name);

TEST(PoseSolutions, SayWhichStandAtABox) {
  MachineModel model = config::load_machine(test::shipped_file("lai"));
  const ToolPose pose{{100, 0, 50}, Vector3(0.3, 0, 1).normalized()};
  const auto open = solve_all(model, pose);
  ASSERT_EQ(open.size(), 2U);
  EXPECT_TRUE(open[0].is_possible() && open[1].is_possible());
  KeepOutBox box;
  box.name = {"vice"};
  box.joints = 0b001;
  box.min[0] = open[0].q[0] - 1;
  box.max[0] = open[0].q[0] + 1;
  ASSERT_TRUE(model.keep_out.add(box));
  model.tip_box = {true, {-1e3, -1e3, -1e3}, {1e3, 1e3, 1e3}};
  const double tip = tip_over_base(model, model.tool_length_mm, open[1].q)[0];
  (tip > 0 ? model.tip_box.max : model.tip_box.min)[0] = 0;
  const auto boxed = solve_all(model, pose);
  ASSERT_EQ(boxed.size(), 2U);
  EXPECT_FALSE(boxed[0].is_possible() || boxed[1].is_possible());
  const std::string text = to_text(boxed, model), json = to_json(boxed, model, pose);
  EXPECT_NE(text.find("INSIDE THE KEEP-OUT BOX vice\n"), std::string::npos) << text;
  EXPECT_NE(text.find("TIP OUTSIDE ITS BOX along X\n"), std::string::npos) << text;
  EXPECT_NE(json.find("\"keep_out\": \"vice\""), std::string::npos) << json;
  EXPECT_NE(json.find("\"tip_outside\": \"X\""), std::string::npos) << json;
  EXPECT_EQ(solution_of_joints(model, boxed[0].q).keep_out, 0);
  EXPECT_EQ(solution_of_joints(model, boxed[1].q).tip_outside, 0);
}

TEST(PoseSolutions, CountTheTurnsThatTravelHasOnEitherSide) {
  MachineModel model = config::load_machine(test::shipped_file("trunnion-ac"));
  const int joint = model.chain.a.joint;
  model.joints[joint].is_endless = false;
  model.joints[joint].limits.travel_min = -1.5 * kTurn_rad;
  model.joints[joint].limits.travel_max = 2.25 * kTurn_rad;
  JointVector q{};
  q[joint] = 0.25 * kTurn_rad;
  EXPECT_EQ(windings_at(model, q, joint).down, 1);
  EXPECT_EQ(windings_at(model, q, joint).up, 2);
}

TEST(PoseSolutions, SayWhichJointIsBeyondTravelAndByHowMuch) {
  const MachineModel model = config::load_machine(test::shipped_file("trunnion-ac"));
  JointVector q{};
  for (int i = 0; i < model.joint_count; ++i) q[i] = model.joints[i].home;
  const int joint = model.chain.linear[0].joint;
  q[joint] = model.joints[joint].limits.travel_max + 2.5;
  q[model.chain.b.joint] = 0.3;
  const auto solutions = solve_all(model, forward(model, model.tool_length_mm, q));
  bool is_found = false;
  for (const PoseSolution& one : solutions) {
    if (std::abs(one.q[joint] - q[joint]) > 1e-9 || one.outside != joint) continue;
    is_found = true;
    EXPECT_NEAR(one.beyond, 2.5, 1e-9);
  }
  EXPECT_TRUE(is_found);
}

TEST(PoseSolutions, AreNoneWhereTheToolCannotLeanSoFar) {
  const MachineModel model = config::load_machine(test::shipped_file("nutating-head"));
  const Vector3 up = model.X_MW.rotation.transpose() * model.chain.a.axis;
  const chain::Reach reach = chain::reach(model.chain);
  ASSERT_LT(reach.largest_rad, std::numbers::pi - 0.1);
  EXPECT_TRUE(solve_all(model, {Vector3::Zero(), -up}).empty());
  EXPECT_NE(why_unreachable(model, {Vector3::Zero(), -up}).find("180.0000 deg"), std::string::npos);
}

}  // namespace
}  // namespace meridian::inspect
