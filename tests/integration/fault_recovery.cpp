// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdio>
#include <filesystem>
#include <limits>
#include <sstream>
#include <thread>
#include <vector>

#include "integration/fault_case.hpp"
#include "integration/set_up_words.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/transport/writer.hpp"

namespace meridian::test {
namespace {

using How = LiveFault::How;
using Where = Phase::Where;

/// The position is some 20 ms old, and takes a while to get to the disk of a busy host.
constexpr std::int64_t kJournalAge_ns = 500'000'000;
constexpr milliseconds kBetweenTimes{10};
/// Of the setpoints on the wire the witness sees all but one in so many, and but for those that the
/// service lost since its last status: no more than drives bridge.
constexpr std::uint64_t kSeenPerUnseen = 100;
constexpr std::uint64_t kBridge_cycles = 50;

/// The line behind `words` in `text`; 0: it is not there.
[[nodiscard]] std::uint32_t line_after(const std::string& text, const std::string& words) {
  const auto at = text.find(words);
  return at == std::string::npos
             ? 0
             : static_cast<std::uint32_t>(std::stoul(text.substr(at + words.size())));
}

}  // namespace

void FaultCase::provoke() {
  switch (fault_.how) {
    case How::kConsole:
      for (int n = 0; n < fault_.times; ++n) {
        if (n > 0) std::this_thread::sleep_for(kBetweenTimes);
        console_.write(std::string(fault_.line) + "\n");
      }
      return;
    case How::kStationDies:
      station_->send_signal(SIGKILL);
      ASSERT_TRUE(station_->wait(milliseconds(2000)));
      return;
    case How::kStationStops:
      return station_->send_signal(SIGSTOP);
    case How::kServiceDies:
    case How::kRecoveryDies:
      return kill_service();
    case How::kAttacker:
    case How::kStuck:
    case How::kBlockedLog:
      return start_attacker();
    case How::kDrivesDie:
      plant_->drives().send_signal(SIGKILL);
      ASSERT_TRUE(plant_->drives().wait(milliseconds(2000)));
      return;
    case How::kStall:
      plant_->service().send_signal(SIGSTOP);
      std::this_thread::sleep_for(milliseconds(fault_.milliseconds));
      return plant_->service().send_signal(SIGCONT);
    case How::kSetUp:
      return phase_.where == Where::kReady ? set_up_words_->expect_accepted()
                                           : set_up_words_->expect_refused();
    case How::kRubbish:
      return send_rubbish();
    case How::kWire:
      return hosts_->spoil(fault_.wire);
  }
}

/// What was to go wrong did go wrong.
void FaultCase::expect_provoked() {
  if (fault_.how == How::kConsole) {
    EXPECT_NE(plant_->drives().said().find("injected: "), std::string::npos) << story();
  }
  if (fault_.how != How::kWire) return;
  const std::string said = hosts_->wire_said();
  int frames = 0, lost = 0, twice = 0, past_others = 0, wrong = 0, late = 0;
  EXPECT_EQ(
      std::sscanf(said.c_str(),
                  "%d frames, %d lost, %d twice, %d past others, %d with a wrong bit, %d late",
                  &frames, &lost, &twice, &past_others, &wrong, &late),
      6)
      << said;
  const Hosts::Spoilt& asked = fault_.wire;
  EXPECT_EQ(lost > 0, asked.lost > 0) << said;
  EXPECT_EQ(twice > 0, asked.twice > 0) << said;
  EXPECT_EQ(past_others > 0, asked.past_others > 0) << said;
  EXPECT_EQ(wrong > 0, asked.wrong > 0) << said;
  EXPECT_EQ(late > 0, asked.delay_ms > 0) << said;
}

/// Where one drive was made to fail, the alarm names its joint.
void FaultCase::expect_joint() {
  const std::string line = fault_.line;
  const auto colon = line.find(':');
  if (colon == std::string::npos || line.find('\n') != std::string::npos) return;
  const MachineModel model = config::load_machine(plant_->machine());
  const int joint = plant_->status().alarm_joint;
  ASSERT_LT(joint, model.joint_count) << story();
  EXPECT_EQ(drive_spec(model, joint).name, line.substr(colon + 1)) << story();
}

/// From somebody who has neither drives nor a station, on every topic that means motion.
void FaultCase::send_rubbish() {
  dds::Participant& somebody = plant_->participant();
  dds::Writer<dds::Batch> batches(somebody);
  dds::Writer<dds::CommandRequest> commands(somebody);
  dds::Writer<dds::SetpointSample> setpoints(somebody);
  dds::Writer<dds::DriveCommand> controlwords(somebody);
  dds::Writer<dds::DriveFeedback> reports(somebody);
  dds::Writer<dds::ActionDone> answers(somebody);
  dds::Writer<dds::Jog> hands(somebody);
  ASSERT_TRUE(eventually([&] {
    return batches.matched_readers() > 0 && commands.matched_readers() > 0 &&
           setpoints.matched_readers() > 1 && controlwords.matched_readers() > 0 &&
           reports.matched_readers() > 0 && answers.matched_readers() > 0 &&
           hands.matched_readers() > 0;
  })) << "nobody hears it";
  // A busy host may keep those who take it for longer than a write waits for them.
  const auto send = [](auto& writer, const auto& sample) {
    EXPECT_TRUE(eventually([&] { return writer.write(sample); }));
  };
  for (std::uint64_t n = 1; n <= 20; ++n) {
    dds::Batch batch;
    batch.session = 666;
    batch.first_sequence = n;
    batch.count = 3;  // and no CRC
    send(batches, batch);
    dds::CommandRequest word;
    word.request = n;
    word.operator_id = 666;
    word.verb = n % 2 == 0 ? Verb::kStart : static_cast<Verb>(200);
    word.epoch_seen = 999;
    send(commands, word);
    dds::SetpointSample setpoint;
    setpoint.setpoint.cycle = (1ULL << 40U) + n;
    setpoint.setpoint.position.fill(100);
    setpoint.setpoint.flags = kSetpointEnabled;
    send(setpoints, setpoint);
    dds::DriveCommand off;
    off.service_id = 666;
    send(controlwords, off);
    dds::DriveFeedback report;
    report.drive_group = 66;
    report.joint_mask = 0x1f;
    report.sample = n;
    report.position.fill(std::numeric_limits<double>::quiet_NaN());
    send(reports, report);
    send(answers, dds::ActionDone{.id = 1ULL << 40U, .service_id = 666, .is_done = false});
    dds::Jog hand;
    hand.operator_id = 666;
    hand.velocity = hand.distance = 1;
    hand.dead_man_ns = 1'000'000'000;
    send(hands, hand);
    std::this_thread::sleep_for(milliseconds(5));
  }
}

/// What it was sending is in the recording of who saw it on the wire; its own is lost with it.
void FaultCase::kill_service() {
  const dds::Status last = plant_->status();
  if (station_) station_->send_signal(SIGKILL);  // else it opens its program anew
  plant_->service().send_signal(SIGKILL);
  ASSERT_TRUE(plant_->service().wait(milliseconds(2000)));
  first_ = {.recording = plant_->folder() / "wire.csv", .is_finished = false};
  const auto sent = witness_->take();
  first_.max_missing =
      last.periods_lost + last.setpoints_overrun + kBridge_cycles + sent.size() / kSeenPerUnseen;
  for (const Setpoint& setpoint : sent) {
    const bool is_old = sent.back().due_ns - setpoint.due_ns > kJournalAge_ns;
    // An approach is that of the first line.
    if (is_old && has_program_ && setpoint.line > part_.motions.front()) {
      line_long_ago_ = setpoint.line;
    }
  }
  write_recording(sent, config::load_machine(plant_->machine()), first_.recording);
  restart_killed_service();
}

void FaultCase::restart_killed_service() {
  const std::uint64_t last = plant_->status().service_id;
  plant_->start_service(service_words_);
  ASSERT_TRUE(eventually([&] { return plant_->status().service_id != last; }, kLong)) << story();
  EXPECT_EQ(plant_->status().state, State::kOff) << story();
}

/// The service goes on at that line, and is killed as soon as it moves: the next one names the same
/// line, for nothing was cut.
void FaultCase::break_off_recovery(std::uint32_t line) {
  ASSERT_NO_FATAL_FAILURE(start_program(line));
  ASSERT_TRUE(eventually(
      [this] { return (witness_->newest().flags & kSetpointMoving) != 0 || has_ended(); }, kLong))
      << story();
  station_->send_signal(SIGKILL);
  plant_->service().send_signal(SIGKILL);
  ASSERT_TRUE(plant_->service().wait(milliseconds(2000)));
  ASSERT_NO_FATAL_FAILURE(restart_killed_service());
  EXPECT_EQ(reported_by_journal(), line) << story();
  ASSERT_NO_FATAL_FAILURE(enable_again());
}

void FaultCase::start_attacker() {
  std::vector<std::string> words{"attacker"};
  std::istringstream line(fault_.line);
  for (std::string word; line >> word;) words.push_back(word);
  for (const std::string& word :
       {std::string("--domain"), plant_->domain(), std::string("--for"), std::string("120")}) {
    words.push_back(word);
  }
  attacker_ = std::make_unique<Process>(words, plant_->folder() / "attacker.log");
  ASSERT_TRUE(eventually(
      [this] { return attacker_->said().find("attacking: ") != std::string::npos; }, kLong))
      << attacker_->said();
  if (fault_.how != How::kStuck) return;
  std::this_thread::sleep_for(milliseconds(300));  // until its readers are known
  attacker_->send_signal(SIGSTOP);
}

/// The line to go on with, as the new service reported it when it began.
std::uint32_t FaultCase::reported_by_journal() {
  std::string report;
  // It is reported before the first status, which has come.
  const std::string said = plant_->service().said();
  const auto at = said.rfind("last program: ");
  if (at != std::string::npos) report = said.substr(at, said.find('\n', at) - at);
  // A program that began just now may not have got to the disk: none of it is cut.
  if (report.empty() && (!has_program_ || phase_.where == Where::kBegin)) return 0;
  const std::uint32_t line = line_after(report, "; go on with --from-line ");
  EXPECT_GT(line, 0U) << report;
  EXPECT_GE(line, line_long_ago_) << "older than a second: " << report;
  const bool is_done = report.find(" done up to block ") != std::string::npos;
  return is_done ? line + 1 : line;  // one block a line
}

void FaultCase::enable_again() {
  ASSERT_TRUE(eventually(
      [this] {
        const auto reset = plant_->say(Verb::kReset);
        const auto enable = plant_->say(Verb::kEnable);
        return reset && enable && plant_->wait_for(State::kReady, milliseconds(500));
      },
      kLong))
      << story();
}

/// Behind a Fault or in a new service: reset, enable, and the rest of the program.
void FaultCase::recover_and_go_on() {
  const dds::Status stopped = plant_->status();
  const bool is_new_service = letter_ == "X";
  // A program that was at its end before has nothing to go on with.
  const bool is_over =
      has_program_ && !is_new_service && has_ended() && station_->wait(milliseconds(0)) == 0;
  const std::uint32_t line = is_new_service ? reported_by_journal() : stopped.alarm_line;
  mend();
  ASSERT_NO_FATAL_FAILURE(enable_again());
  EXPECT_TRUE(eventually([this] { return plant_->status().alarm == Alarm::kNone; }))
      << plant_->standing();
  if (!is_new_service) {
    constexpr int kBridge_ms = 100;
    first_ = {.recording = plant_->recording(),
              .is_finished = is_over,
              .has_left_path = fault_.milliseconds > kBridge_ms};
    end_at(first_, stopped);
    lost_before_ = cycles_lost(stopped);
  }
  if (is_over) return;
  if (station_) {
    ASSERT_TRUE(station_->wait(milliseconds(8000))) << "its program is over: " << story();
  }
  const auto is_at = [this](std::uint32_t n) { return n <= part_.lines.size() - 1; };
  if (!is_at(line)) return;  // all of it is cut
  if (fault_.how == How::kRecoveryDies && line > 0) {
    constexpr int kTimes = 2;
    for (int n = 0; n < kTimes; ++n) ASSERT_NO_FATAL_FAILURE(break_off_recovery(line));
  }
  second_ = PartCut{.recording = plant_->recording(),
                    .from_line = line,
                    // From Ready on: where drives are enabled again is no motion of a program.
                    .from_cycle = is_new_service ? 0 : witness_->newest().cycle};
  ASSERT_NO_FATAL_FAILURE(start_program(line));
  run_to_end(*second_);
}

void FaultCase::check_all() {
  const MachineModel model = config::load_machine(plant_->machine());
  const ToolTable tools =
      config::load_tools(std::string(MERIDIAN_SOURCE_DIR) + "/deploy/tools.toml");
  const PartAsked part{model, tools, part_file_, part_.motions};
  LinesCut before;
  if (!first_.recording.empty() && (has_program_ || second_)) before = check(part, first_);
  if (!second_) {
    EXPECT_EQ(before.last, part_.motions.back());
    EXPECT_TRUE(before.is_last_done);
    return;
  }
  // A tool change that the fault cut short may have come to its end all the same.
  if (const Tool* next = tools.find(2);
      phase_.where == Where::kTool && passes_with(part, *second_, next->length_mm)) {
    second_->tool_mm = next->length_mm;
  }
  const LinesCut after = check(part, *second_);
  EXPECT_EQ(after.last, part_.motions.back());
  EXPECT_TRUE(after.is_last_done);
  if (second_->from_line > 0) expect_seam(part, before, after, second_->from_line, letter_ == "X");
}

}  // namespace meridian::test
