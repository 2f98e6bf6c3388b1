// SPDX-License-Identifier: Apache-2.0

/// What was sent ahead of a block that is refused, or of the end of a stream without an end, is cut
/// to its end where cuts run on through blocks.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "property/cycle/program_run.hpp"
#include "property/planner/smooth_trace.hpp"

namespace meridian::test::smooth_refusal {
namespace {

using SmoothRunning = PlannedRun<SmoothPlanner>;

constexpr std::size_t kBlocks = 500;
constexpr std::size_t kBeforeStart = 150;

/// A line in blocks of 1 mm that bends a little at each, without an end.
std::vector<ClBlock> cuts() {
  std::vector<ClBlock> blocks;
  for (std::size_t n = 0; n < kBlocks; ++n) {
    ClBlock block;
    block.sequence = n;
    block.line = static_cast<std::uint32_t>(n) + 10;
    const double s = static_cast<double>(n);
    block.tip_mm = {s, 5 * std::sin(0.05 * s), 0};
    block.axis = {std::sin(0.4), 0, std::cos(0.4)};
    block.feed = 100;
    block.feed_meaning = FeedMeaning::kTip;
    blocks.push_back(block);
  }
  return blocks;
}

MachineModel smooth_machine() {
  MachineModel machine = bench_machine();
  machine.transition = Transition::kSmooth;
  return machine;
}

/// Runs until the plan is through; where the tool rests then.
ToolPose run_out(SmoothRunning& run) {
  for (int n = 0; n < 20000 && run.world.now() != State::kStarved; ++n) run.run();
  EXPECT_EQ(run.world.now(), State::kStarved);
  LimitShares worst = shares_of_limits(run.world, 0, false);
  EXPECT_LE(std::max({worst.v, worst.a, worst.j}), 1 + 1e-6);
  return forward(run.world.machine, run.world.machine.tool_length_mm, run.world.state.joints);
}

/// Joints of `block` near `reference`.
JointVector joints_near(const MachineModel& machine, const ClBlock& block,
                        const JointVector& reference) {
  const ToolPose pose{to_vector(block.tip_mm), to_vector(block.axis)};
  JointVector nearest = reference;
  double smallest = 1e300;
  for (int branch = 0; branch < branch_count(machine); ++branch) {
    const auto at = solve(machine, machine.tool_length_mm, pose, branch, reference);
    double off = 0;
    for (std::size_t i = 0; i < at.q.size(); ++i) off += std::abs(at.q[i] - reference[i]);
    if (at.status == SolveStatus::kUnreachable || off > smallest) continue;
    smallest = off;
    nearest = at.q;
  }
  return nearest;
}

double distance(const ToolPose& pose, const ClBlock& block) {
  return (pose.tip - to_vector(block.tip_mm)).norm();
}

TEST(SmoothRefusal, WhatIsAheadOfAFaultThatThePlannerFindsIsCutToItsEnd) {
  for (const double share : {0.1, 0.5, 0.9}) {  // of the block that leaves travel
    MachineModel machine = smooth_machine();
    const auto blocks = cuts();
    constexpr std::size_t kBad = 280;
    const JointVector start = joints_of(machine, blocks[0]);
    const double good = joints_near(machine, blocks[kBad - 1], start)[0];
    const double bad = joints_near(machine, blocks[kBad], start)[0];
    const double end = good + share * (bad - good);
    (bad > good ? machine.joints[0].limits.travel_max : machine.joints[0].limits.travel_min) = end;
    SmoothRunning run(machine, blocks, start, kBeforeStart);
    ASSERT_TRUE(run.is_started());
    const ToolPose pose = run_out(run);
    const PlanResult refusal = run.planner().advance(run.writer());
    EXPECT_EQ(refusal.status, PlanStatus::kRefused);
    EXPECT_EQ(refusal.reject.sequence, kBad);
    EXPECT_EQ(refusal.reject.code, RejectCode::kTravelBetween);
    EXPECT_LE(distance(pose, blocks[kBad - 1]), machine.tolerances.tip_mm) << share;
  }
}

TEST(SmoothRefusal, WhatIsAheadOfTheEndOfAStreamIsCutToItsEnd) {
  const auto blocks = cuts();
  const MachineModel machine = smooth_machine();
  SmoothRunning run(machine, blocks, joints_of(machine, blocks[0]), kBeforeStart);
  ASSERT_TRUE(run.is_started());
  for (int n = 0; n < 10; ++n) run.run();
  run.planner().finish();
  EXPECT_LE(distance(run_out(run), blocks.back()), 1e-6);
}

}  // namespace
}  // namespace meridian::test::smooth_refusal
