// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

/// One subcommand of `meridian` is one file X_command.cpp, a namespace of its own with one function
///
///     void meridian::cli::X_command::add(CLI::App& app, int& exit_code);
///
/// which adds the subcommand X with its options to `app` and leaves its verdict in `exit_code` when
/// it has run. It reads options, calls its room and prints; the logic is the room's. A line
/// meridian_command(X rooms...) in this folder's CMakeLists.txt makes it part of the tool.
namespace meridian::cli {

/// Exit codes of the tool (`meridian --help`).
enum ExitCode : int {
  kFine = 0,
  kVerdictNo = 1,       ///< the command ran; what it checked is not in order
  kUsage = 2,           ///< options that make no sense
  kInputRefused = 3,    ///< a file that cannot be read or is not what it should be
  kMachineRefused = 4,  ///< the service said no; its reason is printed
  kNoPeer = 5           ///< nobody to talk to
};

/// Adds every subcommand that this build has, in the order of CMakeLists.txt. Generated.
void add_commands(CLI::App& app, int& exit_code);

}  // namespace meridian::cli
