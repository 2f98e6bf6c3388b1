// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "property/cycle/operated_run.hpp"
#include "property/planner/smooth_trace.hpp"
#include "support/draws.hpp"

/// Stops where the plan has no authority at its full rate for metres, and the rate of plan time
/// hardly falls: how long they take at most.
namespace meridian::test::stop_bound {
namespace {

using SmoothRunning = PlannedRun<SmoothPlanner>;

/// What lies ahead along the plan at most: the rest of a window and its tail, s of this path.
constexpr double kWindow_s = 1.2;

enum class Cause { kHold, kAbort, kDriveFault, kEmergencyStop, kPeriodsLost };

bool is_fault(Cause cause) { return cause >= Cause::kDriveFault; }

/// Cells all of which are planned with all that the joints have.
std::vector<ClBlock> dense_zigzag() {
  std::vector<ClBlock> blocks;
  for (int n = 0; n < 250; ++n) {
    ClBlock block;
    block.sequence = static_cast<std::uint64_t>(n);
    block.line = static_cast<std::uint32_t>(n) + 10;
    const double side = n % 2, tilt = 0.4 + 0.003 * side, azimuth = n % 3 == 0 ? 0.303 : 0.3;
    block.tip_mm = {0.1 * n, 0.03 * side, 0};
    block.axis = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                  std::cos(tilt)};
    block.feed = 100;
    block.feed_meaning = FeedMeaning::kTip;
    blocks.push_back(block);
  }
  end_program(blocks);
  return blocks;
}

/// Plans have all of the limits; `is_soft`: a FaultStop has no more than they have.
MachineModel without_reserve(bool is_soft) {
  MachineModel machine = bench_machine();
  machine.transition = Transition::kSmooth;
  machine.override_ramp_s = 1000;
  for (int i = 0; is_soft && i < machine.joint_count; ++i) {
    JointLimits& limits = machine.joints[i].limits;
    limits.fault_acceleration = limits.acceleration;
    limits.fault_jerk = limits.jerk;
  }
  return machine;
}

/// Stops in the middle and returns how long that takes; 9: longer.
double stop(const MachineModel& machine, const std::vector<ClBlock>& blocks, Cause cause,
            LimitShares& worst) {
  SmoothRunning run(machine, blocks, joints_of(machine, blocks[0]));
  EXPECT_TRUE(run.is_started());
  for (double t = 0; t < 0.63; t += run.world.dt()) run.run();
  EXPECT_EQ(run.world.now(), State::kRunning);
  std::size_t first = run.world.records.size();
  if (cause == Cause::kDriveFault) run.world.in.feedback.fault_mask = 1;
  if (cause == Cause::kEmergencyStop) run.world.in.feedback.emergency_stop = true;
  if (cause == Cause::kPeriodsLost) {
    run.world.run(8);
    first += 4;  // no differences over what was not sent
  }
  if (!is_fault(cause)) run.command(cause == Cause::kHold ? Verb::kHold : Verb::kAbort);
  const State at_rest = cause == Cause::kHold ? State::kHeld : State::kReady;
  const State end = is_fault(cause) ? State::kFault : at_rest;
  while (run.world.now() != end && run.world.records.size() < first + 2500) run.run();
  if (run.world.now() != end) return 9;
  expect_within_limits(run.world, first, is_fault(cause), worst);
  EXPECT_GT(run.world.records.size(), first) << "it rested within the periods that were lost";
  return static_cast<double>(run.world.records.size() - first) * run.world.dt();
}

TEST(StopBound, HoldsAndFaultStopsEndHoweverSlowTheRateOfPlanTimeFalls) {
  const auto blocks = dense_zigzag();
  LimitShares worst;
  double longest_hold = 0, longest_fault = 0;
  for (const bool is_soft : {true, false}) {
    const MachineModel machine = without_reserve(is_soft);
    for (const Cause cause : {Cause::kHold, Cause::kAbort, Cause::kDriveFault,
                              Cause::kEmergencyStop, Cause::kPeriodsLost}) {
      SCOPED_TRACE(testing::Message()
                   << "soft " << is_soft << " cause " << static_cast<int>(cause));
      if (!is_fault(cause) && !is_soft) continue;
      const double time = stop(machine, blocks, cause, worst);
      EXPECT_LT(time, (is_fault(cause) ? 0 : kAlongPlan_s) + kWindow_s);
      double& longest = is_fault(cause) ? longest_fault : longest_hold;
      longest = std::max(longest, time);
    }
  }
  std::printf("longest hold %.3f s, FaultStop %.3f s; worst v %.6f a %.6f j %.6f\n", longest_hold,
              longest_fault, worst.v, worst.a, worst.j);
}

}  // namespace
}  // namespace meridian::test::stop_bound
