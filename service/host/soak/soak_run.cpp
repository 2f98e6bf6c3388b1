// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/soak_run.hpp"

#include <chrono>
#include <utility>

#include "service/host/probe/doctor/doctor.hpp"
#include "service/host/probe/figures.hpp"
#include "service/host/soak/report/report_files.hpp"
#include "service/host/soak/sample_program.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::soak {
namespace {

using std::chrono::milliseconds;
constexpr milliseconds kTick{20};
constexpr double kReportEvery_s = 2, kHealthEvery_s = 1;
constexpr double kFlightWritten_s = 3;  // half a second of record after the fault, then the disk
/// Nothing moves for this long although nobody holds the machine: something is stuck.
constexpr double kStuck_s = 60;

}  // namespace

SoakRun::SoakRun(const SoakOptions& options, const PlantOptions& plant, MachineModel model,
                 const std::function<void(const std::string&)>& say)
    : options_(options),
      say_(say),
      model_(std::move(model)),
      tools_(options.tools.empty() ? ToolTable{} : config::load_tools(options.tools)),
      check_(model_, tools_, folder_.path(), kept_beside(options.report)),
      plant_(plant, folder_.path(), kept_beside(options.report)),
      chaos_(options.seed, options.chaos_every_s, model_.joint_count, model_.max_feed_override),
      participant_({.domain = options.domain, .machine = model_.name}),
      operator_(participant_, "soak"),
      watch_(participant_, model_, report_) {
  report_.machine = model_.name;
  report_.host = probe::host_text();
  report_.seed = options.seed;
  report_.asked_s = options.for_s;
  report_.allowed = load_growth_budgets(!options.trace.empty());
  report_.service_file = options.service;
  report_.cpu = plant.realtime.cpu;
}

SoakReport SoakRun::run(const std::atomic<bool>& is_stopping) {
  start_service();
  start_drives();
  if (options_.chaos_every_s > 0) next_ = chaos_.next();
  report();
  while (now_s() < options_.for_s && !is_stopping.load()) {
    const bool is_news = operator_.wait_for_status(kTick);
    keep_alive();
    if (is_news) {
      see(*operator_.status());
      operate(*operator_.status());
    }
    mishaps();
    look_and_report();
  }
  end();
  return report_;
}

void SoakRun::start_service() {
  plant_.start_service(check_.pipe());
  ++report_.service_starts;
  watch_.begin_life(now_s());
  state_ = State::kOff;
  moved_s_ = now_s();
}

void SoakRun::start_drives() {
  if (now_s() < drives_at_s_) return;
  injected_.reset();
  if (options_.chaos_every_s > 0) injected_ = chaos_.next_of_drives();
  plant_.start_drives(injected_, injected_ ? drive_spec(model_, injected_->drive).name : "");
  watch_.faults().begin_drives(injected_);
  watch_.forget_feedback();
  ++report_.drive_starts;
  asked_in_vain_ = 0;
}

void SoakRun::keep_alive() {
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
    watch_.faults().lose_drives();
    drives_at_s_ = now_s() + kAfterDeath_s;
  }
  if (plant_.station() != nullptr) {
    const auto code = plant_.station()->wait_for_exit(milliseconds(0));
    if (code) end_program(*code);
  }
}

void SoakRun::end_program(int code) {
  constexpr int kInputRefused = 3;
  ++(code == 0 ? report_.finished : code == kInputRefused ? report_.refused : report_.aborted);
  plant_.kill_station();
  ended_s_ = now_s();
}

std::string SoakRun::next_program() {
  if (!options_.programs.empty()) {
    return options_.programs[report_.programs % options_.programs.size()];
  }
  const auto file = folder_.path() / ("program" + std::to_string(report_.programs) + ".cl");
  write_sample_program(model_, options_.seed * 1'000'000 + report_.programs, file);
  return file.string();
}

void SoakRun::start_program() {
  const std::string program = next_program();
  ++report_.programs;
  check_.announce(program, options_.programs.empty(), stream::steady_ns());
  plant_.start_station(program);
}

void SoakRun::see(const dds::Status& status) {
  if (const auto cause = watch_.see(status, now_s())) check_fault(*cause, status);
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

void SoakRun::check_fault(FaultCheck::Cause cause, const dds::Status& status) {
  ++report_.alarms;
  is_drive_sick_ = true;
  if (cause == FaultCheck::Cause::kInjected) {
    ++report_.mishaps[static_cast<std::size_t>(injected_->mishap)];
  } else if (cause == FaultCheck::Cause::kHost) {
    ++report_.host_faults;
    say_("a Fault of the host (" + keep_evidence() + "): " + watch_.faults().describe());
  } else if (cause != FaultCheck::Cause::kOwnDoing) {
    const bool is_unwatched = cause == FaultCheck::Cause::kUnwatched;
    report_.violate(std::string(is_unwatched ? "a Fault that may be of the host, not watched: "
                                             : "a Fault that nothing provoked: ") +
                        watch_.faults().describe() + "; " + status.message,
                    keep_evidence());
  }
}

std::string SoakRun::keep_evidence() {
  flight_at_s_ = now_s() + kFlightWritten_s;
  return plant_.keep_logs();
}

void SoakRun::lose_station() {
  if (plant_.station() != nullptr) ++report_.aborted;
  plant_.kill_station();
  ended_s_ = now_s();
  continue_s_ = 0;
}

void SoakRun::look_and_report() {
  const double now = now_s();
  if (now - healthy_s_ >= kHealthEvery_s) {
    healthy_s_ = now;
    look();
  }
  if (now - reported_s_ < kReportEvery_s) return;
  reported_s_ = now;
  report();
}

void SoakRun::look() {
  if (plant_.service() != nullptr) watch_.look(plant_.service()->id(), now_s());
}

void SoakRun::report() {
  if (!report_.is_over) report_.elapsed_s = now_s();
  if (!options_.trace.empty()) {
    report_.traces = probe::examine_traces(options_.trace).front().found;
  }
  watch_.report_host();
  check_.collect(report_);
  if (options_.report.empty()) return;
  if (!text::write_whole(options_.report, to_json(report_)) ||
      !text::write_whole(text_beside(options_.report), to_text(report_))) {
    say_("the report " + options_.report.string() + " cannot be written");
  }
}

void SoakRun::end() {
  report_.is_interrupted = now_s() < options_.for_s;
  plant_.kill_station();
  look();
  report();  // what follows may take as long as a stop, and somebody may lose patience
  if (!plant_.end_service()) report_.violate("the service did not end well", "soak");
  if (plant_.awaits_flight()) plant_.keep_flight();
  plant_.stop_drives();
  check_.finish();
  report_.is_over = true;
  report();
}

}  // namespace meridian::soak
