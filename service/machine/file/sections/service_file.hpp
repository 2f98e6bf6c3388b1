// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/file/config_error.hpp"

namespace meridian::config {

/// How much of the kernel's real time is asked for.
enum class RealtimeMode : std::uint8_t {
  kEnforce,    ///< without FIFO priority and locked memory start-up fails
  kBestEffort  ///< what is missing is done without, and reported
};

/// What happens to auxiliary and tool blocks. Program stops hold until resume with both.
enum class AuxiliaryPolicy : std::uint8_t {
  kWait,   ///< publish the action, rest until it is done; without an action peer the program is
           ///< refused
  kIgnore  ///< pass them over; the status shows it
};

/// Threads of the service, docs/realtime.md. Priorities are FIFO.
struct RealtimeConfig {
  RealtimeMode mode = RealtimeMode::kEnforce;
  int cpu = -1;  ///< of cycle and publisher; -1: the last that the service may use
  int cycle_priority = 80;
  int publisher_priority = 70;
  int commands_priority = 60;
  /// Of intake, telemetry and the main thread: they share locks of DDS with the receive thread.
  int io_priority = 50;
  int planner_priority = 40;
  bool lock_memory = true;
  bool hold_dma_latency = true;
};

/// The flight recorder: what it keeps of a fault, and where (docs/recordings.md).
struct FlightConfig {
  std::filesystem::path folder;  ///< empty: faults/MACHINE in the state directory, else none
  double seconds = 10;
  int faults = 20;  ///< so many stay in the folder, the oldest go
};

/// The audit log: who did what (docs/security.md).
struct AuditConfig {
  std::filesystem::path file;  ///< empty: MACHINE.audit.log in the state directory, else none
  int file_mb = 16;            ///< a longer one is put aside as FILE.1
  int files = 10;              ///< so many are put aside, the oldest goes
};

/// Traces of slow cycles, docs/realtime.md.
struct TraceConfig {
  std::filesystem::path folder;          ///< empty: none
  double late_us = 0;                    ///< wake-up later than this is slow; 0: half a cycle
  double computation_us = 0;             ///< computation longer than this is slow; 0: half a cycle
  double before_ms = 50, after_ms = 20;  ///< what is shown around it
  double every_s = 10;                   ///< from one file to the next at least
  int files = 10;                        ///< at most; the worst stay
};

/// Everything about the service that is not about the machine.
struct ServiceConfig {
  std::filesystem::path machine;          ///< machine file
  std::filesystem::path tools;            ///< tool table; empty: no tools, tool blocks are refused
  std::filesystem::path recording;        ///< recording of record; empty: none
  std::filesystem::path log;              ///< log file; empty: standard error
  std::filesystem::path state_directory;  ///< of the journal; empty: $STATE_DIRECTORY, else none

  AuditConfig audit;
  FlightConfig flight;
  RealtimeConfig realtime;
  TraceConfig trace;

  int dds_domain = 0;
  std::string dds_partition;  ///< empty: the name of the machine

  AuxiliaryPolicy auxiliary = AuxiliaryPolicy::kWait;
  bool optional_stop = false;  ///< optional stops stop
  double action_timeout_s = 60;
  double enable_timeout_s = 5;
  double feedback_timeout_s = 0.1;  ///< older feedback counts as lost
  bool deadman = false;             ///< nothing moves without an enabling heartbeat
  double deadman_timeout_s = 0.3;   ///< a heartbeat that is silent for longer is lost
  bool open_network = false;        ///< starts also where the network is not secured
  int block_queue = 8192;           ///< places; look-ahead and credits

  /// Periods that drives bridge when setpoints are missing; see find_bridge_cycles().
  std::optional<int> bridge_cycles;

  double status_rate_hz = 20;
};

/// Reads a service file (docs/machine-files.md). Paths in it are relative to the folder of the
/// file. Throws ConfigError. Proof: tests/unit/machine_file/service_file_test.cpp.
[[nodiscard]] ServiceConfig load_service(const std::filesystem::path& path);

/// Returns how many lost periods the drives bridge: what the service file says, else what the
/// machine file says, but at least 50 ms worth in best effort.
[[nodiscard]] int find_bridge_cycles(const ServiceConfig& service, const MachineModel& machine);

}  // namespace meridian::config
