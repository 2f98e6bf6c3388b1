// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/cli/options/cl_options.hpp"
#include "service/programs/cl/cl_options.hpp"
#include "service/programs/nc/tool_names.hpp"
#include "service/protocol/station/preflight.hpp"

namespace meridian::cli {

/// The options about a machine that every subcommand which computes its motion takes alike.
struct MachineOptions {
  std::string machine;
  std::string tools;
  std::string frame;
  std::optional<double> unknown_tool_length_mm;
  int tool = 0;  ///< of the table, in the spindle at the begin; 0: that of the machine file
};

/// Adds --frame, --tools and --tool: where the workpiece lies and what is in the spindle.
void add_workpiece_options(CLI::App& command, MachineOptions& options);

/// Adds --machine and, where a workpiece is cut, --frame, --tools, --tool and
/// --unknown-tool-length.
void add_machine_options(CLI::App& command, MachineOptions& options, bool has_workpiece);

CLI::Option* add_unknown_tool_option(CLI::App& command, MachineOptions& options);

/// The machine with its workpiece in place and its tool in the spindle. Throws config::ConfigError.
[[nodiscard]] MachineModel load_machine(const MachineOptions& options);
/// Empty where no table is named. Throws config::ConfigError.
[[nodiscard]] ToolTable load_tools(const MachineOptions& options);

/// Gives a reader where GOHOME leads: tip and axis of the machine's home with the tool in the
/// spindle; and what the axis words of NC programs do.
void describe_machine(cl::ClReaderOptions& reader, const MachineModel& model,
                      const ToolTable& tools, nc::NamedTools named = {});
/// The tools of the table that have names. Throws config::ConfigError.
[[nodiscard]] nc::NamedTools load_tool_names(const MachineOptions& options);

/// Whether the file can be read a second time: no pipe.
[[nodiscard]] bool can_be_read_twice(const std::string& file);

/// Tools that the file calls and the table has not join it where the options give their length.
void add_unknown_tools(const std::string& file, const cl::ClReaderOptions& reader,
                       const MachineOptions& options, ToolTable& tools);

/// Reads the whole file first: everything that is in the way of it on this machine, and what is
/// odd. A pipe passes: what is wrong there is found on the way. Adds unknown tools and
/// the machine's home to `reader`.
[[nodiscard]] stream::PreflightReport read_through(const std::string& file,
                                                   cl::ClReaderOptions& reader,
                                                   const MachineOptions& options,
                                                   const MachineModel& model, ToolTable& tools);
/// The same, and says it on standard error; false where the file is refused.
[[nodiscard]] bool pass_file(const std::string& file, cl::ClReaderOptions& reader,
                             const MachineOptions& options, const MachineModel& model,
                             ToolTable& tools);

/// What a reader knows of a CL file that is cut on this machine.
[[nodiscard]] cl::ClReaderOptions reader_options(const ClFileOptions& file,
                                                 const MachineOptions& machine,
                                                 const MachineModel& model);

}  // namespace meridian::cli
