// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/python/simulation.hpp"

#include <fstream>
#include <stdexcept>
#include <utility>

#include "meridian/units.hpp"
#include "service/analysis/simulate/simulate.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/programs/nc/nc_reader.hpp"
#include "service/protocol/operator/home_pose.hpp"
#include "service/protocol/station/preflight.hpp"
#include "service/protocol/station/smooth_tolerances.hpp"

namespace meridian::python {
namespace {

cl::ClReaderOptions reading_of(const SimulationOptions& options, const MachineModel& model) {
  cl::ClReaderOptions reading;
  if (!options.dialect.empty()) {
    reading.dialect = cl::find_dialect(options.dialect);
    if (!reading.dialect) throw std::invalid_argument("dialect: no '" + options.dialect + "'");
  }
  if (options.units == "mm") reading.unit = cl::LengthUnit::kMillimetre;
  if (options.units == "inch") reading.unit = cl::LengthUnit::kInch;
  if (!options.units.empty() && !reading.unit) {
    throw std::invalid_argument("units: 'mm' or 'inch', not '" + options.units + "'");
  }
  if (options.feed_mm_per_min) {
    reading.default_feed_mm_per_s = units::per_s_from_per_min(*options.feed_mm_per_min);
  }
  if (model.default_unit_mm) reading.default_unit = cl::LengthUnit::kMillimetre;
  if (model.default_unit_inch) reading.default_unit = cl::LengthUnit::kInch;
  reading.max_feed_mm_per_s = model.max_feed_mm_per_s;
  reading.nc = nc::reader_of_programs(model, ToolTable());
  return reading;
}

SmoothSettings settings_of(const SimulationOptions& options) {
  SmoothSettings settings;
  if (options.transition == "smooth") settings.transition = Transition::kSmooth;
  if (options.transition == "exact_stop") settings.transition = Transition::kExactStop;
  if (!options.transition.empty() && !settings.transition) {
    throw std::invalid_argument("transition: 'smooth' or 'exact_stop', not '" + options.transition +
                                "'");
  }
  settings.tip_tolerance_mm = options.tip_tolerance_mm;
  settings.axis_tolerance_rad = units::rad_from_deg(options.axis_tolerance_deg);
  return settings;
}

ToolTable tools_of(const std::string& file, const cl::ClReaderOptions& reading,
                   const SimulationOptions& options) {
  const ToolTable named = options.tools.empty() ? ToolTable() : config::load_tools(options.tools);
  if (!options.unknown_tool_length_mm) return named;
  std::vector<Tool> all = named.tools();
  for (const int number : stream::unknown_tools(file, reading, named)) {
    all.push_back({number, *options.unknown_tool_length_mm, 0});
  }
  return ToolTable(std::move(all));
}

void add_row(Simulation& run, const CycleRecord& row) {
  run.cycles.push_back(static_cast<std::int64_t>(row.setpoint.cycle));
  run.lines.push_back(row.setpoint.line);
  run.kinds.push_back(static_cast<std::uint8_t>(row.motion));
  run.states.push_back(static_cast<std::uint8_t>(row.state));
  run.plan_times.push_back(row.plan_time_s);
  for (int i = 0; i < run.joint_count; ++i) {
    run.joints.push_back(row.joints[i]);
    run.drives.push_back(row.setpoint.position[i]);
    run.velocities.push_back(row.setpoint.velocity[i]);
  }
}

}  // namespace

Simulation simulate_file(const std::string& file, const Machine& machine,
                         const SimulationOptions& options) {
  const MachineModel& model = machine.model();
  simulate::SimulateOptions simulation;
  simulation.settings = settings_of(options);
  const SmoothSettings& settings = simulation.settings;
  const std::string refusal =
      stream::refusal_of_tolerances(model, settings.transition.value_or(model.transition),
                                    settings.tip_tolerance_mm, settings.axis_tolerance_rad);
  if (!refusal.empty()) throw std::invalid_argument(refusal);
  cl::ClReaderOptions reading = reading_of(options, model);
  const ToolTable tools = tools_of(file, reading, options);
  reading.home = stream::home_pose(model, tools);
  reading.nc = nc::reader_of_programs(model, tools);
  const auto findings = stream::preflight(
      file, reading,
      stream::PreflightMachine{model, tools, "give tools or unknown_tool_length_mm"});
  if (findings.is_refused) throw std::invalid_argument(to_text(findings.findings, file));
  std::ifstream input(file, std::ios::binary);
  cl::ClReader reader(input, file, reading);
  Simulation run;
  run.joint_count = model.joint_count;
  run.report = simulate::simulate(reader, file, model, tools, simulation,
                                  [&run](const CycleRecord& row) { add_row(run, row); });
  run.text = to_text(run.report, model);
  return run;
}

}  // namespace meridian::python
