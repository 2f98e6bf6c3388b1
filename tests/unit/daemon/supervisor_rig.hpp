// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "meridian/cycle/state_table.hpp"
#include "service/daemon/ports/drive_words.hpp"
#include "service/daemon/ports/monotonic.hpp"
#include "service/daemon/supervisor/supervisor.hpp"
#include "support/machines.hpp"
#include "support/private_domain.hpp"

namespace meridian::interpolator {

[[nodiscard]] inline bool comes(const std::function<bool()>& condition) {
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
    ports_->drive_words_for_commands.store(words);
    publish_status();
  }
  void SetUp() override { run(); }
  void TearDown() override {
    ports_->is_stopping = true;
    for (std::thread& thread : threads_) thread.join();
  }
  void run() {
    threads_.emplace_back([this] { supervisor_.run(); });
    threads_.emplace_back([this] { supervisor_.run_replies(); });
    threads_.emplace_back([this] { supervisor_.run_drives(); });
  }
  /// What operators quote from now on; it stays fresh for as long as a test takes.
  void publish_status() {
    constexpr std::int64_t kMinute_ns = 60'000'000'000;
    dds::Status status;
    status.status_sequence = ++status_;
    clock_.published(status, monotonic_ns() + kMinute_ns);
  }
  /// The cycle says what it made of `request`.
  void report(EventCode code, std::uint64_t request, Verb verb) {
    Event event;
    event.code = code;
    event.a = request;
    event.b = static_cast<std::uint64_t>(verb);
    ASSERT_TRUE(ports_->events.try_push(event));
  }
  void show(State state, bool is_dry_run) {
    CycleView view;
    view.cycles_run = ++shown_;
    view.epoch = 1;
    view.record.state = state;
    view.is_dry_run = is_dry_run;
    ports_->commands_view.store(view);
    ports_->drives_asked.store({.is_enabled = is_enabled(state) && !is_dry_run, .epoch = 1});
    ports_->drives_wake.notify();
  }
  void ask(Verb verb, double argument = 0, std::uint64_t operator_id = 9) {
    ++request_;
    repeat(verb, argument, operator_id);
  }
  /// The newest request once more.
  void repeat(Verb verb, double argument = 0, std::uint64_t operator_id = 9) {
    dds::CommandRequest request;
    request.operator_id = operator_id;
    request.request = request_;
    request.verb = verb;
    request.argument = argument;
    request.epoch_seen = 1;
    request.status_seen = status_;
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
  /// The program waits for a change to tool 7, and the action peer hears of it.
  [[nodiscard]] std::optional<dds::Action> ask_for_tool() {
    PlannedAction planned{.epoch = 1, .block = {}};
    planned.block.kind = BlockKind::kTool;
    planned.block.action = ActionKind::kToolChange;
    planned.block.value = 7;
    planned.block.sequence = ++tool_block_;
    Event due;
    due.code = EventCode::kActionDue;
    due.a = tool_block_;
    due.epoch = 1;
    if (!ports_->actions.try_push(planned) || !ports_->events.try_push(due)) return std::nullopt;
    dds::Action action;
    return comes([&] { return actions_.take(action); }) ? std::optional(action) : std::nullopt;
  }
  /// Nobody waits for what the program asked for.
  void abort_program() {
    report(EventCode::kEpochAdvanced, 2, Verb::kAbort);
    Event event;
    ASSERT_TRUE(comes([&] { return ports_->session_events.try_pop(event); }));
  }
  /// A program waits for a change to tool 7 and is aborted: the change goes on without it.
  void abort_in_tool_change() {
    show(State::kRunning, false);
    change_ = ask_for_tool();
    ASSERT_TRUE(change_);
    abort_program();
  }
  /// The action peer says that this change is done, or refuses it; the supervisor has heard of it.
  void end_tool_change(bool is_done) {
    ASSERT_TRUE(actions_done_.write(
        {.id = change_->id, .service_id = change_->service_id, .is_done = is_done}));
    EXPECT_TRUE(comes([this] { return !ports_->is_tool_changing; }));
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
  config::ServiceConfig service_;
  const support::PrivateDomain domain_;
  dds::Participant participant_{{.domain = domain_.id(), .machine = model_.name}};
  dds::Writer<dds::CommandRequest> commands_{participant_};
  dds::Reader<dds::Reply> replies_{participant_};
  dds::Reader<dds::DriveCommand> drive_commands_{participant_};
  dds::Reader<dds::Action> actions_{participant_};
  dds::Writer<dds::ActionDone> actions_done_{participant_};
  const std::unique_ptr<Ports> ports_ = std::make_unique<Ports>();
  StatusClock clock_;
  Supervisor supervisor_{participant_, model_, tools_, service_, 1, clock_, *ports_};
  std::uint64_t shown_ = 0, request_ = 0, status_ = 4, tool_block_ = 11;
  std::optional<dds::Action> change_;
  std::uint16_t controlword_ = 0;
  std::vector<std::thread> threads_;
};

/// What operators say before the thread runs waits for it together.
class SupervisorBurst : public SupervisorTest {
 protected:
  void SetUp() override {}

  /// The cycle reads each command and reports that it carried it out; verbs that lead to motion are
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

}  // namespace meridian::interpolator
