// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "unit/cycle/program.hpp"

/// Rests inside a program: dwell, action, stop, end.
namespace meridian {
namespace {

using test::alarm_of;
using test::kLimits;
using test::Program;

/// Cycles in which nothing moved between the first and the last that did.
int resting_cycles(const test::CycleWorld& world) {
  int resting = 0, pending = 0;
  bool has_moved = false;
  for (const CycleRecord& record : world.records) {
    if ((record.setpoint.flags & kSetpointMoving) != 0) {
      resting += has_moved ? pending : 0;
      pending = 0;
      has_moved = true;
    } else {
      ++pending;
    }
  }
  return resting;
}

TEST(StepBarriers, DwellsForItsTimeWhateverTheOverride) {
  Program p;
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kDwell, 0.25);
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kEnd);
  p.world.command(Verb::kFeedOverride, 0.5);
  p.run(0);
  ASSERT_TRUE(p.world.run_until(State::kReady));
  EXPECT_NEAR(resting_cycles(p.world), 250, 2);
}

TEST(StepBarriers, WaitsForTheActionOfItsBlock) {
  Program p;
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kAction);
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kEnd);
  p.run(2);
  EXPECT_EQ(p.world.now(), State::kRunning);
  EXPECT_EQ(p.world.count(EventCode::kActionDue), 1);
  EXPECT_EQ(p.world.last(EventCode::kActionDue).a, 1u);
  p.world.in.action = {0, true, true};  // of another block
  p.world.run_for(0.5);
  EXPECT_EQ(p.world.now(), State::kRunning);
  p.world.in.action = {1, true, true};
  ASSERT_TRUE(p.world.run_until(State::kReady, 5));
}

TEST(StepBarriers, ARefusedActionIsHeldWithAnAlarmAndAskedForAgainOnResume) {
  Program p;
  p.plan.barrier(TimeKind::kAction);
  p.plan.barrier(TimeKind::kEnd);
  p.run(0.1);
  p.world.in.action = {0, true, false};
  p.world.run_for(0.01);
  EXPECT_EQ(p.world.now(), State::kHeld);
  EXPECT_EQ(alarm_of(p.world), Alarm::kActionFailed);
  p.world.command(Verb::kResume);
  p.world.run_for(0.01);
  EXPECT_EQ(p.world.count(EventCode::kActionDue), 2);
  p.world.in.action = {0, true, true};
  EXPECT_TRUE(p.world.run_until(State::kReady, 1));
}

TEST(StepBarriers, AnActionThatNobodyAnswersTimesOutToHeld) {
  Program p;
  p.world.state.options.action_timeout_s = 0.5;
  p.plan.barrier(TimeKind::kAction);
  p.run(0.45);
  EXPECT_NE(p.world.now(), State::kHeld);
  p.world.run_for(0.1);
  EXPECT_EQ(p.world.now(), State::kHeld);
  EXPECT_EQ(alarm_of(p.world), Alarm::kActionFailed);
}

TEST(StepBarriers, AnActionThatIsDoneDuringAHoldIsNotAskedForAgain) {
  Program p;
  p.plan.barrier(TimeKind::kAction);
  p.plan.barrier(TimeKind::kEnd);
  p.run(0.1);
  p.world.command(Verb::kHold);
  EXPECT_EQ(p.world.now(), State::kHeld);
  p.world.in.action = {0, true, true};
  p.world.run_for(0.1);
  EXPECT_EQ(p.world.now(), State::kHeld);
  p.world.command(Verb::kResume);
  EXPECT_TRUE(p.world.run_until(State::kReady, 1));
  EXPECT_EQ(p.world.count(EventCode::kActionDue), 1);
}

/// Ends the program in force where it is and starts one that begins with an action.
void abort_and_start_with_action(Program& p) {
  p.world.command(Verb::kAbort);
  ASSERT_TRUE(p.world.run_until(State::kReady, 1));
  p.plan.set_epoch(p.world.state.epoch);
  p.plan.barrier(TimeKind::kAction);
  p.plan.barrier(TimeKind::kEnd);
  p.run(0.1);
}

TEST(StepBarriers, AnActionAheadOfEverythingIsAskedForThoughAnAbortedProgramWaitedForOne) {
  Program p;
  p.plan.barrier(TimeKind::kAction);
  p.run(0.1);
  ASSERT_NO_FATAL_FAILURE(abort_and_start_with_action(p));
  EXPECT_EQ(p.world.count(EventCode::kActionDue), 2);
  EXPECT_LT(p.world.state.barrier_time, 0.15) << "s that the one before waited do not count";
}

TEST(StepBarriers, AnActionAheadOfEverythingIsNotDoneByTheAnswerToThatOfAnAbortedProgram) {
  Program p;
  p.plan.barrier(TimeKind::kAction);
  p.run(0.1);
  p.world.command(Verb::kHold);
  p.world.in.action = {p.world.state.sequence, true, true};
  p.world.run_for(0.1);
  p.world.in.action = {};
  ASSERT_NO_FATAL_FAILURE(abort_and_start_with_action(p));
  EXPECT_EQ(p.world.count(EventCode::kActionDue), 2);
  EXPECT_EQ(p.world.now(), State::kApproaching) << "it waits ahead of all motion";
}

TEST(StepBarriers, AProgramStopIsHeldUntilTheOperatorResumes) {
  Program p;
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kStop);
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kEnd);
  p.run(3);
  EXPECT_EQ(p.world.now(), State::kHeld);
  p.world.command(Verb::kResume);
  EXPECT_TRUE(p.world.run_until(State::kReady, 5));
}

TEST(StepBarriers, AnOptionalStopIsHeldOnlyWhereTheOperatorAskedForIt) {
  for (const bool is_asked : {false, true}) {
    Program p;
    p.world.command(Verb::kOptionalStop, is_asked ? 1 : 0);
    p.plan.cut({5, 0, 0}, kLimits);
    p.plan.barrier(TimeKind::kOptionalStop);
    p.plan.barrier(TimeKind::kEnd);
    p.run(3);
    EXPECT_EQ(p.world.now(), is_asked ? State::kHeld : State::kReady);
    EXPECT_EQ(p.world.count(EventCode::kActionDue), 0) << "the planner announces none";
  }
}

TEST(StepBarriers, ASwitchIsOnOrOffAndNothingElse) {
  Program p;
  for (const Verb verb : {Verb::kSingleBlock, Verb::kOptionalStop}) {
    for (const double no_switch : {-1.0, 0.5, 2.0, std::nan("")}) {
      p.world.command(verb, no_switch);
      EXPECT_EQ(test::refusal_of(p.world), Refusal::kOutOfRange);
    }
    p.world.command(verb, 1);
    EXPECT_EQ(p.world.last(EventCode::kAccepted).b, static_cast<std::uint64_t>(verb));
  }
}

TEST(StepBarriers, TheNextProgramIsLoadedAndNotRunAfterAnEnd) {
  Program p;
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kEnd);
  p.plan.cut({5, 0, 0}, kLimits);
  p.run(3);
  EXPECT_EQ(p.world.now(), State::kLoaded);
  const ToolPose end{{5, 0, 0}, test::kBegin.axis};
  const JointVector joints = solve(p.machine, p.machine.tool_length_mm, end, 0, {}).q;
  EXPECT_NEAR(p.world.records.back().joints[0], joints[0], 1e-9);
}

}  // namespace
}  // namespace meridian
