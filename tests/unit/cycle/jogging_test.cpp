// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/jog/jogging.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "support/machines.hpp"
#include "unit/cycle/hand.hpp"

namespace meridian {
namespace {

using test::Hand;

constexpr double kDeadMan_s = 0.1;

TEST(Jogging, FollowsTheHeldVelocityAndComesToReadyWhereNobodyHoldsIt) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 40, 1.0);
  EXPECT_DOUBLE_EQ(hand.world.state.velocity[0], 40);
  EXPECT_EQ(hand.world.now(), State::kJogging);
  const double let_go = hand.world.state.joints[0];
  ASSERT_TRUE(hand.world.run_until(State::kReady, 1));
  const double travelled = hand.world.state.joints[0] - let_go;
  EXPECT_GT(travelled, 40 * kDeadMan_s) << "the dead man's time goes by first";
  EXPECT_LT(travelled, 40 * (kDeadMan_s + 0.1)) << "then it brakes at once";
  EXPECT_EQ(hand.world.state.velocity, JointVector{});
  EXPECT_EQ(hand.world.state.epoch, 1) << "a jog that ends by itself voids nothing";
}

TEST(Jogging, WithoutAnyOrderIsOverSoon) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  hand.world.run_for(kFirstOrder_s - 0.01);
  EXPECT_EQ(hand.world.now(), State::kJogging);
  hand.world.run_for(0.02);
  EXPECT_EQ(hand.world.now(), State::kReady);
}

TEST(Jogging, IsNotTakenUpAgainByAnOrderThatComesLate) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 200, 0.5);
  hand.world.run_for(kDeadMan_s + 0.01);
  ASSERT_EQ(hand.world.now(), State::kJogging) << "still braking";
  hand.hold(0, 200, 0.1);
  ASSERT_TRUE(hand.world.run_until(State::kReady, 1));
  const JointVector rest = hand.world.state.joints;
  hand.hold(0, 200, 0.1);
  EXPECT_EQ(hand.world.state.joints, rest) << "nor in Ready";
}

/// The hand is gone, and a wire that holds back what it said delivers it bit by bit.
TEST(Jogging, OrdersThatAWireHeldBackKeepNothingMoving) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 40, 0.5);
  const double let_go = hand.world.state.joints[0];
  for (int n = 0; n < 40; ++n) {
    hand.age_s += 0.02;
    hand.hold(0, 40, 0.02);
  }
  const double travelled = hand.world.state.joints[0] - let_go;
  EXPECT_LT(travelled, 40 * (kDeadMan_s + 0.1)) << "as where nothing came any more";
  EXPECT_EQ(hand.world.now(), State::kReady);
}

TEST(Jogging, TakesOrdersThatAWireDelaysByLessThanTheDeadMansTime) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  hand.age_s = kDeadMan_s - 0.03;
  hand.hold(0, 40, 1.0);
  EXPECT_DOUBLE_EQ(hand.world.state.velocity[0], 40);
  const double let_go = hand.world.state.joints[0];
  ASSERT_TRUE(hand.world.run_until(State::kReady, 1));
  EXPECT_LT(hand.world.state.joints[0] - let_go, 40 * (0.03 + 0.1))
      << "it let go that much earlier";
}

TEST(Jogging, LetsGoAtOnceHoweverLateThatComesIn) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 40, 0.5);
  hand.age_s = 3;
  hand.order(0, 0);
  hand.world.run();
  EXPECT_TRUE(hand.world.state.jogging.is_let_go());
}

TEST(Jogging, AStallOfTheHostCountsAgainstTheDeadManAlsoWhereNothingMoved) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 0, 0.1);
  hand.order(0, 300);
  hand.world.run(static_cast<std::uint32_t>(5 / hand.world.dt()));
  hand.order(0, 300);  // on its way since before the stall
  ASSERT_TRUE(hand.world.run_until(State::kReady, 1));
  EXPECT_EQ(hand.world.state.joints, JointVector{});
}

TEST(Jogging, OrdersOfAnotherEpochMoveNothing) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  hand.epoch = 7;
  const JointVector before = hand.world.state.joints;
  hand.hold(0, 20, 0.3);
  EXPECT_EQ(hand.world.state.joints, before);
}

