// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string>

#include "service/machine/file/machine_file.hpp"
#include "service/protocol/tools_sum.hpp"
#include "service/recording/telemetry/journal/set_up_file.hpp"
#include "supervisor_rig.hpp"

namespace meridian::interpolator {
namespace {

namespace fs = std::filesystem;

/// The commands thread with a set-up; the test is the disk's thread, the cycle, the status and the
/// main thread.
class SupervisorSetUp : public SupervisorTest {
 protected:
  SupervisorSetUp() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~SupervisorSetUp() override { fs::remove_all(folder_); }
  void SetUp() override {
    const telemetry::SetUp none;
    supervisor_.keep_set_up(file_, none, tools_, in_force_by(none, model_, tools_, 0));
    run();
    show(State::kOff, false);
    ASSERT_TRUE(comes([this] { return ports_->may_leave.load(); }));
  }

  void say(FrameWord word, int number, double x_mm = 0) {
    dds::CommandRequest request;
    request.operator_id = 9;
    request.request = ++request_;
    request.verb = Verb::kFrame;
    request.epoch_seen = 1;
    request.status_seen = status_;
    request.frame.word = word;
    request.frame.frame.number = static_cast<std::uint8_t>(number);
    request.frame.frame.origin_mm = {x_mm, 0, 0};
    (void)commands_.write(request);
  }
  /// The disk does what it is asked for, until the cycle receives a command.
  [[nodiscard]] std::optional<Command> write_and_take(Verb verb = Verb::kFrame) {
    Command command;
    const bool is_there = comes([&] {
      file_.work();
      return ports_->commands.try_pop(command);
    });
    return is_there && command.verb == verb ? std::optional(command) : std::nullopt;
  }
  void report_accepted(const Command& command) {
    report(EventCode::kAccepted, command.request, Verb::kFrame);
  }
  void report_refused(const Command& command, Refusal why) {
    Event event;
    event.code = EventCode::kRefused;
    event.a = command.request;
    event.b = static_cast<std::uint64_t>(Verb::kFrame);
    event.x = static_cast<double>(why);
    ASSERT_TRUE(ports_->events.try_push(event));
  }
  /// Status and machine topic report what is in force.
  void publish_in_force() {
    ASSERT_TRUE(comes([this] { return supervisor_.has_set_up_to_report(); }));
    publish_status();
    ports_->set_up.status = status_;
    ports_->set_up.reported = supervisor_.in_force().change;
    supervisor_.set_up_reported();
  }
  [[nodiscard]] bool is_answered() {
    dds::Reply reply;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return replies_.take(reply);
  }
  /// x of a row on disk; 0: it is not there.
  [[nodiscard]] double on_disk(int number) {
    const telemetry::SetUp set_up = on_disk();
    const WorkFrame* const row = set_up.frames.find(number);
    return row != nullptr ? row->origin_mm[0] : 0;
  }
  [[nodiscard]] telemetry::SetUp on_disk() {
    const auto set_up = telemetry::SetUpFile(folder_, model_.name).read();
    EXPECT_TRUE(set_up);
    return set_up.value_or(telemetry::SetUp());
  }
  void say_tools(const std::string& text, std::uint64_t tools_seen = 0) {
    dds::CommandRequest request;
    request.operator_id = 9;
    request.request = ++request_;
    request.verb = Verb::kTool;
    request.epoch_seen = 1;
    request.status_seen = status_;
    request.tools_seen = tools_seen;
    request.tool_file = text;
    (void)commands_.write(request);
  }
  void say_limits(const LimitsOrder& order) {
    dds::CommandRequest request;
    request.operator_id = 9;
    request.request = ++request_;
    request.verb = Verb::kLimits;
    request.epoch_seen = 1;
    request.status_seen = status_;
    request.limits = order;
    (void)commands_.write(request);
  }
  /// The disk, the cycle and everybody do what the newest word asks for.
  void do_it(Verb verb) {
    const auto command = write_and_take(verb);
    ASSERT_TRUE(command);
    report(EventCode::kAccepted, command->request, verb);
    publish_in_force();
    EXPECT_TRUE(has_reply(verb, Refusal::kNone));
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("meridian-frames-" + std::to_string(::getpid()));
  int error_ = 0;
  telemetry::SetUpFile file_{folder_, model_.name,
                             [this](const fs::path& path, const std::string& text) {
                               return error_ != 0 ? error_ : telemetry::replace_file(path, text);
                             }};
};

TEST_F(SupervisorSetUp, AreOnDiskBeforeTheCycleAndPublishedBeforeTheyAreAcknowledged) {
  say(FrameWord::kSet, 3, 12);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  Command early;
  EXPECT_FALSE(ports_->commands.try_pop(early)) << "the disk has not written it";
  auto command = write_and_take();
  ASSERT_TRUE(command);
  EXPECT_EQ(on_disk(3), 12);
  EXPECT_FALSE(is_answered());
  report_accepted(*command);
  EXPECT_FALSE(is_answered()) << "it is not published";
  publish_in_force();
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kNone));

