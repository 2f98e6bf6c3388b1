// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/cycle/program.hpp"

/// The host stalls: plan time goes on, or the drives have stopped by themselves.
namespace meridian {
namespace {

using test::kLimits;
using test::Program;

TEST(StepLostPeriods, PlanTimeGoesOnBitForBitAndTheSetpointsBetweenAreMissing) {
  Program whole, gaps;
  for (Program* p : {&whole, &gaps}) {
    p->plan.cut({80, 0, 0}, kLimits);
    p->plan.cut({0, 30, 0}, kLimits);
    p->plan.barrier(TimeKind::kEnd);
    p->run(0);
  }
  for (int n = 0; n < 300; ++n) {
    for (int k = 0; k < 4; ++k) whole.world.run();
    const CycleRecord& record = gaps.world.run(3);
    ASSERT_EQ(record.joints, whole.world.records.back().joints) << n;
    ASSERT_EQ(record.setpoint.velocity, whole.world.records.back().setpoint.velocity) << n;
    ASSERT_EQ(record.plan_time_s, whole.world.records.back().plan_time_s) << n;
  }
  EXPECT_EQ(gaps.world.state.periods_lost, 900u);
}

TEST(StepLostPeriods, AHoldGoesOnBitForBitToo) {
  Program whole, gaps;
  for (Program* p : {&whole, &gaps}) {
    p->plan.cut({80, 0, 0}, kLimits);
    p->run(0.3);
    p->world.command(Verb::kHold);
  }
  for (int n = 0; n < 45; ++n) {
    whole.world.run();
    whole.world.run();
    whole.world.run();
    gaps.world.run(2);
    ASSERT_EQ(gaps.world.records.back().joints, whole.world.records.back().joints);
  }
  EXPECT_EQ(gaps.world.now(), State::kHeld);
}

/// Its stop comes to more margin on its way, at a speed that lies between two cycles of the other.
TEST(StepLostPeriods, AHoldThatIsLaidOutAnewGoesOnBitForBitToo) {
  for (const double slow_velocity : {20.0, 30.0, 40.0, 50.0}) {
    Program whole, gaps;
    for (Program* p : {&whole, &gaps}) {
      p->plan.cut({200, 0, 0}, kLimits);
      p->run(0.6);
      // A piece in force is written by the planner alone: of a test it may be written here.
      auto& piece = const_cast<TimePiece&>(*p->world.reader.piece());
      piece.stop_accel = 300;
      piece.stop_jerk = 12'000;
      piece.slow_velocity = slow_velocity;
      piece.slow_stop_accel = 3000;
      piece.slow_stop_jerk = 120'000;
      p->world.command(Verb::kHold);
    }
    const double laid_out_s = whole.world.state.stop.stopping_time;
    for (int n = 0; n < 150; ++n) {
      for (int k = 0; k < 3; ++k) whole.world.run();
      gaps.world.run(2);
      ASSERT_EQ(gaps.world.records.back().joints, whole.world.records.back().joints) << n;
    }
    EXPECT_EQ(gaps.world.now(), State::kHeld);
    const Event stopped = whole.world.last(EventCode::kStopped);
    EXPECT_LT(static_cast<double>(stopped.a) * 1e-9, laid_out_s - 0.03) << "it ended sooner";
  }
}

/// Where drives are after `lost` periods: they go on with the last velocity for the periods that
/// they bridge, then ramp down.
JointVector bridged(const Program& p, std::uint32_t lost, double decel_share) {
  const CycleRecord& last = p.world.records.back();
  const double bridged_s = p.machine.bridge_cycles * p.world.dt();
  const double ramp_s = lost * p.world.dt() - bridged_s;
  JointVector q = last.joints;
  for (std::size_t i = 0; i < 5; ++i) {
    const double v = last.setpoint.velocity[i];
    const double a = std::copysign(p.machine.joints[i].limits.fault_acceleration, v) * decel_share;
    const double t = std::min(ramp_s, a == 0 ? 0 : v / a);
    q[i] += v * bridged_s + v * t - a * t * t / 2;
  }
  return q;
}

TEST(StepLostPeriods, MoreThanTheDrivesBridgeIsAFaultStopFromWhereTheyReport) {
  for (const std::uint32_t lost : {4U, 6U, 10U, 25U}) {
    Program p;
    p.plan.cut({200, 0, 0}, kLimits);
    p.run(0.5);
    const JointVector fed_back = bridged(p, lost, 1.0);
    p.world.in.feedback.position = fed_back;
    const std::size_t first = p.world.records.size();
    p.world.run(lost);
    EXPECT_EQ(p.world.now(), State::kFaultStop) << lost;
    EXPECT_EQ(p.world.state.alarm, Alarm::kPeriodsLost);
    for (std::size_t i = 0; i < 5; ++i) {  // first setpoint: one period on from feedback
      const double reach = p.machine.joints[i].limits.velocity * p.world.dt();
      EXPECT_NEAR(p.world.records.back().joints[i], fed_back[i], reach);
    }
    ASSERT_TRUE(p.world.run_until(State::kFault, 2));
    for (std::size_t n = first; n < p.world.records.size(); ++n) {
      const ToolPose pose = forward(p.machine, p.machine.tool_length_mm, p.world.records[n].joints);
      EXPECT_LE(std::hypot(pose.tip[1], pose.tip[2]), 1e-6);
    }
  }
}

/// The cycle may wake ahead of the thread that receives: what it knows of the drives is of before
/// the stall, 10 mm behind where they are.
TEST(StepLostPeriods, AStopDoesNotBeginWhereDrivesReportedToBeBeforeTheStall) {
  for (const std::int64_t age_ns : {0, 3'000'000, 40'000'000}) {  // the last counts as lost
    Program p;
    p.plan.cut({400, 0, 0}, {250, 1500, 30000});
    p.run(0.6);
    constexpr std::uint32_t kLost = 25;
    const JointVector at = bridged(p, kLost, 1.0), before = p.world.records.back().joints;
    const std::size_t first = p.world.records.size();
    p.world.are_drives_alive = false;
    p.world.in.feedback.arrival_ns = p.world.in.now_ns - age_ns;
    p.world.run(kLost);
    p.world.are_drives_alive = true;
    EXPECT_EQ(p.world.now(), State::kFaultStop);
    EXPECT_EQ(p.world.state.alarm, Alarm::kPeriodsLost);
    double distance = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      const double reach = p.machine.joints[i].limits.velocity * p.world.dt();
      EXPECT_NEAR(p.world.records.back().joints[i], at[i], reach) << i;
      distance = std::max(distance, std::abs(at[i] - before[i]));
    }
    EXPECT_GT(distance, 3) << "it makes a difference";
    ASSERT_TRUE(p.world.run_until(State::kFault, 2));
    EXPECT_EQ(p.world.count(EventCode::kAlarm), age_ns > 30'000'000 ? 2 : 1);
    for (std::size_t n = first; n < p.world.records.size(); ++n) {
      const ToolPose pose = forward(p.machine, p.machine.tool_length_mm, p.world.records[n].joints);
      EXPECT_LE(std::hypot(pose.tip[1], pose.tip[2]), 1e-3) << "drives ramp joint by joint";
    }
  }
}

TEST(StepLostPeriods, DrivesBesideThePathAreLedBackToItInsideTheLimits) {
  Program p;
  p.plan.cut({200, 0, 0}, kLimits);
  p.run(0.5);
  JointVector fed_back = bridged(p, 5, 1.0);
  fed_back[1] += 0.3;
  fed_back[2] -= 0.2;
  p.world.in.feedback.position = fed_back;
  p.world.run(5);
  EXPECT_NEAR(p.world.records.back().joints[1], fed_back[1], 0.31);
  const std::size_t first = p.world.records.size();
  ASSERT_TRUE(p.world.run_until(State::kFault, 2));
  const auto& r = p.world.records;
  const double dt = p.world.dt();
  for (std::size_t n = first + 2; n + 1 < r.size(); ++n) {
    for (std::size_t i = 0; i < 5; ++i) {
      const double a = r[n].joints[i] - 2 * r[n - 1].joints[i] + r[n - 2].joints[i];
      EXPECT_LE(std::abs(a) / (dt * dt), p.machine.joints[i].limits.fault_acceleration * 1.000001);
    }
  }
  const ToolPose pose = forward(p.machine, p.machine.tool_length_mm, r[r.size() - 1].joints);
  EXPECT_LE(std::hypot(pose.tip[1], pose.tip[2]), 1e-9);
}

TEST(StepLostPeriods, AtRestALongStallIsOnlyCounted) {
  Program p;
  p.world.run(5000);
  EXPECT_EQ(p.world.now(), State::kReady);
  EXPECT_EQ(p.world.last(EventCode::kPeriodsLost).a, 5000u);
}

TEST(StepLostPeriods, AreNotSetpointsThatDrivesDidNotTake) {
  Program p;
  p.machine.bridge_cycles = p.world.machine.bridge_cycles = 30;
  p.plan.cut({200, 0, 0}, kLimits);
  p.run(0.5);
  const std::uint64_t seen = p.world.in.cycle;
  for (int n = 0; n < 50; ++n) {
    p.world.in.feedback.cycle_seen = seen;
    p.world.run(n == 0 ? 30 : 0);
    ASSERT_EQ(p.world.now(), State::kRunning) << n;
  }
}

TEST(StepLostPeriods, DrivesThatWentOnDuringAStallAreNotBehind) {
  Program p;
  p.machine.bridge_cycles = p.world.machine.bridge_cycles = 100;
  p.plan.cut({200, 0, 0}, kLimits);
  p.run(0.5);
  p.world.in.feedback.position = bridged(p, 80, 0.0);  // 8 mm ahead of the setpoint, limit 5 mm
  p.world.run(80);
  EXPECT_EQ(p.world.now(), State::kRunning);
}

}  // namespace
}  // namespace meridian
