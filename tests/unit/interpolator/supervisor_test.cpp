// SPDX-License-Identifier: Apache-2.0
#include "service/interpolator/supervisor.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "meridian/rt/state_table.hpp"
#include "service/interpolator/drive_words.hpp"
#include "service/interpolator/monotonic.hpp"
#include "service/telemetry/words.hpp"
#include "support/machines.hpp"
#include "support/private_domain.hpp"

namespace meridian::interpolator {
namespace {

[[nodiscard]] bool comes(const std::function<bool()>& condition) {
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > patience) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// The commands thread, with the test for cycle, operator and drives.
class SupervisorTest : public testing::Test {
 protected:
  SupervisorTest() {
    ports_->spindle_tool_mm = kToolBefore_mm;
    DriveWords words;
    words.joint_mask = 0x1F;
    words.statusword.fill(0x231);  // ready to switch on
    ports_->drive_words.store(words);
    dds::Status status;
    status.status_sequence = 5;
    clock_.published(status, monotonic_ns());
  }
  void SetUp() override { run(); }
  void TearDown() override {
    ports_->is_stopping = true;
    thread_.join();
  }
  void run() {
    thread_ = std::thread([this] { supervisor_.run(); });
  }
  void show(State state, bool is_dry_run) {
    CycleView view;
    view.cycles_run = ++shown_;
    view.epoch = 1;
    view.record.state = state;
    view.is_dry_run = is_dry_run;
    ports_->commands_view.store(view);
  }
  void ask(Verb verb, double argument = 0, std::uint64_t operator_id = 9) {
    dds::CommandRequest request;
    request.operator_id = operator_id;
    request.request = ++request_;
    request.verb = verb;
    request.argument = argument;
    request.epoch_seen = 1;
    request.status_seen = 5;
    (void)commands_.write(request);
  }
  [[nodiscard]] bool has_reply(Verb verb, Refusal refusal) {
    dds::Reply reply;
    return comes([&] { return replies_.take(reply); }) && reply.verb == verb &&
           reply.refusal == refusal;
  }
  /// The cycle takes the next command, which must be `verb`.
  [[nodiscard]] std::optional<Command> take(Verb verb) {
    Command command;
    const bool is_there = comes([&] { return ports_->commands.try_pop(command); });
    return is_there && command.verb == verb ? std::optional(command) : std::nullopt;
  }
  /// The controlword that drive 0 heard last.
  [[nodiscard]] std::uint16_t controlword() {
    dds::DriveCommand command;
    while (drive_commands_.take(command)) {
      if (command.drive == 0) controlword_ = command.controlword;
    }
    return controlword_;
  }

  static constexpr double kToolBefore_mm = 111, kTool_mm = 180;
  const MachineModel model_ = test::lai_machine();
  const ToolTable tools_{{{7, kTool_mm, 5}}};
  const config::ServiceConfig service_;
  const support::PrivateDomain domain_;
  dds::Participant participant_{{.domain = domain_.id(), .machine = model_.name}};
  dds::Writer<dds::CommandRequest> commands_{participant_};
  dds::Reader<dds::Reply> replies_{participant_};
  dds::Reader<dds::DriveCommand> drive_commands_{participant_};
  dds::Reader<dds::Action> actions_{participant_};
  const std::unique_ptr<Ports> ports_ = std::make_unique<Ports>();
  StatusClock clock_;
  Supervisor supervisor_{participant_, model_, tools_, service_, 1, clock_, *ports_};
  std::uint64_t shown_ = 0, request_ = 0;
  std::uint16_t controlword_ = 0;
  std::thread thread_;
};

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

/// Nobody's requests cannot be told apart: each repetition would be done again.
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
  Approach way;
  way.is_planned = true;
  way.epoch = 1;
  way.to = {-1234, -1234, -1234, -2, -2};
  way.retract = 12.3;
  way.length = 1234;
  const std::string before = "dry run: start accepted; ";
  std::set<std::size_t> sizes;
  for (way.line = 1; way.line <= 100'000; way.line *= 10) {  // a character more each time
    ports_->approach.store(way);
    ask(Verb::kStart);
    const auto start = take(Verb::kStart);
    ASSERT_TRUE(start);
    Event accepted;
    accepted.code = EventCode::kAccepted;
    accepted.a = start->request;
    ASSERT_TRUE(ports_->events.try_push(accepted));
    dds::Reply reply;
    ASSERT_TRUE(comes([&] { return replies_.take(reply); }));
    EXPECT_EQ(reply.text, before + telemetry::describe(way, model_, 191 - before.size()));
    sizes.insert(reply.text.size());
  }
  EXPECT_TRUE(sizes.contains(191)) << *sizes.rbegin();
  EXPECT_LT(*sizes.begin(), 175U) << "there was room for all of every one";
}

/// What operators say before the thread runs waits for it together.
class SupervisorBurst : public SupervisorTest {
 protected:
  void SetUp() override {}

  /// The cycle takes what it is told, and says that it did it; verbs that lead to motion are
  /// overtaken. Returns the verbs in that order, once `replies` of them are answered.
  [[nodiscard]] std::vector<Verb> obey_until(std::size_t replies) {
    std::vector<Verb> taken;
    const bool is_answered = comes([&] {
      Command command;
      while (ports_->commands.try_pop(command)) {
        taken.push_back(command.verb);
        Event event;
        event.code = leads_to_motion(command.verb) ? EventCode::kRefused : EventCode::kAccepted;
        event.a = command.request;
        event.b = static_cast<std::uint64_t>(command.verb);
        event.x = static_cast<double>(Refusal::kOvertaken);
        if (!ports_->events.try_push(event)) ADD_FAILURE() << "no room for the answer";
      }
      dds::Reply reply;
      while (replies_.take(reply)) answered_[reply.request] = reply;
      return answered_.size() == replies;
    });
    EXPECT_TRUE(is_answered) << answered_.size() << " of " << replies;
    return taken;
  }

  std::map<std::uint64_t, dds::Reply> answered_;
};

TEST_F(SupervisorBurst, TellsTheCycleAHoldAheadOfSixtyOverridesAndAnswersThemAll) {
  show(State::kRunning, false);
  for (int n = 0; n < 60; ++n) ask(Verb::kFeedOverride, 0.5);
  ask(Verb::kHold);
  run();
  const std::vector<Verb> taken = obey_until(61);
  ASSERT_EQ(taken.size(), 61U);
  EXPECT_EQ(taken.front(), Verb::kHold);
}

TEST_F(SupervisorBurst, TellsEveryStopHoweverMuchWaitsAndAnswersWhatItGoesPast) {
  show(State::kLoaded, false);
  ask(Verb::kStart);
  for (int n = 0; n < 150; ++n) ask(Verb::kFeedOverride, 0.5);
  for (int n = 0; n < 150; ++n) ask(Verb::kHold);
  ask(Verb::kAbort);
  run();
  const std::vector<Verb> taken = obey_until(302);
  ASSERT_GT(taken.size(), 2U);
  EXPECT_EQ(taken[0], Verb::kHold);
  EXPECT_EQ(taken[1], Verb::kAbort);
  EXPECT_EQ(answered_[1].refusal, Refusal::kOvertaken);
  EXPECT_EQ(answered_[1].text.find("start refused: a hold, an abort or disable"), 0U);
  EXPECT_EQ(answered_[151].text, "too many commands at once; say it again");
  EXPECT_TRUE(answered_[301].is_accepted ||
              answered_[301].text.find("the machine was told") != std::string::npos);
  EXPECT_EQ(answered_[302].request, 302U);
}

}  // namespace
}  // namespace meridian::interpolator
