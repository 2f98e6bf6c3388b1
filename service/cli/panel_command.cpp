// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "service/cli/commands.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/panel/panel.hpp"
#include "service/panel/serve/server.hpp"
#include "service/transport/participant.hpp"

namespace meridian::cli::panel_command {
namespace {

struct Options {
  PeerOptions peer;
  panel::PanelOptions panel;
  bool is_open_network = false;
};

int run(Options& options) {
  const auto open_network =
      options.is_open_network ? dds::OpenNetwork::kAllowed : dds::OpenNetwork::kRefused;
  {  // Before a machine is looked for: on an open network a stranger may answer.
    const dds::Participant first(
        {.domain = options.peer.domain, .machine = {}, .open_network = open_network});
    if (first.is_open_network()) {
      std::fprintf(stderr,
                   "meridian panel: OPEN NETWORK: whoever reaches it may command machines\n");
    }
  }
  int exit_code = kFine;
  const auto machine = find_machine(options.peer, exit_code);
  if (!machine) return exit_code;
  watch_for_stop();
  dds::Participant participant({.domain = options.peer.domain,
                                .machine = options.peer.machine,
                                .open_network = open_network});
  try {
    panel::run_panel(participant, options.panel, stop_flag(), [&](std::uint16_t port) {
      std::printf("the panel of %s is at http://127.0.0.1:%u/\n", options.peer.machine.c_str(),
                  static_cast<unsigned>(port));
      std::fflush(stdout);
    });
  } catch (const panel::ServerError& error) {
    std::fprintf(stderr, "meridian: %s\n", error.what());
    return kUsage;
  }
  return kFine;
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "panel", "The operator's page: serves it to browsers on this host until interrupted");
  command->add_option("--port", options->panel.port, "Port on loopback; 0: any that is free")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  command->add_flag("--watch", options->panel.is_watching,
                    "The page shows and asks for nothing: no buttons");
  command->add_flag("--actions", options->panel.answers_actions,
                    "The operator does what the path waits for (tool, spindle, coolant, stop) and "
                    "says so on the page: for machines without a PLC");
  const char* const user = std::getenv("USER");
  options->panel.operator_name = user != nullptr ? user : "operator";
  std::array<char, 64> host{};
  static_cast<void>(::gethostname(host.data(), host.size() - 1));
  options->panel.station_name = std::string("panel at ") + host.data();
  command->add_option("--operator", options->panel.operator_name, "Who asks, for the log")
      ->capture_default_str();
  command->add_flag("--open-network", options->is_open_network,
                    "Start though CYCLONEDDS_URI leads off this host without an identity");
  add_peer_options(*command, options->peer);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli::panel_command
