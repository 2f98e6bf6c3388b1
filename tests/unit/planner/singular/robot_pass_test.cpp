// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/robot/robot_pass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meridian/geometry/great_circle.hpp"
#include "service/core/planner/singular/robot/pass_joints.hpp"
#include "unit/planner/singular/wrist_path.hpp"

namespace meridian::test::robot_pass {
namespace {

using wrist_path::WristPath;

constexpr double kAxisTolerance_rad = 0.002;  // of WristPath::task()

/// How far the roll goes on the exact way from end to end of `pass`.
double exact_turn(const WristPath& path, const RobotPass& pass) {
  JointVector q = path.begin_joints;
  double begin = 0;
  for (int k = 0; k <= 4000; ++k) {
    const double u = pass.begin + (pass.end - pass.begin) * k / 4000;
    q = solve(path.model, path.model.tool_length_mm, path.pose(u), path.branch, q).q;
    if (k == 0) begin = q[robot::kRoll];
  }
  return q[robot::kRoll] - begin;
}

TEST(RobotPass, LeadsStraightThroughTheWristWithTheBendTurnedOver) {
  const WristPath path(1e-4);
  const RobotPass pass = find_robot_pass(path.task(), path.range());
  EXPECT_LT(pass.begin, 10);
  EXPECT_GT(pass.end, 10);
  EXPECT_EQ(pass.at, SingularSet::kWrist);
  EXPECT_EQ(pass.branch_before, path.branch);
  EXPECT_EQ(pass.branch_after, path.branch ^ robot::kFlip);
  EXPECT_LT(std::abs(pass.joint.back() - pass.joint.front()), 0.2);
  EXPECT_GT(std::abs(exact_turn(path, pass)), 2.5) << "by nearly half a turn";
}

TEST(RobotPass, KeepsTheTipAndTheAxisInsideItsToleranceAndMeetsTheExactWay) {
  for (const double beside_rad : {1e-4, 1e-3, 0.01}) {
    SCOPED_TRACE(beside_rad);
    const WristPath path(beside_rad);
    const PassTask task = path.task();
    const RobotPass pass = find_robot_pass(task, path.range());
    ASSERT_GT(pass.end, pass.begin);
    JointVector q = path.begin_joints;
    double largest = 0;
    for (int k = 0; k <= 500; ++k) {
      const double u = pass.begin + (pass.end - pass.begin) * k / 500;
      q = joints_on_pass(task, pass, u, q).q;
      const ToolPose there = forward(path.model, path.model.tool_length_mm, q);
      EXPECT_NEAR((there.tip - path.pose(u).tip).norm(), 0, 1e-6);
      largest = std::max(largest, angle_between(there.axis, path.pose(u).axis));
      if (k > 0 && k < 500) continue;
      const int branch = k == 0 ? pass.branch_before : pass.branch_after;
      const auto exact = solve(path.model, path.model.tool_length_mm, path.pose(u), branch, q);
      for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(q[i], exact.q[i], 1e-5) << k << " " << i;
    }
    EXPECT_LE(largest, kAxisTolerance_rad);
    EXPECT_NEAR(pass.axis_deviation_rad, largest, 0.02 * kAxisTolerance_rad);
  }
}

TEST(RobotPass, PastTheWristFartherOffThanTheToleranceStaysOnItsSide) {
  const WristPath path(0.01);
  const RobotPass pass = find_robot_pass(path.task(), path.range());
  ASSERT_GT(pass.end, pass.begin);
  EXPECT_EQ(pass.branch_after, path.branch);
  EXPECT_NEAR(pass.joint.back() - pass.joint.front(), exact_turn(path, pass), 1e-5);
}

TEST(RobotPass, PastBothSingularitiesDrivesYawAndRollInsideBothTolerances) {
  const WristPath path = wrist_path::path_past_both(1e-4, 0.005);
  const PassTask task = path.task();
  const RobotPass pass = find_robot_pass(task, path.range());
  EXPECT_EQ(pass.at, SingularSet::kWristAndShoulder);
  ASSERT_GT(pass.end, pass.begin);
  JointVector q = path.begin_joints;
  for (int k = 0; k <= 300; ++k) {
    const double u = pass.begin + (pass.end - pass.begin) * k / 300;
    q = joints_on_pass(task, pass, u, q).q;
    const PassDeviation off = deviation_on_pass(task, pass, u, q);
    EXPECT_LE(off.axis_rad, kAxisTolerance_rad) << u;
    EXPECT_LE(off.tip_mm, task.tip_tolerance_mm) << u;
  }
}

TEST(RobotPass, EndsAtRestWhereItMay) {
  const WristPath path(1e-4);
  PassRange range = path.range();
  range.to = 10;
  range.rests_at_to = SingularSet::kWrist;
  const RobotPass pass = find_robot_pass(path.task(), range);
  EXPECT_EQ(pass.end, 10);
  EXPECT_EQ(pass.rests_at_end, SingularSet::kWrist);
  EXPECT_EQ(pass.branch_after, path.branch);
}

TEST(RobotPass, BeginsAtRestWithTheJointAsItStands) {
  const WristPath path(1e-4);
  PassRange range = path.range();
  range.from = 10;
  range.rests_at_from = SingularSet::kWrist;
  range.joints = path.middle;
  range.joints[robot::kRoll] += 0.3;
  const RobotPass pass = find_robot_pass(path.task(), range);
  ASSERT_GT(pass.end, pass.begin);
  EXPECT_EQ(pass.begin, 10);
  EXPECT_EQ(pass.joint.front(), range.joints[robot::kRoll]);
}

TEST(RobotPass, IsNoneWhereAnotherJointIsOutsideTravelThere) {
  WristPath path(1e-4);
  path.model.joints[robot::kElbow].limits.travel_max = path.middle[robot::kElbow] - 0.1;
  const RobotPass pass = find_robot_pass(path.task(), path.range());
  EXPECT_FALSE(pass.end > pass.begin);
}

}  // namespace
}  // namespace meridian::test::robot_pass
