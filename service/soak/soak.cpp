// SPDX-License-Identifier: Apache-2.0
#include "service/soak/soak.hpp"

#include <csignal>
#include <optional>
#include <stdexcept>
#include <utility>

#include "service/config/machine_file.hpp"
#include "service/dds/participant.hpp"
#include "service/dds/reader.hpp"
#include "service/probe/budgets.hpp"
#include "service/probe/figures.hpp"
#include "service/process/processors.hpp"
#include "service/process/programs.hpp"
#include "service/soak/health_watch.hpp"
#include "service/soak/judge.hpp"
#include "service/soak/plant.hpp"
#include "service/soak/sample_program.hpp"
#include "service/stream/operator_link.hpp"
#include "service/stream/steady_ns.hpp"

namespace meridian::soak {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kTick{20}, kAnswer{1500};
constexpr double kReportEvery_s = 5, kHealthEvery_s = 1;
/// Between the end of a program and the next: its recording is cut there.
constexpr double kPause_s = 0.3;
/// A service that is killed is forgotten after its lease; drives that lost it come to rest.
constexpr double kAfterDeath_s = 2.5;
/// Nothing moves for this long although nobody holds the machine: something is stuck.
constexpr double kStuck_s = 60;

[[nodiscard]] bool is_moving(State state) {
  return state == State::kApproaching || state == State::kRunning;
}

class Soak {
 public:
  Soak(const SoakOptions& options, const std::function<void(const std::string&)>& say)
      : options_(options),
        say_(say),
        model_(config::load_machine(options.machine)),
        tools_(options.tools.empty() ? ToolTable{} : config::load_tools(options.tools)),
        judge_(model_, tools_, folder_.path()),
        plant_(options.machine, options.tools, options.domain, folder_.path()),
        chaos_(options.seed, options.chaos_every_s, model_.joint_count, model_.most_feed_override),
        participant_({.domain = options.domain, .machine = model_.name}),
        operator_(participant_, "soak"),
        health_(participant_, report_) {
    report_.machine = model_.name;
    report_.host = probe::host_text();
    report_.seed = options.seed;
    report_.asked_s = options.for_s;
    report_.resident_budget_mib = probe::load_budget("resident_memory").limit;
  }

  SoakReport run(const std::atomic<bool>& is_stopping) {
    start_service();
    start_drives();
    if (options_.chaos_every_s > 0) next_ = chaos_.next();
    while (now_s() < options_.for_s && !is_stopping.load()) {
      const bool is_news = operator_.wait_for_status(kTick);
      keep_alive();
      if (is_news) {
        see(*operator_.status());
        operate(*operator_.status());
      }
      mishaps();
      watch();
    }
    end();
    return report_;
  }

 private:
  [[nodiscard]] double now_s() const {
    return static_cast<double>(stream::steady_ns() - begin_ns_) * 1e-9;
  }

  void start_service() {
    plant_.start_service(judge_.pipe());
    ++report_.service_starts;
    health_.begin_life(now_s());
    counted_ = {};
    state_ = State::kOff;
    moved_s_ = now_s();
  }

  void start_drives() {
    injected_.reset();
    if (options_.chaos_every_s > 0) injected_ = chaos_.next_of_drives();
    plant_.start_drives(injected_, injected_ ? drive_spec(model_, injected_->drive).name : "");
    ++report_.drive_starts;
  }

  /// Starts again what died or was killed.
  void keep_alive() {
    if (plant_.service() == nullptr) {
      if (now_s() >= service_at_s_) start_service();
    } else if (const auto code = plant_.service()->wait_for_exit(milliseconds(0))) {
      report_.violate("the service ended by itself with code " + std::to_string(*code), "soak");
      plant_.kill_service();
      service_at_s_ = now_s() + kAfterDeath_s;
    }
    if (plant_.station() != nullptr) {
      const auto code = plant_.station()->wait_for_exit(milliseconds(0));
      if (code) end_program(*code);
    }
  }

  void end_program(int code) {
    constexpr int kInputRefused = 3;
    ++(code == 0 ? report_.finished : code == kInputRefused ? report_.refused : report_.aborted);
    plant_.kill_station();
    ended_s_ = now_s();
  }

  [[nodiscard]] std::string next_program() {
    if (!options_.programs.empty()) {
      return options_.programs[report_.programs % options_.programs.size()];
    }
    const auto file = folder_.path() / ("program" + std::to_string(report_.programs) + ".cl");
    write_sample_program(model_, options_.seed * 1000 + report_.programs, file);
    return file.string();
  }

  void start_program() {
    const std::string program = next_program();
    ++report_.programs;
    judge_.announce(program, stream::steady_ns());
    plant_.start_station(program);
  }

  /// Counts what the status tells of this life of the service.
  void see(const dds::Status& status) {
    const auto add = [](std::uint64_t& sum, std::uint64_t& counted, std::uint64_t now) {
      if (now > counted) sum += now - counted;
      counted = now;
    };
    if (status.service_id != counted_.service_id) counted_ = {.service_id = status.service_id};
    add(report_.cycles_run, counted_.cycles, status.cycles_run);
    add(report_.periods_lost, counted_.lost, status.periods_lost);
    add(report_.starvations, counted_.starvations, status.starvations);
    add(report_.overruns, counted_.overruns, status.setpoints_overrun + status.events_overrun);
    if (status.state == State::kFault && state_ != State::kFault) {
      ++report_.alarms;
      is_drive_sick_ = injected_.has_value();
    }
    if (status.state != state_ || is_moving(status.state)) moved_s_ = now_s();
    state_ = status.state;
    if (now_s() - moved_s_ < kStuck_s) return;
    report_.violate("nothing moved for a minute in state " +
                        std::to_string(static_cast<int>(status.state)) + ": " + status.message,
                    "soak");
    moved_s_ = now_s();
    break_off();
  }

