// SPDX-License-Identifier: Apache-2.0
#include "service/soak/soak.hpp"

#include <algorithm>
#include <csignal>
#include <optional>
#include <stdexcept>
#include <utility>

#include "service/config/machine_file.hpp"
#include "service/config/service_file.hpp"
#include "service/dds/participant.hpp"
#include "service/dds/reader.hpp"
#include "service/drives/cia402.hpp"
#include "service/probe/doctor.hpp"
#include "service/probe/figures.hpp"
#include "service/probe/measure.hpp"
#include "service/probe/probe_report.hpp"
#include "service/process/processors.hpp"
#include "service/process/programs.hpp"
#include "service/soak/fault_judge.hpp"
#include "service/soak/health_watch.hpp"
#include "service/soak/host_credit.hpp"
#include "service/soak/host_watch.hpp"
#include "service/soak/judge.hpp"
#include "service/soak/overrun_excuse.hpp"
#include "service/soak/plant.hpp"
#include "service/soak/report_files.hpp"
#include "service/soak/sample_program.hpp"
#include "service/soak/status_counts.hpp"
#include "service/stream/operator_link.hpp"
#include "service/stream/steady_ns.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::soak {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kTick{20}, kAnswer{1500};
constexpr double kReportEvery_s = 2, kHealthEvery_s = 1;
/// So often is asked for what leads on and the state stays, until the drives are started anew.
constexpr int kMostInVain = 15;
/// Between the end of a program and the next: its recording is cut there.
constexpr double kPause_s = 0.3;
/// A service that is killed is forgotten after its lease; drives that lost it come to rest. Drives
/// that ended by themselves are gone as long.
constexpr double kAfterDeath_s = 2.5;
constexpr double kFlightWritten_s = 3;  // half a second of record behind the fault, then the disk
/// Nothing moves for this long although nobody holds the machine: something is stuck.
constexpr double kStuck_s = 60;

[[nodiscard]] bool is_moving(State state) {
  return state == State::kApproaching || state == State::kRunning;
}

class Soak {
 public:
  Soak(const SoakOptions& options, const PlantOptions& plant, MachineModel model,
       const std::function<void(const std::string&)>& say)
      : options_(options),
        say_(say),
        model_(std::move(model)),
        tools_(options.tools.empty() ? ToolTable{} : config::load_tools(options.tools)),
        judge_(model_, tools_, folder_.path(), kept_beside(options.report)),
        plant_(plant, folder_.path(), kept_beside(options.report)),
        chaos_(options.seed, options.chaos_every_s, model_.joint_count, model_.most_feed_override),
        participant_({.domain = options.domain, .machine = model_.name}),
        operator_(participant_, "soak"),
        feedback_reader_(participant_),
        health_(participant_, report_),
        bridge_ns_(model_.bridge_cycles * model_.cycle_ns),
        host_(bridge_ns_),
        faults_(static_cast<double>(bridge_ns_) * 1e-9),
        credit_(model_.cycle_ns, HostWatch::nap_ns(bridge_ns_)) {
    report_.machine = model_.name;
    report_.host = probe::host_text();
    report_.seed = options.seed;
    report_.asked_s = options.for_s;
    report_.allowed = load_growth_budgets(!options.trace.empty());
    report_.service_file = options.service;
    report_.cpu = plant.realtime.cpu;
    report_.host_nap_ns = HostWatch::nap_ns(bridge_ns_);
  }

  SoakReport run(const std::atomic<bool>& is_stopping) {
    start_service();
    start_drives();
    if (options_.chaos_every_s > 0) next_ = chaos_.next();
    tell();
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
    newest_.reset();
    faults_.lose_service();
    state_ = State::kOff;
    moved_s_ = now_s();
  }

