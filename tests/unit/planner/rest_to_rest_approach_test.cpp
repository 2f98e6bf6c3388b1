// SPDX-License-Identifier: Apache-2.0

/// The way from where the machine stands to the first block, and what is done ahead of it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"
#include "unit/planner/rest_to_rest_bench.hpp"

namespace meridian::test::rest_to_rest {
namespace {

TEST(RestToRest, ApproachesTheFirstBlockUpAcrossAndDown) {
  Bench bench;
  const ToolPose from = forward(bench.model, bench.model.tool_length_mm, bench.start);
  ASSERT_EQ(bench.plan_and_take(cut(0, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  ASSERT_EQ(bench.paths.back().index, 2U);
  const PathPiece& up = bench.paths.front();
  EXPECT_EQ(up.kind, PathKind::kLine);
  EXPECT_NEAR(to_vector(up.tip_delta).dot(from.axis), bench.model.clearance_mm, 1e-9);
  const PathPiece& down = bench.paths.back();
  EXPECT_NEAR(down.length, bench.model.clearance_mm, 1e-9);
  for (const PathPiece& path : bench.paths) EXPECT_EQ(path.motion, MotionKind::kApproach);
  EXPECT_EQ(bench.times.back().feed_mm_per_s, bench.model.approach_feed_mm_per_s);
  const ToolPose at = forward(bench.model, bench.model.tool_length_mm, bench.planner.joints());
  EXPECT_LT((at.tip - Vector3(50, 0, 20)).norm(), 1e-9);
  EXPECT_LT(angle_between(at.axis, tilted(0.3, 1)), 1e-12);
}

TEST(RestToRest, DeclaresTheApproachOnceWhenItIsPublished) {
  Bench bench;
  Approach approach;
  EXPECT_FALSE(bench.planner.take_approach(approach));
  ASSERT_EQ(bench.plan(block_of(BlockKind::kDwell, 0)).status, PlanStatus::kOk);
  EXPECT_FALSE(bench.planner.take_approach(approach));
  bench.forget();
  ASSERT_EQ(bench.plan_and_take(cut(1, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  ASSERT_TRUE(bench.planner.take_approach(approach));
  EXPECT_TRUE(approach.is_planned);
  EXPECT_EQ(approach.sequence, 1U);
  EXPECT_EQ(approach.line, 101U);
  EXPECT_EQ(approach.from, bench.start);
  const PathPiece& last = bench.paths.back();
  EXPECT_EQ(approach.branch, last.branch);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(approach.to[i], last.joints_end[i], 1e-9) << i;
  EXPECT_EQ(approach.retract, bench.model.clearance_mm);
  EXPECT_EQ(approach.descent, bench.model.clearance_mm);
  double length = 0;
  for (std::size_t i = 0; i < bench.paths.size(); ++i) {
    const bool is_new = i == 0 || bench.paths[i].index != bench.paths[i - 1].index;
    if (is_new) length += bench.paths[i].length;
  }
  EXPECT_NEAR(approach.length, length, 1e-9);
  EXPECT_NEAR(approach.time, bench.duration(), 1e-9);
  EXPECT_FALSE(bench.planner.take_approach(approach));
  ASSERT_EQ(bench.plan(cut(2, {60, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  EXPECT_FALSE(bench.planner.take_approach(approach)) << "one for a program";
}

TEST(RestToRest, RetractsOnlyAsFarAsTravelAllows) {
  MachineModel model = lai_machine();
  model.joints[2].limits.travel_min = -40;  // b4 rises towards minus
  Bench bench(model);
  ASSERT_EQ(bench.plan_and_take(cut(0, {50, 0, 180}, tilted(0, 0))).status, PlanStatus::kOk);
  for (const PathPiece& path : bench.paths) {
    EXPECT_GE(std::min(path.joints_begin[2], path.joints_end[2]), -40 - 1e-9);
  }
  EXPECT_NEAR(bench.paths.front().joints_end[2], -40, 1e-9);
}

TEST(RestToRest, HasNothingToApproachWhereItStandsAlready) {
  Bench bench;
  const ToolPose here = forward(bench.model, bench.model.tool_length_mm, bench.start);
  ASSERT_EQ(bench.plan_and_take(cut(0, here.tip, here.axis)).status, PlanStatus::kOk);
  EXPECT_LT(bench.duration(), 1e-3);
}

/// Tool and spindle of a program that begins in its middle, ahead of its first motion.
TEST(RestToRest, LeavesThePartBeforeTheFirstActionOfAProgramThatMayBeginInIt) {
  Bench bench(lai_machine(), ToolTable({{7, 95, 5}}));
  bench.planner.begin(bench.start, bench.model.tool_length_mm, 1, true);
  bench.reader.set_epoch(1);
  const ToolPose from = forward(bench.model, bench.model.tool_length_mm, bench.start);
  ClBlock tool = block_of(BlockKind::kTool, 0);
  tool.value = 7;
  ASSERT_EQ(bench.plan_and_take(tool).status, PlanStatus::kOk);
  ASSERT_FALSE(bench.times.empty());
  EXPECT_EQ(bench.times.front().kind, TimeKind::kMove);
  EXPECT_EQ(bench.times.back().kind, TimeKind::kAction);
  EXPECT_LT(bench.times.front().window, bench.times.back().window);
  const PathPiece up = bench.paths.front();
  EXPECT_EQ(up.motion, MotionKind::kApproach);
  EXPECT_NEAR(to_vector(up.tip_delta).dot(from.axis), bench.model.clearance_mm, 1e-9);
  const JointVector over = bench.planner.joints();
  const double lift_time = bench.duration();

  bench.forget();
  ASSERT_EQ(bench.plan_and_take(block_of(BlockKind::kAuxiliary, 1)).status, PlanStatus::kOk);
  EXPECT_EQ(bench.times.size(), 1U) << "once is enough";
  ASSERT_EQ(bench.plan_and_take(cut(2, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  const auto first = std::find_if(bench.paths.begin(), bench.paths.end(),
                                  [](const PathPiece& path) { return path.length > 0; });
  ASSERT_NE(first, bench.paths.end());
  EXPECT_EQ(first->kind, PathKind::kJoint) << "it is off the part already";
  EXPECT_EQ(first->joints_begin, over);

  Approach approach;
  ASSERT_TRUE(bench.planner.take_approach(approach));
  EXPECT_EQ(approach.from, bench.start);
  EXPECT_TRUE(approach.has_rest);
  EXPECT_EQ(approach.retract, bench.model.clearance_mm);
  EXPECT_EQ(approach.descent, bench.model.clearance_mm);
  EXPECT_NEAR(approach.time, lift_time + bench.duration(), 1e-9);
}

/// A tool that is longer than the one that broke in the cut, changed where the retraction ended.
struct LongerTool {
  explicit LongerTool(const MachineModel& machine)
      : bench(machine, ToolTable({{8, kLonger_mm, 5}})) {
    bench.planner.begin(bench.start, bench.model.tool_length_mm, 1, true);
    bench.reader.set_epoch(1);
    ClBlock tool = block_of(BlockKind::kTool, 0);
    tool.value = 8;
    EXPECT_EQ(bench.plan_and_take(tool).status, PlanStatus::kOk);
    over = bench.planner.joints();
    bench.forget();
  }
  /// How far the tip is above where the old one stood.
  [[nodiscard]] double above(const JointVector& joints) const {
    const ToolPose from = forward(bench.model, bench.model.tool_length_mm, bench.start);
    return (forward(bench.model, kLonger_mm, joints).tip - from.tip).dot(from.axis);
  }

  static constexpr double kLonger_mm = 110 + 70;
  Bench bench;
  JointVector over;
};

TEST(RestToRest, LiftsALongerToolOffThePartBeforeJointsMove) {
  ASSERT_EQ(lai_machine().tool_length_mm, 110);
  LongerTool longer(lai_machine());
  Bench& bench = longer.bench;
  EXPECT_NEAR(longer.above(longer.over), bench.model.clearance_mm - 70, 1e-9) << "in the part";
  ASSERT_EQ(bench.plan_and_take(cut(1, {50, 0, 20}, tilted(0.3, 1))).status, PlanStatus::kOk);
  const auto move = std::find_if(bench.paths.begin(), bench.paths.end(), [](const PathPiece& path) {
    return path.kind == PathKind::kJoint;
  });
  ASSERT_NE(move, bench.paths.end());
  EXPECT_NEAR(longer.above(move->joints_begin), bench.model.clearance_mm, 1e-6);
  Approach approach;
  ASSERT_TRUE(bench.planner.take_approach(approach));
  EXPECT_NEAR(approach.lift, 70, 1e-9);
}

TEST(RestToRest, RefusesAProgramWhoseLongerToolCannotLeaveThePart) {
  const LongerTool free(lai_machine());
  const auto at =
      solve(free.bench.model, LongerTool::kLonger_mm,
            ToolPose{forward(free.bench.model, LongerTool::kLonger_mm, free.over).tip +
                         60 * forward(free.bench.model, LongerTool::kLonger_mm, free.over).axis,
                     forward(free.bench.model, LongerTool::kLonger_mm, free.over).axis},
            0, free.over);
  MachineModel narrow = lai_machine();
  int joint = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(at.q[i] - free.over[i]) > std::abs(at.q[joint] - free.over[joint])) joint = i;
  }
  JointLimits& limits = narrow.joints[joint].limits;
  (at.q[joint] > free.over[joint] ? limits.travel_max : limits.travel_min) = at.q[joint];
  LongerTool longer(narrow);
  const PlanResult result = longer.bench.plan_and_take(cut(1, {50, 0, 20}, tilted(0.3, 1)));
  EXPECT_EQ(result.status, PlanStatus::kRefused);
  EXPECT_EQ(result.reject.code, RejectCode::kApproach);
  EXPECT_EQ(result.reject.joint, joint);
  EXPECT_TRUE(longer.bench.times.empty());
}

TEST(RestToRest, DoesTheFirstActionsOfAnyOtherProgramWhereTheMachineStands) {
  Bench bench;
  ASSERT_EQ(bench.plan_and_take(block_of(BlockKind::kAuxiliary, 0)).status, PlanStatus::kOk);
  EXPECT_EQ(bench.times.size(), 1U);
  EXPECT_EQ(bench.times.front().kind, TimeKind::kAction);
}

}  // namespace
}  // namespace meridian::test::rest_to_rest
