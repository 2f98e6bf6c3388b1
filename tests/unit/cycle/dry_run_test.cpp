// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/dry_run.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "unit/cycle/dry_program.hpp"
#include "unit/cycle/hand.hpp"

/// A dry run: the machine runs as ever, and there is no way from it to a drive.
namespace meridian {
namespace {

using test::alarm_of;
using test::CycleWorld;
using test::DryRun;
using test::kLimits;
using test::machine_at_begin;
using test::Program;
using test::refusal_of;

/// Holds, an override, lost periods and a resume on the way; the rows from the start on.
[[nodiscard]] std::vector<CycleRecord> operate(CycleWorld& world) {
  EXPECT_TRUE(world.run_until(State::kLoaded, 1));
  const std::size_t first = world.records.size();
  world.command(Verb::kStart);
  world.run_for(0.15);
  world.command(Verb::kFeedOverride, 0.6);
  world.run(2);
  world.run_for(0.1);
  world.command(Verb::kHold);
  EXPECT_TRUE(world.run_until(State::kHeld, 1));
  world.command(Verb::kResume);
  EXPECT_TRUE(world.run_until(State::kReady, 5));
  return {world.records.begin() + static_cast<std::ptrdiff_t>(first), world.records.end()};
}

void expect_same_motion_as_wet(const MachineModel& model) {
  Program wet(State::kReady, machine_at_begin(model));
  wet.plan.set_epoch(wet.world.state.epoch);
  wet.plan.cut({30, 0, 0}, kLimits);
  wet.plan.cut({0, 20, 0}, kLimits);
  wet.plan.barrier(TimeKind::kEnd);
  DryRun dry(false, model);
  ASSERT_TRUE(dry.begin());
  dry.cut();
  const auto wanted = operate(wet.world), is = operate(dry.world);
  ASSERT_EQ(is.size(), wanted.size());
  ASSERT_GT(is.size(), 500U);
  for (std::size_t n = 0; n < is.size(); ++n) {
    ASSERT_EQ(is[n].joints, wanted[n].joints) << n;
    ASSERT_EQ(is[n].setpoint.position, wanted[n].setpoint.position) << n;
    ASSERT_EQ(is[n].setpoint.velocity, wanted[n].setpoint.velocity) << n;
    ASSERT_EQ(is[n].state, wanted[n].state) << n;
    ASSERT_EQ(is[n].setpoint.flags & ~(kSetpointDry | kSetpointDryEnabled),
              wanted[n].setpoint.flags & ~kSetpointEnabled);
    ASSERT_EQ(is_leading(is[n].setpoint.flags), is_leading(wanted[n].setpoint.flags));
  }
}

TEST(DryRun, WithoutDrivesMovesAsWithDrivesBitForBit) {
  expect_same_motion_as_wet(test::lai_machine());
  expect_same_motion_as_wet(test::hybrid_machine());
}

TEST(DryRun, NeverSendsASetpointThatDrivesFollow) {
  DryRun dry;
  ASSERT_TRUE(dry.begin());
  const std::size_t first = dry.world.records.size() - 3;  // the word itself
  dry.cut();
  dry.run(0.1);
  dry.report_emergency();
  ASSERT_TRUE(dry.world.run_until(State::kFault, 1));
  EXPECT_EQ(alarm_of(dry.world), Alarm::kEmergencyStop) << "as ever";
  dry.world.command(Verb::kReset);
  EXPECT_EQ(refusal_of(dry.world), Refusal::kFaultPresent);
  dry.world.in.feedback.emergency_stop = false;
  dry.world.command(Verb::kReset);
  EXPECT_EQ(dry.world.now(), State::kOff);
  EXPECT_TRUE(dry.world.enable()) << "and again, still dry";
  for (std::size_t n = first; n < dry.world.records.size(); ++n) {
    const CycleRecord& record = dry.world.records[n];
    ASSERT_EQ(record.setpoint.flags & kSetpointEnabled, 0) << n;
    ASSERT_NE(record.setpoint.flags & kSetpointDry, 0) << n;
    ASSERT_EQ((record.setpoint.flags & kSetpointDryEnabled) != 0, is_enabled(record.state)) << n;
  }
}

TEST(DryRun, HearsTheEmergencyInputForASecondAndForAsLongAsTheCycleStalled) {
  const MachineModel machine = test::lai_machine();
  CycleInputs in;
  in.now_ns = 10'000'000'000;
  in.feedback.emergency_stop = true;
  const auto is_heard_after = [&](double seconds) {
    in.feedback.emergency_ns = in.now_ns - static_cast<std::int64_t>(1e9 * seconds);
    return is_emergency_heard(machine, in);
  };
  EXPECT_TRUE(is_heard_after(0.999));
  EXPECT_FALSE(is_heard_after(1.001));
  in.lost_periods = 5;
  const double stalled = 5e-9 * static_cast<double>(machine.cycle_ns);
  EXPECT_TRUE(is_heard_after(0.999 + stalled));
  EXPECT_FALSE(is_heard_after(1.001 + stalled));
  in.feedback.emergency_stop = false;
  EXPECT_FALSE(is_heard_after(0)) << "it is closed";
  in = {};
  in.now_ns = 500'000'000;
  in.feedback.emergency_stop = true;
  EXPECT_FALSE(is_emergency_heard(machine, in)) << "nobody ever said so";
}

TEST(DryRun, StandsInForDrivesThatHaveSeenTheLastCycleThatRan) {
  CycleInputs in;
  in.cycle = 100;
  in.lost_periods = 2;
  in.now_ns = 7;
  const DryRun run;
  const Feedback dry = dry_feedback(run.machine, run.world.state, in);
  EXPECT_EQ(dry.cycle_seen, 97U);
  EXPECT_EQ(dry.arrival_ns, 7);
}

TEST(DryRun, BeginsWhereDrivesStandThatAllHaveTheirReferencesElseAtHome) {
  for (const bool is_referenced : {true, false}) {
    DryRun dry(true);
    dry.world.in.feedback.position[1] += 7.5;
    if (!is_referenced) dry.world.in.feedback.referenced_mask &= ~4U;
    ASSERT_TRUE(dry.begin());
    const double home = dry.machine.joints[1].home;
    EXPECT_EQ(dry.world.records.back().joints[1], is_referenced ? home + 7.5 : home);
  }
}

TEST(DryRun, LeavesDrivesWhereTheyAreAndBeginsWithThemWhereTheyAre) {
  DryRun dry(true);
  const JointVector stand = dry.world.in.feedback.position;
  ASSERT_TRUE(dry.begin());
  dry.cut();
  dry.run(0.3);
  EXPECT_GT(std::abs(dry.world.state.joints[0] - stand[0]), 1) << "the dry joints are elsewhere";
  dry.world.command(Verb::kAbort);
  ASSERT_TRUE(dry.world.run_until(State::kReady, 1));
  dry.world.command(Verb::kDisable);
  ASSERT_TRUE(dry.world.run_until(State::kOff, 0.1));
  dry.world.run();
  EXPECT_EQ(dry.world.records.back().setpoint.position, stand) << "off, it is the feedback";
  EXPECT_EQ(dry.world.in.feedback.position, stand);
  dry.world.command(Verb::kDryRun, 0);
  EXPECT_EQ(dry.flags(), 0);
  dry.world.command(Verb::kEnable);
  EXPECT_EQ(dry.world.records.back().setpoint.position, stand);
  EXPECT_EQ(dry.flags(), kSetpointEnabled);
  ASSERT_TRUE(dry.world.run_until(State::kReady, 1));
  EXPECT_EQ(dry.world.in.feedback.position, stand);
}

TEST(DryRun, ThatIsOverLeavesAMachineWithoutDrivesThatKnowsNoPlace) {
  DryRun dry;
  ASSERT_TRUE(dry.begin());
  EXPECT_NE(dry.world.state.joints, JointVector{});
  dry.world.command(Verb::kDisable);
  ASSERT_TRUE(dry.world.run_until(State::kOff, 0.1));
  dry.world.command(Verb::kDryRun, 0);
  EXPECT_EQ(dry.world.state.joints, JointVector{});
  dry.world.command(Verb::kEnable);
  EXPECT_EQ(refusal_of(dry.world), Refusal::kNoFeedback);
  EXPECT_EQ(dry.world.now(), State::kOff);
}

TEST(DryRun, BeginsAndEndsInOffAloneAndVoidsWhatWasSent) {
  DryRun dry;
  const std::uint16_t epoch = dry.world.state.epoch;
  ASSERT_TRUE(dry.begin());
  EXPECT_EQ(dry.world.state.epoch, epoch + 1);
  for (const double bad : {0.5, 2.0, -1.0}) {
    DryRun other;
    other.world.command(Verb::kDryRun, bad);
    EXPECT_EQ(refusal_of(other.world), Refusal::kOutOfRange);
  }
  dry.world.command(Verb::kDryRun, 0);
  EXPECT_EQ(refusal_of(dry.world), Refusal::kWrongState);
  EXPECT_TRUE(dry.world.state.is_dry_run);
  dry.world.command(Verb::kDisable);
  ASSERT_TRUE(dry.world.run_until(State::kOff, 0.1));
  const std::uint16_t later = dry.world.state.epoch;
  dry.world.command(Verb::kDryRun, 1);
  EXPECT_EQ(dry.world.state.epoch, later) << "it was on";
  dry.world.command(Verb::kDryRun, 0);
  EXPECT_EQ(dry.world.state.epoch, later + 1);
}

TEST(DryRun, IsRefusedWhileADriveIsEnabledAndStopsWhenOneComesOn) {
  DryRun dry;
  dry.world.in.feedback.enabled_mask = 8;
  dry.world.command(Verb::kDryRun, 1);
  EXPECT_EQ(refusal_of(dry.world), Refusal::kDriveEnabled);
  EXPECT_FALSE(dry.world.state.is_dry_run);
  dry.world.in.feedback.enabled_mask = 0;
  dry.world.command(Verb::kDryRun, 1);
  dry.world.in.feedback.enabled_mask = 8;
  dry.world.command(Verb::kEnable);
  EXPECT_EQ(refusal_of(dry.world), Refusal::kDriveEnabled);
  EXPECT_EQ(dry.world.now(), State::kOff);
  dry.world.in.feedback.enabled_mask = 0;
  ASSERT_TRUE(dry.begin());
  dry.cut();
  dry.run(0.1);
  dry.world.in.feedback.enabled_mask = 8;
  dry.world.run();
  EXPECT_EQ(dry.world.now(), State::kFaultStop);
  EXPECT_EQ(alarm_of(dry.world), Alarm::kDriveEnabled);
  EXPECT_EQ(dry.world.last(EventCode::kAlarm).b, 3U);
}

TEST(DryRun, IsHinderedByNothingElseThatDrivesReport) {
  DryRun dry(true);
  dry.world.in.feedback.fault_mask = 0b10110;
  dry.world.in.feedback.referenced_mask = 0;
  ASSERT_TRUE(dry.begin());
  dry.cut();
  dry.run(0.1);
  dry.world.in.feedback.joint_mask = 1;
  dry.world.run_for(0.1);
  EXPECT_EQ(dry.world.now(), State::kRunning);
}

TEST(DryRun, StopsWhereMorePeriodsAreLostThanDrivesWouldBridge) {
  DryRun dry;
  ASSERT_TRUE(dry.begin());
  dry.cut();
  dry.run(0.1);
  dry.world.run(static_cast<std::uint32_t>(dry.machine.bridge_cycles));
  EXPECT_EQ(dry.world.now(), State::kRunning);
  dry.world.run(static_cast<std::uint32_t>(dry.machine.bridge_cycles) + 1);
  EXPECT_EQ(alarm_of(dry.world), Alarm::kPeriodsLost);
  EXPECT_TRUE(dry.world.run_until(State::kFault, 1));
}

TEST(DryRun, IsJoggedWithoutDrivesAndNotHomed) {
  test::Hand hand;
  hand.world.command(Verb::kDisable);
  ASSERT_TRUE(hand.world.run_until(State::kOff, 1));
  hand.world.are_drives_alive = false;
  hand.world.in.feedback = {};
  hand.world.command(Verb::kDryRun, 1);
  ASSERT_TRUE(hand.world.enable());
  hand.world.command(Verb::kHome);
  EXPECT_EQ(hand.refusal(), Refusal::kDryRun);
  ASSERT_TRUE(hand.lay_on(0));
  const double from = hand.world.state.joints[0];
  hand.hold(0, 20, 0.5);
  EXPECT_GT(hand.world.state.joints[0], from + 5);
  EXPECT_EQ(hand.world.records.back().setpoint.flags & kSetpointEnabled, 0);
}

}  // namespace
}  // namespace meridian