TEST(Jogging, StopsExactlyAtTheEndOfTravelAndGoesBackFromThere) {
  Hand hand;
  const double end = hand.world.machine.joints[4].limits.travel_max;
  ASSERT_TRUE(hand.lay_on(4));
  hand.hold(4, 10, 3.0);
  EXPECT_NEAR(hand.world.state.joints[4], end, 1e-12);
  EXPECT_EQ(hand.world.state.velocity[4], 0);
  EXPECT_EQ(hand.world.now(), State::kJogging) << "held against the end";
  hand.hold(4, 5, 0.2);
  EXPECT_NEAR(hand.world.state.joints[4], end, 1e-12);
  hand.hold(4, -0.2, 0.5);
  EXPECT_LT(hand.world.state.joints[4], end - 0.05);
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

TEST(Jogging, FromOutsideOfTravelLeadsInwardsOnly) {
  JointVector at{};
  at[1] = 612;
  Hand hand(test::lai_machine(), at);
  ASSERT_EQ(hand.world.now(), State::kReady) << "whoever stands outside may be switched on";
  ASSERT_TRUE(hand.lay_on(1));
  hand.hold(1, 50, 0.5);
  EXPECT_NEAR(hand.world.state.joints[1], 612, 1e-9);
  hand.hold(1, -50, 0.15);
  const double inwards = hand.world.state.joints[1];
  EXPECT_LT(inwards, 611.9);
  hand.hold(1, 50, 0.5);
  EXPECT_LE(hand.world.state.joints[1], inwards) << "not out again";
  hand.hold(1, -50, 1.0);
  EXPECT_LT(hand.world.state.joints[1], 600);
  hand.hold(1, 50, 2.0);
  EXPECT_NEAR(hand.world.state.joints[1], 600, 1e-9);
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

TEST(Jogging, GoesExactlyTheDistanceThatIsAskedFor) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(2));
  hand.distance = 3.7;
  hand.hold(2, -200, 1.0);
  EXPECT_NEAR(hand.world.state.joints[2], -3.7, 1e-12);
  EXPECT_EQ(hand.world.state.velocity[2], 0);
}

TEST(Jogging, AnotherDistanceCountsFromWhereTheJointRestedFirst) {
  for (const double first : {0.0, 50.0}) {
    Hand hand;
    ASSERT_TRUE(hand.lay_on(2));
    hand.distance = first;
    hand.hold(2, -100, 0.2);
    const std::size_t begin = hand.world.records.size();
    ASSERT_LT(hand.world.state.velocity[2], -20);
    hand.distance = 2;
    hand.hold(2, -100, 1.5);
    std::size_t n = begin;
    while (hand.world.records[n].setpoint.velocity[2] != 0) ++n;
    EXPECT_NEAR(hand.world.state.joints[2], hand.world.records[n].joints[2] - 2, 1e-12);
    EXPECT_EQ(hand.world.state.velocity[2], 0);
  }
}

TEST(Jogging, OrdersOfAnotherHandMoveNothing) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  --hand.number;
  hand.hold(0, 20, 0.3);
  EXPECT_EQ(hand.world.state.joints, JointVector{});
}

TEST(Jogging, OneJointRestsBeforeTheNextOneMoves) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 100, 0.3);
  const std::size_t first = hand.world.records.size();
  hand.hold(2, 100, 0.5);
  for (std::size_t n = first; n < hand.world.records.size(); ++n) {
    const JointVector& v = hand.world.records[n].setpoint.velocity;
    EXPECT_FALSE(v[0] != 0 && v[2] != 0);
  }
  EXPECT_GT(hand.world.state.joints[2], 10);
}

TEST(Jogging, AbortBrakesAndVoidsEverythingThatWasAskedFor) {
  for (const Verb verb : {Verb::kAbort, Verb::kHold}) {
    Hand hand;
    ASSERT_TRUE(hand.lay_on(0));
    hand.hold(0, 250, 0.5);
    hand.world.command(verb);
    EXPECT_EQ(hand.world.now(), State::kAborting);
    ASSERT_TRUE(hand.world.run_until(State::kReady, 1));
    EXPECT_EQ(hand.world.state.epoch, 2);
    EXPECT_FALSE(hand.world.state.jogging.is_active());
  }
}

TEST(Jogging, AFaultBrakesHarder) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 290, 0.6);
  hand.world.in.feedback.fault_mask = 4;
  const std::uint64_t begin = hand.world.in.cycle;
  ASSERT_TRUE(hand.world.run_until(State::kFault, 1));
  const double took = static_cast<double>(hand.world.in.cycle - begin) * hand.world.dt();
  EXPECT_LT(took, 290.0 / 6000 + 6000.0 / 240000 + 0.004);
  EXPECT_GT(took, 0.02) << "not at once either";
}

TEST(Jogging, MorePeriodsLostThanDrivesBridgeEndInAStopFromFeedback) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 100, 0.5);
  hand.world.run(8);
  EXPECT_EQ(hand.world.now(), State::kFaultStop);
  EXPECT_TRUE(hand.world.run_until(State::kFault, 1));
  EXPECT_EQ(static_cast<Alarm>(hand.world.last(EventCode::kAlarm).a), Alarm::kPeriodsLost);
}

