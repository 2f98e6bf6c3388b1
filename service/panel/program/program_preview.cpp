// SPDX-License-Identifier: Apache-2.0
#include "service/panel/program/program_preview.hpp"

#include <fstream>

#include "service/analysis/simulate/simulate.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/sections/positions_file.hpp"
#include "service/machine/inspect/placing.hpp"
#include "service/panel/program/program_path.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/programs/nc/nc_reader.hpp"
#include "service/protocol/operator/home_pose.hpp"
#include "service/protocol/operator/served_model.hpp"

namespace meridian::panel {
namespace {

static_assert(static_cast<int>(simulate::Cause::kPole) == 3 &&
                  static_cast<int>(simulate::Cause::kRest) == 4 &&
                  static_cast<int>(simulate::Cause::kRewind) == 7,
              "the page names them: service/panel/page/src/held.js");

[[nodiscard]] ProgramPath::Cause seen(const simulate::ExplainedCycle& cycle) {
  return {.time_s = cycle.time_s,
          .path_mm = cycle.distance_mm,
          .programmed_mm_per_s = cycle.programmed_mm_per_s,
          .limit = cycle.limit,
          .cause = cycle.cause ? static_cast<std::uint32_t>(*cycle.cause) : ProgramPath::kUndecided,
          .tool_length_mm = cycle.tool_length_mm};
}

/// Thrown through the simulator by who is to end it.
struct Overtaken {};

[[nodiscard]] std::string reason_of(const simulate::SimulateReport& report) {
  if (!report.reason.empty()) return report.reason;
  switch (report.outcome) {
    case simulate::Outcome::kDone:
      return "";
    case simulate::Outcome::kStarved:
      return "the program has no end";
    default:
      return "the simulated program did not come to its end";
  }
}

}  // namespace

stream::PreflightMachine reported_machine(const dds::MachineInfo& info) {
  stream::PreflightMachine machine;
  machine.model = stream::served_model(info);
  if (!info.tool_file.empty()) {
    machine.tools = config::parse_tools(info.tool_file, "tool table of the service");
  }
  machine.work_zeros = stream::served_work_zeros(info);
  machine.positions = config::positions_by_name(info.machine_file, info.name);
  return machine;
}

cl::ClReaderOptions reader_for(const stream::PreflightMachine& machine, std::uint32_t first_line) {
  const MachineModel& model = machine.model;
  const ToolTable tools = machine.tools ? *machine.tools : ToolTable();
  cl::ClReaderOptions reader;
  reader.max_feed_mm_per_s = model.max_feed_mm_per_s;
  if (model.default_unit_mm) reader.default_unit = cl::LengthUnit::kMillimetre;
  if (model.default_unit_inch) reader.default_unit = cl::LengthUnit::kInch;
  reader.nc = nc::reader_of_programs(model, tools);
  reader.work_offsets = machine.work_zeros;
  reader.positions = machine.positions;
  reader.home = stream::home_pose(model, tools);
  reader.first_line = first_line;
  return reader;
}

std::string find_where_it_fits(const std::string& file, const cl::ClReaderOptions& reader,
                               const stream::PreflightMachine& machine) {
  std::ifstream input(file, std::ios::binary);
  cl::ClReader program(input, file, reader);
  const ToolTable tools = machine.tools ? *machine.tools : ToolTable();
  const auto poses = inspect::read_poses(program, machine.model, tools);
  if (!poses || poses->empty()) return "";
  inspect::PlacingBox box = inspect::widest_box(machine.model, *poses);
  box.may_turn = true;
  const inspect::Placing found = inspect::find_placing(machine.model, *poses, box);
  if (found.fit.margin < 0) return "The program fits nowhere on this machine.";
  const MachineModel placed = inspect::placed(machine.model, found.origin_mm, found.turn_rad);
  constexpr double kPercent = 100;
  std::string text =
      "It fits with the workpiece at " + inspect::frame_text(placed) + " (x, y, z in mm; ";
  text += "a, b, c in deg), with " + std::to_string(static_cast<int>(kPercent * found.fit.margin));
  return text +
         " % of half the travel to spare. Move the part there, then: meridian ctl frame set 1 "
         "--at " +
         inspect::frame_text(placed);
}

std::optional<SimulatedProgram> simulate_program(const std::string& file,
                                                 const cl::ClReaderOptions& reader,
                                                 const stream::PreflightMachine& machine,
                                                 const std::function<bool()>& is_overtaken) {
  constexpr std::uint64_t kCyclesBetweenLooks = 4096;
  const MachineModel& model = machine.model;
  std::ifstream input(file, std::ios::binary);
  cl::ClReader program(input, file, reader);
  ProgramPath path(model);
  CycleRecord record;
  simulate::Explainer explainer(
      model, {}, [&](const simulate::ExplainedCycle& cycle) { path.add(record, seen(cycle)); },
      [&path](simulate::Cause cause) { path.decide(static_cast<std::uint32_t>(cause)); });
  simulate::SimulateOptions options;
  options.explainer = &explainer;
  options.settings.retracts_first = reader.first_line > 0;
  const ToolTable tools = machine.tools ? *machine.tools : ToolTable();
  SimulatedProgram out;
  try {
    const simulate::SimulateReport report =
        simulate::simulate(program, file, model, tools, options, [&](const CycleRecord& sent) {
          record = sent;
          if (sent.setpoint.cycle % kCyclesBetweenLooks == 0 && is_overtaken()) throw Overtaken();
        });
    out.has_run = report.outcome == simulate::Outcome::kDone;
    out.reason = reason_of(report);
    out.approach_s = report.approach_s;
    out.program_s = report.program_s;
    out.waiting_s = report.waiting_s;
  } catch (const Overtaken&) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < simulate::limit_count(model); ++i) {
    out.limits.push_back(simulate::name_of(static_cast<simulate::LimitId>(i), model));
  }
  out.path = path.bytes();
  return out;
}

}  // namespace meridian::panel
