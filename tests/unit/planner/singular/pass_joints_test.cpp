// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pass_joints.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

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
