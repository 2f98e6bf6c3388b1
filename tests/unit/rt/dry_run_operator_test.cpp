// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "unit/rt/dry_program.hpp"

/// What stands between an operator and a dry run.
namespace meridian {
namespace {

using test::alarm_of;
using test::DryRun;
using test::Program;
using test::refusal_of;

TEST(DryRun, WaitsForAnEmergencyInputOnlyAsLongAsSomebodyReportsIt) {
  DryRun dry;
  dry.world.command(Verb::kDryRun, 1);
  dry.report_emergency();
  dry.world.run_for(0.9);
  dry.world.command(Verb::kEnable);
  EXPECT_EQ(refusal_of(dry.world), Refusal::kFaultPresent);
  dry.world.run_for(0.11);
  dry.world.command(Verb::kEnable);
  ASSERT_TRUE(dry.world.run_until(State::kReady, 0.1)) << "the bridge that said so is gone";
  dry.report_emergency();
  dry.world.run();
  EXPECT_EQ(alarm_of(dry.world), Alarm::kEmergencyStop) << "and counts where it is back";
  ASSERT_TRUE(dry.world.run_until(State::kFault, 1));
  dry.world.command(Verb::kReset);
  EXPECT_EQ(refusal_of(dry.world), Refusal::kFaultPresent);
  dry.world.run_for(1.01);
  dry.world.command(Verb::kReset);
  EXPECT_EQ(dry.world.now(), State::kOff);
}

TEST(DryRun, HearsAnEmergencyInputOverPeriodsThatTheHostLost) {
  DryRun dry;
  dry.world.command(Verb::kDryRun, 1);
  dry.report_emergency();
  dry.world.run_for(0.5);
  dry.world.in.has_command = true;
  dry.world.in.command = {99, Verb::kEnable, 0};
  dry.world.run(800);
  EXPECT_EQ(refusal_of(dry.world), Refusal::kFaultPresent) << "nobody could be heard meanwhile";
}

TEST(DryRun, LeavesDrivesOffThatAnEmergencyInputStoppedWhoeverIsSilentSince) {
  Program wet;
  wet.world.in.feedback.emergency_stop = true;
  ASSERT_TRUE(wet.world.run_until(State::kFault, 1));
  wet.world.in.feedback.enabled_mask = 0;
  const auto refused = [&](Verb verb) {
    wet.world.command(verb);
    return refusal_of(wet.world);
  };
  EXPECT_EQ(refused(Verb::kReset), Refusal::kFaultPresent);
  wet.world.are_drives_alive = false;
  wet.world.run_for(1.01);
  wet.world.command(Verb::kReset);
  ASSERT_EQ(wet.world.now(), State::kOff) << "where a dry run may begin";
  EXPECT_EQ(refused(Verb::kEnable), Refusal::kNoFeedback);
  for (int n = 0; n < 3000; n += 100) {
    wet.world.in.feedback.arrival_ns = wet.world.in.now_ns;  // of the others
    EXPECT_EQ(refused(Verb::kEnable), Refusal::kFaultPresent) << n;
    wet.world.run_for(0.1);
  }
  EXPECT_EQ(wet.world.now(), State::kOff);
}

}  // namespace
}  // namespace meridian
