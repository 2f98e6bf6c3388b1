// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/serve.hpp"

#include <pthread.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>
#include <memory>

#include "interpolator_version.hpp"
#include "service/daemon/notify.hpp"
#include "service/daemon/service.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/sections/service_file.hpp"
#include "service/recording/telemetry/flight_recorder.hpp"
#include "service/recording/telemetry/log.hpp"
#include "service/text/whole_file.hpp"
#include "service/transport/cyclone/dds_log.hpp"

namespace meridian::interpolator {
namespace {

/// Threads that libraries start get small stacks too: locked memory is resident.
void make_stacks_small() {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStack_bytes);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

[[nodiscard]] sigset_t block_end_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signal(SIGPIPE, SIG_IGN);
  return signals;
}

/// The folder for what outlives the service: as asked for, or the one that systemd made.
[[nodiscard]] std::filesystem::path state_folder(const std::string& option,
                                                 const config::ServiceConfig& service) {
  if (!option.empty()) return option;
  if (!service.state_directory.empty()) return service.state_directory;
  const char* const named = std::getenv("STATE_DIRECTORY");
  const std::string folders = named != nullptr ? named : "";
  return folders.substr(0, folders.find(':'));
}

[[nodiscard]] ServiceParts load(const ServeOptions& options) {
  ServiceParts parts;
  if (!options.service.empty()) parts.service = config::load_service(options.service);
  if (options.is_best_effort) parts.service.realtime.mode = config::RealtimeMode::kBestEffort;
  if (options.is_open_network) parts.service.open_network = true;
  const std::string machine =
      !options.machine.empty() ? options.machine : parts.service.machine.string();
  if (machine.empty()) throw StartError("no machine: give --machine FILE or name it in --service");
  parts.model = config::load_machine(machine);
  parts.homing = config::load_homing(machine, parts.model.joint_count);
  parts.monitoring = config::load_monitoring(machine, parts.model);
  parts.machine_file = text::read_whole(machine).value_or("");
  if (!options.frame.empty()) {
    config::place_workpiece(parts.model, config::parse_frame(options.frame));
  }
  if (!parts.service.tools.empty()) {
    parts.tools = config::load_tools(parts.service.tools);
    parts.tool_file = text::read_whole(parts.service.tools).value_or("");
  }
  parts.model.bridge_cycles = config::find_bridge_cycles(parts.service, parts.model);
  parts.domain =
      static_cast<std::uint32_t>(options.domain >= 0 ? options.domain : parts.service.dds_domain);
  if (!options.trace.empty()) parts.service.trace.folder = options.trace;
  parts.recording =
      !options.recording.empty() ? options.recording : parts.service.recording.string();
  parts.state_folder = state_folder(options.state, parts.service);
  config::FlightConfig& flight = parts.service.flight;
  if (!options.faults.empty()) flight.folder = options.faults;
  if (flight.folder.empty()) {
    flight.folder = telemetry::default_fault_folder(parts.state_folder, parts.model.name);
  }
  return parts;
}

void serve_until_ended(const ServiceParts& parts, const sigset_t& signals) {
  const Realtime realtime(parts.service.realtime);
  const auto log = telemetry::make_log(parts.service.log);
  log->info("meridiand {} for machine {}, cycle {} us, domain {}, {}", kVersion, parts.model.name,
            parts.model.cycle_ns / 1000, parts.domain,
            realtime.mode() == dds::RealtimeMode::kEnforced
                ? "real time enforced on CPU " + std::to_string(realtime.cpu())
                : "real time best effort");
  for (const std::string& remark : realtime.remarks()) log->warn("{}", remark);
  const auto service = std::make_unique<Service>(parts, realtime, log);
  service->start();
  realtime.rise_to(parts.service.realtime.io_priority);  // it takes and writes samples too
  log->info("answering in Off");
  ServiceManager manager;
  manager.is_ready("serving machine " + parts.model.name);

  constexpr timespec kLeasePeriod{.tv_sec = 0, .tv_nsec = 100'000'000};
  int signal = 0;
  std::uint32_t looks = 0;
  while ((signal = sigtimedwait(&signals, nullptr, &kLeasePeriod)) < 0) {
    service->keep_lease();
    service->report_set_up();
    service->report_sources();
    if (++looks % 10 == 0) service->report_stalled_readers();
    dds::report_left_out();
    manager.beat(service->heartbeat(), std::chrono::steady_clock::now());
  }
  manager.is_stopping();
  log->info("{}: stopping", signal == SIGINT ? "interrupted" : "asked to end");
  constexpr auto kPatience = std::chrono::seconds(10);
  if (!service->switch_off(kPatience)) {
    log->error("the machine is not Off after {} s; drives stop by their own watchdog",
               kPatience.count());
  }
  service->stop();
  log->info("ended");
}

}  // namespace

void serve(const ServeOptions& options) {
  make_stacks_small();
  const sigset_t signals = block_end_signals();
  serve_until_ended(load(options), signals);
}

void end_log() { telemetry::end_log(); }

}  // namespace meridian::interpolator
