// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "service/core/planner/singular/robot/pass_joints.hpp"
#include "service/core/planner/singular/robot/robot_pass.hpp"
#include "unit/planner/singular/wrist_path.hpp"

/// Passes of a robot that begin or end at rest: where the path ends at the wrist singularity, and
/// where the machine stops inside the tolerance anyway.
namespace meridian::test::robot_pass_rest {
namespace {

using wrist_path::WristPath;

constexpr double kAxisTolerance_rad = 0.002, kTipTolerance_mm = 0.01;  // of WristPath::task()

/// Of the path from `from` to `to`, come to on the exact way.
PassRange range_of(const WristPath& path, double from, double to) {
  PassRange range = path.range();
  range.from = from;
  range.to = to;
  const auto at = path.exact(from, from > 9 ? path.middle : path.begin_joints);
  for (std::size_t i = 0; i < 6; ++i) range.joints[i] = value_of(at.q[i]);
  return range;
}

/// Where the bend goes on a pass, and how far the axis leaves the path.
struct Course {
  Course(const WristPath& path, const PassRange& range, const RobotPass& pass) {
    JointVector q = range.joints;
    for (int k = 0; k <= 400; ++k) {
      const double u = pass.begin + (pass.end - pass.begin) * k / 400;
      q = joints_on_pass(path.task(), pass, u, q).q;
      min_bend = std::min(min_bend, q[robot::kBend]);
      max_bend = std::max(max_bend, q[robot::kBend]);
      off_rad = std::max(off_rad, deviation_on_pass(path.task(), pass, u, q).axis_rad);
    }
  }
  double min_bend = 9, max_bend = -9, off_rad = 0;
};

/// The path ends behind the singularity, and the bend may hardly turn over: to either side.
struct OneSided : WristPath {
  explicit OneSided(double beside_rad) : WristPath(beside_rad) {
    JointLimits& bend = model.joints[robot::kBend].limits;
    (beside_rad > 0 ? bend.travel_min : bend.travel_max) = beside_rad > 0 ? -1e-6 : 1e-6;
  }
};

RobotPass pass_to_rest(const WristPath& path, double from) {
  PassRange range = range_of(path, from, 10.1);
  range.rests_at_to = SingularSet::kWrist;
  return find_robot_pass(path.task(), range);
}

TEST(RobotPassRest, TheRollTurnsToWhereTheBendMayRest) {
  for (const double beside_rad : {1e-5, -1e-5}) {
    const OneSided path(beside_rad);
    const WristPath free(beside_rad);
    const RobotPass pass = pass_to_rest(path, 9.9), straight = pass_to_rest(free, 9.9);
    ASSERT_GT(pass.end, pass.begin);
    EXPECT_EQ(pass.end, 10.1);
    EXPECT_EQ(pass.rests_at_end, SingularSet::kWrist);
    const double turn = pass.joint.back() - pass.joint.front();
    EXPECT_LT(std::abs(straight.joint.back() - straight.joint.front()), 0.1);
    EXPECT_GT(std::abs(turn), 1.5);
    EXPECT_LT(std::abs(turn), std::numbers::pi) << "the short way round";
    EXPECT_EQ(turn > 0, beside_rad < 0) << "to the side on which the path passes";
    const Course course(path, range_of(path, 9.9, 10.1), pass);
    EXPECT_GE(course.min_bend, beside_rad > 0 ? -1e-6 : -1);
    EXPECT_LE(course.max_bend, beside_rad > 0 ? 1 : 1e-6);
    EXPECT_LE(course.off_rad, kAxisTolerance_rad);
  }
}

TEST(RobotPassRest, ATurnThatFitsInNowhereElseEndsSoonerAndTheRollRestsOn) {
  const OneSided path(1e-5);
  const RobotPass pass = pass_to_rest(path, 9.97);
  ASSERT_GT(pass.end, 10);
  EXPECT_LT(pass.end, 10.1);
  EXPECT_EQ(pass.rests_at_end, SingularSet::kWrist);
  RobotPass rest = pass;
  std::tie(rest.begin, rest.end) = std::pair(pass.end, 10.1);
  rest.joint.fill(pass.joint.back());
  const Course course(path, range_of(path, 9.97, 10.1), rest);
  EXPECT_GE(course.min_bend, -1e-6);
  EXPECT_LE(course.off_rad, kAxisTolerance_rad);
}

TEST(RobotPassRest, IsNoneWhereTheBendMayRestNowhere) {
  OneSided path(1e-5);
  path.model.joints[robot::kBend].limits.travel_min = 1e-3;
  const RobotPass pass = pass_to_rest(path, 9.97);
  EXPECT_FALSE(pass.end > pass.begin);
}

TEST(RobotPassRest, ComesToRestInsideTheToleranceAndReportsTheDeviationThere) {
  for (const double to : {10.3, 10.58}) {
    const WristPath path(1e-3);
    PassRange range = range_of(path, 9.9, to);
    range.rests_at_to = SingularSet::kWrist;
    const RobotPass pass = find_robot_pass(path.task(), range);
    ASSERT_EQ(pass.rests_at_end, SingularSet::kWrist);
    const Course course(path, range, pass);
    EXPECT_LE(course.off_rad, kAxisTolerance_rad) << to;
    EXPECT_NEAR(pass.axis_deviation_rad, course.off_rad, 1e-3 * kAxisTolerance_rad) << to;
  }
}

TEST(RobotPassRest, WhereTheBendLeavesTravelAfterwardsEitherWayThereIsAPassAllTheSame) {
  WristPath path(1e-4);
  JointLimits& bend = path.model.joints[robot::kBend].limits;
  bend.travel_min = -0.02;
  bend.travel_max = 0.02;
  const PassRange range = range_of(path, 6, WristPath::kLength_mm);
  const RobotPass pass = find_robot_pass(path.task(), range);
  ASSERT_GT(pass.end, pass.begin);
  const Course course(path, range, pass);
  EXPECT_GE(course.min_bend, -0.02);
  EXPECT_LE(course.max_bend, 0.02);
  EXPECT_LE(course.off_rad, kAxisTolerance_rad);
}

TEST(RobotPassRest, ThePassIsTheOneAfterWhichTheBendStaysInsideTravel) {
  for (const bool may_turn_over : {false, true}) {
    WristPath path(1e-4);
    JointLimits& bend = path.model.joints[robot::kBend].limits;
    (may_turn_over ? bend.travel_max : bend.travel_min) = may_turn_over ? 0.02 : -0.02;
    const RobotPass pass = find_robot_pass(path.task(), range_of(path, 6, WristPath::kLength_mm));
    ASSERT_GT(pass.end, pass.begin);
    EXPECT_EQ(pass.branch_after, may_turn_over ? path.branch ^ robot::kFlip : path.branch);
  }
}

TEST(RobotPassRest, AnEndOfThePathInsideTheToleranceSparesAShortPassThatTurnsNextToStandstill) {
  for (const double beside_rad : {1e-4, 1.95e-3}) {
    for (const double to : {10.0, 10.003}) {
      SCOPED_TRACE(testing::Message() << beside_rad << " to " << to);
      const WristPath path(beside_rad);
      PassRange range = range_of(path, 0, to);
      const RobotPass turning = find_robot_pass(path.task(), range);
      EXPECT_LT(turning.end - turning.begin, kTipTolerance_mm);
      range.stops_at_to = SingularSet::kWrist;
      const RobotPass pass = find_robot_pass(path.task(), range);
      EXPECT_GT(pass.end - pass.begin, 1);
      EXPECT_EQ(pass.end, to);
      EXPECT_EQ(pass.rests_at_end, SingularSet::kWrist);
      EXPECT_EQ(pass.joint[4], pass.joint[5]) << "it comes to rest";
      EXPECT_LE(Course(path, range, pass).off_rad, kAxisTolerance_rad);
    }
  }
}

TEST(RobotPassRest, ABeginOfThePathInsideTheToleranceLetsTheRollStartFromRest) {
  for (const double beside_rad : {1e-6, 1e-5}) {
    SCOPED_TRACE(beside_rad);
    const WristPath path(beside_rad);
    PassRange range = range_of(path, 9.9995, WristPath::kLength_mm);
    const RobotPass turning = find_robot_pass(path.task(), range);
    EXPECT_LT(turning.end - turning.begin, kTipTolerance_mm);
    EXPECT_NE(turning.joint[1], turning.joint[0]);
    range.stops_at_from = SingularSet::kWrist;
    const RobotPass pass = find_robot_pass(path.task(), range);
    EXPECT_GT(pass.end - pass.begin, 1);
    EXPECT_EQ(pass.begin, range.from);
    EXPECT_EQ(pass.joint[0], range.joints[robot::kRoll]) << "as it stands";
    EXPECT_EQ(pass.joint[1], pass.joint[0]) << "at rest";
    EXPECT_EQ(pass.rests_at_end, SingularSet::kNone);
    EXPECT_LE(Course(path, range, pass).off_rad, kAxisTolerance_rad);
  }
}

TEST(RobotPassRest, AStopIsNoReasonToRestWhereAPassOnTheExactWayIsLong) {
  for (const double to : {10.02, 10.3}) {
    const WristPath path(1e-3);
    PassRange range = range_of(path, 0, to);
    const RobotPass plain = find_robot_pass(path.task(), range);
    range.stops_at_to = SingularSet::kWrist;
    const RobotPass pass = find_robot_pass(path.task(), range);
    EXPECT_EQ(pass.rests_at_end, SingularSet::kNone);
    EXPECT_EQ(pass.begin, plain.begin);
    EXPECT_EQ(pass.joint, plain.joint);
  }
}

}  // namespace
}  // namespace meridian::test::robot_pass_rest
