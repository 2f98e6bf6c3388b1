// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "unit/cycle/program.hpp"

/// What makes the machine stop by itself, each provoked: it keeps to its path, inside the FaultStop
/// limits, and ends in Fault.
namespace meridian {
namespace {

using test::alarm_of;
using test::kLimits;
using test::Program;

/// Largest distance of the tip from the x axis of W, the path of the program below, mm.
double deviation_from_path(const Program& p, std::size_t first) {
  double worst = 0;
  for (std::size_t n = first; n < p.world.records.size(); ++n) {
    const CycleRecord& record = p.world.records[n];
    if (record.state != State::kFaultStop) continue;
    const ToolPose pose = forward(p.machine, p.machine.tool_length_mm, record.joints);
    worst = std::max(worst, std::hypot(pose.tip[1], pose.tip[2]));
  }
  return worst;
}

/// Largest second and third difference of the joints in shares of the FaultStop limits.
struct FaultShares {
  double accel = 0, jerk = 0;
};
FaultShares shares_of_fault_limits(const Program& p, std::size_t first) {
  FaultShares worst;
  const double dt = p.world.dt();
  const auto& r = p.world.records;
  for (std::size_t n = std::max<std::size_t>(first, 3); n < r.size(); ++n) {
    for (std::size_t i = 0; i < 5; ++i) {
      const JointLimits& limits = p.machine.joints[i].limits;
      const double a = r[n].joints[i] - 2 * r[n - 1].joints[i] + r[n - 2].joints[i];
      const double j =
          r[n].joints[i] - 3 * r[n - 1].joints[i] + 3 * r[n - 2].joints[i] - r[n - 3].joints[i];
      worst.accel = std::max(worst.accel, std::abs(a) / (dt * dt) / limits.fault_acceleration);
      worst.jerk = std::max(worst.jerk, std::abs(j) / (dt * dt * dt) / limits.fault_jerk);
    }
  }
  return worst;
}

void expect_fault_on_path(Program& p, Alarm alarm) {
  const std::size_t first = p.world.records.size() - 1;
  EXPECT_EQ(p.world.records.back().state, State::kFaultStop);
  ASSERT_TRUE(p.world.run_until(State::kFault, 2));
  EXPECT_EQ(p.world.state.alarm, alarm);
  EXPECT_LE(deviation_from_path(p, first), 1e-9);
  const FaultShares shares = shares_of_fault_limits(p, first);
  EXPECT_LE(shares.accel, 1 + 1e-6);
  EXPECT_LE(shares.jerk, 1 + 1e-6);
  EXPECT_EQ(p.world.records.back().setpoint.flags & kSetpointEnabled, 0);
  EXPECT_EQ(p.world.state.epoch, 2);
}

void start_long_cut(Program& p) {
  p.plan.cut({200, 0, 0}, kLimits);
  p.run(0.5);
  ASSERT_EQ(p.world.now(), State::kRunning);
}

TEST(StepFaults, ADriveFaultStopsOnThePath) {
  Program p;
  start_long_cut(p);
  p.world.in.feedback.fault_mask = 0b00100;
  p.world.run();
  EXPECT_EQ(p.world.last(EventCode::kAlarm).b, 2u);
  expect_fault_on_path(p, Alarm::kDriveFault);
}

/// Cycles that a program runs whose drives follow, and say that `seen` was the last setpoint that
/// they took.
int cycles_unheard(Program& p, std::uint64_t seen) {
  int cycles = 0;
  for (; p.world.now() == State::kRunning && cycles < 100; ++cycles) {
    p.world.in.feedback.cycle_seen = seen;
    p.world.run();
  }
  return cycles;
}

TEST(StepFaults, DrivesThatReportAndTakeNoSetpointsStopTheMachine) {
  for (const std::uint64_t seen : {0U, 1U, 555U, 999'999U}) {  // 555: the newest
    Program p;
    start_long_cut(p);
    ASSERT_LT(p.world.in.cycle, 555U);
    while (p.world.in.cycle < 555) p.world.run();
    p.world.in.feedback.deafest_joint = 3;
    const double granted = p.world.state.options.feedback_timeout_s / p.world.dt() +
                           p.machine.bridge_cycles + kHearingSlack;
    EXPECT_NEAR(cycles_unheard(p, seen), granted, 2) << seen;
    EXPECT_EQ(p.world.last(EventCode::kAlarm).b, 3U);
    EXPECT_NEAR(p.world.last(EventCode::kAlarm).x, granted * p.world.dt(), 0.002);
    expect_fault_on_path(p, Alarm::kSetpointsUnheard);
  }
}

TEST(StepFaults, WhatDrivesDidNotTakeBeforeTheyWereEnabledDoesNotCount) {
  Program p;
  const auto run_unheard = [&p](int cycles, std::uint32_t enabled_mask) {
    for (int n = 0; n < cycles; ++n) {
      p.world.in.feedback.enabled_mask = enabled_mask;
      p.world.in.feedback.cycle_seen = 0;
      p.world.run();
    }
  };
  const std::uint32_t all = all_joints(p.machine);
  run_unheard(20, all);
  ASSERT_EQ(p.world.now(), State::kReady);
  p.world.command(Verb::kDisable);
  run_unheard(300, 0);
  ASSERT_EQ(p.world.now(), State::kOff);
  p.world.command(Verb::kEnable);
  run_unheard(300, 0);
  ASSERT_EQ(p.world.now(), State::kEnabling);
  run_unheard(20, all);
  EXPECT_EQ(p.world.now(), State::kReady);
}

TEST(StepFaults, LostFeedbackNamesTheFirstJointOfTheGroupThatIsSilent) {
  for (const std::uint8_t joint : {std::uint8_t{3}, kNoJoint}) {  // none: it has the stop input
    Program p;
    start_long_cut(p);
    p.world.in.feedback.oldest_joint = joint;
    p.world.are_drives_alive = false;
    ASSERT_TRUE(p.world.run_until(State::kFaultStop, 1));
    EXPECT_EQ(p.world.state.alarm, Alarm::kFeedbackLost);
    EXPECT_EQ(p.world.last(EventCode::kAlarm).b, joint);
  }
}

TEST(StepFaults, AMachineOneOfWhoseDrivesTwoReportIsNotEnabledAndOneThatRunsGoesOn) {
  Program p(State::kOff);
  p.world.run();
  p.world.in.feedback.contested_mask = 0b00100;
  p.world.command(Verb::kEnable);
  EXPECT_EQ(p.world.now(), State::kOff);
  EXPECT_EQ(test::refusal_of(p.world), Refusal::kDriveContested);
  p.world.in.feedback.contested_mask = 0;
  p.world.command(Verb::kEnable);
  p.world.in.feedback.contested_mask = 0b00100;
  p.world.run_for(0.1);
  EXPECT_EQ(p.world.now(), State::kReady);
}

TEST(StepFaults, TheEmergencyInputStopsOnThePathAndBlocksReset) {
  Program p;
  start_long_cut(p);
  p.world.in.feedback.emergency_stop = true;
  p.world.run();
  expect_fault_on_path(p, Alarm::kEmergencyStop);
  p.world.command(Verb::kReset);
  EXPECT_EQ(p.world.now(), State::kFault);
  p.world.in.feedback.emergency_stop = false;
  p.world.command(Verb::kReset);
  EXPECT_EQ(p.world.now(), State::kOff);
}

TEST(StepFaults, LostFeedbackStopsOnThePath) {
  Program p;
  start_long_cut(p);
  p.world.are_drives_alive = false;
  p.world.run_for(0.019);
  EXPECT_EQ(p.world.now(), State::kRunning);
  p.world.run_for(0.003);
  ASSERT_EQ(p.world.now(), State::kFaultStop);
  ASSERT_TRUE(p.world.run_until(State::kFault, 2));
  EXPECT_EQ(p.world.state.alarm, Alarm::kFeedbackLost);
  EXPECT_LE(deviation_from_path(p, 0), 1e-9);
}

TEST(StepFaults, AFollowingErrorStopsTheOthersOnThePath) {
  Program p;
  start_long_cut(p);
  p.world.in.feedback.position[1] += 5.1;  // limit 5 mm
  p.world.run();
  EXPECT_EQ(p.world.last(EventCode::kAlarm).b, 1u);
  expect_fault_on_path(p, Alarm::kFollowingError);
}

TEST(StepFaults, AFaultDuringAHoldGoesOnHarderOnThePath) {
  Program p;
  start_long_cut(p);
  p.world.command(Verb::kHold);
  p.world.run_for(0.03);
  ASSERT_EQ(p.world.now(), State::kHolding);
  p.world.in.feedback.fault_mask = 1;
  p.world.run();
  expect_fault_on_path(p, Alarm::kDriveFault);
}

TEST(StepFaults, AFaultAtRestIsFaultAtOnce) {
  Program p;
  p.world.in.feedback.fault_mask = 1;
  p.world.run();
  EXPECT_EQ(p.world.now(), State::kFault);
  EXPECT_EQ(p.world.states()[p.world.states().size() - 2], State::kFaultStop);
}

TEST(StepFaults, ADriveThatLeavesOperationIsADriveFault) {
  Program p;
  start_long_cut(p);
  p.world.in.feedback.enabled_mask = 0b01111;
  p.world.run();
  EXPECT_EQ(p.world.state.alarm, Alarm::kDriveFault);
}

TEST(StepFaults, AfterFaultOnlyResetEnableAndStartMoveAgain) {
  Program p;
  start_long_cut(p);
  p.world.in.feedback.fault_mask = 1;
  ASSERT_TRUE(p.world.run_until(State::kFault, 2));
  p.world.in.feedback.fault_mask = 0;
  for (const Verb verb : {Verb::kEnable, Verb::kStart, Verb::kResume}) {
    p.world.command(verb);
    EXPECT_EQ(p.world.now(), State::kFault);
  }
  p.world.command(Verb::kReset);
  EXPECT_EQ(p.world.now(), State::kOff);
  ASSERT_TRUE(p.world.enable());
  p.world.run_for(0.1);
  EXPECT_EQ(p.world.now(), State::kReady);
}

TEST(StepFaults, ASetpointThatLeavesTravelIsNeverSent) {
  Program p;
  p.world.machine.joints[0].limits.travel_max = p.plan.joints()[0] + 50;
  p.world.machine.joints[0].limits.travel_min = p.plan.joints()[0] - 50;
  start_long_cut(p);
  ASSERT_TRUE(p.world.run_until(State::kFault, 3));
  EXPECT_EQ(p.world.state.alarm, Alarm::kTravel);
  for (const CycleRecord& record : p.world.records) {
    ASSERT_EQ(first_joint_outside_travel(p.world.machine, record.setpoint.position, 2e-9), -1);
  }
}

TEST(StepFaults, WhatTheMonitoringFindsStopsTheMachineOnThePath) {
  Program p;
  start_long_cut(p);
  p.world.run_for(0.3);
  p.world.in.monitoring = {Alarm::kDriveModel, 2, 0.7};
  p.world.run();
  expect_fault_on_path(p, Alarm::kDriveModel);
  EXPECT_EQ(p.world.last(EventCode::kAlarm).b, 2U);
  EXPECT_EQ(p.world.last(EventCode::kAlarm).x, 0.7);
}

TEST(StepFaults, WhatTheMonitoringFindsInAMachineThatStopsIsNoAlarmOfItsOwn) {
  Program p;
  start_long_cut(p);
  p.world.run_for(0.3);
  p.world.in.feedback.fault_mask = 1;
  p.world.in.monitoring = {Alarm::kFeedbackFrozen, 0, 5};
  p.world.run();
  expect_fault_on_path(p, Alarm::kDriveFault);
  EXPECT_EQ(p.world.count(EventCode::kAlarm), 1);
}

TEST(StepFaults, ASetpointThatTakesTheTipOutOfItsBoxIsNeverSent) {
  Program p;  // its plan knows no box
  const auto tip_of = [&p](const JointVector& joints) {
    return tip_over_base(p.machine, p.machine.tool_length_mm, joints);
  };
  const Array3 tip = tip_of(p.plan.joints());
  p.world.machine.tip_box = {true, {tip[0] - 50, -1e3, -1e3}, {tip[0] + 50, 1e3, 1e3}};
  start_long_cut(p);
  ASSERT_TRUE(p.world.run_until(State::kFault, 3));
  EXPECT_EQ(p.world.state.alarm, Alarm::kTipBox);
  for (const CycleRecord& record : p.world.records) {
    ASSERT_EQ(axis_outside(p.world.machine.tip_box, tip_of(record.joints), 2 * kGuardTip), -1);
  }
}

TEST(StepFaults, APathThatCannotBeEvaluatedEndsOnTheLastCourse) {
  Program p;
  PathPiece path;
  path.epoch = 1;
  path.length = 100;
  path.kind = PathKind::kJoint;
  path.joints_begin = p.plan.joints();
  path.joints_end = p.plan.joints();
  path.joints_end[0] += 100;
  TimePiece piece;
  piece.epoch = 1;
  piece.is_from_rest = true;
  piece.duration = 0.2;
  piece.j = 1000;
  piece.stop_accel = piece.fault_accel = 1000;
  piece.stop_jerk = piece.fault_jerk = 20000;
  MotionWriter writer(*p.world.port);
  ASSERT_TRUE(writer.stage(path) && writer.stage(piece));
  piece.s0 = std::numeric_limits<double>::quiet_NaN();
  piece.is_from_rest = false;
  ASSERT_TRUE(writer.stage(piece));
  writer.publish();
  p.run(0.19);
  const std::size_t first = p.world.records.size();
  p.world.run_for(0.02);
  ASSERT_TRUE(p.world.run_until(State::kFault, 2));
  EXPECT_TRUE(p.world.state.alarm == Alarm::kNotFinite ||
              p.world.state.alarm == Alarm::kUnreachable);
  for (const CycleRecord& record : p.world.records) {
    for (const double q : record.setpoint.position) ASSERT_TRUE(std::isfinite(q));
  }
  EXPECT_LE(shares_of_fault_limits(p, first + 3).accel, 1 + 1e-6);
  EXPECT_GT(p.world.records.back().joints[0], p.world.records[first - 1].joints[0]);
}

TEST(StepFaults, NoEventsAreLostInTheBusiestCycle) {
  Program p;
  start_long_cut(p);
  p.world.in.feedback.fault_mask = 1;
  p.world.in.feedback.emergency_stop = true;
  p.world.in.feedback.position[1] += 9;
  p.world.command(Verb::kAbort);
  EXPECT_EQ(p.world.out.events_dropped, 0u);
  EXPECT_EQ(p.world.state.alarm, Alarm::kEmergencyStop);
}

}  // namespace
}  // namespace meridian
