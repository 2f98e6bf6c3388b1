// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>

#include "service/cli/commands.hpp"
#include "service/cli/host_findings.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/host/process/processors.hpp"
#include "service/panel/desks/request_guard.hpp"
#include "service/panel/desks/token_guard.hpp"
#include "service/panel/panel.hpp"
#include "service/panel/serve/server.hpp"
#include "service/transport/participant.hpp"

namespace meridian::cli::panel_command {
namespace {

struct Options {
  PeerOptions peer;
  panel::PanelOptions panel;
  std::string public_url, token_file;
  bool is_open_network = false;
};

/// The token and the public address; throws ServerError and TokenError.
void read_access(Options& options) {
  if (!options.public_url.empty()) {
    const auto host = panel::public_host_of(options.public_url);
    if (!host) {
      throw panel::ServerError(
          "--public takes the address of the TLS proxy, as https://NAME or https://NAME:PORT");
    }
    options.panel.public_host = *host;
  }
  if (!options.token_file.empty()) options.panel.token = panel::load_token(options.token_file);
}

int serve(Options& options) {
  read_access(options);
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
  options.panel.examine_host = [] {
    return to_json(examine_host(process::last_cpu(), cyclone_uri(), nullptr));
  };
  panel::run_panel(participant, options.panel, stop_flag(), [&](const panel::PanelOpened& opened) {
    std::printf("the panel of %s is at http://127.0.0.1%s/\n", options.peer.machine.c_str(),
                panel::port_in_host(opened.port).c_str());
    if (!opened.refusal.empty()) std::printf("it only watches: %s\n", opened.refusal.c_str());
    if (!options.panel.public_host.empty()) {
      std::printf("and behind its TLS proxy at https://%s/\n", options.panel.public_host.c_str());
    }
    std::fflush(stdout);
  });
  return kFine;
}

int refuse(const std::exception& error) {
  std::fprintf(stderr, "meridian: %s\n", error.what());
  return kUsage;
}

int run(Options& options) {
  try {
    return serve(options);
  } catch (const panel::ServerError& error) {
    return refuse(error);
  } catch (const panel::TokenError& error) {
    return refuse(error);
  }
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "panel", "The operator's page: serves it to browsers on this host until interrupted");
  command->add_option("--port", options->panel.port, "Port on loopback; 0: any that is free")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  command->add_option("--token", options->token_file,
                      "File with the word that browsers and programs have to show; none: loopback "
                      "is open to every account of this host");
  command->add_option("--public", options->public_url,
                      "https://NAME:PORT of a TLS proxy on this host that leads to the panel; "
                      "needs --token");
  command->add_option("--meshes", options->panel.mesh_folder,
                      "Folder of the STL files that the machine file names in [[mesh]]; none: the "
                      "machine is drawn from its joints alone")
      ->check(CLI::ExistingDirectory);
  command->add_option("--history", options->panel.history_file,
                      "Audit log of the service on this host: its faults, commands and sessions "
                      "stand under Messages, those of before the panel began too");
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
