// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/supervisor/supervisor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "service/daemon/ports/drive_words.hpp"
#include "service/recording/telemetry/words.hpp"
#include "supervisor_rig.hpp"

namespace meridian::interpolator {
namespace {

TEST_F(SupervisorTest, SwitchesNoDriveOnInADryRun) {
  show(State::kEnabling, false);
  EXPECT_TRUE(comes([this] { return controlword() == controlword::kSwitchOn; }));
  show(State::kOff, true);
  EXPECT_TRUE(comes([this] { return controlword() == controlword::kShutdown; }));
  show(State::kRunning, true);
  // Commands are repeated at 10 Hz.
  std::this_thread::sleep_for(std::chrono::milliseconds(150));
  EXPECT_EQ(controlword(), controlword::kShutdown);
}

TEST_F(SupervisorTest, DoesTheActionsOfADryRunItselfAndTheSpindleKeepsItsTool) {
  show(State::kOff, true);
  show(State::kRunning, true);
  PlannedAction planned{.epoch = 1, .block = {}};
  planned.block.kind = BlockKind::kTool;
  planned.block.action = ActionKind::kToolChange;
  planned.block.value = 7;
  planned.block.sequence = 12;
  ASSERT_TRUE(comes([&] { return ports_->actions.try_push(planned); }));
  Event due;
  due.code = EventCode::kActionDue;
  due.a = 12;
  due.epoch = 1;
  ASSERT_TRUE(comes([this] { return ports_->state == State::kRunning; }));
  ASSERT_TRUE(ports_->events.try_push(due));
  ASSERT_TRUE(comes([this] {
    ports_->action_answer.refresh();
    return ports_->action_answer.latest().is_answered;
  }));
  EXPECT_TRUE(ports_->action_answer.latest().is_done);
  EXPECT_EQ(ports_->action_answer.latest().sequence, 12U);
  EXPECT_EQ(ports_->spindle_tool_mm, kTool_mm) << "what the dry program goes on with";
  dds::Action action;
  EXPECT_FALSE(actions_.take(action)) << "nobody changes a tool";
  show(State::kOff, false);
  EXPECT_TRUE(comes([this] { return ports_->spindle_tool_mm == kToolBefore_mm; }));
}

TEST_F(SupervisorTest, RefusesToEnableWhileADryRunIsOnItsWay) {
  show(State::kOff, true);
  ask(Verb::kDryRun, 0);
  const auto dry_run = take(Verb::kDryRun);
  ASSERT_TRUE(dry_run);
  ask(Verb::kEnable);
  EXPECT_TRUE(has_reply(Verb::kEnable, Refusal::kStale));
  show(State::kOff, false);
  Event accepted;
  accepted.code = EventCode::kAccepted;
  accepted.a = dry_run->request;
  ASSERT_TRUE(ports_->events.try_push(accepted));
  EXPECT_TRUE(has_reply(Verb::kDryRun, Refusal::kNone));
  ask(Verb::kEnable);
  EXPECT_TRUE(take(Verb::kEnable));
}

TEST_F(SupervisorTest, NamesTheDrivesThatTwoReportWhereItRefusesToEnable) {
  DriveWords words;
  words.joint_mask = 0x1F;
  words.contested_mask = 0b10010;
  ports_->drive_words.store(words);
  show(State::kOff, false);
  ask(Verb::kEnable);
  const auto enable = take(Verb::kEnable);
  ASSERT_TRUE(enable);
  Event refused;
  refused.code = EventCode::kRefused;
  refused.a = enable->request;
  refused.x = static_cast<double>(Refusal::kDriveContested);
  ASSERT_TRUE(ports_->events.try_push(refused));
  dds::Reply reply;
  ASSERT_TRUE(comes([&] { return replies_.take(reply); }));
  EXPECT_EQ(reply.refusal, Refusal::kDriveContested);
  EXPECT_TRUE(reply.text.ends_with(": b2, theta2")) << reply.text;
}

/// Requests of nobody cannot be distinguished: each repetition would be done again.
TEST_F(SupervisorTest, ObeysNobodyButWhereHeStops) {
  show(State::kLoaded, false);
  for (const Verb verb : {Verb::kStart, Verb::kFeedOverride, Verb::kJog, Verb::kReset}) {
    ask(verb, 0, 0);
    EXPECT_TRUE(has_reply(verb, Refusal::kOutOfRange)) << name_of(verb);
  }
  for (const Verb verb : {Verb::kAbort, Verb::kHold, Verb::kAbort}) {
    ask(verb, 0, 0);
    request_ -= 1;  // the same request: whose it is is not known
    const auto command = take(verb);
    ASSERT_TRUE(command) << "no start in front of it";
    Event accepted;
    accepted.code = EventCode::kAccepted;
    accepted.a = command->request;
    accepted.b = static_cast<std::uint64_t>(verb);
    ASSERT_TRUE(ports_->events.try_push(accepted));
    EXPECT_TRUE(has_reply(verb, Refusal::kNone));
  }
}

TEST_F(SupervisorTest, MayLeaveTheMachineInOffAndInADryRun) {
  const auto may_leave = [this](State state, bool is_dry_run, bool wanted) {
    show(state, is_dry_run);
    return comes([&] { return ports_->state == state && ports_->may_leave == wanted; });
  };
  EXPECT_TRUE(may_leave(State::kRunning, false, false)) << "drives would be left alone";
  EXPECT_TRUE(may_leave(State::kOff, false, true));
  EXPECT_TRUE(may_leave(State::kFault, false, false));
  EXPECT_TRUE(may_leave(State::kRunning, true, true)) << "none is on";
}

TEST_F(SupervisorTest, SaysThatItIsADryRunInFrontOfAReplyThatIsAsLongAsOneMayBe) {
  show(State::kLoaded, true);
  Approach approach;
  approach.is_planned = true;
  approach.epoch = 1;
  approach.to = {-1234, -1234, -1234, -2, -2};
  approach.retract = 12.3;
  approach.length = 1234;
  const std::string before = "dry run: start accepted; ";
  std::set<std::size_t> sizes;
  for (approach.line = 1; approach.line <= 100'000;
       approach.line *= 10) {  // a character more each time
    ports_->approach.store(approach);
    ask(Verb::kStart);
    const auto start = take(Verb::kStart);
    ASSERT_TRUE(start);
    Event accepted;
    accepted.code = EventCode::kAccepted;
    accepted.a = start->request;
    ASSERT_TRUE(ports_->events.try_push(accepted));
    dds::Reply reply;
    ASSERT_TRUE(comes([&] { return replies_.take(reply); }));
    EXPECT_EQ(reply.text, before + telemetry::describe(approach, model_, 191 - before.size()));
    sizes.insert(reply.text.size());
  }
  EXPECT_TRUE(sizes.contains(191)) << *sizes.rbegin();
  EXPECT_LT(*sizes.begin(), 175U) << "there was room for all of every one";
}

TEST_F(SupervisorBurst, CommandsAHoldAheadOfSixtyOverridesAndAnswersThemAll) {
  show(State::kRunning, false);
  for (int n = 0; n < 60; ++n) ask(Verb::kFeedOverride, 0.5);
  ask(Verb::kHold);
  run();
  const std::vector<Verb> taken = obey_until(61);
  ASSERT_EQ(taken.size(), 61U);
  EXPECT_EQ(taken.front(), Verb::kHold);
}

TEST_F(SupervisorBurst, CommandsEveryStopHoweverMuchWaitsAndAnswersWhatItGoesPast) {
  // In all fewer than a participant's lane of replies holds: where the processor is busy, the
  // thread that writes them comes late, and what has no room in the lane is dropped.
  constexpr int kOverrides = 110, kHolds = 110, kAll = 1 + kOverrides + kHolds + 1;
  show(State::kLoaded, false);
  ask(Verb::kStart);
  for (int n = 0; n < kOverrides; ++n) ask(Verb::kFeedOverride, 0.5);
  for (int n = 0; n < kHolds; ++n) ask(Verb::kHold);
  ask(Verb::kAbort);
  run();
  const std::vector<Verb> taken = obey_until(kAll);
  ASSERT_GT(taken.size(), 2U);
  EXPECT_EQ(taken[0], Verb::kHold);
  // Holds are read in several lots where the processor is busy, the abort in the last of them.
  const auto next =
      std::find_if(taken.begin(), taken.end(), [](Verb verb) { return verb != Verb::kHold; });
  ASSERT_NE(next, taken.end());
  EXPECT_EQ(*next, Verb::kAbort);
  EXPECT_EQ(answered_[1].refusal, Refusal::kOvertaken);
  EXPECT_EQ(answered_[1].text.find("start refused: a hold, an abort or disable"), 0U);
  EXPECT_EQ(answered_[1 + kOverrides].text, "too many commands at once; say it again");
  EXPECT_TRUE(answered_[kAll - 1].is_accepted ||
              answered_[kAll - 1].text.find("the machine stops all the same") != std::string::npos);
  ASSERT_TRUE(answered_.contains(kAll));
  EXPECT_EQ(answered_.at(kAll).verb, Verb::kAbort);
  EXPECT_TRUE(answered_.at(kAll).is_accepted ||
              answered_.at(kAll).text.find("the machine stops all the same") != std::string::npos);
}

}  // namespace
}  // namespace meridian::interpolator
