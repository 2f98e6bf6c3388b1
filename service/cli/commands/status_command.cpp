// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/cli/status_text.hpp"
#include "service/cli/stoppable_output.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/protocol/operator/served_model.hpp"
#include "service/text/percentiles.hpp"
#include "service/transport/followed.hpp"
#include "service/transport/latency_since.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/waitset.hpp"

namespace meridian::cli::status_command {

namespace {

struct StatusOptions {
  PeerOptions peer;
  bool is_json = false, is_watching = false, is_latency = false;
  std::string histograms;
  double for_s = 0;
};

using Histograms = std::vector<dds::NamedHistogram>;

/// A topic of one service, read and nothing else: what a viewer may in a secured domain.
template <class Message>
class TopicLink {
 public:
  explicit TopicLink(dds::Participant& participant) : reader_(participant), waitset_(participant) {
    waitset_.attach(reader_);
  }

  /// The newest message, waiting for one; nothing: none came in that time.
  [[nodiscard]] std::optional<Message> next(std::chrono::milliseconds patience) {
    const auto until = std::chrono::steady_clock::now() + patience;
    Message message;
    while (!followed_.take(reader_, message)) {
      const auto left = until - std::chrono::steady_clock::now();
      if (left <= left.zero()) return std::nullopt;
      waitset_.wait(left);
    }
    return message;
  }

 private:
  dds::Reader<Message> reader_;
  dds::Followed<Message> followed_;
  dds::Waitset waitset_;
};

/// What the service counted since it started or, where --for was given, in that time.
[[nodiscard]] std::optional<Histograms> measure_latency(dds::Participant& participant,
                                                        const StatusOptions& options) {
  TopicLink<dds::Latency> link(participant);
  const auto patience = options.peer.timeout();
  const auto begin = link.next(patience);
  if (!begin) return std::nullopt;
  if (options.for_s <= 0) return begin->histograms;
  std::this_thread::sleep_for(std::chrono::duration<double>(options.for_s));
  (void)link.next(std::chrono::milliseconds(0));  // what came meanwhile
  const auto end = link.next(patience);
  if (!end) return std::nullopt;
  if (end->service_id != begin->service_id) {
    std::fprintf(stderr, "meridian: the service was started anew meanwhile; counted since then\n");
  }
  return dds::latency_since(*begin, *end).histograms;
}

/// One percentile table for each histogram.
int write_histograms(const Histograms& histograms, const std::string& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  for (const dds::NamedHistogram& one : histograms) {
    const auto path = std::filesystem::path(folder) / text::percentile_file_name(one.name);
    std::ofstream file(path);
    file << "#[" << one.name << ", us]\n" << text::percentile_table(one.histogram);
    if (file.flush()) continue;
    std::fprintf(stderr, "meridian: %s cannot be written\n", path.c_str());
    return kInputRefused;
  }
  return kFine;
}

int print_latency(dds::Participant& participant, const StatusOptions& options) {
  const auto histograms = measure_latency(participant, options);
  if (!histograms) {
    std::fprintf(stderr, "meridian: machine %s does not publish its latencies\n",
                 options.peer.machine.c_str());
    return kNoPeer;
  }
  std::printf("latency, us              samples        p50        p99      p99.9        max\n");
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
  for (const auto& [name, h] : *histograms) {
    std::printf("%-20s %11llu %10.1f %10.1f %10.1f %10.1f\n", name.c_str(),
                static_cast<unsigned long long>(h.count()), us(h.percentile_ns(0.5)),
                us(h.percentile_ns(0.99)), us(h.percentile_ns(0.999)), us(h.max_ns()));
  }
  return options.histograms.empty() ? kFine : write_histograms(*histograms, options.histograms);
}

/// Where the tool is; nothing where the service publishes no machine file that this version reads.
[[nodiscard]] std::optional<Pose<double>> tool_of(const dds::Status& status,
                                                  const std::optional<MachineModel>& model) {
  if (!model) return std::nullopt;
  return forward(*model, status.tool_length_mm, status.joints);
}

[[nodiscard]] std::optional<MachineModel> model_of(const dds::MachineInfo& machine) {
  try {
    return stream::served_model(machine);
  } catch (const config::ConfigError&) {
    return std::nullopt;
  }
}

int run_status(StatusOptions& options) {
  const bool is_latency = options.is_latency || !options.histograms.empty();
  if (options.for_s > 0 && !is_latency) {
    std::fprintf(stderr, "meridian: --for is for --latency and --histograms\n");
    return kUsage;
  }
  int exit_code = kFine;
  const auto machine = find_machine(options.peer, exit_code);
  if (!machine) return exit_code;
  dds::Participant participant({.domain = options.peer.domain, .machine = options.peer.machine});
  if (is_latency) return print_latency(participant, options);
  TopicLink<dds::Status> link(participant);
  const std::optional<MachineModel> model = model_of(*machine);
  if (options.is_watching) watch_for_stop();
  StoppableOutput output;
  do {
    const auto status = link.next(options.peer.timeout());
    if (!status) {
      std::fprintf(stderr, "meridian: machine %s does not publish its status\n",
                   options.peer.machine.c_str());
      return kNoPeer;
    }
    const std::optional<Pose<double>> tool = tool_of(*status, model);
    output.print(options.is_json ? to_json(*status, *machine, tool)
                                 : describe(*status, *machine, tool));
  } while (options.is_watching && !stop_flag().load());
  return kFine;
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<StatusOptions>();
  CLI::App* command = app.add_subcommand(
      "status", "What the machine does now: state, program, block, feed, buffer, counters");
  command->add_flag("--json", options->is_json, "One JSON object per line, for programs");
  command->add_flag("--latency", options->is_latency,
                    "Percentiles of wake-up, computation, hand-over, planning and transport");
  command->add_option(
      "--histograms", options->histograms,
      "The same as percentile tables of HdrHistogram, one file each in this folder");
  command
      ->add_option("--for", options->for_s,
                   "Latencies of this time from now on, s; default: since the service started")
      ->check(finite_range(1e-3, 1e7));
  command->add_flag("--watch", options->is_watching, "Print every status until interrupted");
  add_peer_options(*command, options->peer);
  command->callback([options, &exit_code] { exit_code = run_status(*options); });
}

}  // namespace meridian::cli::status_command
