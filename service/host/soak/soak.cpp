// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/soak.hpp"

#include <stdexcept>
#include <utility>

#include "service/host/probe/doctor/doctor.hpp"
#include "service/host/probe/probe_report.hpp"
#include "service/host/probe/run/measure.hpp"
#include "service/host/process/processors.hpp"
#include "service/host/soak/soak_run.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/sections/service_file.hpp"

namespace meridian::soak {
namespace {

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
  return SoakRun(options, plant, std::move(model), say).run(is_stopping);
}

}  // namespace meridian::soak
