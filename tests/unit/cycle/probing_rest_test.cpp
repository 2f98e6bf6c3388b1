// SPDX-License-Identifier: Apache-2.0

/// What the probe means beside the contact that is sought: at rest, at the end, in slow periods.

#include <gtest/gtest.h>

#include <cmath>

#include "meridian/cycle/jog/probing.hpp"
#include "unit/cycle/hand.hpp"
#include "unit/cycle/probed.hpp"

namespace meridian::test::probing_rest {
namespace {

TEST(ProbingRest, WhoTouchesTheProbeOfAProgramThatIsHeldStopsNothing) {
  Probed p;
  p.run(0.4);
  p.world.command(Verb::kHold);
  ASSERT_TRUE(p.world.run_until(State::kHeld, 2));
  p.world.run_for(0.05);
  p.touch();
  p.world.run_for(0.05);
  EXPECT_EQ(p.world.now(), State::kHeld);
  EXPECT_EQ(p.world.count(EventCode::kAlarm), 0);
}

TEST(ProbingRest, WhoTouchesTheProbeDuringADwellStopsNothing) {
  Program p;
  p.world.in.feedback.probe = ProbeInput::kFree;
  p.plan.cut({5, 0, 0}, kLimits);
  p.plan.barrier(TimeKind::kDwell, 1);
  p.plan.barrier(TimeKind::kEnd);
  p.run(0);
  while (p.world.state.barrier_time == 0) p.world.run();
  p.world.in.feedback.probe = ProbeInput::kContact;
  p.world.run_for(0.05);
  EXPECT_EQ(p.world.now(), State::kRunning);
  EXPECT_EQ(p.world.count(EventCode::kAlarm), 0);
}

TEST(ProbingRest, WhoTouchesTheProbeOfAJogSessionAtRestStopsNothing) {
  Hand hand;
  hand.world.in.feedback.probe = ProbeInput::kFree;
  hand.world.run_for(0.05);
  ASSERT_TRUE(hand.lay_on(0));
  hand.world.in.feedback.probe = ProbeInput::kContact;
  hand.world.run_for(0.02);
  EXPECT_EQ(hand.world.now(), State::kJogging);
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

TEST(ProbingRest, IsAtItsEndWhereDrivesAreWithinAMicrometre) {
  for (const double lag_mm : {0.0009, 0.0015}) {
    Probed p;
    p.seek(0);
    double waited_s = 0;
    for (int n = 0; n < 10'000 && p.world.now() != State::kReady; ++n) {
      p.world.in.feedback.position[0] -= lag_mm;
      p.world.run();
      if (p.world.state.barrier_time > 0) waited_s += p.world.dt();
    }
    EXPECT_EQ(p.world.now(), State::kReady);
    EXPECT_EQ(waited_s > 0.01, lag_mm > 0.001) << waited_s;
  }
}

TEST(ProbingRest, AMotionLeavesContactWithinTheSameDistanceWherePeriodsAreLost) {
  Hand hand;
  hand.world.in.feedback.probe = ProbeInput::kContact;
  hand.world.run_for(0.05);
  ASSERT_TRUE(hand.lay_on(0));
  const double begin = hand.world.state.joints[0];
  for (int n = 0; n < 2000 && hand.world.now() == State::kJogging; ++n) {
    hand.order(0, 20);
    hand.world.run(1);
  }
  EXPECT_EQ(hand.world.state.alarm, Alarm::kContact);
  EXPECT_NEAR(std::abs(hand.world.state.joints[0] - begin), kLeaveContact_mm, 1);
}

}  // namespace
}  // namespace meridian::test::probing_rest
