// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/cli/options/cl_options.hpp"
#include "service/cli/options/machine_options.hpp"
#include "service/machine/inspect/program_poses.hpp"

namespace meridian::cli {

/// The options of `meridian machine --place`.
struct PlacingOptions {
  std::string program, box;
  bool may_turn = false;    ///< about z
  bool is_fastest = false;  ///< the least time is looked for, not the largest margin
};

/// Adds --place, which is returned, --box, --turn and --fastest.
CLI::Option* add_placing_options(CLI::App& command, PlacingOptions& options);

/// Every pose of program `name`, or why it cannot be read. Throws config::ConfigError.
[[nodiscard]] Expected<std::vector<inspect::ProgramPose>, std::string> read_program_poses(
    const std::string& name, const ClFileOptions& cl, const MachineOptions& machine,
    const MachineModel& model);

/// Looks for a frame in which the whole program fits and prints it. The exit code, or why the
/// program cannot be read. Throws config::ConfigError.
[[nodiscard]] Expected<int, std::string> run_placing(const PlacingOptions& options,
                                                     const ClFileOptions& cl,
                                                     const MachineOptions& machine,
                                                     const MachineModel& model);

}  // namespace meridian::cli
