// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "service/host/probe/doctor/finding.hpp"
#include "service/host/probe/doctor/host_files.hpp"
#include "service/transport/convert/messages.hpp"

/// What is wrong with a host and how to mend it. Nothing is changed.
namespace meridian::probe {

/// What a service may need to lock, as its budget says (resident_memory; a test compares).
inline constexpr std::size_t kLockedMemory_mib = 64;

/// What this process was allowed when it tried.
struct Rights {
  bool has_priority = false;  ///< a thread at FIFO 80
  bool has_locked_memory = false;
  bool has_dma_latency = false;  ///< /dev/cpu_dma_latency can be written
  int cpus = 1;                  ///< that this process may use
};
[[nodiscard]] Rights try_rights();

/// Rights, and the limits that stand behind them: control groups, throttling.
[[nodiscard]] Findings examine_rights(const HostFiles& host, const Rights& rights);
/// What a service would meet that is started in a control group of its own, as units are: a kernel
/// that shares real time out among groups gives new ones none, and FIFO is refused there, to root
/// too, whatever this process may.
[[nodiscard]] Findings examine_service_group(const HostFiles& host);
/// Whether the cycle's processor is there, isolated, tickless and without the kernel's callbacks.
[[nodiscard]] Findings examine_isolation(const HostFiles& host, int cpu);
/// Time of day as the kernel keeps it.
struct TimeOfDay {
  bool is_synchronised = false;
  double max_error_s = 0;
};
[[nodiscard]] TimeOfDay read_time_of_day();
/// Time of day, what fires timers, and whether they are moved to other processors.
[[nodiscard]] Findings examine_clocks(const HostFiles& host, const TimeOfDay& now);
/// Processors: clock frequency, sleep states, threads of one core, stolen time.
[[nodiscard]] Findings examine_processors(const HostFiles& host, const Rights& rights);
/// Kernel flavour, timers, memory, what else wakes up.
[[nodiscard]] Findings examine_kernel(const HostFiles& host);
/// Socket buffers and the DDS configuration; `cyclone_uri` is CYCLONEDDS_URI, empty where unset.
[[nodiscard]] Findings examine_network(const HostFiles& host, const std::string& cyclone_uri);
/// Whether traces of slow cycles can be written into `folder` by this user (meridiand --trace), and
/// which lie there; empty: none are asked for.
[[nodiscard]] Findings examine_traces(const std::filesystem::path& folder);
/// Whether this process has an identity that the machine's authority signed.
[[nodiscard]] Findings examine_security(bool is_secured);
/// Who answers in the DDS domain, seen from `host_name` with this `version`.
[[nodiscard]] Findings examine_peers(const std::vector<dds::MachineInfo>& machines,
                                     const std::string& host_name, const std::string& version);

}  // namespace meridian::probe