  say(FrameWord::kSelect, 3);
  command = write_and_take();
  ASSERT_TRUE(command);
  EXPECT_EQ(command->argument, 3);
  ASSERT_TRUE(ports_->set_up.for_cycle.refresh());
  EXPECT_EQ(ports_->set_up.for_cycle.latest().origin_mm, (Array3{12, 0, 0}));
  report_accepted(*command);
  publish_in_force();
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kNone));
  ASSERT_TRUE(ports_->set_up.for_planner.refresh() && ports_->set_up.for_intake.refresh());
  EXPECT_EQ(ports_->set_up.for_planner.latest().number, 3);
  EXPECT_EQ(ports_->set_up.for_intake.latest().sum, supervisor_.in_force().sum);
}

TEST_F(SupervisorSetUp, AreTakenOffTheDiskAgainWhereTheCycleRefusesThem) {
  say(FrameWord::kSet, 3, 12);
  const auto command = write_and_take();
  ASSERT_TRUE(command);
  report_refused(*command, Refusal::kProgramPresent);
  ASSERT_TRUE(comes([&] {
    file_.work();
    return on_disk(3) == 0;
  }));
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kProgramPresent));
  EXPECT_FALSE(ports_->set_up.for_planner.refresh());
  EXPECT_TRUE(supervisor_.set_up().frames.rows().empty());
  EXPECT_TRUE(comes([this] {
    return ports_->set_up.claim.try_take(ProgramClaim::Holder::kSession);
  })) << "programs are let in again";
}

TEST_F(SupervisorSetUp, AreRefusedWithTheDisksReason) {
  error_ = ENOSPC;
  say(FrameWord::kSet, 3, 12);
  dds::Reply reply;
  ASSERT_TRUE(comes([&] {
    file_.work();
    return replies_.take(reply);
  }));
  EXPECT_EQ(reply.refusal, Refusal::kNotJournalled);
  EXPECT_NE(reply.text.find("No space left on device"), std::string::npos) << reply.text;
  Command command;
  EXPECT_FALSE(ports_->commands.try_pop(command));
}

TEST_F(SupervisorSetUp, WaitForNoProgramAndLetNoneIn) {
  ASSERT_TRUE(ports_->set_up.claim.try_take(ProgramClaim::Holder::kSession));
  say(FrameWord::kSet, 3, 12);
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kProgramPresent));
  ports_->set_up.claim.give_back(ProgramClaim::Holder::kSession);
  say(FrameWord::kSet, 3, 12);
  ASSERT_TRUE(write_and_take());
  EXPECT_FALSE(ports_->set_up.claim.try_take(ProgramClaim::Holder::kSession));
}

