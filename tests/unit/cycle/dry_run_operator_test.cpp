// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "unit/cycle/dry_program.hpp"

/// What stands between an operator and a dry run: the emergency input, and that it is meant.
namespace meridian {
namespace {

using test::alarm_of;
using test::DryRun;
using test::kLimits;
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

/// Every state that an operator may say it in.
TEST(DryRun, IsWhatAWordThatIsSaidForItAloneIsRefusedWithout) {
  Program wet(State::kOff);
  const auto expect_refused = [&](const char* where) {
    const State before = wet.world.now();
    for (const Verb verb : {Verb::kEnable, Verb::kStart}) {
      const int refused = wet.world.count(EventCode::kRefused);
      wet.world.command(verb, 1);
      EXPECT_EQ(wet.world.count(EventCode::kRefused), refused + 1) << where;
      EXPECT_EQ(refusal_of(wet.world), Refusal::kNotDryRun) << where;
    }
    return before == wet.world.now();
  };
  wet.world.run();
  EXPECT_TRUE(expect_refused("Off: where enable would switch on"));
  wet.world.command(Verb::kEnable);
  (void)expect_refused("Enabling: already so, as the table says, is no answer to it");
  ASSERT_TRUE(wet.world.run_until(State::kReady, 1));
  wet.plan.set_epoch(wet.world.state.epoch);
  wet.plan.cut({30, 0, 0}, kLimits);
  wet.plan.barrier(TimeKind::kEnd);
  ASSERT_TRUE(wet.world.run_until(State::kLoaded, 1));
  EXPECT_TRUE(expect_refused("Loaded: where start would cut"));
  wet.world.command(Verb::kStart);
  wet.world.run_for(0.1);
  EXPECT_TRUE(expect_refused("Running"));
  ASSERT_TRUE(wet.world.run_until(State::kReady, 2)) << "and nothing of it was hindered";
}

TEST(DryRun, IsEnabledAndStartedByWordsThatAreSaidForItAlone) {
  DryRun dry;
  dry.world.command(Verb::kDryRun, 1);
  for (const double bad : {0.5, 2.0, -1.0, std::nan("")}) {
    dry.world.command(Verb::kEnable, bad);
    EXPECT_EQ(refusal_of(dry.world), Refusal::kOutOfRange) << bad;
  }
  dry.world.command(Verb::kEnable, 1);
  ASSERT_TRUE(dry.world.run_until(State::kReady, 0.1));
  dry.cut();
  ASSERT_TRUE(dry.world.run_until(State::kLoaded, 1));
  dry.world.command(Verb::kStart, 1);
  EXPECT_TRUE(is_on_path(dry.world.now())) << name_of(dry.world.now());
}

}  // namespace
}  // namespace meridian
