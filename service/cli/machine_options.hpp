// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/cl/cl_options.hpp"
#include "service/cli/cl_options.hpp"

namespace meridian::cli {

/// The options about a machine that every subcommand which computes its motion takes alike.
struct MachineOptions {
  std::string machine;
  std::string tools;
  std::string frame;
  int tool = 0;  ///< of the table, in the spindle at the begin; 0: that of the machine file
};

/// Adds --machine and, where a workpiece is cut, --frame, --tools and --tool.
void add_machine_options(CLI::App& command, MachineOptions& options, bool has_workpiece);

/// The machine with its workpiece in place and its tool in the spindle. Throws config::ConfigError.
[[nodiscard]] MachineModel load_machine(const MachineOptions& options);
/// Empty where no table is named. Throws config::ConfigError.
[[nodiscard]] ToolTable load_tools(const MachineOptions& options);

/// What a reader is told about a CL file that is cut on this machine.
[[nodiscard]] cl::ClReaderOptions reader_options(const ClFileOptions& file,
                                                 const MachineModel& model);

}  // namespace meridian::cli
