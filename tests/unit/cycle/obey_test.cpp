// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/obey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/cycle/dry_program.hpp"
#include "unit/cycle/hand.hpp"

/// The operator's word: what it asks for beside the state that the table names.
namespace meridian::test::obey_words {
namespace {

/// A program of one cut that is loaded.
struct Loaded : Program {
  Loaded() {
    plan.cut({100, 0, 0}, kLimits);
    plan.barrier(TimeKind::kEnd);
    EXPECT_TRUE(world.run_until(State::kLoaded, 1));
  }
  /// Whether `verb` is taken with that argument.
  [[nodiscard]] bool takes(Verb verb, double argument) {
    const int refused = world.count(EventCode::kRefused);
    world.command(verb, argument);
    return world.count(EventCode::kRefused) == refused;
  }
};

TEST(Obey, TakesForASwitchNothingButOnAndOff) {
  Loaded p;
  for (const Verb verb : {Verb::kSingleBlock, Verb::kOptionalStop}) {
    for (const double argument : {0.0, 1.0}) EXPECT_TRUE(p.takes(verb, argument)) << argument;
    for (const double argument : {-1.0, 0.5, 2.0, std::nan("")}) {
      EXPECT_FALSE(p.takes(verb, argument)) << argument;
      EXPECT_EQ(refusal_of(p.world), Refusal::kOutOfRange);
    }
  }
}

TEST(Obey, TakesAnOverrideUpToTheLargestOfTheMachine) {
  Loaded p;
  p.world.machine.max_feed_override = 1.5;
  EXPECT_TRUE(p.takes(Verb::kFeedOverride, 1.5));
  EXPECT_EQ(p.world.state.feed_override, 1.5);
  EXPECT_FALSE(p.takes(Verb::kFeedOverride, 1.51));
  EXPECT_FALSE(p.takes(Verb::kFeedOverride, -0.01));
  EXPECT_EQ(p.world.state.feed_override, 1.5) << "what is refused changes nothing";
  EXPECT_TRUE(p.takes(Verb::kRapidOverride, 1));
  EXPECT_FALSE(p.takes(Verb::kRapidOverride, 1.01));
}

TEST(Obey, ReportsAnAlarmAgainOnceItWasReset) {
  Loaded p;
  for (int n = 1; n <= 2; ++n) {
    p.world.in.feedback.emergency_stop = true;
    ASSERT_TRUE(p.world.run_until(State::kFault, 1));
    EXPECT_EQ(p.world.count(EventCode::kAlarm), n);
    p.world.in.feedback.emergency_stop = false;
    p.world.run_for(0.05);
    p.world.command(Verb::kReset);
    ASSERT_EQ(p.world.now(), State::kOff);
    EXPECT_EQ(p.world.state.alarm, Alarm::kNone);
    ASSERT_TRUE(p.world.enable());
  }
}

TEST(Obey, AProgramThatIsAbortedLeavesNothingOfItself) {
  Loaded p;
  p.world.command(Verb::kStart);
  p.world.run_for(0.5);
  ASSERT_TRUE(p.world.state.has_block);
  const std::uint16_t epoch = p.world.state.epoch;
  p.world.command(Verb::kAbort);
  ASSERT_TRUE(p.world.run_until(State::kReady, 2));
  const CycleState& state = p.world.state;
  EXPECT_FALSE(state.has_block);
  EXPECT_EQ(state.epoch, epoch + 1) << "all that was planned is void";
  EXPECT_EQ(state.piece_time, 0);
  EXPECT_EQ(state.program_time, 0);
  EXPECT_EQ(p.world.count(EventCode::kBlockDone), 0) << "the block was not done";
  EXPECT_EQ(p.world.last(EventCode::kEpochAdvanced).a, state.epoch);
}

/// The hardest braking of a joint that is jogged, once it is aborted or ordered to rest.
double hardest_braking(bool is_aborted) {
  Hand hand;
  EXPECT_TRUE(hand.lay_on(0));
  hand.hold(0, 20, 0.5);
  const auto speed = [&hand] { return std::abs(hand.world.state.velocity[0]); };
  EXPECT_GT(speed(), 5);
  double largest = 0;
  for (int n = 0; n < 1000 && speed() > 0; ++n) {
    const double before = speed();
    if (n == 0 && is_aborted) {
      hand.world.command(Verb::kAbort);
    } else {
      if (!is_aborted) hand.order(0, 0);
      hand.world.run();
    }
    largest = std::max(largest, (before - speed()) / hand.world.dt());
  }
  EXPECT_EQ(speed(), 0);
  return largest;
}

TEST(Obey, AJogThatIsAbortedBrakesAsOneThatIsOrderedToRest) {
  EXPECT_NEAR(hardest_braking(true), hardest_braking(false), 0.05 * hardest_braking(false));
}

TEST(Obey, HomesNothingInADryRunAndOnlyJointsThatThereAre) {
  Hand hand;
  const auto refused = [&](double argument) {
    hand.world.command(Verb::kHome, argument);
    return refusal_of(hand.world);
  };
  EXPECT_EQ(refused(0.5), Refusal::kOutOfRange);
  EXPECT_EQ(refused(-1), Refusal::kOutOfRange);
  EXPECT_EQ(refused(32), Refusal::kOutOfRange) << "five joints";
  EXPECT_EQ(joints_to_home(hand.world.machine, 0), 0x1FU);
  EXPECT_EQ(joints_to_home(hand.world.machine, 5), 5U);
  DryRun dry;
  dry.world.in.session = 0;
  dry.world.command(Verb::kDryRun, 1);
  dry.world.command(Verb::kEnable);
  ASSERT_TRUE(dry.world.run_until(State::kReady, 1));
  dry.world.command(Verb::kHome, 0);
  EXPECT_EQ(refusal_of(dry.world), Refusal::kDryRun);
}

TEST(Obey, ADryRunBeginsWhereTheDrivesStandElseAtHome) {
  for (const bool is_referenced : {true, false}) {
    DryRun dry(true);
    dry.world.machine.joints[1].home = 7;
    dry.world.in.feedback.position = {1, 2, 3, 0.1, 0.2};
    dry.world.in.feedback.referenced_mask = is_referenced ? 0x1F : 0;
    dry.world.run();
    dry.world.command(Verb::kDryRun, 1);
    dry.world.command(Verb::kEnable);
    ASSERT_TRUE(dry.world.run_until(State::kReady, 1));
    EXPECT_EQ(dry.world.state.joints[1], is_referenced ? 2 : 7);
  }
}

}  // namespace
}  // namespace meridian::test::obey_words
