// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/service_file.hpp"

#include <algorithm>

#include "service/machine/file/machine_name.hpp"
#include "service/machine/file/section.hpp"

namespace meridian::config {
namespace {

void read_realtime(Section section, RealtimeConfig& realtime) {
  realtime.mode =
      static_cast<RealtimeMode>(section.choice_or("mode", 0, {"enforce", "best_effort"}));
  realtime.cpu = section.integer_or("cpu", realtime.cpu, -1, 1023);
  realtime.cycle_priority = section.integer_or("cycle_priority", realtime.cycle_priority, 1, 98);
  realtime.publisher_priority =
      section.integer_or("publisher_priority", realtime.publisher_priority, 1, 98);
  realtime.commands_priority =
      section.integer_or("commands_priority", realtime.commands_priority, 1, 98);
  realtime.io_priority = section.integer_or("io_priority", realtime.io_priority, 1, 98);
  realtime.planner_priority =
      section.integer_or("planner_priority", realtime.planner_priority, 1, 98);
  realtime.lock_memory = section.truth_or("lock_memory", realtime.lock_memory);
  realtime.hold_dma_latency = section.truth_or("hold_dma_latency", realtime.hold_dma_latency);
  if (realtime.publisher_priority >= realtime.cycle_priority) {
    section.refuse(section.has("publisher_priority") ? "publisher_priority" : "cycle_priority",
                   "publisher_priority below cycle_priority",
                   "they share a processor: the cycle must be able to interrupt the publisher");
  }
  section.finish();
}

void read_dds(Section section, ServiceConfig& config) {
  config.dds_domain = section.integer_or("domain", config.dds_domain, 0, 230);
  config.dds_partition = section.text_or("partition", "");
  config.open_network = section.truth_or("open_network", config.open_network);
  if (!config.dds_partition.empty() && !is_machine_name(config.dds_partition)) {
    section.refuse("partition", kMachineNameWords, "name the partition otherwise");
  }
  section.finish();
}

void read_flight(Section section, const std::filesystem::path& folder, FlightConfig& flight) {
  const std::string name = section.text_or("folder", "");
  if (!name.empty()) flight.folder = (folder / name).lexically_normal();
  flight.seconds = section.number_or("seconds", flight.seconds, {1, 60});
  flight.faults = section.integer_or("faults", flight.faults, 1, 1000);
  section.finish();
}

void read_audit(Section section, const std::filesystem::path& folder, AuditConfig& audit) {
  const std::string name = section.text_or("file", "");
  if (!name.empty()) audit.file = (folder / name).lexically_normal();
  audit.file_mb = section.integer_or("file_mb", audit.file_mb, 1, 10'000);
  audit.files = section.integer_or("files", audit.files, 1, 1000);
  section.finish();
}

void read_trace(Section section, const std::filesystem::path& folder, TraceConfig& trace) {
  const std::string name = section.text_or("folder", "");
  if (!name.empty()) trace.folder = (folder / name).lexically_normal();
  trace.late_us = section.number_or("late_us", trace.late_us, {0, 1e7});
  trace.computation_us = section.number_or("computation_us", trace.computation_us, {0, 1e7});
  trace.before_ms = section.number_or("before_ms", trace.before_ms, {0, 1000});
  trace.after_ms = section.number_or("after_ms", trace.after_ms, {0, 1000});
  trace.every_s = section.number_or("every_s", trace.every_s, {0, 1e6});
  trace.files = section.integer_or("files", trace.files, 1, 1000);
  section.finish();
}

void read_service(Section section, const std::filesystem::path& folder, ServiceConfig& config) {
  const auto inside = [&folder](const std::string& path) {
    return path.empty() ? std::filesystem::path() : (folder / path).lexically_normal();
  };
  config.machine = inside(section.text("machine",
                                       "name the machine file, such as "
                                       "\"machines/lai.toml\""));
  config.tools = inside(section.text_or("tools", ""));
  config.recording = inside(section.text_or("recording", ""));
  config.log = inside(section.text_or("log", ""));
  config.state_directory = inside(section.text_or("state_directory", ""));
  config.auxiliary =
      static_cast<AuxiliaryPolicy>(section.choice_or("auxiliary", 0, {"wait", "ignore"}));
  config.optional_stop = section.truth_or("optional_stop", config.optional_stop);
  config.action_timeout_s =
      section.number_or("action_timeout_s", config.action_timeout_s, {0.1, 3600});
  config.enable_timeout_s =
      section.number_or("enable_timeout_s", config.enable_timeout_s, {0.1, 600});
  config.deadman = section.truth_or("deadman", config.deadman);
  config.deadman_timeout_s =
      section.number_or("deadman_timeout_s", config.deadman_timeout_s, {0.05, 2});
  config.feedback_timeout_s =
      section.number_or("feedback_timeout_s", config.feedback_timeout_s, {1e-3, 10});
  config.block_queue = section.integer_or("block_queue", config.block_queue, 5000, 1'000'000);
  if (const int bridge = section.integer_or("bridge_cycles", -1, 0, 1000); bridge >= 0) {
    config.bridge_cycles = bridge;
  }
  config.status_rate_hz = section.number_or("status_rate_hz", config.status_rate_hz, {1, 100});
  section.finish();
}

}  // namespace

ServiceConfig load_service(const std::filesystem::path& path) {
  const toml::table table = parse_file(path);
  Section file(path.string(), table);
  ServiceConfig config;
  read_service(file.section("service"), path.parent_path(), config);
  read_audit(file.section_or("audit_log"), path.parent_path(), config.audit);
  read_flight(file.section_or("flight_recorder"), path.parent_path(), config.flight);
  read_realtime(file.section_or("realtime"), config.realtime);
  read_dds(file.section_or("dds"), config);
  read_trace(file.section_or("trace"), path.parent_path(), config.trace);
  file.finish();
  return config;
}

int find_bridge_cycles(const ServiceConfig& service, const MachineModel& machine) {
  if (service.bridge_cycles) return *service.bridge_cycles;
  if (service.realtime.mode == RealtimeMode::kEnforce) return machine.bridge_cycles;
  constexpr std::int64_t kBestEffortBridge_ns = 50'000'000;
  return std::max(machine.bridge_cycles, static_cast<int>(kBestEffortBridge_ns / machine.cycle_ns));
}

}  // namespace meridian::config
