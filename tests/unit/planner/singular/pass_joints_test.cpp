// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/robot/pass_joints.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "unit/planner/singular/wrist_path.hpp"

namespace meridian::test::pass_joints {
namespace {

using wrist_path::WristPath;

/// A pass at the wrist from 5 to 15 mm, on which the roll turns from `begin` to `end`.
RobotPass turning(const WristPath& path, double begin, double end) {
  RobotPass pass;
  pass.at = SingularSet::kWrist;
  pass.begin = 5;
  pass.end = 15;
  pass.branch_before = pass.branch_after = path.branch;
  pass.joint = {begin, begin, begin, end, end, end};
  return pass;
}

TEST(PassJoints, DriveTheJointThatTheSingularityLeavesWithoutADirection) {
  EXPECT_EQ(joint_of(Singularity::kWrist), robot::kRoll);
  EXPECT_EQ(joint_of(Singularity::kShoulder), robot::kYaw);
  EXPECT_EQ(first_of(SingularSet::kWrist), Singularity::kWrist);
  EXPECT_EQ(first_of(SingularSet::kWristAndShoulder), Singularity::kShoulder);
  EXPECT_EQ(turned_over(Singularity::kWrist), robot::kFlip);
  EXPECT_EQ(turned_over(Singularity::kShoulder), robot::kBack);
}

TEST(PassJoints, FollowTheQuinticAndKeepTheTip) {
  const WristPath path(0.001);
  const PassTask task = path.task();
  const RobotPass pass = turning(path, 0.3, 0.5);
  JointVector q = path.begin_joints;
  for (const double u : {5.0, 7.5, 10.0, 12.0, 15.0}) {
    const auto at = joints_on_pass(task, pass, u, q);
    ASSERT_NE(at.status, SolveStatus::kUnreachable);
    q = at.q;
    EXPECT_NEAR(q[robot::kRoll], quintic_at(pass.joint, (u - 5) / 10), 1e-12);
    const PassDeviation off = deviation_on_pass(task, pass, u, q);
    EXPECT_EQ(off.tip_mm, 0) << "at the wrist the axis gives, not the tip";
    const ToolPose there = forward(path.model, path.model.tool_length_mm, q);
    EXPECT_NEAR((there.tip - path.pose(u).tip).norm(), 0, 1e-7);
    const double angle = std::acos(std::min(1.0, there.axis.dot(path.pose(u).axis)));
    EXPECT_NEAR(off.axis_rad, angle, 2e-5);
  }
}

TEST(PassJoints, AreWrongWhereTheTipIsOffAtTheWrist) {
  const WristPath path(0.001);
  const PassTask task = path.task();
  const RobotPass pass = turning(path, 0.3, 0.5);
  JointVector q = joints_on_pass(task, pass, 10, path.begin_joints).q;
  q[robot::kShoulder] += 1e-6;
  EXPECT_TRUE(std::isinf(deviation_on_pass(task, pass, 10, q).tip_mm));
}

TEST(PassJoints, LetTheTipGiveAtTheShoulderAlone) {
  const WristPath path(0.3);
  const PassTask task = path.task();
  RobotPass pass = turning(path, 0.3, 0.5);
  pass.at = SingularSet::kShoulder;
  JointVector q =
      solve(path.model, path.model.tool_length_mm, path.pose(10), path.branch, path.begin_joints).q;
  EXPECT_NEAR(deviation_on_pass(task, pass, 10, q).tip_mm, 0, 1e-9);
  q[robot::kYaw] += 1e-4;
  const ToolPose there = forward(path.model, path.model.tool_length_mm, q);
  const PassDeviation off = deviation_on_pass(task, pass, 10, q);
  EXPECT_NEAR(off.tip_mm, (there.tip - path.pose(10).tip).norm(), 1e-9);
  EXPECT_GT(off.tip_mm, 0.01);
  EXPECT_EQ(off.axis_rad, 0) << "of the axis nothing is asked there";
}

TEST(PassJoints, KnowHowFarTheOtherSingularityIs) {
  const WristPath path(0.02);
  const PassTask task = path.task();
  RobotPass pass = turning(path, 0.3, 0.5);
  const JointVector q = joints_on_pass(task, pass, 10, path.begin_joints).q;
  const Vector3 from_base = off_other_singularity(task, pass, 10, q);
  const double reach =
      path.model.robot.upper_arm_mm * std::cos(q[robot::kShoulder]) +
      path.model.robot.forearm_mm * std::cos(q[robot::kShoulder] + q[robot::kElbow]);
  EXPECT_NEAR(from_base.norm(), std::abs(reach), 1e-6) << "of the wrist point";
  EXPECT_EQ(other_tolerance(task, pass), task.tip_tolerance_mm);
  pass.at = SingularSet::kShoulder;
  EXPECT_NEAR(off_other_singularity(task, pass, 10, q).norm(), std::abs(std::sin(q[robot::kBend])),
              1e-12);
  EXPECT_EQ(other_tolerance(task, pass), task.axis_tolerance_rad);
  pass.at = SingularSet::kWristAndShoulder;
  EXPECT_EQ(other_tolerance(task, pass), 0) << "there is no other";
}

TEST(PassJoints, SettleFarFromTheBaseAxisAndNotBesideIt) {
  const WristPath path(0.001);
  const PassTask task = path.task();
  RobotPass pass = turning(path, 0.3, 0.5);
  EXPECT_TRUE(settles(task, pass, path.middle));
  JointVector over_base = path.middle;
  over_base[robot::kShoulder] = 0.5 * std::numbers::pi + 0.5;
  over_base[robot::kElbow] = -1.0;  // upper arm and forearm lean to either side of the axis
  over_base[robot::kRoll] = 0;
  EXPECT_FALSE(settles(task, pass, over_base));
  pass.at = SingularSet::kShoulder;
  EXPECT_TRUE(settles(task, pass, over_base));
}

/// What is left of a small turn of the yaw where the wrist, with its roll as it is, takes the axis
/// nearest to the one that it had, and the wrist point of that axis turns the yaw anew.
double left_of_a_turn(const MachineModel& model, const JointVector& q) {
  constexpr double kTurn = 1e-6;
  const double tool = model.tool_length_mm;
  const ToolPose pose = forward(model, tool, q);
  JointVector turned = q;
  turned[robot::kYaw] += kTurn;
  const auto axis_with = [&](double bend) {
    turned[robot::kBend] = bend;
    return forward(model, tool, turned).axis;
  };
  const double bend =
      std::atan2(pose.axis.dot(axis_with(0.5 * std::numbers::pi)), pose.axis.dot(axis_with(0)));
  const auto yaw_of = [&](const Vector3& axis) {
    const ToolPose at = pose_in_machine(model, ToolPose{pose.tip, axis});
    const auto wrist = robot::wrist_point<double>(model.robot, tool, at);
    return std::atan2(wrist[1], wrist[0]);
  };
  return std::abs(yaw_of(axis_with(bend)) - yaw_of(pose.axis)) / kTurn;
}

TEST(PassJoints, SettleWhereARoundLeavesLessThanHalfOfATurnOfTheYaw) {
  const WristPath path(0.001);
  const PassTask task = path.task();
  const RobotPass pass = turning(path, 0.3, 0.5);
  int settled = 0, unsettled = 0;
  for (const double forearm : {0.9, 1.3, 2.2}) {
    for (const auto& [bend, roll] : {std::pair{0.6, 0.0}, {-0.8, 0.0}, {0.01, 0.7}, {0.01, 1.2}}) {
      for (double off_axis_mm = 20; off_axis_mm < 400; off_axis_mm += 10) {
        JointVector q = path.middle;
        q[robot::kYaw] = 0.2;
        q[robot::kShoulder] = std::acos(off_axis_mm / 700 - std::cos(forearm));
        q[robot::kElbow] = forearm - q[robot::kShoulder];
        q[robot::kBend] = bend;
        q[robot::kRoll] = roll;
        const double left = left_of_a_turn(path.model, q);
        if (std::abs(left - 0.5) < 0.02) continue;
        EXPECT_EQ(settles(task, pass, q), left < 0.5) << left;
        ++(left < 0.5 ? settled : unsettled);
      }
    }
  }
  EXPECT_GT(settled, 100);
  EXPECT_GT(unsettled, 30);
}

TEST(PassJoints, TakeTheTimeInTheMiddleOfEveryStep) {
  WristPath path(0.001);
  path.model.joints[robot::kRoll].limits.velocity = 0.1;
  const PassTask task = path.task();
  RobotPass pass = turning(path, 0, 1);
  pass.joint = {0, 0.2, 0.4, 0.5, 0.52, 0.52};  // it begins fast and comes to rest
  const double coarse = time_on_pass(task, pass, path.begin_joints, 20);
  const double fine = time_on_pass(task, pass, path.begin_joints, 500);
  EXPECT_GT(fine, 0.52 / 0.1);
  EXPECT_NEAR(coarse, fine, 0.01 * fine);
}

TEST(PassJoints, TakeTheTimeOfTheFeedWhereNoJointIsSlower) {
  WristPath path(0.001);
  for (JointSpec& joint : path.model.joints) {
    joint.limits.velocity = joint.limits.acceleration = joint.limits.jerk = 1e9;
  }
  const PassTask task = path.task();
  const RobotPass pass = turning(path, 0.4, 0.4);
  const double time = time_on_pass(task, pass, path.begin_joints, 8);
  EXPECT_NEAR(time, 10.0 / 50, 1e-6);
  path.span.feed_mm_per_s = 25;
  EXPECT_NEAR(time_on_pass(task, pass, path.begin_joints, 8), 2 * time, 1e-6);
  path.model.joints[robot::kRoll].limits.velocity = 0.1;
  const double turned = time_on_pass(task, turning(path, 0, 1), path.begin_joints, 8);
  EXPECT_GT(turned, 0.9 * 1 / 0.1) << "the roll turns by 1 rad";
}

}  // namespace
}  // namespace meridian::test::pass_joints
