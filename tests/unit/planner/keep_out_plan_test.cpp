// SPDX-License-Identifier: Apache-2.0

/// Keep-out boxes between the ends of blocks, from rest to rest.

#include <gtest/gtest.h>

#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"
#include "unit/planner/rest_to_rest_bench.hpp"

namespace meridian::test::rest_to_rest {
namespace {

const Vector3 kFrom(-60, 0, 20), kTo(60, 0, 20);

/// lai_machine() with a box about the joints in the middle of the cut from kFrom to kTo.
MachineModel machine_with_a_box_on_the_path(double half_mm) {
  MachineModel machine = lai_machine();
  Bench bench(machine);
  EXPECT_EQ(bench.plan(cut(0, kFrom, tilted(0.3, 0.2))).status, PlanStatus::kOk);
  EXPECT_EQ(bench.plan(cut(1, 0.5 * (kFrom + kTo), tilted(0.3, 0.2))).status, PlanStatus::kOk);
  KeepOutBox box;
  box.joints = 0b011;
  for (const std::size_t i : {0U, 1U}) {
    box.min[i] = bench.planner.joints()[i] - half_mm;
    box.max[i] = bench.planner.joints()[i] + half_mm;
  }
  EXPECT_TRUE(machine.keep_out.add(box));
  return machine;
}

TEST(KeepOutPlan, RefusesAWayThroughABoxBetweenTwoLegalBlocks) {
  for (const double half_mm : {1e-3, 0.1, 10.0}) {
    const MachineModel machine = machine_with_a_box_on_the_path(half_mm);
    Bench bench(machine);
    ASSERT_EQ(bench.plan(cut(0, kFrom, tilted(0.3, 0.2))).status, PlanStatus::kOk);
    bench.forget();
    const PlanResult refused = bench.plan_and_take(cut(1, kTo, tilted(0.3, 0.2)));
    ASSERT_EQ(refused.status, PlanStatus::kRefused) << half_mm;
    EXPECT_EQ(refused.reject.code, RejectCode::kKeepOut);
    EXPECT_EQ(refused.reject.sequence, 1U);
    EXPECT_EQ(refused.reject.value, 0);
    EXPECT_TRUE(bench.times.empty()) << "nothing of it moves";
  }
}

TEST(KeepOutPlan, PassesBesideABox) {
  MachineModel machine = machine_with_a_box_on_the_path(1.0);
  KeepOut beside;
  KeepOutBox box = machine.keep_out.boxes()[0];
  box.joints |= 0b100;  // b4 stays where it is: over the box
  box.min[2] = 300;
  box.max[2] = 400;
  ASSERT_TRUE(beside.add(box));
  machine.keep_out = beside;
  Bench bench(machine);
  ASSERT_EQ(bench.plan(cut(0, kFrom, tilted(0.3, 0.2))).status, PlanStatus::kOk);
  EXPECT_EQ(bench.plan(cut(1, kTo, tilted(0.3, 0.2))).status, PlanStatus::kOk);
}

TEST(KeepOutPlan, ApproachesPastAWallOnAnotherBranchAndIsRefusedBetweenTwo) {
  MachineModel machine = lai_machine();
  Bench open(machine);
  ASSERT_EQ(open.plan(cut(0, kTo, tilted(0.3, 0.2))).status, PlanStatus::kOk);
  const double there = open.planner.joints()[0];
  ASSERT_GT(std::abs(there), 10);
  for (const double side : {1.0, -1.0}) {  // the other branch has C half a turn on, and b3 across
    KeepOutBox wall;
    wall.joints = 0b001;
    wall.min[0] = side * 0.5 * there - 1;
    wall.max[0] = side * 0.5 * there + 1;
    ASSERT_TRUE(machine.keep_out.add(wall));
    Bench walled(machine);
    const PlanResult result = walled.plan_and_take(cut(0, kTo, tilted(0.3, 0.2)));
    if (side > 0) {
      ASSERT_EQ(result.status, PlanStatus::kOk);
      EXPECT_LT(walled.planner.joints()[0] * there, 0);
    } else {
      ASSERT_EQ(result.status, PlanStatus::kRefused);
      EXPECT_EQ(result.reject.code, RejectCode::kKeepOut);
      EXPECT_TRUE(walled.times.empty());
    }
  }
}

}  // namespace
}  // namespace meridian::test::rest_to_rest
