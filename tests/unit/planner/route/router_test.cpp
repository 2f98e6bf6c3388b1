// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/router.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "support/machines.hpp"
#include "unit/planner/route/routed.hpp"

namespace meridian::test::router {
namespace {

TEST(Router, BeginsWithNoMotionBlockBeforeIt) {
  const PlanCursor begin;
  EXPECT_TRUE(begin.is_first);
  EXPECT_FALSE(begin.has_retracted);
  EXPECT_FALSE(begin.relaxed_from);
  EXPECT_EQ(begin.cut_mm_per_s, 0);
}

TEST(Router, HoldsTheRedundantJointWhereTheAxisStandsStill) {
  Routed one(lai_machine());
  one.stand_at({{0, 0, 0}, tilted(0.3, 0.4)});
  const JointVector from = one.cursor.joints;
  const ClBlock block = cut({40, 10, -5}, tilted(0.3, 0.4));
  ASSERT_FALSE(is_fault(one.route(block)));
  one.expect_joined(from);
  EXPECT_LT(one.away_from(block), kRounding);
  EXPECT_EQ(one.cursor.pose.tip, to_vector(block.tip_mm));
  EXPECT_NEAR(one.cursor.joints[3], from[3], 1e-12);
  EXPECT_NEAR(one.cursor.joints[4], from[4], 1e-12);
  EXPECT_TRUE(one.paths()[0].is_free_driven) << "held, not solved for";
  EXPECT_EQ(one.router.axis_deviation_rad(), 0);
  EXPECT_EQ(one.paths()[0].motion, MotionKind::kCut);
  EXPECT_EQ(one.staged->times[0].feed_mm_per_s, 50);
}

TEST(Router, StaysOnTheBranchThatTheMachineStandsOn) {
  for (const int branch : {0, 1}) {
    Routed one(lai_machine());
    one.stand_at({{0, 0, 0}, tilted(0.3, 0.4)}, branch);
    const JointVector from = one.cursor.joints;
    const ClBlock block = cut({40, 10, -5}, tilted(0.5, 0.9));
    ASSERT_FALSE(is_fault(one.route(block)));
    one.expect_joined(from);
    EXPECT_LT(one.away_from(block), kRounding);
    EXPECT_EQ(one.paths()[0].branch, branch);
    EXPECT_EQ(std::signbit(one.cursor.joints[4]), std::signbit(from[4]));
    EXPECT_LE(tip_speed_of(*one.staged), 50);
  }
}

TEST(Router, KeepsToTheFeedOfTheMachineAndItsFactor) {
  MachineModel model = lai_machine();
  model.max_feed_mm_per_s = 90;
  Routed one(model);
  one.router.set_feed_factor(1.25);
  one.stand_at({{0, 0, 0}, tilted(0.3, 0.4)});
  ASSERT_FALSE(is_fault(one.route(cut({100, 0, 0}, tilted(0.3, 0.4), 60))));
  EXPECT_EQ(one.staged->times[0].feed_factor, 1.25);
  EXPECT_NEAR(tip_speed_of(*one.staged), 75, 0.01);
  ASSERT_FALSE(is_fault(one.route(cut({0, 0, 0}, tilted(0.3, 0.4), 80))));
  EXPECT_EQ(one.staged->times[0].feed_factor, 90.0 / 80);
  EXPECT_NEAR(tip_speed_of(*one.staged), 90, 0.01);
  ASSERT_FALSE(is_fault(one.route(cut({100, 0, 0}, tilted(0.3, 0.4), 200))));
  EXPECT_NEAR(tip_speed_of(*one.staged), 90, 0.01);
  EXPECT_EQ(one.cursor.cut_mm_per_s, 90);
}

TEST(Router, RunsARapidAsFastAsTheJointsAllow) {
  Routed one(lai_machine());
  one.router.set_feed_factor(1.25);
  one.stand_at({{0, 0, 0}, tilted(0.3, 0.4)});
  ASSERT_FALSE(is_fault(one.route(rapid({200, 0, 0}, tilted(0.3, 0.4)))));
  EXPECT_EQ(one.paths()[0].motion, MotionKind::kRapid);
  EXPECT_GT(tip_speed_of(*one.staged), 250);
  EXPECT_EQ(one.staged->times[0].feed_factor, 1);
  EXPECT_EQ(one.staged->times[0].feed_mm_per_s, 0);
  EXPECT_EQ(one.cursor.cut_mm_per_s, 0);
}

TEST(Router, TakesABlockInInverseTimeAsLongAsItSays) {
  Routed one(lai_machine());
  one.stand_at({{0, 0, 0}, tilted(0.3, 0.4)});
  ClBlock block = cut({60, 0, 0}, tilted(0.35, 0.5), 0.25);
  block.feed_meaning = FeedMeaning::kInverseTime;
  ASSERT_FALSE(is_fault(one.route(block)));
  EXPECT_GT(duration_of(*one.staged), 4);
  EXPECT_LT(duration_of(*one.staged), 4.2);
  EXPECT_NEAR(one.cursor.cut_mm_per_s, 15, 1e-6);
}

TEST(Router, FollowsAnArc) {
  Routed one(lai_machine());
  one.stand_at({{20, 0, 0}, tilted(0.3, 0.4)});
  ClBlock block = cut({0, 20, 0}, tilted(0.3, 0.4));
  block.is_arc = true;
  block.sweep_rad = std::numbers::pi / 2;
  ASSERT_FALSE(is_fault(one.route(block)));
  ASSERT_EQ(one.paths().size(), 1U);
  EXPECT_EQ(one.paths()[0].kind, PathKind::kArc);
  EXPECT_NEAR(one.paths()[0].length, 10 * std::numbers::pi, 1e-6);
  EXPECT_LT(one.away_from(block), 1e-6);
}

TEST(Router, StagesNothingWhereNothingMoves) {
  Routed one(lai_machine());
  one.stand_at({{20, 0, 0}, tilted(0.3, 0.4)});
  EXPECT_FALSE(is_fault(one.route(cut({20, 0, 0}, tilted(0.3, 0.4)))));
  EXPECT_EQ(one.staged->path_count, 0);
}

TEST(Router, KnowsWhatIsInReachAndTravel) {
  Routed one(lai_machine());
  one.stand_at({{0, 0, 0}, tilted(0.3, 0.4)});
  EXPECT_TRUE(one.router.is_reachable(cut({100, 0, 0}, tilted(0.5, 2)), one.cursor));
  EXPECT_FALSE(one.router.is_reachable(cut({100, 0, 0}, tilted(1.2, 2)), one.cursor))
      << "the tilt goes to 60 degrees";
  EXPECT_FALSE(one.router.is_reachable(cut({3000, 0, 0}, tilted(0.5, 2)), one.cursor));
  one.model.tip_box.is_set = true;
  one.model.tip_box.min = {-1e4, -1e4, -1e4};
  one.model.tip_box.max = {-1e3, 1e4, 1e4};
  EXPECT_FALSE(one.router.is_reachable(cut({100, 0, 0}, tilted(0.5, 2)), one.cursor));
}

TEST(Router, ReachesAWindingFourTurnsAwayEitherWayAndNoFarther) {
  for (const int turns : {-5, -4, 4, 5}) {
    Routed one(lai_machine());
    const Vector3 axis = tilted(0.5, 2);
    one.stand_at({{0, 0, 0}, axis});
    const ToolPose end{{100, 0, 0}, axis};
    const auto there = solve(one.model, one.cursor.tool_length_mm, end, 0, one.cursor.joints);
    JointLimits& limits = one.model.joints[3].limits;
    limits.travel_min = there.q[3] + turns * kTurn_rad - 0.1;
    limits.travel_max = limits.travel_min + 0.2;
    EXPECT_EQ(one.router.is_reachable(cut({100, 0, 0}, axis), one.cursor), std::abs(turns) == 4);
  }
}

TEST(Router, SaysWhichJointLeavesTravel) {
  Routed one(lai_machine());
  one.stand_at({{0, 0, 0}, tilted(0.3, 0.4)});
  const PathFault fault = one.route(cut({100, 0, 0}, tilted(1.2, 0.4)));
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(fault.joint, 4);
}

}  // namespace
}  // namespace meridian::test::router
