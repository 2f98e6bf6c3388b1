// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "service/cli/commands.hpp"
#include "service/cli/host_findings.hpp"
#include "service/cli/options/machine_name_option.hpp"
#include "service/host/probe/doctor/dds_network.hpp"
#include "service/host/probe/doctor/doctor.hpp"
#include "service/host/process/processors.hpp"
#include "service/machine/file/sections/service_file.hpp"
#include "service/protocol/operator/machine_finder.hpp"
#include "service/transport/participant.hpp"

namespace meridian::cli::doctor_command {
namespace {

struct Options {
  std::uint32_t domain = 0;
  std::string machine, trace, service;
  std::optional<int> cpu;
  bool is_json = false, is_silent = false;
};

void add(probe::Findings& all, const probe::Findings& more) {
  all.insert(all.end(), more.begin(), more.end());
}

[[nodiscard]] probe::Findings examine_domain(const Options& options) {
  char host_name[256] = {};
  ::gethostname(host_name, sizeof host_name - 1);
  try {
    constexpr std::chrono::milliseconds kPatience{800};
    const dds::Participant participant({.domain = options.domain, .machine = options.machine});
    probe::Findings all = probe::examine_security(participant.is_secured());
    add(all, probe::examine_peers(stream::find_machines(options.domain, options.machine, kPatience),
                                  host_name, MERIDIAN_VERSION));
    return all;
  } catch (const dds::DdsError& error) {
    return {{"DDS", probe::Health::kBad, error.what(), "mend CYCLONEDDS_URI or the network"}};
  }
}

/// The one that the service would take, however it is reached from here.
[[nodiscard]] int cycle_cpu(const Options& options) {
  if (options.cpu) return *options.cpu;
  const int named =
      options.service.empty() ? -1 : config::load_service(options.service).realtime.cpu;
  return named >= 0 ? named : process::last_cpu();
}

int run(const Options& options) {
  const probe::HostFiles host;
  const probe::Rights rights = probe::try_rights();
  const std::string uri = cyclone_uri();
  probe::Findings all = examine_host(cycle_cpu(options), uri, &rights);
  if (!options.is_silent) {
    add(all, probe::examine_dds_network(host, uri, probe::real_network()));
  }
  add(all, probe::examine_traces(options.trace));
  if (!options.is_silent) add(all, examine_domain(options));
  std::cout << (options.is_json ? to_json(all) : to_text(all));
  return is_fit(all) ? kFine : kVerdictNo;
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "doctor",
      "What is wrong with this host for real time, and how to mend it: rights, processors, "
      "kernel, network, traces, who answers. Nothing is changed. Exit code 1 where something is "
      "bad");
  command->add_option("--domain", options->domain, "DDS domain")
      ->envname("MERIDIAN_DOMAIN")
      ->check(CLI::Range(0, 230))
      ->capture_default_str();
  command
      ->add_option("--machine-name", options->machine,
                   "Look for this machine only; needed in a secured domain")
      ->check(machine_name());
  command->add_option("--service", options->service,
                      "Service file (TOML): its [realtime] cpu is the cycle's processor");
  command
      ->add_option("--cpu", options->cpu,
                   "The cycle's processor; default: as --service says, else the last of this "
                   "process")
      ->check(CLI::Range(0, 1023));
  command->add_option("--trace", options->trace,
                      "Folder of meridiand --trace: can traces of slow cycles be written there by "
                      "this user, and which lie there");
  command->add_flag("--no-dds", options->is_silent,
                    "Send nothing: no look at the network of DDS and who answers there");
  command->add_flag("--json", options->is_json, "As JSON");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli::doctor_command