TEST(Jogging, AStopDoesNotBeginWhereDrivesReportedToBeBeforeAStall) {
  Hand hand;
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 290, 0.6);
  const double before = hand.world.state.joints[0], speed = hand.world.state.velocity[0];
  hand.world.are_drives_alive = false;
  hand.world.run(18);
  const double bridged_s = hand.world.machine.bridge_cycles * hand.world.dt();
  const double ramp_s = 18 * hand.world.dt() - bridged_s;
  const double decel = hand.world.machine.joints[0].limits.fault_acceleration;
  const double at = before + speed * bridged_s + speed * ramp_s - decel * ramp_s * ramp_s / 2;
  EXPECT_NEAR(hand.world.state.joints[0], at, speed * hand.world.dt());
  EXPECT_EQ(hand.world.now(), State::kFaultStop);
}

TEST(Jogging, DrivesThatRanOutOfTravelBrakeThereAndDoNotStandStillAtOnce) {
  for (const MachineModel& machine : {test::lai_machine(), test::hybrid_machine()}) {
    Hand hand(machine);
    ASSERT_TRUE(hand.lay_on(1));
    hand.hold(1, 290, 0.6);
    JointVector beyond = hand.world.state.joints;
    double speed = hand.world.state.velocity[1];
    ASSERT_GT(speed, 30);
    beyond[1] = machine.joints[1].limits.travel_max + 1;
    hand.world.in.feedback.position = drives_of(machine, beyond);
    const std::size_t first = hand.world.records.size();
    hand.world.run(8);
    ASSERT_TRUE(hand.world.run_until(State::kFault, 1));
    EXPECT_EQ(hand.world.count(EventCode::kAlarm), 1);
    EXPECT_EQ(static_cast<Alarm>(hand.world.last(EventCode::kAlarm).a), Alarm::kPeriodsLost);
    const double ramp = machine.joints[1].limits.fault_acceleration * hand.world.dt();
    for (std::size_t n = first; n < hand.world.records.size(); ++n) {
      const double v = hand.world.records[n].setpoint.velocity[1];
      if (machine.stage.radius_mm > 0) continue;  // of a drive there, not of the joint
      EXPECT_LE(std::abs(v - speed), ramp * (n == first ? 10 : 1.001));
      speed = v;
    }
    EXPECT_GT(hand.world.records.back().joints[1], beyond[1] + 0.05) << "braked from there";
  }
}

TEST(Jogging, LostPeriodsThatDrivesBridgeCountAgainstTheDeadMan) {
  Hand hand;
  hand.world.machine.bridge_cycles = 50;
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 50, 0.5);
  for (int n = 0; n < 4; ++n) hand.world.run(29);
  EXPECT_TRUE(hand.world.state.jogging.is_let_go() || hand.world.now() == State::kReady);
}

TEST(Jogging, WithoutAReferenceIsSlowHasNoTravelAndIsAllThereIs) {
  JointVector at{};
  at[0] = 5000;
  Hand hand(test::lai_machine(), at, 0x1EU);
  ASSERT_EQ(hand.world.now(), State::kReady) << "a position without a reference says nothing";
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 300, 1.0);
  EXPECT_DOUBLE_EQ(hand.world.state.velocity[0], 30);
  EXPECT_GT(hand.world.state.joints[0], 5010);
}

TEST(Jogging, IsRefusedWhileAStationHoldsTheMachine) {
  Hand hand;
  hand.world.in.session = 5;
  EXPECT_FALSE(hand.lay_on(0));
  EXPECT_EQ(hand.refusal(), Refusal::kProgramPresent);
}

TEST(Jogging, IsRefusedWithoutSuchAJointAndForAStageWithoutReferences) {
  Hand hand;
  EXPECT_FALSE(hand.lay_on(5));
  EXPECT_EQ(hand.refusal(), Refusal::kOutOfRange);
  Hand hybrid(test::hybrid_machine(), {}, 0x17U);
  EXPECT_FALSE(hybrid.lay_on(1));
  EXPECT_EQ(hybrid.refusal(), Refusal::kNotReferenced);
  EXPECT_TRUE(hybrid.lay_on(0));
}

TEST(Jogging, OfAStageEndsWhereItsDrivesDo) {
  Hand hand(test::hybrid_machine());
  const JointLimits& drive = hand.world.machine.stage_drives[0].limits;
  ASSERT_TRUE(hand.lay_on(1));
  hand.hold(1, 300, 5);
  hand.hold(1, -300, 8);
  const JointVector u = hand.world.records.back().setpoint.position;
  const double gap = std::min({std::abs(u[1] - drive.travel_max), std::abs(u[3] - drive.travel_max),
                               600 - std::abs(hand.world.state.joints[1])});
  EXPECT_NEAR(gap, 0, 1e-9);
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

}  // namespace
}  // namespace meridian
