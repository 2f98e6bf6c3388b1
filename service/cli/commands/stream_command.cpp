// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "meridian/units.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/options/cl_options.hpp"
#include "service/cli/options/machine_options.hpp"
#include "service/cli/options/operator/reported_machine.hpp"
#include "service/cli/options/peer_options.hpp"
#include "service/cli/progress_text.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/sections/positions_file.hpp"
#include "service/machine/file/tool_names.hpp"
#include "service/protocol/frame_sum.hpp"
#include "service/protocol/limits_sum.hpp"
#include "service/protocol/operator/served_model.hpp"
#include "service/protocol/station/stream_run.hpp"
#include "service/protocol/tools_sum.hpp"
#include "service/text/printable.hpp"
#include "service/transport/participant.hpp"

namespace meridian::cli::stream_command {

namespace {

struct StreamCommandOptions {
  PeerOptions peer;
  ClFileOptions file;
  JoinOptions join;
  stream::StreamOptions stream;
  std::string machine_file, tool_file;
  bool has_no_preflight = false;
  bool is_changed = false;
};

int exit_code_of(stream::StreamEnd end) {
  switch (end) {
    case stream::StreamEnd::kFine:
      return kFine;
    case stream::StreamEnd::kInterrupted:
      return kVerdictNo;
    case stream::StreamEnd::kInputRefused:
      return kInputRefused;
    case stream::StreamEnd::kMachineRefused:
      return kMachineRefused;
    case stream::StreamEnd::kNoPeer:
      return kNoPeer;
  }
  return kVerdictNo;
}

/// The tools that NC programs may call by name: those of the table that the file is checked for.
nc::NamedTools named_tools(const StreamCommandOptions& options, const dds::MachineInfo& info) {
  if (!options.machine_file.empty()) {
    return options.tool_file.empty() ? nc::NamedTools()
                                     : config::load_tool_names(options.tool_file);
  }
  return info.tool_file.empty()
             ? nc::NamedTools()
             : config::parse_tool_names(info.tool_file, "tool table of the service");
}

config::PositionsByName positions_of(const StreamCommandOptions& options,
                                     const dds::MachineInfo& info) {
  return options.machine_file.empty()
             ? config::positions_by_name(info.machine_file, "machine file of the service")
             : config::load_positions(options.machine_file);
}

/// Returns the machine that the file is checked for: the one that the service publishes, unless
/// files were given. Nothing where the service does not publish its file.
std::optional<stream::PreflightMachine> preflight_machine(const StreamCommandOptions& options,
                                                          const dds::MachineInfo& info) {
  std::optional<stream::PreflightMachine> machine;
  if (!options.machine_file.empty()) {
    machine.emplace();
    machine->model = config::load_machine(options.machine_file);
    if (!options.tool_file.empty()) machine->tools = config::load_tools(options.tool_file);
    return machine;
  }
  auto model = reported_machine(info);
  if (!model) return machine;
  machine.emplace();
  machine->model = std::move(*model);
  if (!info.tool_file.empty()) {
    machine->tools = config::parse_tools(info.tool_file, "tool table of the service");
  }
  return machine;
}

/// Reads the whole file first; false where it is refused.
bool pass_preflight(StreamCommandOptions& options,
                    const std::optional<stream::PreflightMachine>& machine) {
  stream::PreflightReport report =
      stream::preflight(options.stream.file, options.stream.reader, machine);
  std::fputs(to_text(report.findings, options.stream.file).c_str(), stderr);
  if (report.is_refused) return false;
  std::printf("preflight: %llu blocks, %s at programmed feeds%s\n",
              static_cast<unsigned long long>(report.blocks),
              time_text(report.times.total_s()).c_str(),
              machine ? "" : "; reach and travel are the service's to check");
  options.stream.preflight = std::move(report);
  return true;
}

int run_stream_command(StreamCommandOptions& options) {
  options.stream.reader = reader_options(options.file);
  const SmoothSettings asked = settings_of(options.join);
  options.stream.tip_tolerance_mm = asked.tip_tolerance_mm;
  options.stream.axis_tolerance_rad = asked.axis_tolerance_rad;
  options.stream.options = options_text(options.file, options.join);
  if (asked.transition == Transition::kSmooth) options.stream.policies |= dds::kPolicySmooth;
  if (asked.transition == Transition::kExactStop) options.stream.policies |= dds::kPolicyExactStop;
  if (options.file.first_line > 0) options.stream.policies |= dds::kPolicyRetractFirst;
  if (options.is_changed) options.stream.policies |= dds::kPolicyChanged;
  int exit_code = kFine;
  const auto machine = find_machine(options.peer, exit_code);
  if (!machine) return exit_code;
  const auto checked_for = preflight_machine(options, *machine);
  options.stream.frame = checked_for
                             ? stream::frame_sum(checked_for->model, machine->work_frames)
                             : stream::frame_sum(machine->frame_rotation, machine->frame_origin_mm,
                                                 machine->work_frames);
  if (checked_for && checked_for->tools)
    options.stream.tools = stream::tools_sum(*checked_for->tools);
  const bool is_of_file = !options.machine_file.empty();
  options.stream.limits = stream::limits_sum(is_of_file ? SoftLimits() : machine->soft_limits);
  cl::ClReaderOptions& reader = options.stream.reader;
  reader.max_feed_mm_per_s = units::per_s_from_per_min(machine->max_feed_mm_per_min);
  if (checked_for && checked_for->model.default_unit_mm) {
    reader.default_unit = cl::LengthUnit::kMillimetre;
  } else if (checked_for && checked_for->model.default_unit_inch) {
    reader.default_unit = cl::LengthUnit::kInch;
  }
  for (const auto& zero : stream::served_work_zeros(*machine)) reader.work_offsets.insert(zero);
  if (checked_for) {
    reader.positions = positions_of(options, *machine);
    describe_machine(reader, checked_for->model, checked_for->tools.value_or(ToolTable()),
                     named_tools(options, *machine));
  }
  const bool is_read_first = !options.has_no_preflight && options.stream.file != "-";
  if (is_read_first && !pass_preflight(options, checked_for)) return kInputRefused;

  watch_for_stop();
  dds::Participant participant({.domain = options.peer.domain, .machine = options.peer.machine});
  ProgressPrinter printer(::isatty(STDOUT_FILENO) != 0);
  const stream::StreamEnd end = stream::run_stream(
      participant, options.stream, stop_flag(),
      {.say = [&](const std::string& said) { printer.say(text::printable(said)); },
       .show = [&](const stream::ProgressView& view) { printer.show(view); }});
  printer.end();
  return exit_code_of(end);
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<StreamCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "stream",
      "Stream a CL file to the machine: preflight of the whole file, session, blocks as credits "
      "come, progress and what the machine says. Blocks alone move nothing: start is `meridian "
      "ctl start`");
  command
      ->add_option(
          "file", options->stream.file,
          "CL file (APT or CLDATA text) or NC program; - is standard input, without preflight")
      ->required();
  command->add_flag("--no-preflight", options->has_no_preflight,
                    "Stream at once, for endless sources; what is wrong is found on the way");
  CLI::Option* const machine =
      command->add_option("--machine", options->machine_file,
                          "Check reach and travel in the preflight by this machine file; default: "
                          "the one that the service publishes");
  command->add_option("--tools", options->tool_file, "... and this tool table; only with --machine")
      ->needs(machine);
  command->add_flag("--wait-end", options->stream.is_waiting_for_end,
                    "Stay until the machine ran the program");
  command->add_flag(
      "--changed", options->is_changed,
      "Go on (--from-line) although file, options or frame are others than those that "
      "the program was begun with");
  std::array<char, 64> host{};
  static_cast<void>(::gethostname(host.data(), host.size() - 1));
  options->stream.station = host.data();
  command->add_option("--station", options->stream.station, "Name of this station, for messages")
      ->capture_default_str();
  add_cl_file_options(*command, options->file);
  add_join_options(*command, options->join);
  add_peer_options(*command, options->peer);
  command->callback([options, &exit_code] { exit_code = run_stream_command(*options); });
}

}  // namespace meridian::cli::stream_command
