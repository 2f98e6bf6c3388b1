// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "supervisor_rig.hpp"

/// Words that come late, twice, in crowds, or whose answers are lost.
namespace meridian::interpolator {
namespace {

TEST_F(SupervisorTest, AnswersARepetitionAgainBehindManyOtherAnswersAndDoesNotObeyItAgain) {
  show(State::kHeld, false);
  ask(Verb::kResume);
  const auto resume = take(Verb::kResume);
  ASSERT_TRUE(resume);
  report(EventCode::kAccepted, resume->request, Verb::kResume);
  ASSERT_TRUE(has_reply(Verb::kResume, Refusal::kNone));
  const std::uint64_t said = request_;
  for (int n = 0; n < 100; ++n) {
    ask(static_cast<Verb>(kVerbCount), 0, 10);
    if (n % 4 == 0) ask(Verb::kHome, 0, 0);
  }
  request_ = said;
  repeat(Verb::kResume);
  dds::Reply reply;
  ASSERT_TRUE(comes([&] { return replies_.take(reply) && reply.request == said; }));
  EXPECT_TRUE(reply.is_accepted);
  ask(Verb::kFeedOverride, 0.5, 11);
  EXPECT_TRUE(take(Verb::kFeedOverride)) << "the next command of the cycle";
}

TEST_F(SupervisorTest, TakesWhatWasSaidBeforeAStopAndComesBehindItForOvertaken) {
  show(State::kHeld, false);
  ask(Verb::kHold, 0, 8);
  const auto hold = take(Verb::kHold);
  ASSERT_TRUE(hold);
  report(EventCode::kAccepted, hold->request, Verb::kHold);
  ASSERT_TRUE(has_reply(Verb::kHold, Refusal::kNone));
  for (const Verb verb : {Verb::kResume, Verb::kStart, Verb::kEnable, Verb::kJog, Verb::kHome}) {
    ask(verb);
    EXPECT_TRUE(has_reply(verb, Refusal::kOvertaken)) << name_of(verb);
  }
  ask(Verb::kFeedOverride, 0.5);
  EXPECT_TRUE(take(Verb::kFeedOverride)) << "moves nothing";
  publish_status();
  ask(Verb::kResume);
  EXPECT_TRUE(take(Verb::kResume)) << "by whom the stop may be seen";
}

TEST_F(SupervisorTest, ResetsTheDrivesOnceForAllWhoAskMeanwhileAndAnswersEachOnce) {
  DriveWords words;
  words.joint_mask = 0x1F;
  words.statusword.fill(0x08);  // fault
  ports_->drive_words.store(words);
  show(State::kFault, false);
  ask(Verb::kReset, 0, 8);
  repeat(Verb::kReset, 0, 8);
  ask(Verb::kReset, 0, 9);
  ask(Verb::kFeedOverride, 0.5, 9);
  const auto between = take(Verb::kFeedOverride);
  ASSERT_TRUE(between) << "both resets wait for the drives";
  report(EventCode::kAccepted, between->request, Verb::kFeedOverride);
  ASSERT_TRUE(has_reply(Verb::kFeedOverride, Refusal::kNone));
  const auto first = take(Verb::kReset), second = take(Verb::kReset);
  ASSERT_TRUE(first && second);
  report(EventCode::kAccepted, first->request, Verb::kReset);
  report(EventCode::kAccepted, second->request, Verb::kReset);
  EXPECT_TRUE(has_reply(Verb::kReset, Refusal::kNone));
  EXPECT_TRUE(has_reply(Verb::kReset, Refusal::kNone));
  ask(Verb::kOptionalStop, 1);
  EXPECT_TRUE(take(Verb::kOptionalStop)) << "the repetition is not a third";
}

TEST_F(SupervisorTest, GivesUpAWordWhoseAnswerIsLostAndDoesNotObeyItAgain) {
  show(State::kReady, false);
  ask(Verb::kRapidOverride, 0.5);
  ASSERT_TRUE(take(Verb::kRapidOverride));
  const std::uint64_t lost = request_;
  ask(Verb::kFeedOverride, 0.5);
  const auto next = take(Verb::kFeedOverride);
  ASSERT_TRUE(next);
  report(EventCode::kAccepted, next->request, Verb::kFeedOverride);
  EXPECT_TRUE(has_reply(Verb::kRapidOverride, Refusal::kWrongState));
  EXPECT_TRUE(has_reply(Verb::kFeedOverride, Refusal::kNone));
  request_ = lost;
  repeat(Verb::kRapidOverride, 0.5);
  EXPECT_TRUE(has_reply(Verb::kRapidOverride, Refusal::kWrongState)) << "the same answer";
}

/// A changer goes on where the program that asked for it is aborted.
TEST_F(SupervisorTest, KnowsTheToolOfAChangeThatEndsBehindAnAbort) {
  ASSERT_NO_FATAL_FAILURE(abort_in_tool_change());
  show(State::kReady, false);
  ask(Verb::kJog, kMaxJoints + 2);
  EXPECT_TRUE(has_reply(Verb::kJog, Refusal::kWrongState)) << "along a tool that nobody knows";
  EXPECT_TRUE(ports_->is_tool_changing) << "no program either";
  EXPECT_EQ(ports_->spindle_tool_mm, kToolBefore_mm);
  ASSERT_NO_FATAL_FAILURE(end_tool_change(true));
  EXPECT_EQ(ports_->spindle_tool_mm, kTool_mm);
  ask(Verb::kJog, kMaxJoints + 2);
  EXPECT_TRUE(take(Verb::kJog));
}

TEST_F(SupervisorTest, KeepsTheToolOfAChangeThatIsNotDone) {
  ASSERT_NO_FATAL_FAILURE(abort_in_tool_change());
  ASSERT_NO_FATAL_FAILURE(end_tool_change(false));
  EXPECT_EQ(ports_->spindle_tool_mm, kToolBefore_mm);
}

TEST_F(SupervisorTest, TakesTheAnswerOfAChangeInADryRunForTheToolBehindIt) {
  ASSERT_NO_FATAL_FAILURE(abort_in_tool_change());
  show(State::kOff, true);
  ASSERT_TRUE(comes([this] { return ports_->state == State::kOff; }));
  ASSERT_NO_FATAL_FAILURE(end_tool_change(true));
  EXPECT_EQ(ports_->spindle_tool_mm, kToolBefore_mm);
  show(State::kOff, false);
  EXPECT_TRUE(comes([this] { return ports_->spindle_tool_mm == kTool_mm; }));
}

TEST_F(SupervisorBurst, WaitsForTheToolNoLongerThanForAnyAction) {
  service_.action_timeout_s = 0.1;
  run();
  show(State::kRunning, false);
  ASSERT_TRUE(ask_for_tool());
  EXPECT_TRUE(ports_->is_tool_changing);
  EXPECT_TRUE(comes([this] { return !ports_->is_tool_changing; }));
}

}  // namespace
}  // namespace meridian::interpolator
