// SPDX-License-Identifier: Apache-2.0

/// What a planner from rest to rest refuses, and that nothing of it moves.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"
#include "unit/planner/rest_to_rest_bench.hpp"

namespace meridian::test::rest_to_rest {
namespace {

TEST(RestToRest, RefusesAnUnknownTool) {
  Bench bench;
  ClBlock tool = block_of(BlockKind::kTool, 1);
  tool.value = 12;
  const PlanResult result = bench.plan_and_take(tool);
  EXPECT_EQ(result.status, PlanStatus::kRefused);
  EXPECT_EQ(result.reject.code, RejectCode::kUnknownTool);
  EXPECT_EQ(result.reject.value, 12);
  EXPECT_TRUE(bench.times.empty());
}

TEST(RestToRest, RefusesAWayThatLeavesTravelBetweenTwoLegalBlocks) {
  // The tip far out on the turning table swings b3 past its end between two blocks inside it.
  MachineModel narrow = lai_machine();
  const Vector3 tip(200, 0, 20);
  Bench wide(narrow);
  ASSERT_EQ(wide.plan(cut(0, tip, tilted(0.45, -0.6))).status, PlanStatus::kOk);
  const JointVector before = wide.planner.joints();
  ASSERT_EQ(wide.plan(cut(1, tip, tilted(0.45, 0.6))).status, PlanStatus::kOk);
  // The same way, with the end of travel put between the largest value at the ends and the one on
  // the way: refused, and nothing of it published.
  const double at_ends = std::max(before[0], wide.planner.joints()[0]);
  double between_ends = at_ends;
  for (double s = 0; s <= 1; s += 0.01) {
    const GreatCircle circle = find_great_circle(tilted(0.45, -0.6), tilted(0.45, 0.6));
    const Vector3 axis = axis_on_circle(circle.begin, circle.normal, s * circle.turn);
    const auto at = solve(narrow, narrow.tool_length_mm, ToolPose{tip, axis}, 0, before);
    between_ends = std::max(between_ends, at.q[0]);
  }
  ASSERT_GT(between_ends, at_ends + 1);
  narrow.joints[0].limits.travel_max = 0.5 * (between_ends + at_ends);
  Bench tight(narrow);
  ASSERT_EQ(tight.plan(cut(0, tip, tilted(0.45, -0.6))).status, PlanStatus::kOk);
  tight.forget();
  const PlanResult refused = tight.plan_and_take(cut(1, tip, tilted(0.45, 0.6)));
  EXPECT_EQ(refused.status, PlanStatus::kRefused);
  EXPECT_EQ(refused.reject.code, RejectCode::kTravelBetween);
  EXPECT_EQ(refused.reject.sequence, 1U);
  EXPECT_EQ(refused.reject.line, 101U);
  EXPECT_EQ(refused.reject.joint, 0);
  EXPECT_GT(refused.reject.value, narrow.joints[0].limits.travel_max);
  EXPECT_TRUE(tight.times.empty());
  // Nor does a later block move, though it could be reached.
  EXPECT_EQ(tight.plan_and_take(cut(2, tip, tilted(0.45, -0.6))).status, PlanStatus::kRefused);
  EXPECT_TRUE(tight.times.empty());
}

TEST(RestToRest, RefusesWhereTheTurnedTableRunsOutOfTravel) {
  Bench bench;  // C two turns each way
  PlanResult result;
  std::uint64_t n = 0;
  for (; n < 200 && result.status == PlanStatus::kOk; ++n) {
    result = bench.plan_and_take(cut(n, {20, 0, 20}, tilted(0.3, 0.5 * static_cast<double>(n))));
  }
  EXPECT_EQ(result.status, PlanStatus::kRefused);
  EXPECT_EQ(result.reject.joint, 3);
  EXPECT_GT(std::abs(result.reject.value), 4 * 3.14159);
  EXPECT_GT(n, 20U);
}

TEST(RestToRest, RefusesWhatIsNoBlock) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    ClBlock block;
    RejectCode code;
  };
  ClBlock no_feed = cut(1, {1, 0, 0}, tilted(0.3, 0), 0);
  ClBlock bad_tip = cut(1, {nan, 0, 0}, tilted(0.3, 0));
  ClBlock bad_axis = cut(1, {1, 0, 0}, {0, 0, 0});
  ClBlock reversed = cut(1, {1, 0, 0}, -tilted(0.3, 0));
  ClBlock bad_feed = cut(1, {1, 0, 0}, tilted(0.3, 0), nan);
  for (const Case& c :
       {Case{no_feed, RejectCode::kFeed}, Case{bad_tip, RejectCode::kNotFinite},
        Case{bad_axis, RejectCode::kNotFinite}, Case{reversed, RejectCode::kAxisReversal},
        Case{bad_feed, RejectCode::kNotFinite}}) {
    Bench bench;
    ASSERT_EQ(bench.plan(cut(0, {0, 0, 0}, tilted(0.3, 0))).status, PlanStatus::kOk);
    bench.forget();
    const PlanResult result = bench.plan_and_take(c.block);
    EXPECT_EQ(result.status, PlanStatus::kRefused);
    EXPECT_EQ(result.reject.code, c.code);
    EXPECT_TRUE(bench.times.empty());
  }
}

}  // namespace
}  // namespace meridian::test::rest_to_rest
