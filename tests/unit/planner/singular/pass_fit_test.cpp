// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/robot/pass_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "service/core/planner/singular/pole/pole_time.hpp"
#include "unit/planner/singular/wrist_path.hpp"

namespace meridian::test::pass_fit {
namespace {

using wrist_path::WristPath;

RobotPass pass_of(const WristPath& path, double begin, double end) {
  RobotPass pass;
  pass.at = SingularSet::kWrist;
  pass.begin = begin;
  pass.end = end;
  pass.branch_before = pass.branch_after = path.branch;
  return pass;
}

/// The roll of the exact way, with its derivatives by u.
Jet<2> exact_roll(const WristPath& path, double u, const JointVector& near) {
  return path.exact(u, near).q[robot::kRoll];
}

/// A pass past both singularities.
RobotPass pass_of_both(const WristPath& path, double begin, double end) {
  RobotPass pass = pass_of(path, begin, end);
  pass.at = SingularSet::kWristAndShoulder;
  return pass;
}

void expect_same_end(const Jet<3>& got, const Jet<2>& wanted) {
  EXPECT_NEAR(value_of(got), value_of(wanted), 1e-8);
  EXPECT_NEAR(got.derivative(1), wanted.derivative(1), 1e-7);
  EXPECT_NEAR(got.derivative(2), wanted.derivative(2), 1e-6);
}

TEST(PassFit, MeetsTheExactWayWithTwoDerivativesAtBothEnds) {
  const WristPath path(0.01);
  ASSERT_GE(path.branch, 0);
  const PassTask task = path.task();
  const PassRange range = path.range();
  PassFit fit(task, range);
  RobotPass pass = pass_of(path, 4, 17);
  ASSERT_TRUE(fit.fit(pass, 0));
  EXPECT_EQ(pass.rests_at_end, SingularSet::kNone);
  JointVector near = path.begin_joints;
  for (const double share : {0.0, 1.0}) {
    const Jet<3> got = free_at(pass.joint, share, 13);
    near[robot::kRoll] = value_of(got);
    const Jet<2> wanted = exact_roll(path, share > 0 ? 17 : 4, near);
    EXPECT_NEAR(value_of(got), value_of(wanted), 1e-9) << share;
    EXPECT_NEAR(got.derivative(1), wanted.derivative(1), 1e-8) << share;
    EXPECT_NEAR(got.derivative(2), wanted.derivative(2), 1e-7) << share;
  }
  EXPECT_NEAR(fit.reference()[robot::kRoll], pass.joint[0], 1e-9) << "joints at its begin";
}

TEST(PassFit, BeginsAtRestWhereTheJointStandsThere) {
  const WristPath path(0.01);
  const PassTask task = path.task();
  PassRange range = path.range();
  range.rests_at_from = SingularSet::kWrist;
  range.joints[robot::kRoll] = -0.3;
  PassFit fit(task, range);
  RobotPass pass = pass_of(path, 0, 15);
  ASSERT_TRUE(fit.fit(pass, 0));
  const Jet<3> begin = free_at(pass.joint, 0, 15);
  EXPECT_EQ(value_of(begin), -0.3) << "not where the exact way is";
  EXPECT_NEAR(begin.derivative(1), 0, 1e-12);
  EXPECT_NEAR(begin.derivative(2), 0, 1e-12);
}

TEST(PassFit, ComesToRestWhereItMayTurnedAsAsked) {
  const WristPath path(0.01);
  const PassTask task = path.task();
  PassRange range = path.range();
  range.rests_at_to = SingularSet::kWrist;
  PassFit fit(task, range);
  double straight = 0;
  for (const double turn : {0.0, 0.7, -0.7}) {
    RobotPass pass = pass_of(path, 5, 20);
    pass.branch_after ^= robot::kFlip;
    ASSERT_TRUE(fit.fit(pass, turn));
    EXPECT_EQ(pass.rests_at_end, SingularSet::kWrist);
    EXPECT_EQ(pass.branch_after, path.branch) << "at rest the wrist is not turned over";
    const Jet<3> end = free_at(pass.joint, 1, 15);
    EXPECT_NEAR(end.derivative(1), 0, 1e-12);
    EXPECT_NEAR(end.derivative(2), 0, 1e-12);
    if (turn == 0) straight = value_of(end);
    EXPECT_NEAR(value_of(end), straight + turn, 1e-12);
    EXPECT_TRUE(fit.leads_on(pass));
  }
}

TEST(PassFit, IsNoneBetweenPointsThatAreTheSame) {
  const WristPath path(0.01);
  const PassTask task = path.task();
  const PassRange range = path.range();
  PassFit fit(task, range);
  RobotPass pass = pass_of(path, 9, 9 + 1.5 * kSamePoint_mm);
  EXPECT_FALSE(fit.fit(pass, 0));
  pass.end = 9 + 3 * kSamePoint_mm;
  EXPECT_TRUE(fit.fit(pass, 0));
}

TEST(PassFit, IsNoneWhereTheRollOfTheExactWayTurnsTooSharplyToGuide) {
  const WristPath path(1e-7);
  const PassTask task = path.task();
  const PassRange range = path.range();
  PassFit fit(task, range);
  RobotPass pass = pass_of(path, 4, 10.00002);
  EXPECT_FALSE(fit.fit(pass, 0));
}

TEST(PassFit, LeadsOnWhereTheExactWayBehindItKeepsTravel) {
  WristPath path(0.01);
  const PassTask task = path.task();
  const PassRange range = path.range();
  PassFit fit(task, range);
  RobotPass pass = pass_of(path, 4, 13);
  ASSERT_TRUE(fit.fit(pass, 0));
  EXPECT_TRUE(fit.leads_on(pass));
  // The roll turns on behind the pass: just out of its travel.
  const double at_end = pass.joint.back();
  JointVector near = path.begin_joints;
  near[robot::kRoll] = at_end;
  const double last = value_of(exact_roll(path, 20, near));
  JointLimits& roll = path.model.joints[robot::kRoll].limits;
  const double edge = 0.5 * (at_end + last);
  (last > at_end ? roll.travel_max : roll.travel_min) = edge;
  EXPECT_FALSE(fit.leads_on(pass));
}

TEST(PassFit, LeadsOnFromTheWindingThatThePassEndsOn) {
  WristPath path(0.01);
  const PassTask task = path.task();
  const PassRange range = path.range();
  PassFit fit(task, range);
  RobotPass pass = pass_of(path, 4, 13);
  ASSERT_TRUE(fit.fit(pass, 0));
  const double begin = pass.joint.front(), end = pass.joint.back();
  JointLimits& roll = path.model.joints[robot::kRoll].limits;
  (end > begin ? roll.travel_max : roll.travel_min) = 0.5 * (begin + end);
  (end > begin ? roll.travel_min : roll.travel_max) = end > begin ? -10 : 10;
  ASSERT_TRUE(fit.fit(pass, 0));
  const double turn = end > begin ? -2 * std::numbers::pi : 2 * std::numbers::pi;
  EXPECT_NEAR(pass.joint.back(), end + turn, 1e-9);
  EXPECT_TRUE(fit.leads_on(pass));
}

TEST(PassFit, PastBothSingularitiesYawAndRollMeetTheExactWay) {
  const WristPath path = wrist_path::path_past_both(0.01, 0.6);
  ASSERT_GE(path.branch, 0);
  const PassTask task = path.task();
  for (const double end : {17.0, WristPath::kLength_mm}) {
    const PassRange range = path.range();
    PassFit fit(task, range);
    RobotPass pass = pass_of_both(path, 4, end);
    ASSERT_TRUE(fit.fit(pass, 0));
    EXPECT_EQ(pass.rests_at_end, SingularSet::kNone);
    JointVector near = path.begin_joints;
    for (const double share : {0.0, 1.0}) {
      const Jet<3> yaw = free_at(pass.joint, share, end - 4),
                   roll = free_at(pass.roll, share, end - 4);
      near[robot::kYaw] = value_of(yaw);
      near[robot::kRoll] = value_of(roll);
      const auto wanted = path.exact(share > 0 ? end : 4, near);
      expect_same_end(yaw, wanted.q[robot::kYaw]);
      expect_same_end(roll, wanted.q[robot::kRoll]);
    }
    EXPECT_TRUE(fit.leads_on(pass));
  }
}

TEST(PassFit, PastBothTheRollBeginsWhereItStandsWhereThePathBegins) {
  const WristPath path = wrist_path::path_past_both(0.01, 0.6);
  const PassTask task = path.task();
  PassRange range = path.range();
  range.joints[robot::kRoll] += 1e-7;
  PassFit fit(task, range);
  RobotPass pass = pass_of_both(path, 0, 17);
  ASSERT_TRUE(fit.fit(pass, 0));
  EXPECT_EQ(pass.roll.front(), range.joints[robot::kRoll]);
  range.rests_at_from = SingularSet::kWristAndShoulder;
  ASSERT_TRUE(fit.fit(pass, 0));
  EXPECT_EQ(pass.roll.front(), range.joints[robot::kRoll]);
  EXPECT_EQ(pass.joint.front(), range.joints[robot::kYaw]);
  for (const FreeQuintic& joint : {pass.joint, pass.roll}) {
    EXPECT_NEAR(free_at(joint, 0, 17).derivative(1), 0, 1e-12);
    EXPECT_NEAR(free_at(joint, 0, 17).derivative(2), 0, 1e-12);
  }
}

TEST(PassFit, PastBothTheRollRestsWhereTheWayEndsWithTheToolInLineWithTheForearm) {
  for (const double beside_rad :
       {1e-4, 1e-3}) {  // of a tolerance of 2e-3 a fifth counts as in line
    const WristPath path = wrist_path::path_past_both(beside_rad, 0.6);
    const PassTask task = path.task();
    PassRange range = path.range();
    range.to = 10;
    PassFit fit(task, range);
    RobotPass pass = pass_of_both(path, 4, 10);
    pass.branch_after = path.branch ^ (beside_rad < 2e-4 ? int{robot::kFlip} : 0);
    (void)fit.fit(pass, 0);
    const bool is_in_line = beside_rad < 2e-4;
    EXPECT_EQ(pass.rests_at_end, is_in_line ? SingularSet::kWrist : SingularSet::kNone);
    EXPECT_EQ(pass.branch_after, path.branch) << "at rest the wrist is not turned over";
    EXPECT_EQ(std::abs(free_at(pass.roll, 1, 6).derivative(1)) < 1e-12, is_in_line);
  }
}

TEST(PassFit, BeginsNoPassBesideBothButWhereThePathBegins) {
  const WristPath path = wrist_path::path_past_both(1e-3, 0.001);
  const PassTask task = path.task();
  PassRange range = path.range();
  PassFit fit(task, range);
  RobotPass pass = pass_of_both(path, 10, 17);
  range.rests_at_from = SingularSet::kWristAndShoulder;
  EXPECT_FALSE(fit.fit(pass, 0));
  range.from = 10;
  range.joints = path.middle;
  EXPECT_TRUE(fit.fit(pass, 0));
}

}  // namespace
}  // namespace meridian::test::pass_fit
