// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>

#include "service/cli/commands.hpp"
#include "service/dds/participant.hpp"
#include "service/probe/doctor.hpp"
#include "service/stream/machine_finder.hpp"

namespace meridian::cli {
namespace {

struct Options {
  std::uint32_t domain = 0;
  std::string machine, trace;
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

int run(const Options& options) {
  const probe::HostFiles host;
  const probe::Rights rights = probe::try_rights();
  const char* const uri = std::getenv("CYCLONEDDS_URI");
  probe::Findings all = probe::examine_rights(host, rights);
  add(all, probe::examine_processors(host, rights));
  add(all, probe::examine_kernel(host));
  add(all, probe::examine_network(host, uri == nullptr ? "" : uri));
  add(all, probe::examine_traces(options.trace));
  if (!options.is_silent) add(all, examine_domain(options));
  std::cout << (options.is_json ? to_json(all) : to_text(all));
  return is_fit(all) ? kFine : kVerdictNo;
}

}  // namespace

void add_doctor_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "doctor",
      "What is wrong with this host for real time, and how to mend it: rights, processors, "
      "kernel, network, traces, who answers. Nothing is changed. Exit code 1 where something is "
      "bad");
  command->add_option("--domain", options->domain, "DDS domain")
      ->check(CLI::Range(0, 230))
      ->capture_default_str();
  command->add_option("--machine-name", options->machine,
                      "Look for this machine only; needed in a secured domain");
  command->add_option("--trace", options->trace,
                      "Folder of meridiand --trace: can traces of slow cycles be written there by "
                      "this user, and which lie there");
  command->add_flag("--no-dds", options->is_silent, "Do not look for machines in the DDS domain");
  command->add_flag("--json", options->is_json, "As JSON");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli
