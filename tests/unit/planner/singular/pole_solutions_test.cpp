// SPDX-License-Identifier: Apache-2.0

/// Which branch and winding a router takes at the pole, and what is left where one of them fails.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "support/keep_out_machine.hpp"
#include "support/machines.hpp"
#include "unit/planner/route/routed.hpp"

namespace meridian::test::pole_solutions {
namespace {

using router::cut;
using router::kRounding;
using router::Routed;

constexpr int kC = 3;

/// A router that stands on the pole, C at 0.
struct OnPole : Routed {
  explicit OnPole(const MachineModel& m) : Routed(m) { stand_at({{0, 0, 0}, Vector3::UnitZ()}); }
};

/// C may not turn from 0 to `side`, a sign, by more than half a radian.
MachineModel with_barred_turn(const MachineModel& machine, double side) {
  JointVector min{}, max{};
  min[kC] = side > 0 ? 0.5 : -0.6;
  max[kC] = side > 0 ? 0.6 : -0.5;
  return with_keep_out(machine, 1U << kC, min, max);
}

const ClBlock& away() {
  static const ClBlock block = cut({60, 0, 0}, tilted(0.3, 1.2));
  return block;
}

double turn_away(const MachineModel& machine) {
  OnPole one(machine);
  EXPECT_FALSE(is_fault(one.route(away())));
  return one.cursor.joints[kC];
}

TEST(PoleSolutions, AreTriedOneAfterTheOtherFromTheCheapestOn) {
  const double first = turn_away(bench_machine());
  OnPole barred(with_barred_turn(bench_machine(), first));
  const JointVector from = barred.cursor.joints;
  ASSERT_FALSE(is_fault(barred.route(away())));
  barred.expect_joined(from);
  EXPECT_LT(barred.away_from(away()), kRounding);
  EXPECT_NEAR(std::abs(barred.cursor.joints[kC]), std::numbers::pi - std::abs(first), kRounding);
  ASSERT_EQ(barred.paths().size(), 2U) << "nothing is left of the first one";
  EXPECT_EQ(barred.paths()[0].index, 0U);
}

TEST(PoleSolutions, ThatAllFailLeaveTheFaultOfTheCheapestAndNothingStaged) {
  const double first = turn_away(bench_machine());
  const MachineModel half = with_barred_turn(bench_machine(), first);
  OnPole barred(with_barred_turn(half, -first));
  const JointVector from = barred.cursor.joints;
  const PathFault fault = barred.route(away());
  EXPECT_EQ(fault.kind, PathFault::Kind::kKeepOut);
  EXPECT_EQ(fault.value, 0) << "the box that the cheapest meets";
  EXPECT_EQ(barred.staged->path_count, 0);
  EXPECT_EQ(barred.staged->time_count, 0);
  EXPECT_EQ(barred.cursor.joints, from);
}

TEST(PoleSolutions, OutsideTravelNameTheJointAndItsValue) {
  MachineModel model = bench_machine();
  model.joints[0].limits.travel_max = 100;
  OnPole one(model);
  const ClBlock far = cut({5000, 0, 0}, tilted(0.3, 1.2));
  const PathFault fault = one.route(far);
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  ASSERT_GE(fault.joint, 0);
  const ToolPose end{{5000, 0, 0}, tilted(0.3, 1.2)};
  const JointVector at = solve(model, model.tool_length_mm, end, 0, one.cursor.joints).q;
  EXPECT_EQ(fault.joint, first_joint_outside_travel(model, at, 0));
  EXPECT_NEAR(fault.value, at[static_cast<std::size_t>(fault.joint)], kRounding);
  EXPECT_EQ(one.staged->path_count, 0);
}

TEST(PoleSolutions, AreUnreachableWhereTheMachineKeepsOutOfTheBlocksEnd) {
  MachineModel model = bench_machine();
  model.tip_box = {true, {5000, 5000, 5000}, {5001, 5001, 5001}};
  OnPole one(model);
  const PathFault fault = one.route(away());
  EXPECT_EQ(fault.kind, PathFault::Kind::kUnreachable);
  EXPECT_EQ(fault.joint, -1) << "no joint is outside its travel";
}

/// A look-ahead in which routes carry farther where the redundant joint ends `above` a value.
struct Carried : PoleLookAhead {
  void ask(const Start& /*start*/, std::span<const RouteAhead> routes) noexcept override {
    found.assign(routes.begin(), routes.end());
    for (RouteAhead& route : found) route.carries = (route.free > above) == is_above ? 5 : 4;
  }
  [[nodiscard]] bool look() noexcept override { return true; }
  [[nodiscard]] std::span<const RouteAhead> routes() const noexcept override { return found; }
  [[nodiscard]] bool is_cut_short() const noexcept override { return false; }
  std::vector<RouteAhead> found;
  double above = 0;
  bool is_above = true;
};

TEST(PoleSolutions, RunThroughThePoleOnlyWhereThatCarriesFarthest) {
  const ClBlock block = cut({60, 0, 0}, Vector3(-0.2, 0.0005, 1).normalized());
  for (const bool is_through : {true, false}) {
    SCOPED_TRACE(is_through);
    Routed one(bench_machine());
    Carried carried;
    one.router.ask(&carried);
    one.router.set_pole_tolerance(0.001);
    one.stand_at({{0, 0, 0}, Vector3(0.2, 0.0005, 1).normalized()});
    const JointVector from = one.cursor.joints;
    carried.above = from[kC] + 0.1;  // straight through, C turns by 0.005
    carried.is_above = !is_through;
    ASSERT_FALSE(is_fault(one.route(block)));
    one.expect_joined(from);
    EXPECT_LT(one.away_from(block), kRounding);
    const double turn = one.cursor.joints[kC] - from[kC];
    EXPECT_NEAR(turn, is_through ? 0 : std::numbers::pi, 0.01);
    EXPECT_EQ(one.paths().size() == 1, is_through);
  }
}

/// Beside the pole, where C turns by more than a quarter on the branch in force, in one direction.
struct BesidePole {
  static constexpr double kFreeCone_rad = 0.002;

