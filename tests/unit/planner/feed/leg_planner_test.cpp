// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/legs/leg_planner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/profile.hpp"
#include "support/machines.hpp"
#include "unit/planner/feed/planned_leg.hpp"

namespace meridian::test::leg_planner {
namespace {

Leg joint_move(const JointVector& begin, const JointVector& end) {
  Leg leg;
  leg.path = make_joint_move(begin, end, 0b11000);
  return leg;
}

TEST(LegPlanner, MovesOneJointByTheFastestMotionOfConstantBounds) {
  Planned one(bench_machine());
  const JointVector end{120, 0, 0, 0, 0, 0};
  ASSERT_FALSE(is_fault(one.plan(joint_move({}, end), {})));
  ASSERT_EQ(one.staged->path_count, 1);
  EXPECT_EQ(one.joints, end);
  const Profile best = rest_to_rest_with_reserve(120, {0.99 * 300, 0.99 * 3000, 0.99 * 60000});
  EXPECT_NEAR(duration_of(*one.staged), best.duration(), 2e-3 * best.duration());
  const JointUse use = use_of_motion(one.model, *one.staged);
  EXPECT_LE(use.worst(), 1);
  EXPECT_EQ(one.staged->paths[0].index, 100U);
  EXPECT_EQ(one.staged->times[0].window, 7U);
  EXPECT_TRUE(one.staged->times[0].is_from_rest);
}

TEST(LegPlanner, FollowsALineAwayFromThePoleInsideEveryLimit) {
  Planned one(lai_machine());
  const ToolPose begin = pose_of({0, 0, 0}, 0.3, 0.2), end = pose_of({60, 20, 10}, 0.6, 0.9);
  ASSERT_FALSE(is_fault(one.plan_line(begin, end, 80)));
  EXPECT_LE(use_of_motion(one.model, *one.staged).worst(), 1);
  EXPECT_LE(tip_speed_of(*one.staged), 80);
  EXPECT_GT(tip_speed_of(*one.staged), 79.8);
  const ToolPose got = forward(one.model, one.model.tool_length_mm, one.joints);
  EXPECT_NEAR((got.tip - end.tip).norm(), 0, 1e-9);
  EXPECT_NEAR(angle_between(got.axis, end.axis), 0, 1e-9);
  EXPECT_LE(use_of_stops(one.model, *one.staged, false).worst(), 1);
  EXPECT_LE(use_of_stops(one.model, *one.staged, true).worst(), 1);
  EXPECT_GT(use_of_stops(one.model, *one.staged, false).jerk, 0.9) << "a stop uses what there is";
}

TEST(LegPlanner, CutsALegThatPassesBesideThePole) {
  for (const double beside : {1e-2, 2e-3, 1e-4}) {
    SCOPED_TRACE(beside);
    Planned one(bench_machine());
    // The axis crosses from +x to -x, `beside` off the pole.
    const auto at = [&](double x, double lean) {
      return ToolPose{{x, 0, 0}, Vector3(lean, beside, 1).normalized()};
    };
    ASSERT_FALSE(is_fault(one.plan_line(at(0, 0.15), at(40, -0.15), 50)));
    EXPECT_LE(use_of_motion(one.model, *one.staged).worst(), 1);
    EXPECT_LE(tip_speed_of(*one.staged), 50);
    EXPECT_LE(use_of_stops(one.model, *one.staged, false).worst(), 1 + 1e-6);
    EXPECT_LE(use_of_stops(one.model, *one.staged, true).worst(), 1 + 1e-6);
    expect_joined(one);
    // C turns by nearly half a turn.
    EXPECT_NEAR(std::abs(one.joints[3] - one.start[3]), std::numbers::pi - 2 * beside / 0.15,
                0.02 * beside / 0.15 + 1e-3);
    // C turns at 60 deg/s at most: that is the least time.
    const double smallest = std::abs(one.joints[3] - one.start[3]) / units::rad_from_deg(60);
    EXPECT_LT(duration_of(*one.staged), 1.6 * smallest);
  }
}

TEST(LegPlanner, RunsInInverseTimeNoFasterThanItsShare) {
  Planned one(lai_machine());
  Leg leg;
  const ToolPose begin = pose_of({0, 0, 0}, 0.3, 0.2), end = pose_of({60, 20, 10}, 0.35, 0.3);
  leg.path = make_line(begin, end);
  leg.share_per_s = 0.4;
  ASSERT_FALSE(is_fault(one.plan(leg, solve(one.model, 110, begin, 0, {}).q)));
  double fastest = 0;
  for (int n = 0; n < one.staged->time_count; ++n) {
    const TimePiece& time = one.staged->times[n];
    for (int k = 0; k <= 4; ++k)
      fastest = std::max(fastest, state_at(time, k * time.duration / 4).ds);
  }
  EXPECT_LE(fastest, 0.4 * leg.path.length);
  EXPECT_GT(fastest, 0.399 * leg.path.length);
  EXPECT_GT(duration_of(*one.staged), 2.5);
}

TEST(LegPlanner, FindsNoMotionOutsideTravel) {
  Planned one(lai_machine());
  one.model.joints[0].limits.travel_max = 50;
  const PathFault fault = one.plan(joint_move({}, {120, 0, 0, 0, 0, 0}), {});
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(fault.joint, 0);
  EXPECT_EQ(one.joints, JointVector{});
  EXPECT_EQ(one.staged->time_count, 0);
}

TEST(LegPlanner, SeesATurningPointOutsideTravelBetweenTheEnds) {
  // Off the pole the tilt is smallest in the middle: both ends are inside.
  Planned one(lai_machine());
  one.model.joints[4].limits.travel_max = 1;
  const ToolPose begin = pose_of({0, 0, 0}, 0.4, 0.5), end = pose_of({5, 0, 0}, 0.4, -0.5);
  const JointVector from = solve(one.model, 110, begin, 0, {}).q;
  const double tilt = from[4];
  JointLimits& limits = one.model.joints[4].limits;
  (tilt > 0 ? limits.travel_min : limits.travel_max) = tilt - (tilt > 0 ? 1e-3 : -1e-3);
  const PathFault fault = one.plan_line(begin, end, 50);
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(fault.joint, 4);
}

TEST(LegPlanner, RefusesALegThatDoesNotBeginWhereTheMachineIs) {
  Planned one(lai_machine());
  Leg leg;
  const ToolPose begin = pose_of({0, 0, 0}, 0.3, 0.2), end = pose_of({20, 0, 0}, 0.3, 0.2);
  leg.path = make_line(begin, end);
  leg.feed_mm_per_s = 50;
  JointVector from = solve(one.model, 110, begin, 0, {}).q;
  from[1] += 1e-3;
  const PathFault fault = one.plan(leg, from);
  EXPECT_EQ(fault.kind, PathFault::Kind::kJump);
  EXPECT_EQ(fault.joint, 1);
}

TEST(LegPlanner, SaysWhereThereIsNoRoomForItsPieces) {
  Planned one(bench_machine());
  one.staged->path_count = static_cast<int>(one.staged->paths.size());
  const auto plan = [&one] { return one.plan(joint_move({}, {120, 0, 0, 0, 0, 0}), {}); };
  const PathFault of_paths = plan();
  one.staged->clear(0);
  one.staged->time_count = static_cast<int>(one.staged->times.size()) - 2;
  const PathFault of_times = plan();
  for (const PathFault& fault : {of_paths, of_times}) {
    EXPECT_EQ(fault.kind, PathFault::Kind::kTooLong);
    EXPECT_EQ(fault.joint, -1) << "no joint is at fault";
    EXPECT_EQ(fault.value, 0);
  }
}

/// Where jerk is low, joints change much of what they may use while acceleration still grows.
TEST(LegPlanner, GoesOnEvenlyWhereAPhaseIsCutWhileItsAccelerationChanges) {
  struct Case {
    double tilt, tilt_end, turn, length, feed;
  };
  MachineModel model = bench_machine();
  for (int i = 0; i < 5; ++i) {
    model.joints[i].limits.jerk *= 0.1;
    model.joints[i].limits.fault_jerk *= 0.1;
  }
  for (const Case& c : {Case{0.3, 0.2, 0.9, 200, 90}, {0.3, 0.45, 2, 20, 5}}) {
    Planned one(model);
    ASSERT_FALSE(is_fault(one.plan_line(pose_of({0, 0, 0}, c.tilt, 0),
                                        pose_of({c.length, 30, 0}, c.tilt_end, c.turn), c.feed)));
    EXPECT_LE(use_of_motion(one.model, *one.staged).worst(), 1);
    bool is_cut = false;
    for (int n = 1; n < one.staged->time_count; ++n) {
      const TimePiece &before = one.staged->times[n - 1], &time = one.staged->times[n];
      is_cut = is_cut || (time.j != 0 && time.j == before.j && time.stop_jerk != before.stop_jerk);
    }
    EXPECT_TRUE(is_cut);
  }
}

TEST(LegPlanner, ShapesTheFeedWhereTheJointsDoNotFollowEvenly) {
  // Close to the pole at its end: constant bounds would be those of the end all the way.
  Planned one(bench_machine());
  ASSERT_FALSE(
      is_fault(one.plan_line(pose_of({0, 0, 0}, 0.5, 0), pose_of({200, 30, 0}, 0.03, 0.9), 90)));
  EXPECT_LE(use_of_motion(one.model, *one.staged).worst(), 1);
  EXPECT_GT(tip_speed_of(*one.staged), 60);
  EXPECT_LE(use_of_stops(one.model, *one.staged, false).worst(), 1 + 1e-6);
}

TEST(LegPlanner, TurnsTheRedundantJointOnThePole) {
  Planned one(bench_machine());
  Leg leg;
  leg.path = make_turn(pose_of({0, 0, 0}, 0, 0), 0.2, 1.4);
  leg.path.is_free_driven = true;
  JointVector from = solve_held(one.model, 100, pose_of({0, 0, 0}, 0, 0), 0.2).q;
  ASSERT_FALSE(is_fault(one.plan(leg, from)));
  EXPECT_NEAR(one.joints[3], 1.4, 1e-12);
  EXPECT_LE(use_of_motion(one.model, *one.staged).worst(), 1);
  EXPECT_GT(use_of_motion(one.model, *one.staged).velocity, 0.85);
}

TEST(LegPlanner, KnowsThePoleThatIsNearest) {
  const MachineModel model = lai_machine();
  const Vector3 pole = pole_direction(model);
  EXPECT_EQ(find_nearest_pole(model, (pole + Vector3(0.2, 0.1, 0)).normalized()), pole);
  EXPECT_EQ(find_nearest_pole(model, (Vector3(0.2, 0.1, 0) - pole).normalized()), Vector3(-pole));
}

}  // namespace
}  // namespace meridian::test::leg_planner
