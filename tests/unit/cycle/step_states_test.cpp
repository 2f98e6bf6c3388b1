// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "unit/cycle/program.hpp"

/// The arrows of the state diagram, one by one (docs/operating.md).
namespace meridian {
namespace {

using test::alarm_of;
using test::kLimits;
using test::MadePlan;
using test::Program;
using test::refusal_of;

TEST(Step, WhileOffTheSetpointIsTheFeedbackAndNotEnabled) {
  Program p(State::kOff);
  p.world.in.feedback.position[2] = 12.5;
  const CycleRecord& record = p.world.run();
  EXPECT_EQ(record.setpoint.position[2], 12.5);
  EXPECT_EQ(record.setpoint.flags, 0);
}

TEST(Step, TheFirstEnabledSetpointIsTheFeedback) {
  Program p(State::kOff);
  p.world.run();
  p.world.in.feedback.position[0] += 0.125;
  const CycleRecord& record = p.world.command(Verb::kEnable);
  EXPECT_EQ(record.state, State::kEnabling);
  EXPECT_EQ(record.setpoint.position, p.world.in.feedback.position);
  EXPECT_NE(record.setpoint.flags & kSetpointEnabled, 0);
}

TEST(Step, EnablingRepeatsTheLatchedFeedbackAndTimesOutToFault) {
  Program p(State::kOff);
  p.world.run();
  p.world.are_drives_alive = true;
  p.world.command(Verb::kEnable);
  const JointVector latched = p.world.records.back().setpoint.position;
  for (int n = 0; n < 4900; ++n) {
    p.world.in.feedback.enabled_mask = 0b01111;  // the last drive never comes
    p.world.in.feedback.position[1] = 1e-3 * n;
    ASSERT_EQ(p.world.run().setpoint.position, latched);
    ASSERT_EQ(p.world.now(), State::kEnabling);
  }
  for (int n = 0; n < 300; ++n) {
    p.world.in.feedback.enabled_mask = 0b01111;
    p.world.run();
  }
  EXPECT_EQ(p.world.now(), State::kFault);
  EXPECT_EQ(alarm_of(p.world), Alarm::kEnableTimeout);
  EXPECT_EQ(p.world.last(EventCode::kAlarm).b, 4u);
}

TEST(Step, RefusesToEnableWithoutFeedbackOrWithAFaultPresent) {
  Program p(State::kOff);
  p.world.are_drives_alive = false;
  p.world.command(Verb::kEnable);
  EXPECT_EQ(refusal_of(p.world), Refusal::kNoFeedback);
  p.world.are_drives_alive = true;
  p.world.in.feedback.fault_mask = 1;
  p.world.command(Verb::kEnable);
  EXPECT_EQ(refusal_of(p.world), Refusal::kFaultPresent);
  EXPECT_EQ(p.world.now(), State::kOff);
}

TEST(Step, OnlyReadyWithBlocksIsLoadedAndOnlyStartMoves) {
  Program p;
  p.world.run_for(0.1);
  EXPECT_EQ(p.world.now(), State::kReady);
  p.plan.cut({10, 0, 0}, kLimits);
  p.world.run_for(0.5);
  EXPECT_EQ(p.world.now(), State::kLoaded);
  for (const CycleRecord& record : p.world.records) {
    ASSERT_EQ(record.setpoint.flags & kSetpointMoving, 0);
  }
  p.world.command(Verb::kStart);
  p.world.run();
  EXPECT_NE(p.world.records.back().setpoint.flags & kSetpointMoving, 0);
}

TEST(Step, RunsAProgramFromApproachToEnd) {
  Program p;
  p.plan.cut({0, 0, -5}, kLimits, MotionKind::kApproach);
  p.plan.cut({10, 0, 0}, kLimits);
  p.plan.cut({0, 10, 0}, kLimits);
  p.plan.barrier(TimeKind::kEnd);
  ASSERT_TRUE(p.world.run_until(State::kLoaded));
  p.world.command(Verb::kStart);
  ASSERT_TRUE(p.world.run_until(State::kReady));
  const std::vector<State> expected{State::kOff,    State::kEnabling,    State::kReady,
                                    State::kLoaded, State::kApproaching, State::kRunning,
                                    State::kReady};
  EXPECT_EQ(p.world.states(), expected);
  EXPECT_EQ(p.world.count(EventCode::kBlockStarted), 3);
  EXPECT_EQ(p.world.count(EventCode::kBlockDone), 3);
  EXPECT_EQ(p.world.count(EventCode::kProgramEnd), 1);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(p.world.records.back().joints[i], p.plan.joints()[i], 1e-9);
  }
}

TEST(Step, RefusesToStartUnreferenced) {
  Program p;
  p.plan.cut({10, 0, 0}, kLimits);
  ASSERT_TRUE(p.world.run_until(State::kLoaded));
  p.world.in.feedback.referenced_mask = 0b10111;
  p.world.command(Verb::kStart);
  EXPECT_EQ(refusal_of(p.world), Refusal::kNotReferenced);
  EXPECT_EQ(p.world.now(), State::kLoaded);
}

TEST(Step, HoldsOnThePathAndResumesToTheEnd) {
  Program p;
  p.plan.cut({50, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kEnd);
  p.run(0.2);
  p.world.command(Verb::kHold);
  EXPECT_EQ(p.world.now(), State::kHolding);
  ASSERT_TRUE(p.world.run_until(State::kHeld));
  const Event stopped = p.world.last(EventCode::kStopped);
  EXPECT_NEAR(static_cast<double>(stopped.a) * 1e-9, 100.0 / 1500 + 1500.0 / 30000, 2e-3);
  EXPECT_GT(stopped.x, 1);
  const JointVector held = p.world.records.back().joints;
  p.world.run_for(0.1);
  EXPECT_EQ(p.world.records.back().joints, held);
  p.world.command(Verb::kResume);
  ASSERT_TRUE(p.world.run_until(State::kReady));
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(p.world.records.back().joints[i], p.plan.joints()[i], 1e-9);
  }
}

TEST(Step, TheSetpointOfTheCycleThatSeesTheHoldAlreadyDecelerates) {
  Program p;
  p.plan.cut({80, 0, 0}, kLimits);
  p.run(0.4);
  const auto& r = p.world.records;
  const auto step_of = [&r](std::size_t back) {
    return r[r.size() - 1 - back].joints[0] - r[r.size() - 2 - back].joints[0];
  };
  EXPECT_NEAR(step_of(0), step_of(1), 1e-12);  // cruise
  p.world.command(Verb::kHold);
  EXPECT_LT(step_of(0), step_of(1) - 1e-6);
  p.world.run();
  EXPECT_LT(step_of(0), step_of(1) - 1e-5);
}

TEST(Step, AbortStopsOnThePathThenEmptiesTheQueueAndAdvancesTheEpoch) {
  Program p;
  for (int n = 0; n < 20; ++n) p.plan.cut({50, 0, 0}, kLimits);
  p.run(0.2);
  p.world.command(Verb::kAbort);
  EXPECT_EQ(p.world.now(), State::kAborting);
  EXPECT_EQ(p.world.records.back().setpoint.epoch, 1);
  ASSERT_TRUE(p.world.run_until(State::kReady));
  EXPECT_EQ(p.world.last(EventCode::kEpochAdvanced).a, 2u);
  p.world.run_for(0.5);
  EXPECT_EQ(p.world.now(), State::kReady);
  EXPECT_TRUE(p.world.port->times.empty());
}

TEST(Step, ASecondProgramRunsAfterAnAbort) {
  Program p;
  p.plan.cut({50, 0, 0}, kLimits);
  ASSERT_TRUE(p.world.run_until(State::kLoaded));
  p.world.command(Verb::kAbort);
  ASSERT_EQ(p.world.now(), State::kReady);
  MadePlan second(p.machine, *p.world.port, test::kBegin);
  second.set_epoch(p.world.state.epoch);
  second.cut({0, 20, 0}, kLimits);
  second.barrier(TimeKind::kEnd);
  ASSERT_TRUE(p.world.run_until(State::kLoaded));
  p.world.command(Verb::kStart);
  ASSERT_TRUE(p.world.run_until(State::kReady));
  EXPECT_NEAR(p.world.records.back().joints[1], second.joints()[1], 1e-9);
}

TEST(Step, StarvedContinuesByItselfInTimeAndInItsOwnSession) {
  Program p;
  p.plan.cut({5, 0, 0}, kLimits);
  ASSERT_TRUE(p.world.run_until(State::kLoaded));
  p.world.command(Verb::kStart);
  ASSERT_TRUE(p.world.run_until(State::kStarved));
  p.world.run_for(1.5);
  p.plan.cut({5, 0, 0}, kLimits);
  p.world.run();
  EXPECT_EQ(p.world.now(), State::kRunning);
  ASSERT_TRUE(p.world.run_until(State::kStarved));
  EXPECT_EQ(p.world.state.starvations, 2u);
}

TEST(Step, StarvedTooLongWaitsForTheOperator) {
  Program p;
  p.plan.cut({5, 0, 0}, kLimits);
  ASSERT_TRUE(p.world.run_until(State::kLoaded));
  p.world.command(Verb::kStart);
  ASSERT_TRUE(p.world.run_until(State::kStarved));
  p.world.command(Verb::kResume);
  EXPECT_EQ(refusal_of(p.world), Refusal::kNoProgram);
  p.world.run_for(2.1);
  p.plan.cut({5, 0, 0}, kLimits);
  p.world.run_for(1);
  EXPECT_EQ(p.world.now(), State::kStarved);
  p.world.command(Verb::kResume);
  EXPECT_EQ(p.world.now(), State::kRunning);
}

TEST(Step, StarvedDoesNotContinueForAnotherStation) {
  Program p;
  p.plan.cut({5, 0, 0}, kLimits);
  ASSERT_TRUE(p.world.run_until(State::kLoaded));
  p.world.command(Verb::kStart);
  ASSERT_TRUE(p.world.run_until(State::kStarved));
  p.world.in.session = 2;
  p.plan.cut({5, 0, 0}, kLimits);
  p.world.run_for(0.5);
  EXPECT_EQ(p.world.now(), State::kStarved);
}

TEST(Step, HoldWhileStarvedMeansHeld) {
  Program p;
  p.plan.cut({5, 0, 0}, kLimits);
  ASSERT_TRUE(p.world.run_until(State::kLoaded));
  p.world.command(Verb::kStart);
  ASSERT_TRUE(p.world.run_until(State::kStarved));
  p.world.command(Verb::kHold);
  EXPECT_EQ(p.world.now(), State::kHeld);
  p.plan.cut({5, 0, 0}, kLimits);
  p.world.run_for(0.5);
  EXPECT_EQ(p.world.now(), State::kHeld);
}

TEST(Step, DisablesOnlyAtRestAndOverDisablingToOff) {
  Program p;
  p.plan.cut({50, 0, 0}, kLimits);
  ASSERT_TRUE(p.world.run_until(State::kLoaded));
  p.world.command(Verb::kStart);
  p.world.command(Verb::kDisable);
  EXPECT_EQ(refusal_of(p.world), Refusal::kWrongState);
  p.world.command(Verb::kHold);
  ASSERT_TRUE(p.world.run_until(State::kHeld));
  p.world.command(Verb::kDisable);
  EXPECT_EQ(p.world.now(), State::kDisabling);
  ASSERT_TRUE(p.world.run_until(State::kOff, 2));
  EXPECT_EQ(p.world.state.epoch, 2);
}

TEST(Step, OverridesOutOfRangeAreRefusedAndThoseInForceStay) {
  Program p;
  p.world.command(Verb::kFeedOverride, 0.7);
  EXPECT_EQ(p.world.state.feed_override, 0.7);
  for (const double bad : {-0.1, 1.01, 1.5, std::nan("")}) {
    p.world.command(Verb::kFeedOverride, bad);
    EXPECT_EQ(refusal_of(p.world), Refusal::kOutOfRange);
  }
  p.world.command(Verb::kRapidOverride, 1.01);
  EXPECT_EQ(refusal_of(p.world), Refusal::kOutOfRange);
  EXPECT_EQ(p.world.state.feed_override, 0.7);
  EXPECT_EQ(p.world.state.rapid_override, 1.0);
}

TEST(Step, AcceptsAnOverrideUpToTheMachinesMaximumAndReportsItToThePlanner) {
  Program p;
  p.world.machine.max_feed_override = 1.2;
  p.world.command(Verb::kFeedOverride, 1.2);
  EXPECT_EQ(p.world.state.feed_override, 1.2);
  EXPECT_EQ(p.world.port->feed_override, 1.2);
  p.world.command(Verb::kFeedOverride, 1.21);
  EXPECT_EQ(refusal_of(p.world), Refusal::kOutOfRange);
  p.world.command(Verb::kRapidOverride, 1.1);
  EXPECT_EQ(refusal_of(p.world), Refusal::kOutOfRange);
  EXPECT_EQ(p.world.port->feed_override, 1.2);
}

TEST(Step, FollowsTheOverrideOfTheMotionInForce) {
  Program p;
  p.plan.cut({60, 0, 0}, kLimits, MotionKind::kRapid);
  p.plan.cut({60, 0, 0}, kLimits);
  p.world.command(Verb::kFeedOverride, 0.5);
  p.run(0.2);
  EXPECT_EQ(p.world.records.back().rate, 1);
  p.world.run_for(1.2);
  EXPECT_EQ(p.world.records.back().motion, MotionKind::kCut);
  EXPECT_EQ(p.world.records.back().rate, 0.5);
}

}  // namespace
}  // namespace meridian
