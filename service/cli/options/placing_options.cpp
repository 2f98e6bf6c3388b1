// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/placing_options.hpp"

#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>

#include "service/analysis/simulate/simulate.hpp"
#include "service/cli/commands.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/machine/inspect/placing.hpp"
#include "service/text/printed.hpp"

namespace meridian::cli {
namespace {

/// `x0,x1,y0,y1,z0,z1` in mm; throws config::ConfigError.
inspect::PlacingBox read_box(const std::string& text) {
  inspect::PlacingBox box;
  std::istringstream numbers(text);
  bool is_fine = true;
  for (std::size_t i = 0; i < 3 && is_fine; ++i) {
    char comma = ',';
    if (i > 0) numbers >> comma;
    is_fine = comma == ',' && (numbers >> box.low_mm[i] >> comma >> box.high_mm[i]) &&
              comma == ',' && box.low_mm[i] <= box.high_mm[i];
  }
  if (is_fine && numbers.peek() == std::istringstream::traits_type::eof()) return box;
  throw config::ConfigError({.file = "--box",
                             .value = "'" + text + "' is no box",
                             .remedy = "give x0,x1,y0,y1,z0,z1 in mm, the smaller of each first"});
}

/// A program with all that reading it on a machine takes.
struct ReadableProgram {
  ToolTable tools;
  cl::ClReaderOptions reading;
  std::ifstream file;
  std::istream* input = nullptr;  ///< nullptr: it cannot be opened
};

void open_program(const std::string& name, const ClFileOptions& cl, const MachineOptions& machine,
                  const MachineModel& model, ReadableProgram& out) {
  out.tools = load_tools(machine);
  out.reading = reader_options(cl, machine, model);
  add_unknown_tools(name, out.reading, machine, out.tools);
  describe_machine(out.reading, model, out.tools, load_tool_names(machine));
  out.input = open_cl_file(name, out.file);
}

/// A frame with the time that the program takes in it.
struct TimedPlacing {
  inspect::Placing placing;
  double time_s = 0;   ///< simulated
  std::string reason;  ///< why the program does not run there; empty: it runs
};

TimedPlacing simulate_at(const inspect::Placing& placing, const PlacingOptions& options,
                         const ClFileOptions& cl, const MachineOptions& machine,
                         const MachineModel& model) {
  const MachineModel there = inspect::placed(model, placing.origin_mm, placing.turn_rad);
  ReadableProgram program;
  open_program(options.program, cl, machine, there, program);
  if (program.input == nullptr) return {placing, 0, options.program + " cannot be opened again"};
  cl::ClReader reader(*program.input, options.program, program.reading);
  const simulate::SimulateReport report = simulate::simulate(
      reader, options.program, there, program.tools, {}, [](const CycleRecord&) {});
  const bool has_run = report.outcome == simulate::Outcome::kDone;
  return {placing, report.program_s, has_run ? "" : report.reason};
}

std::string time_text(const TimedPlacing& at) {
  return at.reason.empty() ? text::printed("%.1f s", at.time_s) : "none: " + at.reason;
}

/// The quicker one of the frames with the largest margin and with the least estimated time, as
/// simulated.
TimedPlacing fastest(const inspect::Placing& widest, const PlacingOptions& options,
                     const std::vector<inspect::ProgramPose>& poses, const inspect::PlacingBox& box,
                     const ClFileOptions& cl, const MachineOptions& machine,
                     const MachineModel& model) {
  const auto quick = inspect::find_placing(model, poses, box, inspect::PlacingAim::kTime);
  const TimedPlacing by_margin = simulate_at(widest, options, cl, machine, model);
  const TimedPlacing by_time = simulate_at(quick, options, cl, machine, model);
  const bool is_quicker =
      by_time.reason.empty() && (!by_margin.reason.empty() || by_time.time_s < by_margin.time_s);
  const TimedPlacing& best = is_quicker ? by_time : by_margin;
  std::cout << "time       " << time_text(best) << "; with the largest margin "
            << time_text(by_margin) << "\n";
  return best;
}

}  // namespace

CLI::Option* add_placing_options(CLI::App& command, PlacingOptions& options) {
  CLI::Option* const program = command.add_option(
      "--place", options.program,
      "A part program: find the frame in which it fits with the largest margin to all ends of "
      "travel. Exit code 1 where there is none");
  command
      .add_option("--box", options.box,
                  "With --place: where the origin of the workpiece may lie, x0,x1,y0,y1,z0,z1 in "
                  "mm; default: wherever the machine reaches")
      ->needs(program);
  command.add_flag("--turn", options.may_turn, "With --place: the workpiece may turn about z")
      ->needs(program);
  command
      .add_flag("--fastest", options.is_fastest,
                "With --place: the frame in which the program takes the least time, 2 % of half "
                "the travel left")
      ->needs(program);
  return program;
}

Expected<std::vector<inspect::ProgramPose>, std::string> read_program_poses(
    const std::string& name, const ClFileOptions& cl, const MachineOptions& machine,
    const MachineModel& model) {
  ReadableProgram program;
  open_program(name, cl, machine, model, program);
  if (program.input == nullptr) return tl::make_unexpected(name + ": cannot be opened");
  cl::ClReader reader(*program.input, name, program.reading);
  auto poses = inspect::read_poses(reader, model, program.tools);
  if (!poses) return tl::make_unexpected(poses.error().text());
  if (poses->empty()) return tl::make_unexpected(name + " moves nothing");
  return *std::move(poses);
}

Expected<int, std::string> run_placing(const PlacingOptions& options, const ClFileOptions& cl,
                                       const MachineOptions& machine, const MachineModel& model) {
  if (options.is_fastest && !can_be_read_twice(options.program)) {
    return tl::make_unexpected("--fastest reads the program again and again: give a file");
  }
  const auto poses = read_program_poses(options.program, cl, machine, model);
  if (!poses) return tl::make_unexpected(poses.error());
  inspect::PlacingBox box =
      options.box.empty() ? inspect::widest_box(model, *poses) : read_box(options.box);
  box.may_turn = options.may_turn;
  inspect::Placing found = inspect::find_placing(model, *poses, box);
  bool runs = found.fit.margin >= 0;
  if (runs && options.is_fastest) {
    const TimedPlacing quick = fastest(found, options, *poses, box, cl, machine, model);
    found = quick.placing;
    runs = quick.reason.empty();
  }
  std::cout << to_text(found, model, *poses);
  return runs ? kFine : kVerdictNo;
}

}  // namespace meridian::cli
