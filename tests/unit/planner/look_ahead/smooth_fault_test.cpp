// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "meridian/kinematics/kinematics.hpp"
#include "unit/planner/look_ahead/ran_blocks.hpp"

/// Where a smooth run ends that cannot go on: it names the block, and rests ahead of it.
namespace meridian::test::smooth_fault {
namespace {

using ran_blocks::kBegin;
using ran_blocks::Ran;
using ran_blocks::Status;

/// The machine whose first joint may not pass where it is at `pose`.
MachineModel machine_that_ends_at(const ToolPose& pose) {
  MachineModel model = bench_machine();
  model.joints[0].limits.travel_max = solve(model, model.tool_length_mm, pose, 0, {}).q[0];
  return model;
}

TEST(SmoothFault, EndsAheadOfABlockThatLeavesTravelAndNamesIt) {
  MachineModel model = bench_machine();
  const JointVector begin = solve(model, model.tool_length_mm, kBegin, 0, {}).q;
  ToolPose at = kBegin;
  at.tip[0] += 51;  // on the 26th block
  const JointVector end = solve(model, model.tool_length_mm, at, 0, {}).q;
  int joint = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(end[i] - begin[i]) > std::abs(end[joint] - begin[joint])) joint = i;
  }
  JointLimits& limits = model.joints[joint].limits;
  (end[joint] > begin[joint] ? limits.travel_max : limits.travel_min) = end[joint];
  Ran one(model);
  for (int n = 0; n < 150 && !one.run.has_fault(); ++n) one.cut_straight(1, 2);
  ASSERT_TRUE(one.run.has_fault());
  one.reader.set_epoch(3);
  for (int n = 0; n < 5000 && one.run.publish(one.writer) != Status::kFailed; ++n) {
    (void)one.reader.advance();
  }
  EXPECT_EQ(one.run.publish(one.writer), Status::kFailed);
  EXPECT_EQ(one.run.fault().kind, PathFault::Kind::kTravel);
  EXPECT_EQ(one.run.faulty_block().joint, joint);
  EXPECT_EQ(one.run.faulty_block().sequence, 40U + 25);
  EXPECT_EQ(one.run.faulty_block().line, 140U + 25);
  const ToolPose rest = forward(model, model.tool_length_mm, one.run.joints());
  EXPECT_GT((rest.tip - kBegin.tip)[0], 49.9) << "where the block before ends, or behind it";
  EXPECT_LT((rest.tip - kBegin.tip)[0], 51);
}

TEST(SmoothFault, NamesTheBlockThatLeavesTravelAmongShortOnes) {
  for (const int wanted : {28, 29, 30, 31, 32, 33}) {
    MachineModel model = bench_machine();
    ToolPose at = kBegin;
    at.tip[0] += 48.05 + 0.1 * wanted;  // in the middle of the short block
    model.joints[0].limits.travel_max = solve(model, model.tool_length_mm, at, 0, {}).q[0];
    Ran one(model);
    one.cut_straight(24, 2);
    one.cut_straight(100, 0.1);
    for (int n = 0; n < 150 && !one.run.has_fault(); ++n) one.cut_straight(1, 2);
    ASSERT_TRUE(one.run.has_fault());
    EXPECT_EQ(one.run.faulty_block().sequence, static_cast<std::uint64_t>(40 + 24 + wanted));
    EXPECT_EQ(one.run.faulty_block().line, static_cast<std::uint32_t>(140 + 24 + wanted));
  }
}

/// A span has one end of a block, or none: where it has one, the fault may lie ahead of it or not.
/// The end of a long block is not known yet where the fault is found near its begin.
TEST(SmoothFault, NamesTheBlockThatLeavesTravelAmongLongOnes) {
  for (const double length : {6.0, 10.0, 40.0}) {
    for (const int wanted : {1, 2, 3}) {
      for (const double share : {0.0005, 0.01, 0.03, 0.1, 0.5, 0.9, 0.99}) {
        ToolPose at = kBegin;
        at.tip[0] += length * (wanted + share);
        Ran one(machine_that_ends_at(at));
        for (int n = 0; n < 60 && !one.run.has_fault(); ++n) one.cut_straight(1, length);
        ASSERT_TRUE(one.run.has_fault());
        EXPECT_EQ(one.run.faulty_block().sequence, static_cast<std::uint64_t>(40 + wanted))
            << length << " mm, at " << share;
        EXPECT_EQ(one.run.faulty_block().line, static_cast<std::uint32_t>(140 + wanted));
      }
    }
  }
}

/// The step of the samples does not matter.
TEST(SmoothFault, NamesTheBlockThatLeavesTravelWithinAMicrometreOfItsEnd) {
  for (const double length : {2.0, 2.4, 11.3}) {
    for (const int wanted : {2, 3, 4}) {
      for (const double beyond : {-0.001, 0.001}) {
        ToolPose at = kBegin;
        at.tip[0] += length * wanted + beyond;
        Ran one(machine_that_ends_at(at));
        for (int n = 0; n < 100 && !one.run.has_fault(); ++n) one.cut_straight(1, length, 200);
        ASSERT_TRUE(one.run.has_fault());
        const int block = beyond < 0 ? wanted - 1 : wanted;
        EXPECT_EQ(one.run.faulty_block().sequence, static_cast<std::uint64_t>(40 + block))
            << length << " mm, end of " << wanted << " and " << beyond;
      }
    }
  }
}

/// Through the pole, where C may not turn by a half and the tilt may not turn over.
TEST(SmoothFault, WhereNoRouteLeadsPastThePoleItNamesTheBlockThereAndRestsAhead) {
  const auto at = [](double x) {
    return ToolPose{Vector3(x, 0, 0), Vector3(0, 0.004 * x, 1).normalized()};
  };
  MachineModel model = bench_machine();
  const auto free = static_cast<std::size_t>(redundant_joint(model));
  model.joints[free].is_endless = false;
  model.joints[free].limits.travel_min = -2;
  model.joints[free].limits.travel_max = 0.5;
  JointLimits& tilt = model.joints[free == 4 ? 3 : 4].limits;
  tilt.travel_min = 0;
  Ran one(model, at(-60));
  one.reader.set_epoch(3);
  for (int n = 1; n <= 120 && !one.run.has_fault(); ++n) {
    one.cut(at(-60 + 2 * n));
    while (one.status == Status::kNoRoom && one.reader.advance() != nullptr) {
      one.status = one.run.publish(one.writer);
    }
  }
  ASSERT_TRUE(one.run.has_fault());
  EXPECT_EQ(one.run.fault().kind, PathFault::Kind::kBranch);
  EXPECT_EQ(one.run.faulty_block().joint, static_cast<int>(free));
  // Spans are held back from where a pass may begin.
  const double end = -58 + 2 * (static_cast<double>(one.run.faulty_block().sequence) - 40);
  EXPECT_GE(end, -kPoleReach_mm);
  EXPECT_LT(end, -kPoleReach_mm + 4);
  EXPECT_EQ(one.run.faulty_block().line, one.run.faulty_block().sequence + 100);
  for (int n = 0; n < 5000 && one.run.publish(one.writer) != Status::kFailed; ++n) {
    (void)one.reader.advance();
  }
  EXPECT_EQ(one.run.publish(one.writer), Status::kFailed);
  EXPECT_LT(forward(model, model.tool_length_mm, one.run.joints()).tip[0], 0);
}

}  // namespace
}  // namespace meridian::test::smooth_fault
