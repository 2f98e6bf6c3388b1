// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "unit/cycle/program.hpp"

/// Motion that goes on over path pieces and windows: stops across seams, tails taken and skipped.
namespace meridian {
namespace {

using test::kLimits;
using test::Program;

/// Largest second and third difference of the tip's x in shares of the bounds of the plan.
struct BoundShares {
  double accel = 0, jerk = 0;
};
BoundShares shares_of_bounds(const Program& p) {
  BoundShares worst;
  const double dt = p.world.dt();
  std::vector<double> x;
  for (const CycleRecord& record : p.world.records) {
    x.push_back(forward(p.machine, p.machine.tool_length_mm, record.joints).tip[0]);
  }
  constexpr double kRounding_mm = 1e-12;
  for (std::size_t n = 3; n < x.size(); ++n) {
    const double a = std::abs(x[n] - 2 * x[n - 1] + x[n - 2]) - kRounding_mm;
    const double j = std::abs(x[n] - 3 * x[n - 1] + 3 * x[n - 2] - x[n - 3]) - 2 * kRounding_mm;
    worst.accel = std::max(worst.accel, a / (dt * dt) / kLimits.acceleration);
    worst.jerk = std::max(worst.jerk, j / (dt * dt * dt) / kLimits.jerk);
  }
  return worst;
}

TEST(StepWindows, AStopGoesOnOverTheSeamOfTwoPathPieces) {
  int crossed = 0;
  for (int k = 0; k < 65; ++k) {
    Program p;
    p.plan.cut_over_two_paths({60, 0, 0}, kLimits);
    p.plan.barrier(TimeKind::kEnd);
    p.run(0.005 + 0.01 * k);
    const std::uint64_t before =
        p.world.reader.path() != nullptr ? p.world.reader.path()->index : 9;
    p.world.command(Verb::kHold);
    ASSERT_TRUE(p.world.run_until(State::kHeld, 2));
    const std::uint64_t after = p.world.reader.path() != nullptr ? p.world.reader.path()->index : 9;
    crossed += before == 0 && after == 1;
    p.world.command(Verb::kResume);
    ASSERT_TRUE(p.world.run_until(State::kReady, 10));
    const BoundShares shares = shares_of_bounds(p);
    EXPECT_LE(shares.accel, 1 + 1e-6) << k;
    EXPECT_LE(shares.jerk, 1 + 1e-6) << k;
    EXPECT_NEAR(p.world.records.back().joints[0], p.plan.joints()[0], 1e-9);
  }
  EXPECT_GE(crossed, 5);
}

TEST(StepWindows, TheTailIsSkippedWhereTheNextWindowIsThereInTime) {
  Program p;
  p.plan.cut_with_tail({100, 0, 0}, kLimits, 0.2);
  p.plan.continue_cut();
  p.plan.barrier(TimeKind::kEnd);
  p.run(0);
  ASSERT_TRUE(p.world.run_until(State::kReady, 10));
  EXPECT_EQ(p.world.state.starvations, 0u);
  const BoundShares shares = shares_of_bounds(p);
  EXPECT_LE(shares.accel, 1 + 1e-6);
  EXPECT_LE(shares.jerk, 1 + 1e-6);
  EXPECT_NEAR(p.world.records.back().joints[0], p.plan.joints()[0], 1e-9);
}

TEST(StepWindows, TheTailIsRunToRestWhereNothingFollowsAndLaterWindowsInMotionAreVoid) {
  Program p;
  p.plan.cut_with_tail({100, 0, 0}, kLimits, 0.2);
  p.run(0.28);
  EXPECT_EQ(p.world.now(), State::kRunning);
  ASSERT_TRUE(p.world.run_until(State::kStarving, 1));
  p.plan.continue_cut();  // too late: it starts in motion
  ASSERT_TRUE(p.world.run_until(State::kStarved, 1));
  EXPECT_EQ(p.world.records.back().setpoint.flags & kSetpointMoving, 0);
  p.world.run_for(0.5);
  EXPECT_EQ(p.world.now(), State::kStarved);
  const BoundShares shares = shares_of_bounds(p);
  EXPECT_LE(shares.accel, 1 + 1e-6);
  EXPECT_LE(shares.jerk, 1 + 1e-6);
  const double x =
      forward(p.machine, p.machine.tool_length_mm, p.world.records.back().joints).tip[0];
  EXPECT_GT(x, 20);
  EXPECT_LT(x, 90);
}

TEST(StepWindows, AHoldWhileStarvingStaysInsideTheBounds) {
  Program p;
  p.plan.cut_with_tail({100, 0, 0}, kLimits, 0.2);
  p.run(0);
  ASSERT_TRUE(p.world.run_until(State::kStarving, 1));
  p.world.run_for(0.02);
  p.world.command(Verb::kHold);
  ASSERT_TRUE(p.world.run_until(State::kHeld, 1));
  const BoundShares shares = shares_of_bounds(p);
  EXPECT_LE(shares.accel, 1 + 1e-6);
  EXPECT_LE(shares.jerk, 1 + 1e-6);
}

TEST(StepWindows, LosesNoTimeFromPieceToPiece) {
  Program p;
  p.plan.cut_over_two_paths({60, 0, 0}, kLimits);
  p.plan.cut({-60, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kEnd);
  p.run(0);
  ASSERT_TRUE(p.world.run_until(State::kReady, 10));
  const double planned = rest_to_rest_with_reserve(60, kLimits).duration() +
                         rest_to_rest_with_reserve(60, kLimits).duration();
  int moving = 0;
  for (const CycleRecord& record : p.world.records) {
    moving += (record.setpoint.flags & kSetpointMoving) != 0;
  }
  EXPECT_NEAR(moving * p.world.dt(), planned, 2 * p.world.dt());
}

}  // namespace
}  // namespace meridian
