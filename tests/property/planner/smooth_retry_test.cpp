// SPDX-License-Identifier: Apache-2.0

/// A block that a smooth run cannot follow as it rounds it is done from rest to rest.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "property/cycle/passed_vertices.hpp"
#include "property/planner/smooth_trace.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::smooth_retry {
namespace {

constexpr int kTilting = 6, kBlocks = 40;
constexpr double kSteep_rad = 0.5, kUpright_rad = 0.2;

/// The tool is set upright over some blocks of 1 mm, and goes on so.
std::vector<ClBlock> raised_tool() {
  std::vector<ClBlock> blocks;
  for (int n = 0; n <= kBlocks; ++n) {
    const double share = std::min(1.0, static_cast<double>(n) / kTilting);
    const double tilt = kSteep_rad + share * (kUpright_rad - kSteep_rad);
    ClBlock block;
    block.sequence = blocks.size();
    block.line = static_cast<std::uint32_t>(blocks.size()) + 10;
    block.tip_mm = {n - 30.0, 20, 30};
    block.axis = {std::sin(tilt), 0, std::cos(tilt)};
    block.feed = 50;
    block.feed_meaning = FeedMeaning::kTip;
    blocks.push_back(block);
  }
  end_program(blocks);
  return blocks;
}

/// A machine whose tilt goes no farther than the program, and `left_rad` beyond. The spline that
/// rounds the last corner swings beyond it.
struct Raised {
  explicit Raised(double left_rad = 0) : blocks(raised_tool()), model(bench_machine()) {
    start = joints_of(model, blocks[0]);
    whole = plan_smooth(model, blocks, start);
    const double side = std::copysign(1.0, start[4]), upright = side * kUpright_rad;
    for (const PlanSample& setpoint : sample(model, whole, 250e-6, 0.37, start)) {
      swing_rad = std::max(swing_rad, side * (upright - setpoint.q[4]));
    }
    JointLimits& limits = model.joints[4].limits;
    (side > 0 ? limits.travel_min : limits.travel_max) = upright - side * left_rad;
  }
  [[nodiscard]] SmoothTrace plan(Transition how = Transition::kSmooth) const {
    return plan_smooth(model, blocks, start, {how, 0, 0});
  }

