// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pass_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "service/core/planner/singular/pole_time.hpp"
#include "unit/planner/singular/wrist_path.hpp"

namespace meridian::test::pass_fit {
namespace {

using wrist_path::WristPath;

PassRange range_of(const WristPath& path) {
  PassRange range;
  range.nearest = 10;
  range.to = WristPath::kLength_mm;
  range.branch = path.branch;
  range.joints = path.begin_joints;
  return range;
}

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
  const auto pose = pose_of<Jet<2>>(path.span, u);
  return solve(path.model, path.model.tool_length_mm, pose, path.branch, near).q[robot::kRoll];
}

TEST(PassFit, MeetsTheExactWayWithTwoDerivativesAtBothEnds) {
  const WristPath path(0.01);
  ASSERT_GE(path.branch, 0);
  const PassTask task = path.task();
  const PassRange range = range_of(path);
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
  PassRange range = range_of(path);
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
  PassRange range = range_of(path);
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
  const PassRange range = range_of(path);
  PassFit fit(task, range);
  RobotPass pass = pass_of(path, 9, 9 + 1.5 * kSamePoint_mm);
  EXPECT_FALSE(fit.fit(pass, 0));
  pass.end = 9 + 3 * kSamePoint_mm;
  EXPECT_TRUE(fit.fit(pass, 0));
}

TEST(PassFit, IsNoneWhereTheRollOfTheExactWayTurnsTooSharplyToGuide) {
  const WristPath path(1e-7);
  const PassTask task = path.task();
  const PassRange range = range_of(path);
  PassFit fit(task, range);
  RobotPass pass = pass_of(path, 4, 10.00002);
  EXPECT_FALSE(fit.fit(pass, 0));
}

TEST(PassFit, LeadsOnWhereTheExactWayBehindItKeepsTravel) {
  WristPath path(0.01);
  const PassTask task = path.task();
  const PassRange range = range_of(path);
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

}  // namespace
}  // namespace meridian::test::pass_fit
