// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <memory>

#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/machine_options.hpp"
#include "service/cli/record_live.hpp"
#include "service/neighbours/ros/conversion.hpp"
#include "service/recording/record/flight/flight_picture.hpp"
#include "service/recording/record/flight/flight_report.hpp"

namespace meridian::cli::record_command {
namespace {

struct Options {
  std::string flight, recording, picture;
  LiveOptions live;
};

int refuse(const record::RecordError& error) {
  std::cerr << error.text() << "\n";
  return kInputRefused;
}

int read(const Options& options) {
  const MachineModel model = load_machine(options.live.machine);
  auto recording = record::RecordingReader::open(options.flight, model);
  if (!recording) return refuse(recording.error());
  const auto report = record::read_flight(*recording, model);
  if (!report) return refuse(report.error());
  std::cout << record::to_text(*report, model);
  if (options.picture.empty()) return kFine;
  const auto error = record::draw_flight(*recording, *report, model, options.picture);
  return error ? refuse(*error) : kFine;
}

int convert(const Options& options) {
  const MachineModel model = load_machine(options.live.machine);
  const auto report = ros::convert(options.recording, options.live.mcap, model);
  if (!report) return refuse(report.error());
  std::cout << ros::to_text(*report, options.live.mcap);
  return kFine;
}

int run(Options& options) {
  const LiveOptions& live = options.live;
  const bool is_listening = options.flight.empty() && options.recording.empty();
  if (is_listening ? live.output.empty() && live.mcap.empty() : !live.output.empty()) {
    throw CLI::ValidationError(
        "record", "name the recording to write, or one after --mcap, --read or --convert");
  }
  if (is_listening && live.mcap.empty() && !live.machine.machine.empty()) {
    throw CLI::ValidationError("--machine", "belongs to --mcap, --read or --convert");
  }
  if (is_listening) return record_live(options.live);
  return options.recording.empty() ? read(options) : convert(options);
}

}  // namespace

void add(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand(
      "record",
      "Setpoints and feedback as they are seen on the wire, into a recording, an MCAP file or "
      "both, with the gaps, the age of what arrives and the following error. Or, with --read, what "
      "such a recording or one of the flight recorder says of a fault. Or, with --convert, any "
      "recording as an MCAP file");
  LiveOptions& live = options->live;
  command->add_option("output", live.output, "Recording to write (CSV)");
  CLI::Option* const read_option =
      command->add_option("--read", options->flight,
                          "Instead: report alarm, stop, following errors and what drives reported, "
                          "out of this file of the flight recorder or of this command");
  CLI::Option* const convert_option =
      command
          ->add_option("--convert", options->recording,
                       "Instead: write this recording (CSV) of the service, the simulator, the "
                       "flight recorder or this command, with its events, to the file behind "
                       "--mcap")
          ->excludes(read_option);
  CLI::Option* const mcap =
      command
          ->add_option("--mcap", live.mcap,
                       "MCAP file to write, for Foxglove and PlotJuggler; beside a recording or "
                       "without one")
          ->excludes(read_option);
  convert_option->needs(mcap);
  CLI::Option* const machine =
      command->add_option("-m,--machine", live.machine.machine,
                          "For --read and --convert: machine file (TOML); for --mcap in place of "
                          "what the service says of itself");
  read_option->needs(machine);
  convert_option->needs(machine);
  add_workpiece_options(*command, live.machine);
  command->add_option("--picture", options->picture, "For --read: draw it to this .png or .svg")
      ->needs(read_option);
  command->add_option("--duration", live.duration_s, "End after so many seconds")
      ->check(finite_positive());
  command->add_flag("--until-end", live.until_end, "End when the program in the machine ends");
  command->add_option("--max-missing", live.max_missing,
                      "Exit code 1 where more cycles are missing");
  add_peer_options(*command, live.peer);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace meridian::cli::record_command
