// SPDX-License-Identifier: Apache-2.0
#include "integration/fault_case.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <thread>
#include <utility>

#include "integration/live_run.hpp"
#include "integration/set_up_words.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/alarm_letter.hpp"
#include "support/text_file.hpp"

namespace meridian::test {
namespace {

using How = LiveFault::How;
using Where = Phase::Where;

constexpr milliseconds kAtOnce{700};  ///< longer than any fault of the matrix takes to be seen
constexpr int kCycle_us = 2000;
constexpr int kTries = 20;
constexpr const char* kToolFile = "/deploy/tools.toml";

}  // namespace

FaultCase::FaultCase(const LiveFault& fault, const Phase& phase)
    : fault_(fault), phase_(phase), part_(phase) {}

FaultCase::~FaultCase() {
  if (attacker_) attacker_->send_signal(SIGKILL);
  attacker_.reset();
  plant_.reset();
  if (unread_log_ >= 0) ::close(unread_log_);
}

bool FaultCase::ends_service() const noexcept {
  return fault_.how == How::kServiceDies || fault_.how == How::kRecoveryDies;
}

bool FaultCase::is_piped() const noexcept {
  return fault_.is_of_station() || phase_.where == Where::kStarved;
}

/// Near its end a smooth plan holds more back than these parts are long.
std::string FaultCase::transition() const {
  const bool is_exact = fault_.is_of_station() && phase_.where != Where::kCut;
  return is_exact ? "exact_stop" : phase_.transition;
}

/// How far a station that is piped has come when it happens: a little behind where it happens.
std::uint32_t FaultCase::fed_line() const {
  const auto end = static_cast<std::uint32_t>(part_.lines.size());
  if (phase_.where == Where::kStarved) return part_.section + 3;
  return phase_.where == Where::kEnd ? end - 1 : end - 3;
}

void FaultCase::run() {
  set_up();
  if (testing::Test::HasFatalFailure()) return;
  if (phase_.where != Where::kReady) {
    ASSERT_NO_FATAL_FAILURE(start_program(0));
    ASSERT_NO_FATAL_FAILURE(reach_phase());
  }
  ASSERT_NO_FATAL_FAILURE(provoke());
  letter_ = wait_for_outcome();
  if (testing::Test::HasFatalFailure()) return;
  const bool is_expected = expected(fault_, phase_).find(letter_) != std::string::npos;
  EXPECT_TRUE(is_expected) << "came: " << letter_ << ", expected: " << expected(fault_, phase_)
                           << "\n"
                           << story();
  if (letter_ == "·") {
    ASSERT_NO_FATAL_FAILURE(go_on());
  } else if (letter_ == "S") {
    ASSERT_NO_FATAL_FAILURE(fault_.how == How::kStationDies ? replace_station() : go_on());
  } else {
    ASSERT_NO_FATAL_FAILURE(expect_joint());
    ASSERT_NO_FATAL_FAILURE(recover_and_go_on());
  }
  plant_->service().send_signal(SIGTERM);
  ASSERT_EQ(plant_->service().wait(milliseconds(8000)), 0) << story();
  expect_provoked();
  check_all();
}

std::string FaultCase::host_said() const {
  constexpr double kBridge_s = 0.1;  // service_file() of live_run.hpp
  if (!host_.is_watching()) {
    return "whether the host took a processor away was not seen: no right to real-time threads";
  }
  if (host_.longest_s() <= kBridge_s) return "";
  char text[160];
  std::snprintf(text, sizeof text,
                "the host kept a processor from a thread of highest priority for %.0f ms, longer "
                "than the drives bridge",
                1e3 * host_.longest_s());
  return text;
}

std::string FaultCase::story() {
  return plant_->standing() + "\n" + plant_->service().said() + plant_->drives().said() +
         (station_ ? station_->said() : "");
}

void FaultCase::set_up() {
  if (fault_.how == How::kWire) hosts_ = std::make_unique<Hosts>(Hosts::Wire::kSpoilt);
  plant_ = std::make_unique<Plant>();
  plant_->set_cycle_us(kCycle_us);
  plant_->change_machine({{"clearance_mm = [0-9]+", "clearance_mm = 5"}});
  witness_ = std::make_unique<Witness>(plant_->participant());
  actions_ = std::make_unique<dds::Reader<dds::Action>>(plant_->participant());
  part_file_ = (plant_->folder() / "part.cls").string();
  std::ofstream(part_file_) << part_.text();
  const std::string tools = std::string(MERIDIAN_SOURCE_DIR) + kToolFile;
  service_words_ = {"--service",
                    service_file(*plant_, "tools = \"" + tools + "\"\naction_timeout_s = 4\n")};
  if (fault_.how == How::kBlockedLog) {
    const std::string log = plant_->folder() / "service.log";
    ASSERT_EQ(::mkfifo(log.c_str(), 0600), 0);
    unread_log_ = ::open(log.c_str(), O_RDWR | O_CLOEXEC);
    constexpr int kSmallest = 4096;
    ASSERT_GE(::fcntl(unread_log_, F_SETPIPE_SZ, kSmallest), 0);
  }
  plant_->start_service(service_words_);
  plant_->start_drives({"--action-delay", "1"}, &console_);
  ASSERT_TRUE(plant_->enable()) << story();
  if (fault_.how == How::kSetUp) {
    set_up_words_ = std::make_unique<SetUpWords>(*plant_, read_text(tools));
  }
}

void FaultCase::start_station(std::uint32_t from_line) {
  const bool is_first = stations_++ == 0;
  std::vector<std::string> words = {"meridian",       "stream",       part_file_,   "--domain",
                                    plant_->domain(), "--transition", transition(), "--wait-end"};
  if (is_first && is_piped()) {
    words[2] = "-";
    source_ = std::make_unique<InputPipe>();
    source_->write(part_.text_up_to(fed_line()));
  }
  if (from_line > 0) {
    words.insert(words.end(), {"--from-line", std::to_string(from_line), "--station", "another"});
  }
  station_ =
      std::make_unique<Process>(words, plant_->folder() / ("station" + std::to_string(stations_)),
                                is_first ? source_.get() : nullptr);
}

void FaultCase::start_program(std::uint32_t from_line) {
  const auto is_loaded = [this] { return plant_->status().state == State::kLoaded; };
  // Nobody is let in while a tool change that the fault cut short is not answered; whatever else
  // is refused is not asked for again.
  const auto is_refused_for_now = [this] {
    return station_->said().find("which tool is in the spindle is not known") != std::string::npos;
  };
  int tries = 0;
  do {
    start_station(from_line);
    (void)plant_->runs_until([this](const auto& s) {
      return s.state == State::kLoaded || station_->wait(milliseconds(0)).has_value();
    });
  } while (!is_loaded() && is_refused_for_now() && ++tries < kTries);
  ASSERT_TRUE(is_loaded()) << story();
  ASSERT_NO_FATAL_FAILURE(plant_->must(Verb::kStart));
  has_program_ = true;
}

void FaultCase::reach_phase() {
  const auto until = [this](const std::function<bool(const Setpoint&)>& is_there) {
    ASSERT_TRUE(eventually([&] { return is_there(witness_->newest()) || has_ended(); }, kLong));
    ASSERT_FALSE(has_ended()) << story();
  };
  const auto until_cut = [&](std::uint32_t line) {
    until([line](const Setpoint& now) {
      return now.line >= line && (now.flags & kSetpointMoving) != 0;
    });
  };
  switch (phase_.where) {
    case Where::kReady:
      return;
    case Where::kBegin:
      return until([](const Setpoint& now) { return (now.flags & kSetpointMoving) != 0; });
    case Where::kCut:
      return until_cut(part_.section + 1);
    case Where::kRapid: {
      constexpr double kFast_mm_per_s = 100;
      return until([&](const Setpoint& now) { return std::abs(now.velocity[0]) > kFast_mm_per_s; });
    }
    case Where::kPole: {
      constexpr double kTurning_rad_per_s = 0.7;
      return until([&](const Setpoint& now) {
        return now.line >= part_.section && std::abs(now.velocity[3]) > kTurning_rad_per_s;
      });
    }
    case Where::kHolding:
    case Where::kHeld:
      ASSERT_NO_FATAL_FAILURE(until_cut(part_.section + 2));
      ASSERT_NO_FATAL_FAILURE(plant_->must(Verb::kHold));
      if (phase_.where == Where::kHeld) {
        ASSERT_TRUE(plant_->wait_for(State::kHeld)) << story();
      }
      return;
    case Where::kDwell:
      return until([&](const Setpoint& now) {
        return now.line + 1 >= part_.section && (now.flags & kSetpointMoving) == 0;
      });
    case Where::kTool:
      ASSERT_TRUE(eventually(
          [this] {
            dds::Action action;
            while (actions_->take(action)) {
              if (action.kind == ActionKind::kToolChange) return true;
            }
            return false;
          },
          kLong))
          << story();
      return;
    case Where::kStarved:
      ASSERT_TRUE(plant_->runs_until(
          [](const auto& s) {
            return s.state == State::kStarved && s.blocks_done == s.blocks_received;
          },
          kLong))
          << story();
      return;
    case Where::kEnd:
      return until_cut(part_.motions.back());
  }
}

/// Whether it faults in that time.
bool FaultCase::waits_for_fault(milliseconds patience) {
  return eventually([this] { return plant_->status().state == State::kFault; }, patience);
}

std::string FaultCase::wait_for_outcome() {
  const std::string letters = expected(fault_, phase_);
  if (ends_service()) return "X";
  if (fault_.is_of_station()) {
    if (phase_.is_held()) resume_held();
    // A smooth plan waits for more behind what it holds back (docs/motion.md, section 9).
    const bool is_smooth = transition() == "smooth";
    const bool is_starved = plant_->runs_until(
        [is_smooth](const auto& s) {
          return s.state == State::kStarved && (is_smooth || s.blocks_done == s.blocks_received);
        },
        kLong);
    return is_starved ? "S" : letter_of(plant_->status().alarm);
  }
  const bool is_dull = letters.find("·") != std::string::npos;
  if (phase_.waits() || phase_.where == Where::kHolding) {
    if (!waits_for_fault(is_dull ? kAtOnce : milliseconds(8000))) return "·";
  } else {
    EXPECT_TRUE(eventually(
        [this] { return plant_->status().state == State::kFault || has_ended(); }, kLong))
        << "neither a Fault nor the end of the program: " << story();
    // It may come to light when the program is at its end already.
    if (plant_->status().state != State::kFault &&
        (is_dull || !waits_for_fault(milliseconds(3000)))) {
      return "·";
    }
  }
  // Alarm and state come to the status by two ways.
  (void)eventually([this] { return plant_->status().alarm != Alarm::kNone; });
  return letter_of(plant_->status().alarm);
}

void FaultCase::mend() {
  if (fault_.how == How::kConsole) console_.write("mend\n");
  if (fault_.how == How::kDrivesDie) plant_->start_drives({"--action-delay", "1"}, &console_);
  if (hosts_) hosts_->spoil({});
}

/// What the operator held.
void FaultCase::resume_held() {
  ASSERT_TRUE(plant_->wait_for(State::kHeld)) << story();
  plant_->must(Verb::kResume);
}

/// Until the station has heard of the program's end, without an operator, but where a station kept
/// the machine waiting for longer than it resumes by itself. That is the end of `cut`.
void FaultCase::run_to_end(PartCut& cut, bool is_kept_waiting) {
  ASSERT_TRUE(plant_->runs_until(
      [&](const auto& s) {
        if (is_kept_waiting && s.state == State::kStarved) (void)plant_->say(Verb::kResume);
        return has_ended();
      },
      kLong))
      << story();
  ASSERT_EQ(station_->wait(milliseconds(0)), 0) << story();
  ASSERT_TRUE(plant_->wait_for(State::kReady)) << story();
  end_at(cut, plant_->status(), lost_before_);
}

void FaultCase::go_on() {
  if (phase_.where == Where::kReady) {
    mend();
    ASSERT_NO_FATAL_FAILURE(start_program(0));
  } else if (phase_.waits() || phase_.where == Where::kHolding) {
    mend();
  }
  if (is_piped()) {
    std::string rest = part_.text();
    rest.erase(0, part_.text_up_to(fed_line()).size());
    source_->write(rest);
    source_->close();
    if (fault_.how == How::kStationStops) station_->send_signal(SIGCONT);
  }
  if (phase_.is_held() && !fault_.is_of_station()) {
    ASSERT_NO_FATAL_FAILURE(resume_held());
  }
  first_.recording = plant_->recording();
  run_to_end(first_, is_piped());
}

/// The station is gone, and every block that it had sent is cut: another one goes on behind them.
void FaultCase::replace_station() {
  const auto state = plant_->status();
  EXPECT_EQ(state.alarm, Alarm::kNone) << story();
  const bool is_all = state.blocks_done == state.blocks_received;
  EXPECT_EQ(state.line == fed_line(), is_all) << story();
  first_ = {.recording = plant_->recording(), .is_finished = phase_.where == Where::kEnd};
  ASSERT_NO_FATAL_FAILURE(plant_->must(Verb::kAbort));
  ASSERT_TRUE(plant_->runs_until([](const auto& s) {
    return s.state == State::kReady && s.session == 0;
  })) << story();
  const dds::Status aborted = plant_->status();
  end_at(first_, aborted);
  if (phase_.where == Where::kEnd) return;
  lost_before_ = cycles_lost(aborted);
  second_ = PartCut{.recording = first_.recording,
                    .from_line = is_all ? fed_line() + 1 : state.line,
                    .from_cycle = first_.to_cycle + 1};
  ASSERT_NO_FATAL_FAILURE(start_program(second_->from_line));
  run_to_end(*second_);
}

}  // namespace meridian::test
