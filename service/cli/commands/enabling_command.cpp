// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/protocol/operator/operator_link.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/writer.hpp"

namespace meridian::cli::enabling_command {
namespace {

struct EnablingOptions {
  PeerOptions peer;
  std::string operator_name;
  double period_ms = 50;
};

int run_enabling(EnablingOptions& options) {
  int exit_code = kFine;
  const auto machine = find_machine(options.peer, exit_code);
  if (!machine) return exit_code;
  watch_for_stop();
  dds::Participant participant({.domain = options.peer.domain, .machine = options.peer.machine});
  dds::Writer<dds::Enabling> heartbeats(participant);
  dds::Enabling heartbeat;
  heartbeat.operator_id = stream::draw_id();
  heartbeat.operator_name = options.operator_name;
  heartbeat.device = dds::EnablingDevice::kPressed;
  std::printf("pressed: machine %s moves while this runs; interrupt to release\n",
              options.peer.machine.c_str());
  std::fflush(stdout);
  const auto period = std::chrono::duration<double, std::milli>(options.period_ms);
  while (!stop_flag().load()) {
    ++heartbeat.sample;
    static_cast<void>(heartbeats.write(heartbeat));
    std::this_thread::sleep_for(period);
  }
  heartbeat.device = dds::EnablingDevice::kReleased;
  ++heartbeat.sample;
  static_cast<void>(heartbeats.write(heartbeat));
  std::printf("released\n");
  return kFine;
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<EnablingOptions>();
  CLI::App* command = app.add_subcommand(
      "enabling",
      "An enabling device: sends its heartbeat until it is interrupted; what moves is held when it "
      "is released, ends in any way or is not heard any more");
  const char* user = std::getenv("USER");
  options->operator_name = user != nullptr ? user : "operator";
  command->add_option("--operator", options->operator_name, "Whose device it is, for the log")
      ->capture_default_str();
  command->add_option("--period", options->period_ms, "Time between two heartbeats, ms")
      ->capture_default_str()
      ->check(finite_range(1.0, 1000.0));
  add_peer_options(*command, options->peer);
  command->callback([options, &exit_code] { exit_code = run_enabling(*options); });
}

}  // namespace meridian::cli::enabling_command
