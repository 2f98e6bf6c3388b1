// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <fstream>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include "meridian/planner/smooth_planner.hpp"
#include "service/programs/cl/cl_error.hpp"
#include "service/programs/cl/cl_options.hpp"

namespace meridian::cli {

/// The options about a CL file that every subcommand which reads one takes alike.
struct ClFileOptions {
  std::string units, dialect;
  std::string arc_sense = "form";
  std::string frame;
  std::optional<double> feed_mm_per_min;
  std::vector<std::string> allow_unknown;
  std::vector<std::string> work_zeros;
  bool allow_no_end = false;
  std::uint32_t first_line = 0;
};

/// Adds the file itself; - is standard input.
void add_cl_file(CLI::App& command, std::string& name);

/// Standard input for "-", else `file`, opened; null where that fails.
[[nodiscard]] std::istream* open_cl_file(const std::string& name, std::ifstream& file);

/// What the reader found odd and took nevertheless, a line each on standard error.
void print_warnings(const std::string& name, const std::vector<cl::ClWarning>& warnings);

/// Adds --dialect, --units, --feed, --allow-unknown, --allow-no-end, --arc-sense and
/// --from-line to `command`.
/// `dialect_name`: for a command to which --dialect is the dialect of its output.
void add_cl_file_options(CLI::App& command, ClFileOptions& options,
                         const char* dialect_name = "--dialect");

/// How the cuts of a program join, where not as the machine's file says.
struct JoinOptions {
  std::string transition;       ///< "": the machine's
  double tip_tolerance_mm = 0;  ///< 0: the machine's
  double axis_tolerance_deg = 0;
};
/// Adds --transition, --tip-tolerance-mm and --axis-tolerance-deg.
void add_join_options(CLI::App& command, JoinOptions& options);

/// What a program is planned with that is run with these options.
[[nodiscard]] SmoothSettings settings_of(const JoinOptions& join);

/// The options of both that were given, as they stand on a command line; without --from-line,
/// which is what changes where a program is gone on with.
[[nodiscard]] std::string options_text(const ClFileOptions& file, const JoinOptions& join);

/// Adds --frame, for commands that put out points in the frame of the kinematics.
void add_frame_option(CLI::App& command, ClFileOptions& options);

/// The options of the reader. A wrong --frame throws config::ConfigError.
[[nodiscard]] cl::ClReaderOptions reader_options(const ClFileOptions& options);

}  // namespace meridian::cli