  /// From anywhere back to a machine that can be switched on.
  void break_off() {
    plant_.kill_station();
    ++report_.aborted;
    (void)operator_.ask(Verb::kAbort, 0, kAnswer);
    start_drives();
  }

  void operate(const dds::Status& status) {
    const double now = now_s();
    if (now < ask_again_s_) return;
    switch (status.state) {
      case State::kOff:
        ask(Verb::kEnable);
        break;
      case State::kFault:
        if (std::exchange(is_drive_sick_, false)) cure_drives();
        ask(Verb::kReset);
        break;
      case State::kReady:
        if (plant_.station() == nullptr && now - ended_s_ > kPause_s) start_program();
        break;
      case State::kLoaded:
        ask(Verb::kStart);
        break;
      case State::kHeld:
        if (now >= resume_s_) ask(Verb::kResume);
        break;
      case State::kStarved:
        if (plant_.station() == nullptr) ask(Verb::kAbort);
        break;
      default:
        break;
    }
  }

  /// Asks, and not again at once.
  void ask(Verb verb, double value = 0) {
    (void)operator_.ask(verb, value, kAnswer);
    ask_again_s_ = now_s() + 0.2;
  }

  /// What the drives were told to suffer is over with their process.
  void cure_drives() {
    ++report_.mishaps[static_cast<std::size_t>(injected_->mishap)];
    start_drives();
  }

  void mishaps() {
    const double now = now_s();
    if (continue_s_ > 0 && now >= continue_s_ && plant_.station() != nullptr) {
      plant_.station()->send_signal(SIGCONT);
      continue_s_ = 0;
    }
    if (!next_ || now < next_->at_s || state_ != State::kRunning) return;
    ++report_.mishaps[static_cast<std::size_t>(next_->mishap)];
    happen(*next_);
    do {
      next_ = chaos_.next();
    } while (next_->at_s < now);
  }

  void happen(const Planned& mishap) {
    switch (mishap.mishap) {
      case Mishap::kHold:
        ask(Verb::kHold);
        resume_s_ = now_s() + mishap.value;
        break;
      case Mishap::kOverride:
        judge_.announce_override(mishap.value, stream::steady_ns());
        ask(Verb::kFeedOverride, mishap.value);
        break;
      case Mishap::kAbort:
        ask(Verb::kAbort);
        break;
      case Mishap::kStationStops:
        if (plant_.station() == nullptr) break;
        plant_.station()->send_signal(SIGSTOP);
        continue_s_ = now_s() + mishap.value;
        break;
      case Mishap::kStationDies:
        if (plant_.station() == nullptr) break;
        plant_.kill_station();
        ++report_.aborted;
        ended_s_ = now_s();
        break;
      case Mishap::kServiceDies:
        plant_.kill_service();
        plant_.kill_station();
        ++report_.aborted;
        service_at_s_ = now_s() + kAfterDeath_s;
        state_ = State::kOff;
        break;
      default:
        break;  // those of the drives happen there
    }
  }

  void watch() {
    const double now = now_s();
    if (now - healthy_s_ >= kHealthEvery_s) {
      healthy_s_ = now;
      if (plant_.service() != nullptr) health_.look(plant_.service()->id(), now);
    }
    if (now - told_s_ < kReportEvery_s) return;
    told_s_ = now;
    tell();
  }

  void tell() {
    report_.elapsed_s = now_s();
    judge_.collect(report_);
    if (options_.report.empty()) return;
    auto text_file = options_.report;
    text_file.replace_extension(".txt");
    if (!write_whole(options_.report, to_json(report_)) ||
        !write_whole(text_file, to_text(report_))) {
      say_("the report " + options_.report.string() + " cannot be written");
    }
  }

  void end() {
    report_.elapsed_s = now_s();
    plant_.kill_station();
    if (plant_.service() != nullptr) health_.look(plant_.service()->id(), now_s());
    if (!plant_.end_service()) report_.violate("the service did not end well", "soak");
    plant_.stop_drives();
    judge_.finish();
    report_.is_over = true;
    const double elapsed_s = report_.elapsed_s;
    tell();
    report_.elapsed_s = elapsed_s;
  }

  struct Counted {
    std::uint64_t service_id = 0, cycles = 0, lost = 0, starvations = 0, overruns = 0;
  };

  const SoakOptions& options_;
  const std::function<void(const std::string&)>& say_;
  const process::ScratchFolder folder_;
  const MachineModel model_;
  const ToolTable tools_;
  SoakReport report_;
  Judge judge_;
  Plant plant_;
  Chaos chaos_;
  dds::Participant participant_;
  stream::OperatorLink operator_;
  HealthWatch health_;
  std::optional<Planned> next_, injected_;
  Counted counted_;
  State state_ = State::kOff;
  bool is_drive_sick_ = false;
  const std::int64_t begin_ns_ = stream::steady_ns();
  double moved_s_ = 0, ended_s_ = 0, ask_again_s_ = 0, resume_s_ = 0, continue_s_ = 0;
  double service_at_s_ = 0, healthy_s_ = 0, told_s_ = 0;
};

}  // namespace

SoakReport run_soak(const SoakOptions& options, const std::atomic<bool>& is_stopping,
                    const std::function<void(const std::string&)>& say) {
  process::stay_off_cpu(process::last_cpu());  // our DDS threads inherit that
  return Soak(options, say).run(is_stopping);
}

}  // namespace meridian::soak