  explicit BesidePole(int windings = 0) {
    Routed free(model);
    free.stand_at(begin);
    const double from = free.cursor.joints[kC];
    EXPECT_FALSE(is_fault(free.route(block)));
    sense = free.cursor.joints[kC] > from ? 1 : -1;
    EXPECT_GT(sense * (free.cursor.joints[kC] - from), 2);
    near[kC] = from + sense * windings * kTurn_rad;
    at = near[kC];
  }
  /// C has 1 rad of travel left in the direction of the path, and `room` in the other.
  void set_travel(double room) {
    model.joints[kC].limits.travel_min = sense > 0 ? at - room : at - 1;
    model.joints[kC].limits.travel_max = sense > 0 ? at + 1 : at + room;
  }
  void stand(Routed& one) const {
    one.router.set_free_cone(kFreeCone_rad);
    one.stand_at(begin, 0, near);
    EXPECT_NEAR(one.cursor.joints[kC], at, kRounding);
  }

  MachineModel model = lai_machine();
  ToolPose begin{{0, 0, 0}, tilted(0.001, 0)};
  ClBlock block = cut({20, 0, 0}, tilted(0.3, 2.5));
  JointVector near{};
  double at = 0, sense = 1;
};

void expect_refused(Routed& one, const ClBlock& block) {
  const JointVector from = one.cursor.joints;
  const PathFault fault = one.route(block);
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel) << "of the branch in force";
  EXPECT_EQ(fault.joint, kC);
  EXPECT_EQ(one.staged->path_count, 0);
  EXPECT_EQ(one.cursor.joints, from);
  EXPECT_EQ(one.router.axis_deviation_rad(), 0) << "the axis stayed where it was programmed";
}

TEST(PoleSolutions, BesideThePoleTurnTheOtherWayAtRestWhereTravelEnds) {
  BesidePole beside;
  beside.set_travel(9);
  Routed turned(beside.model);
  beside.stand(turned);
  ASSERT_FALSE(is_fault(turned.route(beside.block)));
  const double end = turned.cursor.joints[kC];
  EXPECT_LT((end - beside.at) * beside.sense, 0) << "the other direction";
  EXPECT_LT(turned.away_from(beside.block), kRounding);
  EXPECT_NEAR(turned.router.axis_deviation_rad(), 0.001, 1e-9);

  JointVector min{}, max{};
  min[kC] = std::min(beside.at, end) + 0.3;
  max[kC] = min[kC] + 0.1;
  Routed barred(with_keep_out(beside.model, 1U << kC, min, max));
  beside.stand(barred);
  expect_refused(barred, beside.block);
}

TEST(PoleSolutions, BesideThePoleAreThoseThatCarryFarthest) {
  for (const bool is_far : {true, false}) {
    BesidePole beside;
    beside.set_travel(11);
    Routed one(beside.model);
    Carried carried;
    one.router.ask(&carried);
    beside.stand(one);
    carried.above = beside.at - beside.sense * 5;
    carried.is_above = is_far == (beside.sense < 0);
    ASSERT_FALSE(is_fault(one.route(beside.block)));
    EXPECT_EQ(std::abs(one.cursor.joints[kC] - beside.at) > 5, is_far);
    EXPECT_LT(one.away_from(beside.block), kRounding);
  }
}

TEST(PoleSolutions, BesideThePoleAreNoMoreThanFourTurnsAway) {
  BesidePole beside(6);
  beside.set_travel(50);
  // Tilted by 0.1 to 0.2 rad to either side it may not be, for five turns.
  for (const double side : {-1.0, 1.0}) {
    JointVector min{}, max{};
    min[kC] = std::min(beside.at + beside.sense, beside.at - beside.sense * 5 * kTurn_rad);
    max[kC] = std::max(beside.at + beside.sense, beside.at - beside.sense * 5 * kTurn_rad);
    min[4] = side > 0 ? 0.1 : -0.2;
    max[4] = side > 0 ? 0.2 : -0.1;
    beside.model = with_keep_out(beside.model, 1U << kC | 1U << 4, min, max);
  }
  Routed barred(beside.model);
  beside.stand(barred);
  expect_refused(barred, beside.block);
}

}  // namespace
}  // namespace meridian::test::pole_solutions
