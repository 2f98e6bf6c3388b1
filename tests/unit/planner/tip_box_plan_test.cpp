// SPDX-License-Identifier: Apache-2.0

/// The tip box between the ends of blocks, from rest to rest.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "meridian/kinematics/tip_over_base.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "support/machines.hpp"
#include "unit/planner/rest_to_rest_bench.hpp"

namespace meridian::test::rest_to_rest {
namespace {

const Vector3 kAside(60, 0, 20);

[[nodiscard]] Array3 tip_of(const MachineModel& model, const JointVector& joints) {
  return tip_over_base(model, model.tool_length_mm, joints);
}

/// The tool turns about a tip that stands on the part, and the table with it: over the base the tip
/// goes to larger X and comes back.
TEST(TipBoxPlan, RefusesAWayOutOfTheBoxBetweenTwoBlocksThatEndInside) {
  const MachineModel open = lai_machine();
  const ClBlock first = cut(0, kAside, tilted(0.3, -0.8)),
                second = cut(1, kAside, tilted(0.3, 0.8));
  Bench free(open);
  ASSERT_EQ(free.plan(first).status, PlanStatus::kOk);
  const double from = tip_of(open, free.planner.joints())[0];
  free.forget();
  ASSERT_EQ(free.plan_and_take(second).status, PlanStatus::kOk);
  ASSERT_NEAR(tip_of(open, free.planner.joints())[0], from, 1e-9);
  ASSERT_GT(from, 10);
  for (const double room_mm : {1e-3, 0.1, 200.0}) {
    MachineModel machine = open;
    machine.tip_box = {true, {-1e3, -1e3, -1e3}, {from + room_mm, 1e3, 1e3}};
    Bench bench(machine);
    ASSERT_EQ(bench.plan(first).status, PlanStatus::kOk);
    bench.forget();
    const PlanResult result = bench.plan_and_take(second);
    if (room_mm > 100) {
      EXPECT_EQ(result.status, PlanStatus::kOk);
      continue;
    }
    ASSERT_EQ(result.status, PlanStatus::kRefused) << room_mm;
    EXPECT_EQ(result.reject.code, RejectCode::kTipBox);
    EXPECT_EQ(result.reject.joint, 0);
    EXPECT_EQ(result.reject.sequence, 1U);
    EXPECT_TRUE(bench.times.empty()) << "nothing of it moves";
  }
}

TEST(TipBoxPlan, ApproachesBelowACeilingThatIsLowerThanItsClearance) {
  MachineModel machine = lai_machine();
  Bench open(machine);
  ASSERT_EQ(open.plan_and_take(cut(0, kAside, tilted(0, 0))).status, PlanStatus::kOk);
  const double ceiling =
      std::max(tip_of(machine, open.start)[2], tip_of(machine, open.planner.joints())[2]) + 5;
  ASSERT_LT(5, machine.clearance_mm);
  machine.tip_box = {true, {-1e3, -1e3, -1e3}, {1e3, 1e3, ceiling}};
  Bench low(machine);
  EXPECT_EQ(low.plan_and_take(cut(0, kAside, tilted(0, 0))).status, PlanStatus::kOk);
  Approach approach;
  ASSERT_TRUE(low.planner.take_approach(approach));
  EXPECT_LT(approach.retract, machine.clearance_mm);
}

TEST(TipBoxPlan, RefusesABlockBeyondTheBoxOnEveryBranch) {
  MachineModel machine = lai_machine();
  machine.tip_box = {true, {-1e3, -1e3, -1e3}, {1e3, 1e3, 300}};
  Bench bench(machine);
  const PlanResult result = bench.plan_and_take(cut(0, {0, 0, 350}, tilted(0.3, 0)));
  ASSERT_EQ(result.status, PlanStatus::kRefused);
  EXPECT_EQ(result.reject.code, RejectCode::kTipBox);
  EXPECT_EQ(result.reject.joint, 2);
  EXPECT_NEAR(result.reject.value, 350, 1e-9);
}

/// Joints on cubics over a step: where a sample finds the tip outside, the check does too.
TEST(TipBoxPlan, MissesNoCellThatLeavesTheBox) {
  constexpr unsigned kSeed = 22074;
  constexpr double h = 0.5;
  std::mt19937_64 engine(kSeed);
  std::uniform_real_distribution<double> unit(-1, 1);
  MachineModel machine = lai_machine();
  int outside = 0, inside = 0;
  for (int draw = 0; draw < 20000; ++draw) {
    LimitedVector c[4]{};
    for (std::size_t i = 0; i < 5; ++i) {
      const double scale = machine.joints[i].is_rotary ? 0.02 : 1;
      for (int k = 0; k < 4; ++k) c[k][i] = scale * unit(engine);
    }
    c[0][4] = 0.8 * unit(engine);
    const auto at = [&c](double t) {
      JointVector q{};
      for (std::size_t i = 0; i < 5; ++i) {
        q[i] = c[0][i] + t * (c[1][i] + t * (c[2][i] / 2 + t * c[3][i] / 6));
      }
      return q;
    };
    const auto tip = [&](double t) { return tip_of(machine, at(t)); };
    const Array3 middle = tip(h / 2);
    const double half = 0.8 + 0.7 * unit(engine);
    machine.tip_box = {true, {}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      machine.tip_box.min[i] = middle[i] - half * (1.1 + unit(engine));
      machine.tip_box.max[i] = middle[i] + half * (1.1 + unit(engine));
    }
    bool leaves = false;
    for (int n = 0; n <= 200 && !leaves; ++n) {
      leaves = axis_outside(machine.tip_box, tip(h * n / 200)) >= 0;
    }
    LimitedVector end[4]{};
    const JointVector last = at(h);
    for (std::size_t i = 0; i < 5; ++i) {
      end[0][i] = last[i];
      end[1][i] = c[1][i] + h * (c[2][i] + h * c[3][i] / 2);
      end[2][i] = c[2][i] + h * c[3][i];
      end[3][i] = c[3][i];
    }
    const PathFault fault = check_tip_box(machine, machine.tool_length_mm, {c[0], c[1], c[2], c[3]},
                                          {end[0], end[1], end[2], end[3]}, h);
    ASSERT_TRUE(is_fault(fault) || !leaves) << "seed " << kSeed << ", draw " << draw;
    outside += leaves ? 1 : 0;
    inside += is_fault(fault) ? 0 : 1;
  }
  EXPECT_GT(outside, 2000);
  EXPECT_GT(inside, 2000);
}

}  // namespace
}  // namespace meridian::test::rest_to_rest
