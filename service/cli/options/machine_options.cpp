// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/machine_options.hpp"

#include <filesystem>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/sections/positions_file.hpp"
#include "service/machine/file/tool_names.hpp"
#include "service/programs/nc/nc_reader.hpp"
#include "service/protocol/operator/home_pose.hpp"

namespace meridian::cli {

void add_workpiece_options(CLI::App& command, MachineOptions& options) {
  command.add_option("--frame", options.frame,
                     "Where the workpiece lies: x,y,z[,a,b,c] in mm and deg, Rz(c) Ry(b) Rx(a); "
                     "instead of the machine file's frame");
  CLI::Option* const tools = command.add_option("--tools", options.tools,
                                                "Tool table (TOML) for programs that call tools");
  command
      .add_option("--tool", options.tool,
                  "Number of the tool that is in the spindle at the begin; instead of the machine "
                  "file's tool_length_mm")
      ->needs(tools)
      ->check(finite_positive());
}

void add_machine_options(CLI::App& command, MachineOptions& options, bool has_workpiece) {
  command.add_option("-m,--machine", options.machine, "Machine file (TOML)")->required();
  if (!has_workpiece) return;
  add_workpiece_options(command, options);
  add_unknown_tool_option(command, options);
}

CLI::Option* add_unknown_tool_option(CLI::App& command, MachineOptions& options) {
  return command
      .add_option("--unknown-tool-length", options.unknown_tool_length_mm,
                  "Length of every tool that the program calls and the table has not, mm")
      ->check(finite_range(0.0, 1e4));
}

MachineModel load_machine(const MachineOptions& options) {
  MachineModel model = config::load_machine(options.machine);
  if (!options.frame.empty()) {
    config::place_workpiece(model, config::parse_frame(options.frame));
  }
  if (options.tool > 0) {
    const ToolTable tools = load_tools(options);
    const Tool* const tool = tools.find(options.tool);
    if (tool == nullptr) {
      throw config::ConfigError({.file = options.tools,
                                 .value = "tool " + std::to_string(options.tool) + " is not there",
                                 .remedy = "name one of the table's after --tool"});
    }
    model.tool_length_mm = tool->tip_length_mm();
  }
  return model;
}

ToolTable load_tools(const MachineOptions& options) {
  return options.tools.empty() ? ToolTable() : config::load_tools(options.tools);
}

nc::NamedTools load_tool_names(const MachineOptions& options) {
  return options.tools.empty() ? nc::NamedTools() : config::load_tool_names(options.tools);
}

bool can_be_read_twice(const std::string& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error);
}

void add_unknown_tools(const std::string& file, const cl::ClReaderOptions& reader,
                       const MachineOptions& options, ToolTable& tools) {
  if (!options.unknown_tool_length_mm || !can_be_read_twice(file)) return;
  std::vector<Tool> all = tools.tools();
  for (const int number : stream::unknown_tools(file, reader, tools)) {
    all.push_back({number, *options.unknown_tool_length_mm, 0});
  }
  tools = ToolTable(std::move(all));
}

void describe_machine(cl::ClReaderOptions& reader, const MachineModel& model,
                      const ToolTable& tools, nc::NamedTools named) {
  reader.nc = nc::reader_of_programs(model, tools, std::move(named));
  reader.home = stream::home_pose(model, tools);
}

stream::PreflightReport read_through(const std::string& file, cl::ClReaderOptions& reader,
                                     const MachineOptions& options, const MachineModel& model,
                                     ToolTable& tools) {
  describe_machine(reader, model, tools, load_tool_names(options));
  add_unknown_tools(file, reader, options, tools);
  describe_machine(reader, model, tools, load_tool_names(options));
  if (!can_be_read_twice(file)) return {};
  return stream::preflight(
      file, reader,
      stream::PreflightMachine{model, tools, "give --tools FILE or --unknown-tool-length MM"});
}

bool pass_file(const std::string& file, cl::ClReaderOptions& reader, const MachineOptions& options,
               const MachineModel& model, ToolTable& tools) {
  const stream::PreflightReport report = read_through(file, reader, options, model, tools);
  std::cerr << to_text(report.findings, file);
  return !report.is_refused;
}

cl::ClReaderOptions reader_options(const ClFileOptions& file, const MachineOptions& machine,
                                   const MachineModel& model) {
  cl::ClReaderOptions out = reader_options(file);
  if (model.default_unit_mm) out.default_unit = cl::LengthUnit::kMillimetre;
  if (model.default_unit_inch) out.default_unit = cl::LengthUnit::kInch;
  out.max_feed_mm_per_s = model.max_feed_mm_per_s;
  out.positions = config::load_positions(machine.machine);
  out.nc = nc::reader_of_programs(model, ToolTable());
  return out;
}

}  // namespace meridian::cli