  std::vector<ClBlock> blocks;
  MachineModel model;
  JointVector start{};
  SmoothTrace whole;  ///< with travel to spare
  double swing_rad = 0;
};

int rests_of(const SmoothTrace& trace) {
  return static_cast<int>(
      std::count_if(trace.times.begin(), trace.times.end(), [](const TimePiece& piece) {
        return piece.kind == TimeKind::kMove && state_at(piece, piece.duration).ds < 1e-6;
      }));
}

TEST(SmoothRetry, KeepsTravelWhereRoundingAloneWouldLeaveIt) {
  const Raised one;
  ASSERT_GT(one.swing_rad, 1e-6);
  const SmoothTrace trace = one.plan();
  ASSERT_EQ(trace.last.status, PlanStatus::kOk);
  const auto setpoints = sample(one.model, trace, 1e-3, 0.37, one.start);
  for (const PlanSample& setpoint : setpoints) {
    ASSERT_LT(first_joint_outside_travel(one.model, setpoint.q, 1e-9), 0);
  }
  const LimitUse use = measure_limits(one.model, setpoints, 1e-3);
  EXPECT_LE(std::max({use.v, use.a, use.j}), 1 + 1e-6) << use.where;
}

TEST(SmoothRetry, KeepsTheProgramWithinItsTolerances) {
  const Raised one;
  const SmoothTrace trace = one.plan();
  const auto programmed = programmed_paths(one.blocks);
  const double tip_mm = one.model.tolerances.tip_mm, axis_rad = one.model.tolerances.axis_rad;
  PassedVertices vertices(one.blocks, tip_mm, axis_rad);
  std::size_t before = 0;
  const auto setpoints = sample(one.model, trace, 1e-3, 0.37, one.start);
  for (std::size_t n = 3; n + 3 < setpoints.size(); ++n) {
    const TimePiece& time = trace.times[static_cast<std::size_t>(setpoints[n].piece)];
    if (time.kind != TimeKind::kMove) continue;
    const ToolPose pose = forward(one.model, one.model.tool_length_mm, setpoints[n].q);
    vertices.add(time.sequence, pose, n == before + 1);
    before = n;
    ASSERT_LE(distance_from(programmed, time.sequence, pose, tip_mm, axis_rad), 1 + 1e-6);
  }
  EXPECT_LE(vertices.worst(true), 1 + 1e-6);
}

TEST(SmoothRetry, RestsOnlyAboutTheBlocksThatRoundingTakesOut) {
  const Raised one;
  const SmoothTrace trace = one.plan();
  EXPECT_GT(rests_of(trace), rests_of(one.whole));
  EXPECT_LT(rests_of(trace), kBlocks / 2);
  EXPECT_LT(trace.duration_s(), one.plan(Transition::kExactStop).duration_s());
}

TEST(SmoothRetry, IsTheSameHoweverManyBlocksAreReadAtOnce) {
  const Raised one;
  const SmoothTrace once = one.plan();
  for (const std::size_t every : {7U, 1000U}) {
    const SmoothTrace again = plan_smooth(
        one.model, one.blocks, one.start, {Transition::kSmooth, 0, 0},
        [every](std::size_t n) { return n % every == 0; }, [](std::size_t) { return false; });
    EXPECT_TRUE(are_same(once, again)) << "read every " << every << " blocks";
  }
}

/// The run rests in the middle of a block of 20 s: 18.5 of its 20 mm are left.
TEST(SmoothRetry, TakesAsMuchOfTheInverseTimeOfABlockAsIsLeftOfIt) {
  constexpr double kBlock_s = 20;
  Raised one;
  for (ClBlock& block : one.blocks) {
    block.tip_mm[0] *= 20;
    if (block.kind != BlockKind::kCut) continue;
    block.feed_meaning = FeedMeaning::kInverseTime;
    block.feed = 1 / kBlock_s;
  }
  const SmoothTrace trace = one.plan();
  ASSERT_EQ(trace.last.status, PlanStatus::kOk);
  double from_rest_to_rest_s = 0;
  for (std::size_t n = 0; n < trace.times.size(); ++n) {
    const PathPiece& path = trace.paths[n];
    const bool is_retried = path.kind == PathKind::kLine && path.motion != MotionKind::kApproach;
    if (is_retried) from_rest_to_rest_s += trace.times[n].duration;
  }
  EXPECT_GT(from_rest_to_rest_s, 0.9 * kBlock_s);
  EXPECT_LT(from_rest_to_rest_s, 0.96 * kBlock_s);
}

/// Nobody runs what is published: a block that is tried from rest to rest would wait for that.
TEST(SmoothRetry, IsRefusedAtOnceWhereTheEndOfTheBlockHasNoSolutionInsideTravel) {
  const Raised one(-0.05);
  SmoothPlanner planner(one.model);
  const auto port = std::make_unique<MotionPort>();
  MotionWriter writer(*port);
  planner.begin(one.start, one.model.tool_length_mm, 0, {Transition::kSmooth, 0, 0});
  planner.look_no_further();
  PlanResult result;
  for (std::size_t n = 0; n < one.blocks.size() && result.status == PlanStatus::kOk; ++n) {
    result = planner.plan(one.blocks[n], writer);
  }
  EXPECT_EQ(result.status, PlanStatus::kRefused);
}

TEST(SmoothRetry, IsRefusedWhereTheLinesLeaveTravelToo) {
  for (const double left_rad : {-1e-3, -0.05}) {
    const Raised one(left_rad);
    const SmoothTrace trace = one.plan();
    ASSERT_EQ(trace.last.status, PlanStatus::kRefused);
    EXPECT_EQ(trace.last.reject.code, RejectCode::kTravelBetween);
    EXPECT_EQ(trace.last.reject.joint, 4);
    EXPECT_LE(trace.last.reject.sequence, static_cast<std::uint64_t>(kTilting));
    EXPECT_EQ(trace.last.reject.line, trace.last.reject.sequence + 10);
  }
}

}  // namespace
}  // namespace meridian::test::smooth_retry
