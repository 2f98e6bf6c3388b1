// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "supervisor_rig.hpp"

/// Stops that come while nobody looks after anything else.
namespace meridian::interpolator {
namespace {

/// The commands thread does not run: it hangs, or has not come to it.
using WithoutCommandsThread = SupervisorBurst;

TEST_F(WithoutCommandsThread, AStopReachesTheCycleAllTheSame) {
  for (const Verb verb : {Verb::kHold, Verb::kAbort, Verb::kDisable}) {
    ask(verb);
    EXPECT_TRUE(take(verb)) << name_of(verb);
  }
}

TEST_F(WithoutCommandsThread, AStopReachesTheCycleThoughNoCommandFindsRoomAnyMore) {
  const std::size_t room = ports_->arrivals.capacity();
  for (std::size_t n = 0; n < room + 200; ++n) {
    ask(Verb::kFeedOverride, 0.5);
    if (n % 64 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(comes([&] { return ports_->commands_dropped.load() == 200; }))
      << ports_->commands_dropped.load() << " dropped, " << ports_->arrivals.size() << " wait";
  ask(Verb::kHold);
  EXPECT_TRUE(take(Verb::kHold));
}

TEST_F(WithoutCommandsThread, EachStopIsObeyedAlsoTheSameOneAgain) {
  ask(Verb::kHold);
  ASSERT_TRUE(take(Verb::kHold));
  repeat(Verb::kHold);
  EXPECT_TRUE(take(Verb::kHold)) << "a stop is never taken for a repetition";
  repeat(Verb::kHold, 0, 0);
  EXPECT_TRUE(take(Verb::kHold)) << "whoever asks";
}

TEST_F(SupervisorTest, ObeysAHoldWithTheNumberOfACommandThatWasAnswered) {
  show(State::kReady, false);
  ask(Verb::kFeedOverride, 0.5);
  const auto before = take(Verb::kFeedOverride);
  ASSERT_TRUE(before);
  report(EventCode::kAccepted, before->request, Verb::kFeedOverride);
  ASSERT_TRUE(has_reply(Verb::kFeedOverride, Refusal::kNone));
  repeat(Verb::kHold);  // an operator's program that counts anew
  const auto hold = take(Verb::kHold);
  ASSERT_TRUE(hold);
  report(EventCode::kAccepted, hold->request, Verb::kHold);
  EXPECT_TRUE(has_reply(Verb::kHold, Refusal::kNone)) << "and hears of the hold, of nothing else";
}

TEST_F(SupervisorTest, DoesNotTakeAnotherParticipantsCommandForARepetition) {
  show(State::kReady, false);
  dds::Participant stranger({.domain = domain_.id(), .machine = model_.name});
  dds::Writer<dds::CommandRequest> commands(stranger);
  ASSERT_TRUE(comes([&] { return commands.matched_readers() > 0; }));
  const dds::CommandRequest request{.request = request_ + 1,
                                    .operator_id = 9,
                                    .verb = Verb::kRapidOverride,
                                    .epoch_seen = 1,
                                    .status_seen = status_,
                                    .argument = 0.5};
  ASSERT_TRUE(commands.write(request));
  const auto his = take(Verb::kRapidOverride);
  ASSERT_TRUE(his);
  report(EventCode::kAccepted, his->request, Verb::kRapidOverride);
  dds::Reply reply;
  ASSERT_TRUE(comes([&] { return replies_.take(reply); }));
  EXPECT_EQ(reply.requester, dds::number_of(stranger));
  ask(Verb::kRapidOverride, 0.5);
  const auto own = take(Verb::kRapidOverride);
  ASSERT_TRUE(own) << "the same number, verb and value, of somebody else";
  report(EventCode::kAccepted, own->request, Verb::kRapidOverride);
  ASSERT_TRUE(comes([&] { return replies_.take(reply); }));
  EXPECT_EQ(reply.requester, dds::number_of(participant_));
}

TEST_F(SupervisorTest, AnswersAStopThatTheCycleAnsweredBeforeThisThreadHeardOfIt) {
  show(State::kRunning, false);
  for (int n = 0; n < 50; ++n) {
    ask(Verb::kHold);
    const auto hold = take(Verb::kHold);
    ASSERT_TRUE(hold);
    report(EventCode::kAccepted, hold->request, Verb::kHold);
    ASSERT_TRUE(has_reply(Verb::kHold, Refusal::kNone)) << n;
  }
}

TEST_F(SupervisorTest, DropsAFloodOfOneParticipantReportsItOnceAndObeysItsStops) {
  show(State::kRunning, false);
  for (int n = 0; n < 900; ++n) ask(static_cast<Verb>(kVerbCount));
  EXPECT_TRUE(comes([this] { return ports_->commands_dropped > 300; }));
  ask(Verb::kHold);
  EXPECT_TRUE(take(Verb::kHold));
  int reports = 0;
  for (Notice notice; ports_->notices.try_pop(notice);) {
    reports += std::string(notice.text.data()).find("beyond 200 a second") != std::string::npos;
    EXPECT_EQ(notice.kind, Notice::Kind::kWarning);
  }
  EXPECT_EQ(reports, 1);
  dds::Participant other({.domain = domain_.id(), .machine = model_.name});
  dds::Writer<dds::CommandRequest> commands(other);
  ASSERT_TRUE(comes([&] { return commands.matched_readers() > 0; }));
  ASSERT_TRUE(commands.write({.request = 1,
                              .operator_id = 10,
                              .verb = Verb::kFeedOverride,
                              .epoch_seen = 1,
                              .status_seen = status_,
                              .argument = 0.5}));
  EXPECT_TRUE(take(Verb::kFeedOverride)) << "others are heard";
}

TEST_F(SupervisorTest, RefusesWhatMovesByItselfWithAnOpenGuard) {
  ports_->is_guard_open = true;
  show(State::kLoaded, false);
  ask(Verb::kStart);
  EXPECT_TRUE(has_reply(Verb::kStart, Refusal::kGuardOpen));
  show(State::kReady, false);
  ask(Verb::kHome);
  EXPECT_TRUE(has_reply(Verb::kHome, Refusal::kGuardOpen));
  ask(Verb::kJog);
  EXPECT_TRUE(take(Verb::kJog)) << "the hand may";
}

TEST_F(SupervisorTest, SaysWhenAGuardOpensAndShutsAndThatADryRunGoesOn) {
  Notice notice;
  const auto says = [&](const std::string& text) {
    return comes([&] { return ports_->notices.try_pop(notice); }) && notice.kind != Notice::Kind::kNews &&
           std::string(notice.text.data()).find(text) == 0;
  };
  show(State::kReady, false);
  ports_->is_guard_open = true;
  EXPECT_TRUE(says("a guard is open: what moved is held")) << notice.text.data();
  ports_->is_guard_open = false;
  EXPECT_TRUE(says("the guard is shut")) << "in the place of what the status said";
  show(State::kLoaded, true);
  ask(Verb::kFeedOverride, 0.5);
  ASSERT_TRUE(take(Verb::kFeedOverride)) << "it knows of the dry run by now";
  while (ports_->notices.try_pop(notice)) {
  }
  ports_->is_guard_open = true;
  EXPECT_TRUE(says("a guard is open; the dry run goes on")) << notice.text.data();
  ask(Verb::kStart);
  EXPECT_TRUE(take(Verb::kStart)) << "nothing moves in a dry run";
}

TEST_F(SupervisorTest, RefusesWhatMovesWithoutAnEnablingDeviceWhereOneIsRequired) {
  ports_->enabling.set_up(true, 300'000'000);
  show(State::kLoaded, false);
  ask(Verb::kStart);
  EXPECT_TRUE(has_reply(Verb::kStart, Refusal::kNoEnablingDevice));
  dds::Writer<dds::Enabling> device(participant_);
  ASSERT_TRUE(comes([&] {
    (void)device.write({.operator_name = "anna", .device = dds::EnablingDevice::kPressed});
    ports_->enabling.look(monotonic_ns());
    return ports_->enabling.pressed() == 1;
  }));
  ask(Verb::kStart);
  EXPECT_TRUE(take(Verb::kStart));
}

}  // namespace
}  // namespace meridian::interpolator
