// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "service/programs/cl/cl_options.hpp"
#include "service/protocol/station/preflight.hpp"
#include "service/transport/convert/messages.hpp"

/// What a program will do on the machine that its service reports, before anything moves.
namespace meridian::panel {

/// The machine as its service reports it. Throws config::ConfigError where the file did not fit
/// the topic.
[[nodiscard]] stream::PreflightMachine reported_machine(const dds::MachineInfo& info);

/// How a program is read for `machine`; it begins with `first_line`, 0: with its first.
[[nodiscard]] cl::ClReaderOptions reader_for(const stream::PreflightMachine& machine,
                                             std::uint32_t first_line);

/// Where on the machine a program would fit that does not where the workpiece is: a frame as
/// `meridian ctl frame set N --at` takes it, and the margin, in words. Empty: that cannot be said
/// (a program that cannot be read, or one of more than kMaxPlacedBlocks).
/// Proof: tests/panel/program_preview_test.cpp.
[[nodiscard]] std::string find_where_it_fits(const std::string& file,
                                             const cl::ClReaderOptions& reader,
                                             const stream::PreflightMachine& machine);
inline constexpr std::uint64_t kMaxPlacedBlocks = 100'000;

/// A program that ran in the simulator. Units: s.
struct SimulatedProgram {
  bool has_run = false;  ///< to its end
  std::string reason;    ///< why it did not
  double approach_s = 0, program_s = 0, waiting_s = 0;
  std::vector<std::string> limits;  ///< names of the limits that points of the path have
  std::string path;                 ///< ProgramPath::bytes()
};

/// Runs a program from the home of the machine, as the service would. Nothing where
/// `is_overtaken` said so, which is asked now and then. Proof:
/// tests/panel/program_preview_test.cpp.
[[nodiscard]] std::optional<SimulatedProgram> simulate_program(
    const std::string& file, const cl::ClReaderOptions& reader,
    const stream::PreflightMachine& machine, const std::function<bool()>& is_overtaken);

}  // namespace meridian::panel
