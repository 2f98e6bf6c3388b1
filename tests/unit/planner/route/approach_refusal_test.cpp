// SPDX-License-Identifier: Apache-2.0

/// Why there is no approach; and how far one to joints that are known goes.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/keep_out_machine.hpp"
#include "support/machines.hpp"
#include "unit/planner/route/approached.hpp"

namespace meridian::test::approach_refusal {
namespace {

using approach::Approached;
using approach::cut;
using approach::kRounding;

TEST(ApproachRefusal, NamesTheBlockBehindThatLeavesTravelOnEveryRoute) {
  std::vector<ClBlock> blocks{cut({80, 20, 10}, tilted(0.3, 0.6)),
                              cut({90, 20, 10}, tilted(1.3, 0.6))};
  blocks[1].sequence = 8;
  blocks[1].line = 108;
  Approached one(lai_machine());
  one.router.look_at(blocks, {});
  const PathFault fault = one.router.approach(blocks[0], one.cursor, *one.staged);
  EXPECT_EQ(fault.kind, PathFault::Kind::kTravel);
  EXPECT_EQ(fault.joint, 4) << "60 degrees of tilt";
  ASSERT_TRUE(one.router.lost_block());
  EXPECT_EQ(one.router.lost_block()->sequence, 8U);
  EXPECT_EQ(one.router.lost_block()->line, 108U);
  EXPECT_EQ(one.router.lost_block()->value, fault.value);
  EXPECT_EQ(one.staged->path_count, 0);
  EXPECT_EQ(one.cursor.joints, one.start);

  blocks.pop_back();
  one.router.look_at(blocks, {});
  ASSERT_FALSE(is_fault(one.router.approach(blocks[0], one.cursor, *one.staged)));
  EXPECT_FALSE(one.router.lost_block());
}

TEST(ApproachRefusal, NamesTheBoxThatTheTargetLiesIn) {
  Approached probe(lai_machine());
  const ClBlock block = cut({80, 20, 10}, tilted(0.3, 0.6));
  ASSERT_FALSE(is_fault(probe.router.approach(block, probe.cursor, *probe.staged)));
  JointVector min{}, max{};
  min[0] = 590;
  max[0] = 600;
  MachineModel model = with_keep_out(lai_machine(), 1U, min, max);
  for (const double side : {-1.0, 1.0}) {  // on every branch and winding
    min[4] = side > 0 ? 0.29 : -0.31;
    max[4] = side > 0 ? 0.31 : -0.29;
    model = with_keep_out(model, 1U << 4, min, max);
  }
  Approached one(model, {{0, 0, 0}, tilted(0.1, 0.4)});
  const PathFault fault = one.router.approach(block, one.cursor, *one.staged);
  EXPECT_EQ(fault.kind, PathFault::Kind::kKeepOut);
  EXPECT_EQ(fault.joint, -1);
  EXPECT_GE(fault.value, 1) << "not the first box";
}

TEST(ApproachToJoints, CountsARadianAsFiftyMillimetres) {
  Approached one(lai_machine());
  JointVector to = one.start;
  to[3] += 1;
  const ClBlock block = cut({0, 0, 0}, Vector3::UnitZ());
  ASSERT_FALSE(is_fault(one.router.approach_joints(block, to, one.cursor, *one.staged)));
  EXPECT_NEAR(one.router.last_approach().length, 50, kRounding);
  one.staged->clear(0);
  to[0] += 10;
  ASSERT_FALSE(is_fault(one.router.approach_joints(block, to, one.cursor, *one.staged)));
  EXPECT_NEAR(one.router.last_approach().length, 10, kRounding);
}

}  // namespace
}  // namespace meridian::test::approach_refusal
