// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/service.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <thread>
#include <utility>

#include "interpolator_version.hpp"
#include "service/daemon/machine_info.hpp"
#include "service/daemon/ports/monotonic.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/recording/telemetry/file_name.hpp"
#include "service/recording/telemetry/log.hpp"
#include "service/text/checksum.hpp"

namespace meridian::interpolator {
namespace {

[[nodiscard]] std::uint64_t draw_id() {
  std::random_device device;
  const std::uint64_t id = (std::uint64_t{device()} << 32U) | device();
  return id != 0 ? id : 1;
}

[[nodiscard]] std::string partition_of(const ServiceParts& parts) {
  const std::string& chosen = parts.service.dds_partition;
  return chosen.empty() ? parts.model.name : chosen;
}

[[nodiscard]] CycleOptions cycle_options(const config::ServiceConfig& service,
                                         const config::HomingConfig& homing) {
  CycleOptions options;
  options.enable_timeout_s = service.enable_timeout_s;
  options.action_timeout_s = service.action_timeout_s;
  options.feedback_timeout_s = service.feedback_timeout_s;
  options.homing_timeout_s = homing.timeout_s;
  options.homing_turns = homing.turns;
  options.stops_at_optional = service.optional_stop;
  return options;
}

/// What programs are cut with as long as this service lasts; the set-up changes.
[[nodiscard]] telemetry::CutSetup cut_setup(const ServiceParts& parts) {
  telemetry::CutSetup setup;
  setup.machine = text::checksum_of(parts.machine_file);
  return setup;
}

[[nodiscard]] telemetry::AuditOptions audit_options(const ServiceParts& parts) {
  const config::AuditConfig& wish = parts.service.audit;
  telemetry::AuditOptions options;
  options.file = wish.file;
  if (options.file.empty() && !parts.state_folder.empty()) {
    options.file = parts.state_folder / (telemetry::plain_name(parts.model.name) + ".audit.log");
  }
  options.file_bytes = static_cast<std::uint64_t>(wish.file_mb) << 20U;
  options.files = wish.files;
  return options;
}

/// A line about the service itself.
[[nodiscard]] telemetry::AuditEntry audit_entry(telemetry::AuditKind kind) {
  std::array<char, 64> host{};
  (void)::gethostname(host.data(), host.size() - 1);
  telemetry::AuditEntry entry;
  entry.identity = "process " + std::to_string(::getpid()) + " on host " + host.data();
  entry.text = std::string("meridiand ") + kVersion;
  entry.kind = kind;
  return entry;
}

StartError unreadable(const std::filesystem::path& set_up, const std::string& why) {
  return StartError("the set-up " + set_up.string() + " " + why +
                    "; put it right, or remove it and set work frames, tools and soft limits anew");
}

StartError outside_travel(const std::filesystem::path& set_up, const std::string& limits) {
  return StartError("the set-up " + set_up.string() + " holds " + limits +
                    ", not inside the travel of the machine file; start with the machine file of "
                    "before and say meridian ctl limits clear and open, or remove the set-up and "
                    "set work frames, tools and soft limits anew");
}

StartError served_already(const dds::MachineInfo& holder) {
  return StartError("machine '" + holder.name + "' is served already by meridiand on host " +
                    holder.host + ", process " + std::to_string(holder.pid) +
                    "; end that one first, or choose another --domain");
}

}  // namespace

Service::Service(const ServiceParts& parts, const Realtime& realtime,
                 std::shared_ptr<spdlog::logger> log)
    : parts_(parts),
      realtime_(realtime),
      log_(std::move(log)),
      service_id_(draw_id()),
      tool_lengths_(stream::lengths_of(parts_.tools)),
      rings_(parts_.service.trace.folder.empty() ? nullptr : std::make_unique<trace::Rings>()),
      ports_(rings_.get()),
      status_clock_(static_cast<std::int64_t>(1e9 / parts_.service.status_rate_hz)),
      participant_({.domain = parts_.domain,
                    .machine = partition_of(parts_),
                    .transport = realtime.has_priorities() ? dds::Transport::kLoopbackRealtime
                                                           : dds::Transport::kLoopback,
                    .open_network = parts_.service.open_network ? dds::OpenNetwork::kAllowed
                                                                : dds::OpenNetwork::kRefused}),
      lease_(participant_, machine_info(parts_, service_id_),
             [this](const std::string& text) { log_->warn("{}", text); }),
      set_up_(parts_.state_folder, parts_.model.name),
      audit_(audit_options(parts_)),
      publisher_(participant_, service_id_, ports_),
      feedback_(participant_, parts_.model, service_id_, ports_),
      intake_(participant_, parts_.model, tool_lengths_, parts_.service, service_id_, ports_),
      planner_(parts_.model, parts_.tools, ports_),
      cycle_(parts_.model, cycle_options(parts_.service, parts_.homing), parts_.monitoring, ports_),
      supervisor_(participant_, parts_.model, parts_.tools, parts_.service, service_id_,
                  status_clock_, ports_, &audit_),
      recorder_(parts_.recording, parts_.model),
      journal_(parts_.state_folder, parts_.model.name),
      flight_(parts_.service.flight, parts_.model, log_),
      telemetry_(participant_, parts_.model, parts_.service, service_id_, realtime.mode(), intake_,
                 status_clock_, recorder_, journal_, flight_, log_, ports_),
      tracer_(make_tracer()),
      stalled_readers_(participant_) {
  ports_.spindle_tool_mm = parts_.model.tool_length_mm;
  ports_.enabling.set_up(parts_.service.deadman,
                         static_cast<std::int64_t>(1e9 * parts_.service.deadman_timeout_s));
  supervisor_.watch_readers(stalled_readers_);
  telemetry_.watch_readers(stalled_readers_);
  stalled_readers_.watch(intake_.writer(), "cl_credit");
  supervisor_.on_session_event([this](bool has_action_peer) {
    intake_.set_action_peer(has_action_peer);
    intake_.wake();
  });
  telemetry_.audit_into(audit_);
  take_lease();
  report_security();
  report_last_program();
}

Service::~Service() { stop(); }

std::unique_ptr<trace::Tracer> Service::make_tracer() {
  if (!rings_) return nullptr;
  const config::TraceConfig& wish = parts_.service.trace;
  const auto ns = [](double value, double unit_ns) { return std::llround(value * unit_ns); };
  const auto or_half_a_cycle = [&](double us) {
    return us > 0 ? ns(us, 1e3) : parts_.model.cycle_ns / 2;
  };
  trace::TraceOptions options;
  options.folder = wish.folder;
  options.limits = {or_half_a_cycle(wish.late_us), or_half_a_cycle(wish.computation_us)};
  options.before_ns = ns(wish.before_ms, 1e6);
  options.after_ns = ns(wish.after_ms, 1e6);
  options.every_ns = ns(wish.every_s, 1e9);
  options.max_files = wish.files;
  const dds::MachineInfo info = machine_info(parts_, service_id_);
  return trace::make_tracer(
      options, trace::TraceOrigin{info.name, info.service_version, info.host}, *rings_,
      [this](const std::string& text) { log_->warn("{}", text); },
      [this](const std::string& text) { log_->error("{}", text); });
}

void Service::take_lease() {
  // Others announce themselves every 200 ms; a killed service is forgotten after its lease of 1 s.
  constexpr auto kStartWindow = std::chrono::milliseconds(500);
  constexpr auto kPatience = std::chrono::milliseconds(1800);
  const auto holder = lease_.find_holder(kStartWindow, kPatience);
  if (holder) throw served_already(*holder);
  read_set_up();
  lease_.hold();
}

/// Behind the lease, for another service may have changed it until then. A machine whose set-up
/// cannot be read does not start with another one than its operator has set.
void Service::read_set_up() {
  const auto set_up = set_up_.read();
  if (!set_up) throw unreadable(set_up_.path(), set_up.error());
  ToolTable tools = parts_.tools;
  if (set_up->tools) {
    try {
      tools = config::parse_tools(*set_up->tools, "its tool table");
    } catch (const config::ConfigError& error) {
      throw unreadable(set_up_.path(), error.what());
    }
  }
  if (set_up->limits.find_fault(parts_.model) != LimitsFault::kNone) {
    throw outside_travel(set_up_.path(), telemetry::limits_text(set_up->limits, parts_.model));
  }
  const SetUpInForce in_force = in_force_by(*set_up, parts_.model, tools, 0);
  intake_.set_up(in_force, tools);
  planner_.set_up(in_force, tools);
  cycle_.set_up(in_force);
  telemetry_.set_up(in_force, tools);
  supervisor_.keep_set_up(set_up_, *set_up, tools, in_force);
  lease_.set_up(set_up->frames, in_force, reported_tools(*set_up), false);
  if (in_force.number != 0) {
    log_->info("work frame {} of the set-up is in force, in the place of the machine file's",
               in_force.number);
  }
  if (!set_up->limits.empty()) {
    log_->info(
        "{} in force, as they were set; meridian ctl limits clear gives the whole travel again, "
        "open takes the boxes away",
        telemetry::limits_text(set_up->limits, parts_.model));
  }
  if (set_up->tools) {
    log_->info(
        "the tool table of the set-up is in force, in the place of the service's own file; "
        "meridian ctl tool load without a file takes that again");
  }
}

std::string Service::reported_tools(const telemetry::SetUp& set_up) const {
  const std::string& text = set_up.tools ? *set_up.tools : parts_.tool_file;
  return text.size() <= dds::kToolFileBytes ? text : "";
}

void Service::report_set_up() {
  if (!supervisor_.has_set_up_to_report()) return;
  const telemetry::SetUp& set_up = supervisor_.set_up();
  lease_.set_up(set_up.frames, supervisor_.in_force(), reported_tools(set_up), true);
  supervisor_.set_up_reported();
}

void Service::report_security() {
  if (participant_.is_secured()) {
    log_->info("secured: only identities of this machine's authority take part, each in its role");
  } else if (participant_.is_open_network()) {
    log_->warn(
        "OPEN NETWORK: whoever reaches it may command this machine, as open_network allows "
        "(docs/security.md)");
  } else {
    log_->info("open: whoever reaches DDS domain {} may command this machine (docs/security.md)",
               parts_.domain);
  }
}

/// Behind the lease: the journal of a machine is its service's alone.
void Service::report_last_program() {
  if (!journal_.is_kept()) {
    log_->info("no journal of the last executed block is kept: no state_directory is named");
    return;
  }
  telemetry::CutSetup setup = cut_setup(parts_);
  setup.frame = supervisor_.in_force().sum;
  setup.tools = supervisor_.in_force().tools;
  if (const auto last = journal_.read()) {
    last_program_.set(*last);
    const std::string words = telemetry::describe(*last);
    log_->info("{}; {}", words, telemetry::describe_more(*last));
    telemetry_.say_first(words);
  }
  telemetry_.go_on_from(last_program_, setup);
  intake_.go_on_with(last_program_, setup);
  if (!journal_.complaint().empty()) {
    log_->warn("{}", journal_.complaint());
    telemetry_.say_first(journal_.complaint());
  }
}

void Service::keep_lease() {
  const std::uint64_t master = feedback_.master();
  // In Fault the drives may be another one's: then they are left to it.
  const bool is_lost = ports_.state == State::kFault && master != 0 && master != service_id_;
  const auto keeper = lease_.find_keeper(ports_.may_leave || is_lost, master);
  if (keeper) throw served_already(*keeper);
}

void Service::report_sources() {
  feedback_.report_sources([this](telemetry::Weight weight, const std::string& text) {
    log_->log(telemetry::level_of(weight), "{}", text);
  });
}

void Service::report_stalled_readers() {
  std::string stalled = stalled_readers_.look(monotonic_ns());
  if (stalled == stalled_) return;
  if (stalled.empty()) {
    log_->info("every reader acknowledges again what it is sent");
  } else {
    log_->warn(
        "a reader has not acknowledged for 2 s: {}; what it is sent passes it by, nobody "
        "waits for it",
        stalled);
  }
  stalled_ = std::move(stalled);
  StalledReader shown;
  std::memcpy(shown.name.data(), stalled_.data(), std::min(stalled_.size(), shown.name.size() - 1));
  ports_.stalled_reader.store(shown);
}

void Service::start() {
  const config::RealtimeConfig& plan = realtime_.wish();
  const auto add = [this](const char* name, int priority, bool is_on_realtime_cpu, auto body) {
    threads_.emplace_back(realtime_, ThreadPlan{name, priority, is_on_realtime_cpu},
                          std::move(body));
  };
  recorder_thread_ = Thread(realtime_, {"recorder", 0, false}, [this] { recorder_.run(); });
  journal_thread_ = Thread(realtime_, {"journal", 0, false}, [this] {
    journal_.run([this](const std::string& complaint) { log_->error("{}", complaint); },
                 [this] { set_up_.work(); });
  });
  flight_thread_ = Thread(realtime_, {"flight", 0, false}, [this] { flight_.run(); });
  audit_thread_ = Thread(realtime_, {"audit", 0, false}, [this] {
    audit_.run([this](const std::string& complaint) { log_->error("{}", complaint); });
  });
  audit_.append(audit_entry(telemetry::AuditKind::kStart));
  if (tracer_) add("tracer", 0, false, [this] { tracer_->run(ports_.is_stopping); });
  add("telemetry", plan.io_priority, false, [this] { telemetry_.run(); });
  add("intake", plan.io_priority, false, [this] { intake_.run(); });
  add("planner", plan.planner_priority, false, [this] { planner_.run(); });
  add("commands", plan.commands_priority, false, [this] { supervisor_.run(); });
  add("replies", plan.io_priority, false, [this] { supervisor_.run_replies(); });
  add("drives", plan.commands_priority, false, [this] { supervisor_.run_drives(); });
  add("publisher", plan.publisher_priority, true, [this] { publisher_.run(); });
  add("cycle", plan.cycle_priority, true, [this] { cycle_.run(); });
}

bool Service::switch_off(std::chrono::milliseconds patience) {
  supervisor_.switch_off();
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!supervisor_.has_switched_off() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return supervisor_.has_switched_off();
}

void Service::stop() {
  ports_.is_stopping = true;
  ports_.publisher_wake.notify();
  ports_.planner_wake.notify();
  ports_.reply_wake.notify();
  ports_.drives_wake.notify();
  threads_.clear();
  recorder_.stop();
  recorder_thread_.join();
  journal_.stop();
  journal_thread_.join();
  flight_.stop();
  flight_thread_.join();
  if (!is_stopped_) audit_.append(audit_entry(telemetry::AuditKind::kStop));
  audit_.stop();
  audit_thread_.join();
  const std::string complaint = recorder_.complaint();
  if (!std::exchange(is_stopped_, true) && !complaint.empty()) log_->error("{}", complaint);
}

}  // namespace meridian::interpolator
