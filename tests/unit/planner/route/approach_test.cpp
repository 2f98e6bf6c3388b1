// SPDX-License-Identifier: Apache-2.0

/// How a router comes to the first block of a program.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/kinematics/winding.hpp"
#include "support/machines.hpp"
#include "unit/planner/route/approached.hpp"

namespace meridian::test::approach {
namespace {

TEST(Approach, LeadsOffThePartAcrossAndDownAtApproachFeed) {
  Approached one(lai_machine());
  const ClBlock block = cut({80, 20, 10}, tilted(0.2, 2));
  ASSERT_FALSE(is_fault(one.router.approach(block, one.cursor, *one.staged)));
  const auto paths = one.paths();
  ASSERT_EQ(paths.size(), 3U);
  EXPECT_NEAR((to_vector(paths[0].tip_delta) - 50 * tilted(0.3, 0.4)).norm(), 0, kRounding);
  EXPECT_EQ(paths[1].kind, PathKind::kJoint);
  EXPECT_NEAR((to_vector(paths[2].tip_delta) + 50 * tilted(0.2, 2)).norm(), 0, kRounding);
  JointVector before = one.start;
  for (const PathPiece& path : paths) {
    EXPECT_EQ(path.motion, MotionKind::kApproach);
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(path.joints_begin[i], before[i], 1e-9);
    before = path.joints_end;
  }
  EXPECT_LT(one.away_from(block), kRounding);
  EXPECT_EQ(one.cursor.pose.tip, to_vector(block.tip_mm));
  const TimePiece &first = one.staged->times[0],
                  &last = one.staged->times[one.staged->time_count - 1];
  EXPECT_EQ(first.feed_mm_per_s, 0);
  EXPECT_EQ(last.feed_mm_per_s, one.model.approach_feed_mm_per_s);
}

TEST(Approach, IsDescribed) {
  Approached one(lai_machine());
  const ClBlock block = cut({80, 20, 10}, tilted(0.2, 2));
  ASSERT_FALSE(is_fault(one.router.approach(block, one.cursor, *one.staged)));
  const Approach& planned = one.router.last_approach();
  EXPECT_TRUE(planned.is_planned);
  EXPECT_FALSE(planned.has_rest);
  EXPECT_EQ(planned.epoch, 3);
  EXPECT_EQ(planned.sequence, 7U);
  EXPECT_EQ(planned.line, 107U);
  EXPECT_EQ(planned.from, one.start);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(planned.to[i], one.cursor.joints[i], 1e-9);
  EXPECT_NEAR(planned.retract, 50, kRounding);
  EXPECT_NEAR(planned.descent, 50, kRounding);
  EXPECT_EQ(planned.lift, 0);
  EXPECT_NEAR(planned.length, one.length(), kRounding);
  EXPECT_NEAR(planned.time, duration_of(*one.staged), kRounding);
  const auto on_branch = solve(one.model, 110, one.cursor.pose, planned.branch, planned.to);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(on_branch.q[i], planned.to[i], 1e-9);
}

TEST(Approach, MovesTheJointsAloneWhereItIsNearby) {
  Approached one(lai_machine());
  const ClBlock block = cut({0.0005, 0, 0}, tilted(0.3, 0.4));
  ASSERT_FALSE(is_fault(one.router.approach(block, one.cursor, *one.staged)));
  ASSERT_EQ(one.paths().size(), 1U);
  EXPECT_EQ(one.paths()[0].kind, PathKind::kJoint);
  EXPECT_EQ(one.router.last_approach().retract, 0);
  EXPECT_EQ(one.router.last_approach().descent, 0);
}

TEST(Approach, RetractsAsFarAsTravelAllows) {
  MachineModel model = lai_machine();
  Approached probe(model);
  ASSERT_FALSE(is_fault(
      probe.router.approach(cut({80, 20, 10}, tilted(0.2, 2)), probe.cursor, *probe.staged)));
  const PathPiece up = probe.paths()[0];
  for (int i = 0; i < 3; ++i) {
    MachineModel narrow = model;
    const double by = up.joints_end[i] - up.joints_begin[i];
    if (std::abs(by) < 1) continue;
    JointLimits& limits = narrow.joints[i].limits;
    (by > 0 ? limits.travel_max : limits.travel_min) = up.joints_begin[i] + 0.4 * by;
    Approached one(narrow);
    const PathFault fault =
        one.router.retract(cut({0, 0, 0}, tilted(0.3, 0.4)), one.cursor, *one.staged);
    ASSERT_FALSE(is_fault(fault));
    ASSERT_EQ(one.paths().size(), 1U);
    EXPECT_NEAR(one.paths()[0].length, 20, 1e-6) << "joint " << i;
    EXPECT_NEAR(one.cursor.joints[i], up.joints_begin[i] + 0.4 * by, 1e-6);
  }
}

TEST(Approach, RetractsAsFarAsTheTipBoxAllows) {
  MachineModel model = lai_machine();
  Approached probe(model, {{0, 0, 0}, Vector3::UnitZ()});
  const Array3 from = tip_over_base(model, model.tool_length_mm, probe.start);
  ASSERT_FALSE(is_fault(
      probe.router.retract(cut({0, 0, 0}, Vector3::UnitZ()), probe.cursor, *probe.staged)));
  const Array3 to = tip_over_base(model, model.tool_length_mm, probe.cursor.joints);
  model.tip_box.is_set = true;
  for (std::size_t i = 0; i < 3; ++i) {
    model.tip_box.min[i] = std::min(from[i], from[i] + 0.3 * (to[i] - from[i])) - 1e-9;
    model.tip_box.max[i] = std::max(from[i], from[i] + 0.3 * (to[i] - from[i])) + 1e-9;
  }
  Approached one(model, {{0, 0, 0}, Vector3::UnitZ()});
  ASSERT_FALSE(
      is_fault(one.router.retract(cut({0, 0, 0}, Vector3::UnitZ()), one.cursor, *one.staged)));
  ASSERT_EQ(one.paths().size(), 1U);
  EXPECT_NEAR(one.paths()[0].length, 15, 1e-5);
}

TEST(Approach, GoesOnFromWhereTheToolWasRetracted) {
  Approached one(lai_machine());
  const ClBlock tool = cut({0, 0, 0}, tilted(0.3, 0.4)), block = cut({80, 20, 10}, tilted(0.2, 2));
  ASSERT_FALSE(is_fault(one.router.retract(tool, one.cursor, *one.staged)));
  EXPECT_TRUE(one.cursor.has_retracted);
  EXPECT_NEAR((one.cursor.pose.tip - 50 * tilted(0.3, 0.4)).norm(), 0, kRounding);
  const double up_s = duration_of(*one.staged);
  EXPECT_LT(up_s, 0.9) << "by a rapid";
  EXPECT_EQ(one.staged->times[0].feed_mm_per_s, 0);
  ASSERT_FALSE(is_fault(one.router.approach(block, one.cursor, *one.staged)));
  ASSERT_EQ(one.paths().size(), 3U) << "up once";
  EXPECT_EQ(one.paths()[1].kind, PathKind::kJoint);
  const Approach& planned = one.router.last_approach();
  EXPECT_TRUE(planned.has_rest);
  EXPECT_EQ(planned.from, one.start);
  EXPECT_NEAR(planned.retract, 50, kRounding);
  EXPECT_EQ(planned.lift, 0);
  EXPECT_NEAR(planned.length, one.length(), kRounding);
  EXPECT_NEAR(planned.time, duration_of(*one.staged), kRounding);
  EXPECT_GT(planned.time, up_s);
}

TEST(Approach, LiftsAToolThatIsLongerAsFarAsTheOther) {
  Approached one(lai_machine());
  const ClBlock tool = cut({0, 0, 0}, tilted(0.3, 0.4)), block = cut({80, 20, 10}, tilted(0.2, 2));
  ASSERT_FALSE(is_fault(one.router.retract(tool, one.cursor, *one.staged)));
  one.cursor.tool_length_mm += 30;
  one.cursor.pose = forward(one.model, one.cursor.tool_length_mm, one.cursor.joints);
  ASSERT_FALSE(is_fault(one.router.approach(block, one.cursor, *one.staged)));
  ASSERT_EQ(one.paths().size(), 4U);
  EXPECT_NEAR((to_vector(one.paths()[1].tip_delta) - 30 * tilted(0.3, 0.4)).norm(), 0, 1e-6);
  EXPECT_NEAR(one.router.last_approach().lift, 30, 1e-6);
  EXPECT_LT(one.away_from(block), kRounding);
}

TEST(Approach, IsRefusedWhereALongerToolCannotBeLifted) {
  MachineModel model = lai_machine();
  Approached probe(model);
  const ClBlock tool = cut({0, 0, 0}, tilted(0.3, 0.4)), block = cut({80, 20, 10}, tilted(0.2, 2));
  ASSERT_FALSE(is_fault(probe.router.retract(tool, probe.cursor, *probe.staged)));
  const JointVector up = probe.cursor.joints;
  const double by = up[2] - probe.start[2];
  ASSERT_GT(std::abs(by), 1);
  (by > 0 ? model.joints[2].limits.travel_max : model.joints[2].limits.travel_min) =
      up[2] + 0.1 * by;
  Approached one(model);
  ASSERT_FALSE(is_fault(one.router.retract(tool, one.cursor, *one.staged)));
  one.cursor.tool_length_mm += 30;
  one.cursor.pose = forward(one.model, one.cursor.tool_length_mm, one.cursor.joints);
  const PathFault fault = one.router.approach(block, one.cursor, *one.staged);
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(fault.joint, 2);
}

TEST(Approach, GoesToJointsThatAreKnownStraight) {
  Approached one(lai_machine());
  const JointVector to{30, -10, 5, 1.0, 0.2, 0};
  ASSERT_FALSE(is_fault(
      one.router.approach_joints(cut({0, 0, 0}, Vector3::UnitZ()), to, one.cursor, *one.staged)));
  ASSERT_EQ(one.paths().size(), 1U);
  EXPECT_EQ(one.paths()[0].kind, PathKind::kJoint);
  EXPECT_EQ(one.cursor.joints, to);
  EXPECT_NEAR((one.cursor.pose.tip - forward(one.model, 110, to).tip).norm(), 0, kRounding);
  EXPECT_NEAR(one.router.last_approach().length, one.paths()[0].length, kRounding);
  double largest = 0;
  for (int n = 0; n < one.staged->time_count; ++n) {
    largest = std::max(largest, one.staged->times[n].v);
  }
  EXPECT_NEAR(largest, 50, 0.1) << "path length at the feed of the block";
  const JointVector outside{30, -10, 700, 1.0, 0.2, 0};
  const PathFault fault = one.router.approach_joints(cut({0, 0, 0}, Vector3::UnitZ()), outside,
                                                     one.cursor, *one.staged);
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(fault.joint, 2);
  EXPECT_EQ(fault.value, 700);
}

TEST(Approach, TakesTheBranchAndWindingThatIsNearest) {
  for (const int branch : {0, 1}) {
    Approached one(lai_machine(), {{0, 0, 0}, tilted(0.3, 0.4)}, branch);
    const ClBlock block = cut({80, 20, 10}, tilted(0.3, 0.6));
    ASSERT_FALSE(is_fault(one.router.approach(block, one.cursor, *one.staged)));
    EXPECT_EQ(one.router.last_approach().branch, branch);
    EXPECT_NEAR(std::abs(one.cursor.joints[3] - one.start[3]), 0.2, 0.01);
  }
}

TEST(Approach, KeepsHalfATurnOffEitherEndOfTravelWhereItCan) {
  for (const double azimuth : {0.2, 0.6}) {  // C turns one direction or the other, to there
    Approached probe(lai_machine());
    const ClBlock block = cut({80, 20, 10}, tilted(0.3, azimuth));
    ASSERT_FALSE(is_fault(probe.router.approach(block, probe.cursor, *probe.staged)));
    const double at = probe.cursor.joints[3], side = at > probe.start[3] ? 1 : -1;
    MachineModel model = lai_machine();
    model.joints[3].limits.travel_min = side > 0 ? at - 14 : at - 0.05;
    model.joints[3].limits.travel_max = side > 0 ? at + 0.05 : at + 14;
    Approached one(model);
    ASSERT_FALSE(is_fault(one.router.approach(block, one.cursor, *one.staged)));
    EXPECT_LT(side * (one.cursor.joints[3] - at), -2) << "another branch or winding has room";
  }
}

TEST(Approach, ReportsTheAxisDeviationOfItsOwnAlone) {
  Approached one(lai_machine());
  const double off_rad = 0.5 * kPoleDeviation_rad;
  ASSERT_FALSE(is_fault(
      one.router.approach(cut({80, 20, 10}, tilted(off_rad, 1)), one.cursor, *one.staged)));
  EXPECT_NEAR(one.router.axis_deviation_rad(), off_rad, 1e-12);
  ASSERT_FALSE(
      is_fault(one.router.approach(cut({40, 0, 0}, tilted(0.3, 0.6)), one.cursor, *one.staged)));
  EXPECT_EQ(one.router.axis_deviation_rad(), 0);
  (void)one.router.relaxed(tilted(off_rad, 1), kPoleDeviation_rad);
  ASSERT_FALSE(is_fault(one.router.approach_joints(cut({40, 0, 0}, tilted(0.3, 0.6)), one.start,
                                                   one.cursor, *one.staged)));
  EXPECT_EQ(one.router.axis_deviation_rad(), 0) << "to joints as well";
}

TEST(Approach, TakesTheWayThatTheBlocksBehindItAllow) {
  // Round by 300 degrees: only from one end of travel on.
  std::vector<ClBlock> blocks;
  for (int n = 0; n <= 30; ++n) {
    blocks.push_back(cut({80.0 + n, 20, 10}, tilted(0.3, 0.6 + n * std::numbers::pi / 18)));
    blocks.back().sequence = 7 + static_cast<unsigned>(n);
  }
  MachineModel model = lai_machine();
  model.joints[3].limits.travel_min = units::rad_from_deg(-200);
  model.joints[3].limits.travel_max = units::rad_from_deg(200);
  Approached one(model);
  one.router.look_at(blocks, {});
  ASSERT_FALSE(is_fault(one.router.approach(blocks[0], one.cursor, *one.staged)));
  JointVector q = one.cursor.joints;
  const int branch = one.router.last_approach().branch;
  for (const ClBlock& block : blocks) {
    q = solve(model, 110, ToolPose{to_vector(block.tip_mm), to_vector(block.axis)}, branch, q).q;
    EXPECT_LE(std::abs(q[3]), units::rad_from_deg(200)) << block.sequence;
  }
}

TEST(Approach, SaysWhyThereIsNone) {
  Approached one(lai_machine());
  const PathFault tilt =
      one.router.approach(cut({0, 0, 0}, tilted(1.3, 0)), one.cursor, *one.staged);
  EXPECT_EQ(tilt.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(tilt.joint, 4);
  EXPECT_EQ(one.staged->path_count, 0);
  EXPECT_EQ(one.cursor.joints, one.start);
  const PathFault far =
      one.router.approach(cut({5000, 0, 0}, tilted(0.3, 0)), one.cursor, *one.staged);
  EXPECT_EQ(far.kind, PathFault::Kind::kTravel);
  EXPECT_LT(far.joint, 3);
}

}  // namespace
}  // namespace meridian::test::approach