TEST_F(SupervisorSetUp, AreAskedForOnceMoreWhereTheCyclesAnswerWasLost) {
  say(FrameWord::kSet, 3, 12);
  ASSERT_TRUE(write_and_take());
  ask(Verb::kSingleBlock, 1);
  const auto after = take(Verb::kSingleBlock);
  ASSERT_TRUE(after);
  report(EventCode::kAccepted, after->request, Verb::kSingleBlock);
  const auto again = take(Verb::kFrame);
  ASSERT_TRUE(again);
  report_accepted(*again);
  publish_in_force();
  EXPECT_TRUE(has_reply(Verb::kSingleBlock, Refusal::kNone));
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kNone));
}

TEST_F(SupervisorSetUp, AreSetOneAtATimeAndByWhoHasSeenTheLast) {
  say(FrameWord::kSet, 3, 12);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  say(FrameWord::kSet, 3, 13);
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kStale));
  const auto command = write_and_take();
  ASSERT_TRUE(command);
  report_accepted(*command);
  publish_in_force();
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kNone));
  --status_;  // what was published before
  say(FrameWord::kSet, 3, 14);
  EXPECT_TRUE(has_reply(Verb::kFrame, Refusal::kStale));
  ask(Verb::kEnable);
  EXPECT_TRUE(has_reply(Verb::kEnable, Refusal::kStale));
  ++status_;
  say(FrameWord::kSet, 3, 15);
  EXPECT_TRUE(write_and_take());
  EXPECT_EQ(on_disk(3), 15);
}

constexpr const char* kLonger =
    "[[tool]]\nnumber = 7\nlength_mm = 200\nradius_mm = 5\n"
    "length_wear_mm = -0.5\n";

TEST_F(SupervisorSetUp, GivesEverybodyTheToolsThatAreOnDisk) {
  say_tools(kLonger, stream::tools_sum(tools_));
  do_it(Verb::kTool);
  EXPECT_EQ(on_disk().tools, kLonger);
  const ToolTable longer = config::parse_tools(kLonger, "test");
  for (auto* box : {&ports_->set_up.planner_tools, &ports_->set_up.intake_tools,
                    &ports_->set_up.telemetry_tools}) {
    ToolTable tools;
    EXPECT_TRUE(box->try_take(tools));
    EXPECT_EQ(tools, longer);
  }
  EXPECT_EQ(supervisor_.in_force().tools, stream::tools_sum(longer));
  say(FrameWord::kSet, 3, 12);
  do_it(Verb::kFrame);
  EXPECT_EQ(on_disk().tools, kLonger) << "a frame leaves the tools as they are";
}

TEST_F(SupervisorSetUp, TakesTheServicesOwnToolsAgain) {
  say_tools(kLonger);
  do_it(Verb::kTool);
  say_tools("");
  do_it(Verb::kTool);
  EXPECT_FALSE(on_disk().tools);
  EXPECT_EQ(supervisor_.in_force().tools, stream::tools_sum(tools_));
}

TEST_F(SupervisorSetUp, ShrinksTheTravelOfEverybodyAndGivesItBack) {
  const JointLimits whole = model_.joints[0].limits;
  say_limits({LimitsWord::kSet, 0, whole.travel_min / 2, whole.travel_max / 2});
  const auto command = write_and_take(Verb::kLimits);
  ASSERT_TRUE(command);
  ASSERT_TRUE(ports_->set_up.for_cycle.refresh());
  MachineModel cycles = model_;
  apply_set_up(cycles, ports_->set_up.for_cycle.latest());
  EXPECT_EQ(cycles.joints[0].limits.travel_max, whole.travel_max / 2);
  EXPECT_EQ(cycles.joints[1].limits.travel_max, model_.joints[1].limits.travel_max);
  report(EventCode::kAccepted, command->request, Verb::kLimits);
  publish_in_force();
  EXPECT_TRUE(has_reply(Verb::kLimits, Refusal::kNone));
  EXPECT_TRUE(on_disk().limits.rows()[0].is_set);
  ASSERT_TRUE(ports_->set_up.for_planner.refresh() && ports_->set_up.for_intake.refresh() &&
              ports_->set_up.for_telemetry.refresh());
  EXPECT_EQ(ports_->set_up.for_planner.latest().travel, ports_->set_up.for_cycle.latest().travel);
  EXPECT_EQ(ports_->set_up.for_intake.latest().limits, supervisor_.in_force().limits);
  say_limits({LimitsWord::kClear, LimitsOrder::kAllJoints});
  do_it(Verb::kLimits);
  ASSERT_TRUE(ports_->set_up.for_cycle.refresh());
  apply_set_up(cycles, ports_->set_up.for_cycle.latest());
  EXPECT_EQ(cycles.joints[0].limits.travel_min, whole.travel_min);
  EXPECT_EQ(cycles.joints[0].limits.travel_max, whole.travel_max);
  EXPECT_TRUE(on_disk().limits.empty());
}

