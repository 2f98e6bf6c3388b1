// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include "service/cli/commands.hpp"
#include "service/cli/peer_options.hpp"
#include "service/cli/status_text.hpp"
#include "service/dds/participant.hpp"
#include "service/dds/reader.hpp"
#include "service/dds/waitset.hpp"
#include "service/stream/operator_link.hpp"

namespace meridian::cli {

namespace {

struct StatusOptions {
  PeerOptions peer;
  bool is_json = false, is_watching = false, is_latency = false;
};

/// Waits for the next snapshot of the latency topic and prints its percentiles.
int print_latency(dds::Participant& participant, const StatusOptions& options) {
  dds::Waitset waitset(participant);
  dds::Reader<dds::Latency> reader(participant);
  waitset.attach(reader);
  const auto until = std::chrono::steady_clock::now() + options.peer.timeout();
  dds::Latency latency;
  while (!reader.take(latency)) {
    const auto left = until - std::chrono::steady_clock::now();
    if (left <= left.zero()) {
      std::fprintf(stderr, "meridian: machine %s does not tell its latencies\n",
                   options.peer.machine.c_str());
      return kNoPeer;
    }
    waitset.wait(left);
  }
  std::printf("latency, us            samples        p50        p99      p99.9        max\n");
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
  for (const dds::HistogramSnapshot& h : latency.histograms) {
    std::printf("%-18s %11llu %10.1f %10.1f %10.1f %10.1f\n", h.name.c_str(),
                static_cast<unsigned long long>(h.count), us(h.p50_ns), us(h.p99_ns), us(h.p999_ns),
                us(h.max_ns));
  }
  return kFine;
}

int run_status(StatusOptions& options) {
  int exit_code = kFine;
  const auto machine = find_machine(options.peer, exit_code);
  if (!machine) return exit_code;
  dds::Participant participant({.domain = options.peer.domain, .machine = options.peer.machine});
  if (options.is_latency) return print_latency(participant, options);
  stream::OperatorLink link(participant, "status");
  if (options.is_watching) watch_for_stop();
  do {
    if (!link.wait_for_status(options.peer.timeout())) {
      std::fprintf(stderr, "meridian: machine %s does not tell its status\n",
                   options.peer.machine.c_str());
      return kNoPeer;
    }
    std::printf("%s\n", options.is_json ? to_json(*link.status(), *machine).c_str()
                                        : describe(*link.status(), *machine).c_str());
    std::fflush(stdout);
  } while (options.is_watching && !stop_flag().load());
  return kFine;
}

}  // namespace

void add_status_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<StatusOptions>();
  CLI::App* command = app.add_subcommand(
      "status", "What the machine does now: state, program, block, feed, buffer, counters");
  command->add_flag("--json", options->is_json, "One JSON object per line, for programs");
  command->add_flag("--latency", options->is_latency,
                    "Percentiles of wake-up, computation and hand-over since the service started");
  command->add_flag("--watch", options->is_watching, "Print every status until interrupted");
  add_peer_options(*command, options->peer);
  command->callback([options, &exit_code] { exit_code = run_status(*options); });
}

}  // namespace meridian::cli
