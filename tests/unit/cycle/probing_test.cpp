// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/jog/probing.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/cycle/hand.hpp"
#include "unit/cycle/probed.hpp"

namespace meridian {
namespace {

using test::alarm_of;
using test::Hand;
using test::kLimits;
using test::Probed;
using test::Program;
using test::refusal_of;

TEST(Probing, IsRefusedWithoutAProbeInContactAndInADryRun) {
  Probed none(ProbeInput::kNone);
  none.seek(0.01);
  EXPECT_EQ(none.world.now(), State::kLoaded);
  EXPECT_EQ(refusal_of(none.world), Refusal::kNoProbe);
  Probed touching(ProbeInput::kContact);
  touching.seek(0.01);
  EXPECT_EQ(touching.world.now(), State::kLoaded);
  EXPECT_EQ(refusal_of(touching.world), Refusal::kProbeContact);
  Program dry(State::kOff);
  dry.world.in.feedback.probe = ProbeInput::kFree;
  dry.world.run();
  dry.world.command(Verb::kDryRun, 1);
  dry.plan.set_epoch(dry.world.state.epoch);
  dry.plan.cut({200, 0, 0}, kLimits);
  dry.world.command(Verb::kEnable);
  ASSERT_TRUE(dry.world.run_until(State::kReady, 1));
  dry.world.command(Verb::kStart, kStartProbing);
  EXPECT_EQ(refusal_of(dry.world), Refusal::kDryRun);
}

TEST(Probing, DoesNotBeginInTheMiddleOfAnotherProgram) {
  Probed p;
  p.run(0.2);
  ASSERT_EQ(p.world.now(), State::kRunning);
  p.world.command(Verb::kStart, kStartProbing);
  EXPECT_EQ(refusal_of(p.world), Refusal::kWrongState);
  EXPECT_EQ(p.world.state.probing.state, ProbeState::kOff);
}

TEST(Probing, LatchesTheFeedbackOfBothReportsAndStopsOnThePath) {
  Probed p;
  p.seek(0.4);
  ASSERT_EQ(p.world.now(), State::kRunning);
  const JointVector before = p.world.records[p.world.records.size() - 2].joints;
  const JointVector at = p.world.records.back().joints;
  p.touch();
  EXPECT_EQ(p.world.now(), State::kAborting);
  EXPECT_EQ(p.reported(0), at);
  EXPECT_EQ(p.reported(1), before);
  EXPECT_EQ(p.world.count(EventCode::kContactFound), 1);
  EXPECT_EQ(p.world.last(EventCode::kContactFound).a, 1U);
  ASSERT_TRUE(p.world.run_until(State::kReady, 2));
  EXPECT_EQ(p.world.state.epoch, 2);
  EXPECT_EQ(p.world.count(EventCode::kAlarm), 0);
  EXPECT_EQ(p.world.count(EventCode::kProgramEnd), 0);
  EXPECT_NEAR(p.tip_x(p.world.state.joints) - p.tip_x(at), p.world.last(EventCode::kStopped).x,
              1e-6);
  EXPECT_EQ(p.world.state.probing.state, ProbeState::kOff);
}

TEST(Probing, CountsThePeriodsBetweenTheReportsThatItSaw) {
  Probed p;
  p.seek(0.4);
  p.say(ProbeInput::kContact);
  p.world.run(2);  // two periods were lost, and with them two reports
  EXPECT_EQ(p.world.last(EventCode::kContactFound).a, 3U);
}

TEST(Probing, WithoutContactEndsInReadyWithAnAlarmAndNoFault) {
  Probed p;
  p.seek(0);
  ASSERT_TRUE(p.world.run_until(State::kReady, 10));
  EXPECT_EQ(alarm_of(p.world), Alarm::kNoContact);
  EXPECT_EQ(p.world.count(EventCode::kProgramEnd), 1);
  EXPECT_EQ(p.world.state.alarm, Alarm::kNone);
  EXPECT_EQ(p.world.state.probing.state, ProbeState::kOff);
}

TEST(Probing, ThatAnOperatorAbortsSaysNothingOfAContact) {
  Probed p;
  p.seek(0.4);
  p.world.command(Verb::kAbort);
  ASSERT_TRUE(p.world.run_until(State::kReady, 2));
  EXPECT_EQ(p.world.count(EventCode::kAlarm), 0);
  EXPECT_EQ(p.world.count(EventCode::kContactFound), 0);
}

TEST(Probing, FindsItsContactWhileItIsHeldBackToo) {
  Probed p;
  p.seek(0.4);
  p.world.command(Verb::kHold);
  ASSERT_EQ(p.world.now(), State::kHolding);
  p.touch();
  EXPECT_EQ(p.world.count(EventCode::kContactFound), 1);
  EXPECT_EQ(p.world.last(EventCode::kContactFound).x, 1) << "it was stopped already";
  EXPECT_EQ(p.world.now(), State::kAborting);
  ASSERT_TRUE(p.world.run_until(State::kReady, 2));
  EXPECT_EQ(p.world.count(EventCode::kAlarm), 0);
}

TEST(Probing, FindsTheContactOfDrivesThatComeUpToItsEndLate) {
  Probed p;
  p.seek(0);
  const auto run_late = [&p] {
    p.world.in.feedback.position[0] -= 0.05;  // mm, what the first joint lags
    p.world.run();
  };
  for (int n = 0; n < 10'000 && p.world.state.barrier_time == 0; ++n) run_late();
  for (int n = 0; n < 20; ++n) run_late();
  ASSERT_EQ(p.world.now(), State::kRunning) << "it waits for them";
  p.say(ProbeInput::kContact);
  run_late();
  EXPECT_EQ(p.world.count(EventCode::kContactFound), 1);
  EXPECT_EQ(p.world.count(EventCode::kAlarm), 0);
  ASSERT_TRUE(p.world.run_until(State::kReady, 2));
}

TEST(Probing, WaitsForDrivesThatNeverComeUpToItsEndNoLongerThanTheySettle) {
  Probed p;
  p.seek(0);
  double waited_s = 0;
  for (int n = 0; n < 10'000 && p.world.now() != State::kReady; ++n) {
    p.world.in.feedback.position[0] -= 0.05;
    p.world.run();
    if (p.world.state.barrier_time > 0) waited_s += p.world.dt();
  }
  EXPECT_EQ(alarm_of(p.world), Alarm::kNoContact);
  EXPECT_NEAR(waited_s, kProbeSettle_s, 0.01);
}

TEST(Probing, IsNoFasterThanItsFeedWhateverTheOverride) {
  for (const bool is_sought : {true, false}) {
    Probed p(ProbeInput::kFree, 1.25);
    p.world.machine.max_feed_override = 1.25;
    p.world.command(Verb::kFeedOverride, 1.25);
    p.world.command(Verb::kStart, is_sought ? kStartProbing : 0);
    p.world.run_for(0.5);
    ASSERT_EQ(p.world.now(), State::kRunning);
    const double of_the_feed = 1.25 * p.world.records.back().rate;
    EXPECT_NEAR(of_the_feed, is_sought ? 1 : 1.25, 1e-9);
  }
}

TEST(Probing, AMotionThatBeginsInContactAndStaysInItIsAnAlarm) {
  Hand hand;
  hand.world.in.feedback.probe = ProbeInput::kContact;
  hand.world.run_for(0.05);
  ASSERT_TRUE(hand.lay_on(0));
  const double begin = hand.world.state.joints[0];
  for (int n = 0; n < 200 && hand.world.now() == State::kJogging; ++n) hand.hold(0, 20, 0.02);
  EXPECT_EQ(hand.world.state.alarm, Alarm::kContact);
  EXPECT_NEAR(std::abs(hand.world.state.joints[0] - begin), kLeaveContact_mm, 1);
}

TEST(Probing, IsNotResumedInContactAndFindsItBehindTheResume) {
  Probed p;
  p.seek(0.4);
  p.world.command(Verb::kHold);
  ASSERT_TRUE(p.world.run_until(State::kHeld, 2));
  p.touch();  // by hand
  p.world.command(Verb::kResume);
  EXPECT_EQ(refusal_of(p.world), Refusal::kProbeContact);
  EXPECT_EQ(p.world.now(), State::kHeld);
  EXPECT_EQ(p.world.count(EventCode::kContactFound), 0);
  p.say(ProbeInput::kFree);
  p.world.command(Verb::kResume);
  p.world.run_for(0.2);
  p.touch();
  EXPECT_EQ(p.world.count(EventCode::kContactFound), 1);
}

TEST(Probing, StopsWithAnAlarmWhereTheProbeIsConnectedNoMore) {
  Probed p;
  p.seek(0.4);
  p.say(ProbeInput::kNone);
  p.world.run();
  EXPECT_EQ(p.world.now(), State::kFaultStop);
  EXPECT_EQ(p.world.state.alarm, Alarm::kProbeLost);
  ASSERT_TRUE(p.world.run_until(State::kFault, 2));
}

TEST(Probing, StopsWithAnAlarmWhereFeedbackIsLost) {
  Probed p;
  p.seek(0.4);
  p.world.are_drives_alive = false;
  ASSERT_TRUE(p.world.run_until(State::kFault, 2));
  EXPECT_EQ(p.world.state.alarm, Alarm::kFeedbackLost);
  EXPECT_EQ(p.world.count(EventCode::kContactFound), 0);
}

TEST(Probing, ContactInAProgramThatSeeksNoneIsAnAlarm) {
  Probed p;
  p.run(0.4);
  p.touch();
  EXPECT_EQ(p.world.now(), State::kFaultStop);
  EXPECT_EQ(p.world.state.alarm, Alarm::kContact);
  EXPECT_EQ(p.world.count(EventCode::kContactFound), 0);
}

TEST(Probing, ContactWhileJoggingIsAnAlarm) {
  Hand hand;
  hand.world.in.feedback.probe = ProbeInput::kFree;
  hand.world.run_for(0.05);
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 20, 0.3);
  ASSERT_EQ(hand.world.now(), State::kJogging);
  hand.world.in.feedback.probe = ProbeInput::kContact;
  hand.world.run();
  EXPECT_EQ(hand.world.now(), State::kFaultStop);
  EXPECT_EQ(hand.world.state.alarm, Alarm::kContact);
}

TEST(Probing, AMotionThatBeginsInContactMayLeaveItAndItsStylusMayBounce) {
  Hand hand;
  hand.world.in.feedback.probe = ProbeInput::kContact;
  hand.world.run_for(0.05);
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 20, 0.2);
  for (int n = 0; n < 3; ++n) {
    hand.order(0, 20);
    hand.world.in.feedback.probe = ProbeInput::kFree;
    hand.world.run_for(0.015);
    hand.world.in.feedback.probe = ProbeInput::kContact;
    hand.world.run_for(0.01);
  }
  hand.world.in.feedback.probe = ProbeInput::kFree;
  hand.hold(0, 20, 0.1);
  EXPECT_EQ(hand.world.now(), State::kJogging);
  hand.world.in.feedback.probe = ProbeInput::kContact;
  hand.world.run();
  EXPECT_EQ(hand.world.state.alarm, Alarm::kContact) << "free for long enough";
}

TEST(Probing, WhoTouchesTheProbeOfAMachineAtRestStopsNothing) {
  Probed p;
  p.world.run_for(0.05);
  p.touch();
  p.world.run_for(0.05);
  EXPECT_EQ(p.world.now(), State::kLoaded);
  EXPECT_EQ(p.world.count(EventCode::kAlarm), 0);
}

TEST(Probing, DrivesThatAreHomingMayTouch) {
  Hand hand;
  hand.world.in.feedback.probe = ProbeInput::kFree;
  hand.world.run_for(0.05);
  hand.world.command(Verb::kHome);
  ASSERT_EQ(hand.world.now(), State::kHoming);
  hand.world.in.feedback.homing_mask = 0x1F;
  hand.world.in.feedback.position[0] += 0.01;
  hand.world.run();
  hand.world.in.feedback.probe = ProbeInput::kContact;
  hand.world.run();
  EXPECT_EQ(hand.world.now(), State::kHoming);
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

}  // namespace
}  // namespace meridian