TEST_F(SupervisorSetUp, RefusesLimitsThatWidenTravel) {
  say_limits({LimitsWord::kSet, 0, 0, 2 * model_.joints[0].limits.travel_max});
  EXPECT_TRUE(has_reply(Verb::kLimits, Refusal::kOutOfRange));
  Command command;
  EXPECT_FALSE(ports_->commands.try_pop(command));
}

TEST_F(SupervisorSetUp, MeasuresTheToolInTheSpindleAnew) {
  say_tools(kLonger);
  do_it(Verb::kTool);
  EXPECT_EQ(ports_->spindle_tool_mm, kToolBefore_mm) << "no tool of the table is in the spindle";
  show(State::kRunning, false);
  change_ = ask_for_tool();
  ASSERT_TRUE(change_);
  end_tool_change(true);
  EXPECT_EQ(ports_->spindle_tool, 7U);
  EXPECT_EQ(ports_->spindle_tool_mm, 199.5);
  abort_program();
  show(State::kOff, false);
  say_tools("");
  do_it(Verb::kTool);
  EXPECT_EQ(ports_->spindle_tool_mm, kTool_mm);
  say_tools("# none\n");
  do_it(Verb::kTool);
  EXPECT_EQ(ports_->spindle_tool_mm, kTool_mm) << "it is in the spindle, whatever the table says";
}

TEST_F(SupervisorSetUp, RefusesToolsThatAreNone) {
  say_tools("[[tool]]\nnumber = 7\nlength_mm = -1\nradius_mm = 5\n");
  dds::Reply reply;
  ASSERT_TRUE(comes([&] { return replies_.take(reply); }));
  EXPECT_EQ(reply.refusal, Refusal::kOutOfRange);
  EXPECT_NE(reply.text.find("tools:3: tool[0].length_mm"), std::string::npos) << reply.text;
}

TEST_F(SupervisorSetUp, RefusesToolsThatWereMadeFromOthers) {
  say_tools(kLonger, stream::tools_sum(tools_) + 1);
  EXPECT_TRUE(has_reply(Verb::kTool, Refusal::kStale));
}

TEST_F(SupervisorSetUp, RefusesToolsWhileOneIsChanged) {
  abort_in_tool_change();
  show(State::kOff, false);
  say_tools(kLonger);
  EXPECT_TRUE(has_reply(Verb::kTool, Refusal::kWrongState));
  end_tool_change(true);
  say_tools(kLonger);
  EXPECT_TRUE(write_and_take(Verb::kTool));
}

TEST_F(SupervisorSetUp, ChangesTheToolOfADryRunAndTheOneBefore) {
  show(State::kRunning, false);
  change_ = ask_for_tool();
  ASSERT_TRUE(change_);
  end_tool_change(true);
  abort_program();
  show(State::kOff, true);
  ASSERT_TRUE(comes([this] { return ports_->may_leave.load(); }));
  say_tools(kLonger);
  do_it(Verb::kTool);
  EXPECT_EQ(ports_->spindle_tool_mm, 199.5);
  show(State::kOff, false);
  say(FrameWord::kSet, 3, 12);
  do_it(Verb::kFrame);
  EXPECT_EQ(ports_->spindle_tool_mm, 199.5);
}

}  // namespace
}  // namespace meridian::interpolator
