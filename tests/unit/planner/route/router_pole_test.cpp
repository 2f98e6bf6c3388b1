// SPDX-License-Identifier: Apache-2.0

/// How a router comes to the pole, leaves it and passes it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "support/machines.hpp"
#include "unit/planner/route/routed.hpp"

namespace meridian::test::router {
namespace {

TEST(Router, GoesToThePoleWithTheRedundantJointAtRest) {
  Routed one(bench_machine());
  one.stand_at({{0, 0, 0}, tilted(0.3, 0.4)});
  const JointVector from = one.cursor.joints;
  ASSERT_FALSE(is_fault(one.route(cut({40, 0, 0}, Vector3::UnitZ()))));
  one.expect_joined(from);
  EXPECT_EQ(one.cursor.joints[3], from[3]);
  EXPECT_NEAR(one.cursor.joints[4], 0, kRounding);
  EXPECT_NEAR(angle_between(one.reached().axis, Vector3::UnitZ()), 0, kRounding);
}

TEST(Router, TurnsTheRedundantJointOnThePoleAndThenLeavesIt) {
  Routed one(bench_machine());
  one.stand_at({{0, 0, 0}, tilted(0.3, 0)});
  ASSERT_FALSE(is_fault(one.route(cut({40, 0, 0}, Vector3::UnitZ()))));
  const JointVector on_pole = one.cursor.joints;
  const ClBlock block = cut({60, 0, 0}, tilted(0.3, 1.2));
  ASSERT_FALSE(is_fault(one.route(block)));
  one.expect_joined(on_pole);
  ASSERT_EQ(one.paths().size(), 2U);
  const PathPiece turn = one.paths()[0], answer = one.paths()[1];
  EXPECT_EQ(turn.kind, PathKind::kTurn);
  EXPECT_EQ(turn.motion, MotionKind::kPoleTurn);
  EXPECT_NEAR(std::abs(turn.free_end - turn.free_begin), 1.2, kRounding) << "the shorter way";
  EXPECT_TRUE(answer.is_free_driven);
  EXPECT_EQ(answer.free_begin, answer.free_end);
  EXPECT_LT(one.away_from(block), kRounding);
  EXPECT_LE(tip_speed_of(*one.staged), 50);
}

TEST(Router, LeavesThePoleWithoutATurnWhereTheAzimuthIsThatOfTheJoint) {
  Routed one(bench_machine());
  one.stand_at({{0, 0, 0}, tilted(0.3, 0)});
  ASSERT_FALSE(is_fault(one.route(cut({40, 0, 0}, Vector3::UnitZ()))));
  ASSERT_FALSE(is_fault(one.route(cut({60, 0, 0}, tilted(0.3, std::numbers::pi)))));
  EXPECT_EQ(one.paths().size(), 1U) << "out on the other branch";
  EXPECT_NEAR(one.cursor.joints[3], one.paths()[0].joints_begin[3], 1e-12);
}

/// What follows begins on the joints that its begin has, where slides show 1e-9 rad of C.
TEST(Router, LeavesThePoleOnTheJointsOfItsEndWhereATurnWouldBeTooLittle) {
  const MachineModel model = bench_machine();
  for (const double off : {-9e-10, 5e-10}) {
    Routed one(model);
    one.stand_at({{0, 0, 0}, tilted(0.3, 0)});
    ASSERT_FALSE(is_fault(one.route(cut({40, 0, 0}, Vector3::UnitZ()))));
    one.cursor.joints[3] += off;
    const ClBlock block = cut({60, 0, 0}, tilted(0.3, 0));
    ASSERT_FALSE(is_fault(one.route(block)));
    ASSERT_EQ(one.paths().size(), 1U) << "no turn";
    const ToolPose end{to_vector(block.tip_mm), to_vector(block.axis)};
    const JointVector& got = one.cursor.joints;
    const int branch = got[4] * solve(model, model.tool_length_mm, end, 0, got).q[4] > 0 ? 0 : 1;
    const JointVector wanted = solve(model, model.tool_length_mm, end, branch, got).q;
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(got[i], wanted[i], 1e-12) << i;
  }
}

TEST(Router, RunsThroughThePoleWhereItPassesInsideTheTolerance) {
  const Vector3 begin = Vector3(0.2, 0.0005, 1).normalized();
  const ClBlock block = cut({60, 0, 0}, Vector3(-0.2, 0.0005, 1).normalized());
  Routed through(bench_machine()), exact(bench_machine());
  through.router.set_pole_tolerance(0.001);
  for (Routed* one : {&through, &exact}) {
    one->stand_at({{0, 0, 0}, begin});
    const JointVector from = one->cursor.joints;
    ASSERT_FALSE(is_fault(one->route(block)));
    one->expect_joined(from);
    EXPECT_LT(one->away_from(block), kRounding);
    const double turn = std::abs(one->cursor.joints[3] - from[3]);
    EXPECT_NEAR(turn, one == &through ? 0.005 : std::numbers::pi - 0.005, 1e-4);
  }
  EXPECT_GT(through.router.axis_deviation_rad(), 1e-4);
  EXPECT_LE(through.router.axis_deviation_rad(), 0.001);
  EXPECT_EQ(exact.router.axis_deviation_rad(), 0);
  EXPECT_LT(duration_of(*through.staged), duration_of(*exact.staged) - 1);
}

TEST(Router, PassesOverThePoleItselfWhereNoStraightPassageIsInsideTravel) {
  MachineModel model = lai_machine();
  model.joints[4].limits.travel_min = -0.05;  // the other branch is outside
  Routed one(model);
  one.router.set_pole_tolerance(0.001);
  const Vector3 begin = Vector3(0.2, 0.0005, 1).normalized();
  one.stand_at({{0, 0, 0}, begin}, 0);
  if (one.cursor.joints[4] < 0) one.stand_at({{0, 0, 0}, begin}, 1);
  const JointVector from = one.cursor.joints;
  ASSERT_GT(from[4], 0);
  const ClBlock block = cut({60, 0, 0}, Vector3(-0.2, 0.0005, 1).normalized());
  ASSERT_FALSE(is_fault(one.route(block)));
  one.expect_joined(from);
  EXPECT_LT(one.away_from(block), kRounding);
  const auto paths = one.paths();
  const auto turn = std::find_if(paths.begin(), paths.end(), [](const PathPiece& path) {
    return path.kind == PathKind::kTurn;
  });
  ASSERT_NE(turn, paths.end());
  EXPECT_NEAR(turn->tip_begin[0], 30, 0.01) << "half of the way";
  EXPECT_NEAR(one.router.axis_deviation_rad(), 0.0005, 1e-6);
}

TEST(Router, TakesAxesNearThePoleForThePole) {
  Routed one(bench_machine());
  EXPECT_EQ(one.router.relaxed(tilted(0.01, 1), 0.009), tilted(0.01, 1));
  EXPECT_EQ(one.router.axis_deviation_rad(), 0);
  EXPECT_EQ(one.router.relaxed(tilted(0.01, 1), 0.011), Vector3::UnitZ());
  EXPECT_NEAR(one.router.axis_deviation_rad(), 0.01, 1e-9);
  one.stand_at({{0, 0, 0}, tilted(0.3, 0)});
  ASSERT_FALSE(is_fault(one.route(cut({40, 0, 0}, tilted(0.5 * kPoleDeviation_rad, 2)))));
  EXPECT_EQ(one.cursor.pose.axis, Vector3::UnitZ());
  EXPECT_NEAR(one.router.axis_deviation_rad(), 0.5 * kPoleDeviation_rad, 1e-9);
  ASSERT_TRUE(one.cursor.relaxed_from);
  ASSERT_FALSE(is_fault(one.route(cut({45, 0, 0}, tilted(0.3, 2)))));
  EXPECT_FALSE(one.cursor.relaxed_from);
  EXPECT_LT(one.router.axis_deviation_rad(), 1e-12) << "of each block by itself";
}

TEST(Router, TakesTheLegsOfABlockInInverseTimeTogetherAsLongAsItSays) {
  MachineModel model = lai_machine();
  model.joints[4].limits.travel_min = -0.05;  // no way but over the pole itself
  Routed one(model);
  const Vector3 begin = Vector3(0.2, 0, 1).normalized();
  one.stand_at({{0, 0, 0}, begin}, 0);
  if (one.cursor.joints[4] < 0) one.stand_at({{0, 0, 0}, begin}, 1);
  ClBlock block = cut({60, 0, 0}, Vector3(-0.2, 0, 1).normalized(), 0.1);
  block.feed_meaning = FeedMeaning::kInverseTime;
  ASSERT_FALSE(is_fault(one.route(block)));
  double moving = 0;
  for (int n = 0; n < one.staged->time_count; ++n) {
    const TimePiece& time = one.staged->times[n];
    if (one.staged->paths[time.path_index].kind != PathKind::kTurn) moving += time.duration;
  }
  EXPECT_GT(moving, 10);
  EXPECT_LT(moving, 10.5);
}

/// Where the redundant joint runs out of travel beside the pole, it may be turned at rest there.
TEST(Router, TurnsToAnotherBranchInsideTheFreeCone) {
  MachineModel model = lai_machine();
  Routed probe(model);
  const ToolPose begin{{0, 0, 0}, tilted(0.001, 0)};
  probe.stand_at(begin);
  const double at = probe.cursor.joints[3];
  const ClBlock block = cut({20, 0, 0}, tilted(0.3, 2.5));
  ASSERT_FALSE(is_fault(probe.route(block)));
  const double by = probe.cursor.joints[3] - at;
  ASSERT_GT(std::abs(by), 2);
  model.joints[3].limits.travel_min = by > 0 ? at - 4 : at - 1;
  model.joints[3].limits.travel_max = by > 0 ? at + 1 : at + 4;
  Routed refused(model), turned(model);
  turned.router.set_free_cone(0.002);
  refused.stand_at(begin);
  const PathFault fault = refused.route(block);
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(fault.joint, 3);
  turned.stand_at(begin);
  ASSERT_FALSE(is_fault(turned.route(block)));
  turned.expect_joined([&] {
    Routed again(model);
    again.stand_at(begin);
    return again.cursor.joints;
  }());
  EXPECT_EQ(turned.paths()[0].kind, PathKind::kTurn);
  EXPECT_LT(turned.away_from(block), kRounding);
  EXPECT_NEAR(turned.router.axis_deviation_rad(), 0.001, 1e-9);
}

/// One that answers what a test says.
struct Answers : PoleLookAhead {
  void ask(const Start& start, std::span<const RouteAhead> routes) noexcept override {
    asked = start;
    found.assign(routes.begin(), routes.end());
    for (RouteAhead& answer : found) {
      if ((answer.free > 0) == prefers_positive) answer.carries = 5;
    }
  }
  [[nodiscard]] bool look() noexcept override { return is_known; }
  [[nodiscard]] std::span<const RouteAhead> routes() const noexcept override { return found; }
  [[nodiscard]] bool is_cut_short() const noexcept override { return false; }
  Start asked;
  std::vector<RouteAhead> found;
  bool is_known = true, prefers_positive = true;
};

TEST(Router, LeavesThePoleByTheWayThatCarriesFarthest) {
  for (const bool prefers_positive : {true, false}) {
    Routed one(lai_machine());
    Answers answers;
    answers.prefers_positive = prefers_positive;
    one.router.ask(&answers);
    one.stand_at({{0, 0, 0}, tilted(0.3, 0)});
    ASSERT_FALSE(is_fault(one.route(cut({40, 0, 0}, Vector3::UnitZ()))));
    ASSERT_FALSE(is_fault(one.route(cut({60, 0, 0}, tilted(0.3, 1.2)))));
    EXPECT_EQ(answers.asked.sequence, 7U);
    EXPECT_FALSE(answers.asked.is_on_path);
    EXPECT_EQ(one.cursor.joints[3] > 0, prefers_positive);
    EXPECT_FALSE(one.router.needs_ahead());
    EXPECT_GT(answers.found.size(), 2U) << "both branches and several windings";
  }
}

TEST(Router, AsksOnceAboutEveryBranchAndWindingInsideTravel) {
  Routed one(lai_machine());
  Answers answers;
  one.router.ask(&answers);
  one.stand_at({{0, 0, 0}, Vector3::UnitZ()});
  const ToolPose end{{60, 0, 0}, tilted(0.3, 1.2)};
  const JointVector from = one.cursor.joints;
  ASSERT_FALSE(is_fault(one.route(cut(end.tip, end.axis))));
  std::vector<double> expected, asked;
  for (int branch = 0; branch < 2; ++branch) {
    const double free = solve(one.model, one.model.tool_length_mm, end, branch, from).q[3];
    for (int turns = -4; turns <= 4; ++turns) {
      const double wound = free + turns * kTurn_rad;
      if (std::abs(wound) <= 4 * std::numbers::pi) expected.push_back(wound);
    }
  }
  for (const RouteAhead& route : answers.found) asked.push_back(route.free);
  std::sort(expected.begin(), expected.end());
  std::sort(asked.begin(), asked.end());
  ASSERT_EQ(asked.size(), expected.size());
  EXPECT_EQ(asked.size(), 8U) << "two turns each way, on two branches";
  for (std::size_t n = 0; n < asked.size(); ++n) EXPECT_NEAR(asked[n], expected[n], kRounding);
}

TEST(Router, SaysThatItWaitsForBlocks) {
  Routed one(lai_machine());
  Answers answers;
  answers.is_known = false;
  one.router.ask(&answers);
  one.stand_at({{0, 0, 0}, tilted(0.3, 0)});
  ASSERT_FALSE(is_fault(one.route(cut({40, 0, 0}, Vector3::UnitZ()))));
  EXPECT_FALSE(one.router.needs_ahead());
  (void)one.route(cut({60, 0, 0}, tilted(0.3, 1.2)));
  EXPECT_TRUE(one.router.needs_ahead());
  (void)one.route(cut({70, 0, 0}, tilted(0.3, 1.2)));
  EXPECT_FALSE(one.router.needs_ahead());
}

}  // namespace
}  // namespace meridian::test::router
