// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/cl/cl_error.hpp"
#include "service/cl/cl_options.hpp"
#include "service/stream/time_table.hpp"

namespace meridian::stream {

/// The machine that a file is judged for.
struct PreflightMachine {
  MachineModel model;
  std::optional<ToolTable> tools;  ///< nothing: not known here, the service judges tools
};

/// What is known about a CL file after it was read once.
struct PreflightReport {
  std::string refusal;  ///< empty: the file is fine
  std::uint64_t blocks = 0;
  bool contains_actions = false;
  std::vector<cl::ClWarning> warnings;
  TimeTable times;  ///< at programmed feeds
};

/// Reads the whole of a CL file and judges every block as the service will, reach and travel
/// included where `machine` is given. A file that cannot be opened is refused. Action words pass:
/// whether somebody answers them is the service's to know.
/// Proof: tests/unit/stream/preflight_test.cpp.
[[nodiscard]] PreflightReport preflight(const std::string& file, const cl::ClReaderOptions& options,
                                        const std::optional<PreflightMachine>& machine);

}  // namespace meridian::stream