  /// New drives; those that ended by themselves stay away for a while first.
  void start_drives() {
    if (now_s() < drives_at_s_) return;
    injected_.reset();
    if (options_.chaos_every_s > 0) injected_ = chaos_.next_of_drives();
    plant_.start_drives(injected_, injected_ ? drive_spec(model_, injected_->drive).name : "");
    faults_.begin_drives(injected_);
    feedback_ = {};
    ++report_.drive_starts;
    asked_in_vain_ = 0;
  }

  /// Starts again what died or was killed.
  void keep_alive() {
    if (plant_.awaits_flight() && now_s() >= flight_at_s_) plant_.keep_flight();
    if (plant_.service() == nullptr) {
      if (now_s() >= service_at_s_) start_service();
    } else if (const auto code = plant_.service()->wait_for_exit(milliseconds(0))) {
      report_.violate("the service ended by itself with code " + std::to_string(*code), "soak");
      plant_.kill_service();
      service_at_s_ = now_s() + kAfterDeath_s;
    }
    if (plant_.drives() == nullptr) {
      start_drives();
    } else if (const auto code = plant_.drives()->wait_for_exit(milliseconds(0))) {
      report_.violate("the drives ended by themselves with code " + std::to_string(*code),
                      keep_evidence());
      plant_.stop_drives();
      faults_.lose_drives();
      drives_at_s_ = now_s() + kAfterDeath_s;
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
    write_sample_program(model_, options_.seed * 1'000'000 + report_.programs, file);
    return file.string();
  }

  void start_program() {
    const std::string program = next_program();
    ++report_.programs;
    judge_.announce(program, options_.programs.empty(), stream::steady_ns());
    plant_.start_station(program);
  }

  void see(const dds::Status& status) {
    newest_ = status;
    count(status);
    constexpr std::int64_t kMemory_ns = FaultJudge::kStallsOf_ns + FaultJudge::kLongestStop_ns;
    const Witness witness{host_.stalls_since(status.time_ns - kMemory_ns), host_.is_watching(),
                          misses_setpoints()};
    if (const auto cause = faults_.see(status, now_s(), witness)) judge_fault(*cause, status);
    if (status.state != state_) asked_in_vain_ = 0;
    if (status.state != state_ || is_moving(status.state)) moved_s_ = now_s();
    state_ = status.state;
    if (now_s() - moved_s_ < kStuck_s) return;
    report_.violate("nothing moved for a minute in state " +
                        std::to_string(static_cast<int>(status.state)) + ": " + status.message,
                    "soak");
    moved_s_ = now_s();
    break_off();
  }

  void count(const dds::Status& status) {
    const std::uint64_t lost = report_.periods_lost, overruns = report_.overruns;
    counts_.add(status, report_);
    const Histogram late = host_.lateness(report_.cpu), lately = late.since(bare_);
    bare_ = late;
    credit_.add(now_s(), lately);
    report_.periods_lost_to_host += credit_.explain(now_s(), report_.periods_lost - lost);
    report_.overruns_by_host +=
        excuse_.explain(now_s(), report_.overruns - overruns, has_stall_of_late());
    health_.take_bare(now_s(), lately);
    health_.take_cutting(now_s(), is_moving(status.state));
  }

  [[nodiscard]] bool has_stall_of_late() const {
    constexpr auto kNear_ns = static_cast<std::int64_t>(1e9 * OverrunExcuse::kNear_s);
    return std::ranges::any_of(
        host_.stalls_since(stream::steady_ns() - kNear_ns),
        [](const Stall& one) { return one.length_ns >= HostWatch::kStall_ns; });
  }

  /// Whether a drive has stopped because setpoints stayed away.
  [[nodiscard]] bool misses_setpoints() {
    while (feedback_reader_.take(feedback_)) continue;
    return std::ranges::find(feedback_.error, drives::kErrorSetpointsStopped) !=
           feedback_.error.end();
  }

  /// What the drives suffer of is over with their process.
  void judge_fault(FaultJudge::Cause cause, const dds::Status& status) {
    ++report_.alarms;
    is_drive_sick_ = true;
    if (cause == FaultJudge::Cause::kInjected) {
      ++report_.mishaps[static_cast<std::size_t>(injected_->mishap)];
    } else if (cause == FaultJudge::Cause::kHost) {
      ++report_.host_faults;
      say_("a Fault of the host (" + keep_evidence() + "): " + faults_.describe());
    } else if (cause != FaultJudge::Cause::kOwnDoing) {
      const bool is_unwatched = cause == FaultJudge::Cause::kUnwatched;
      report_.violate(std::string(is_unwatched ? "a Fault that may be of the host, not watched: "
                                               : "a Fault that nothing provoked: ") +
                          faults_.describe() + "; " + status.message,
                      keep_evidence());
    }
  }

  [[nodiscard]] std::string keep_evidence() {
    flight_at_s_ = now_s() + kFlightWritten_s;
    return plant_.keep_logs();
  }

  /// From anywhere back to a machine that can be switched on.
  void break_off() {
    lose_station();
    ask(Verb::kAbort);
    start_drives();
  }

  void operate(const dds::Status& status) {
    const double now = now_s();
    if (now < ask_again_s_) return;
    switch (status.state) {
      case State::kOff:
        lead_on(status.drives_fault_mask != 0 ? Verb::kReset : Verb::kEnable);
        break;
      case State::kFault:
        if (!faults_.is_judged()) break;
        if (std::exchange(is_drive_sick_, false)) start_drives();
        lead_on(Verb::kReset);
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

  /// Asks, and not again at once; whether it was accepted.
  bool ask(Verb verb, double value = 0) {
    const auto reply = operator_.ask(verb, value, kAnswer);
    ask_again_s_ = now_s() + 0.2;
    report_.asks_unanswered += reply ? 0 : 1;
    report_.asks_refused += reply && !reply->is_accepted ? 1 : 0;
    return reply && reply->is_accepted;
  }

  /// Asks for the way out of Off or Fault. Drives may have fallen ill while nobody could stop in
  /// Fault for it, and a reset, accepted or not, does not mend them: there are new ones then.
  void lead_on(Verb verb) {
    ask(verb);
    if (++asked_in_vain_ >= kMostInVain) start_drives();
  }

  void mishaps() {
    const double now = now_s();
    if (continue_s_ > 0 && now >= continue_s_ && plant_.station() != nullptr) {
      plant_.station()->send_signal(SIGCONT);
      continue_s_ = 0;
    }
    if (!next_ || now < next_->at_s || state_ != State::kRunning) return;
    if (happen(*next_)) ++report_.mishaps[static_cast<std::size_t>(next_->mishap)];
    do {
      next_ = chaos_.next();
    } while (next_->at_s < now);
  }

  /// Lets it happen; false where it was refused or there was nobody for it to happen to.
  bool happen(const Planned& mishap) {
    switch (mishap.mishap) {
      case Mishap::kHold:
        resume_s_ = now_s() + mishap.value;
        return ask(Verb::kHold);
      case Mishap::kOverride:
        judge_.announce_override(mishap.value, stream::steady_ns());
        return ask(Verb::kFeedOverride, mishap.value);
      case Mishap::kAbort:
        return ask(Verb::kAbort);
      case Mishap::kStationStops:
        if (plant_.station() == nullptr) return false;
        plant_.station()->send_signal(SIGSTOP);
        continue_s_ = now_s() + mishap.value;
        return true;
      case Mishap::kStationDies:
        if (plant_.station() == nullptr) return false;
        lose_station();
        return true;
      case Mishap::kServiceDies:
        plant_.kill_service();
        lose_station();
        service_at_s_ = now_s() + kAfterDeath_s;
        state_ = State::kOff;
        return true;
      default:
        return false;  // those of the drives happen there
    }
  }

  void lose_station() {
    if (plant_.station() != nullptr) ++report_.aborted;
    plant_.kill_station();
    ended_s_ = now_s();
    continue_s_ = 0;
  }

  void watch() {
    const double now = now_s();
    if (now - healthy_s_ >= kHealthEvery_s) {
      healthy_s_ = now;
      look(now);
    }
    if (now - told_s_ < kReportEvery_s) return;
    told_s_ = now;
    tell();
  }

  void look(double now_s) {
    if (plant_.service() == nullptr) return;
    health_.look(plant_.service()->id(), now_s, newest_ ? &*newest_ : nullptr);
  }

  void tell() {
    if (!report_.is_over) report_.elapsed_s = now_s();
    if (!options_.trace.empty()) {
      report_.traces = probe::examine_traces(options_.trace).front().found;
    }
    report_.is_host_watched = host_.is_watching();
    report_.host_stalls = host_.stalls();
    report_.host_longest_s = host_.longest_s();
    judge_.collect(report_);
    if (options_.report.empty()) return;
    if (!text::write_whole(options_.report, to_json(report_)) ||
        !text::write_whole(text_beside(options_.report), to_text(report_))) {
      say_("the report " + options_.report.string() + " cannot be written");
    }
  }

  void end() {
    report_.is_interrupted = now_s() < options_.for_s;
    plant_.kill_station();
    look(now_s());
    tell();  // what follows may take as long as a stop, and somebody may lose patience
    if (!plant_.end_service()) report_.violate("the service did not end well", "soak");
    if (plant_.awaits_flight()) plant_.keep_flight();
    plant_.stop_drives();
    judge_.finish();
    report_.is_over = true;
    tell();
  }

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
  dds::Reader<dds::DriveFeedback> feedback_reader_;
  dds::DriveFeedback feedback_;  ///< the newest
  HealthWatch health_;
  std::int64_t bridge_ns_;  ///< what drives bridge
  HostWatch host_;
  FaultJudge faults_;
  HostCredit credit_;
  OverrunExcuse excuse_;
  Histogram bare_;                     ///< lateness of the witness, as far as it is taken
  std::optional<dds::Status> newest_;  ///< of this life
  std::optional<Planned> next_, injected_;
  StatusCounts counts_;
  State state_ = State::kOff;
  bool is_drive_sick_ = false;
  int asked_in_vain_ = 0;
  const std::int64_t begin_ns_ = stream::steady_ns();
  double moved_s_ = 0, ended_s_ = 0, ask_again_s_ = 0, resume_s_ = 0, continue_s_ = 0;
  double service_at_s_ = 0, drives_at_s_ = 0, flight_at_s_ = 0, healthy_s_ = 0, told_s_ = 0;
};

/// A service that enforces real time would end at once, again and again.
void refuse_without_rights(const config::RealtimeConfig& realtime) {
  if (realtime.mode != config::RealtimeMode::kEnforce) return;
  const auto missing = probe::missing_rights(probe::try_rights(), realtime);
  if (missing.empty()) return;
  std::string text = "the service file enforces real time, and here is no right to ";
  for (const std::string& one : missing) text += (&one == &missing.front() ? "" : ", ") + one;
  throw std::runtime_error(text + "; see meridian doctor, or set mode = \"best_effort\"");
}

}  // namespace

SoakReport run_soak(const SoakOptions& options, const std::atomic<bool>& is_stopping,
                    const std::function<void(const std::string&)>& say) {
  config::ServiceConfig service;
  service.realtime.mode = config::RealtimeMode::kBestEffort;
  if (!options.service.empty()) service = config::load_service(options.service);
  MachineModel model = config::load_machine(options.machine);
  model.bridge_cycles = config::find_bridge_cycles(service, model);
  service.realtime.cpu = probe::cycle_cpu(service.realtime);
  refuse_without_rights(service.realtime);
  process::stay_off_cpu(service.realtime.cpu);  // our DDS threads inherit that
  const PlantOptions plant{.machine = options.machine,
                           .tools = options.tools,
                           .domain = options.domain,
                           .realtime = service.realtime,
                           .bridge_cycles = service.bridge_cycles,
                           .trace = options.trace};
  return Soak(options, plant, std::move(model), say).run(is_stopping);
}

}  // namespace meridian::soak
