// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/peer_options.hpp"

#include <csignal>
#include <cstdio>

#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/machine_name_option.hpp"
#include "service/protocol/operator/machine_finder.hpp"

namespace meridian::cli {

void add_peer_options(CLI::App& command, PeerOptions& options) {
  command.add_option("--domain", options.domain, "DDS domain")
      ->envname("MERIDIAN_DOMAIN")
      ->capture_default_str()
      ->check(CLI::Range(0, 230));
  command
      .add_option("--machine-name", options.machine,
                  "Name of the machine; needed where a domain has more than one")
      ->check(machine_name());
  command.add_option("--timeout", options.timeout_s, "How long to wait for a service, s")
      ->capture_default_str()
      ->check(finite_range(0.0, 1e6));
}

std::optional<dds::MachineInfo> find_machine(PeerOptions& options, int& exit_code) {
  const auto machines = stream::find_machines(options.domain, options.machine, options.timeout());
  if (machines.size() == 1 && !config::is_machine_name(machines.front().name)) {
    std::fprintf(stderr,
                 "meridian: a service says that its machine is '%s', which is no name: %s\n",
                 machines.front().name.c_str(), config::kMachineNameWords);
    exit_code = kNoPeer;
    return std::nullopt;
  }
  if (machines.size() == 1) {
    if (options.machine.empty()) options.machine = machines.front().name;
    return machines.front();
  }
  if (machines.empty()) {
    std::fprintf(stderr,
                 "meridian: no service answers%s%s in DDS domain %u; start meridiand, or choose "
                 "--domain and --machine-name\n",
                 options.machine.empty() ? "" : " for machine ", options.machine.c_str(),
                 options.domain);
    exit_code = kNoPeer;
    return std::nullopt;
  }
  std::string names;
  for (const dds::MachineInfo& machine : machines) names += " " + machine.name;
  std::fprintf(stderr,
               "meridian: several machines in DDS domain %u, choose one by "
               "--machine-name:%s\n",
               options.domain, names.c_str());
  exit_code = kUsage;
  return std::nullopt;
}

std::atomic<bool>& stop_flag() noexcept {
  static std::atomic<bool> flag{false};
  static_assert(std::atomic<bool>::is_always_lock_free);
  return flag;
}

void watch_for_stop() {
  static_cast<void>(stop_flag().load());  // made before a signal can ask for it
  const auto stop = [](int) { stop_flag().store(true); };
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);
}

void outlive_readers() { std::signal(SIGPIPE, SIG_IGN); }

}  // namespace meridian::cli
