// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/programs/cl/cl_options.hpp"
#include "service/programs/cl/findings.hpp"
#include "service/protocol/time_table.hpp"

namespace meridian::stream {

/// The machine that a file is checked for.
struct PreflightMachine {
  MachineModel model;
  std::optional<ToolTable> tools;  ///< nothing: not known here, the service checks tools
  std::string tool_remedy = "add it to the tool table of the service";  ///< for unknown tools
  std::map<int, Vector3> work_zeros{};  ///< of its work frames (cl::ClReaderOptions::work_offsets)
  std::map<std::string, std::vector<double>>
      positions{};  ///< by name (cl::ClReaderOptions::positions)
};

/// What is known about a CL file after it was read once.
struct PreflightReport {
  bool is_refused = false;
  std::vector<cl::Finding> findings;  ///< all of them, warnings too, by line
  std::uint64_t blocks = 0;
  bool contains_actions = false;
  TimeTable times;  ///< at programmed feeds
};

/// Reads the whole of a CL file and checks every block as the service will, reach and travel
/// included where `machine` is given: everything that is wrong with it is found in one pass. Behind
/// an unknown tool reach is not checked, as its length is not known. A file that cannot be opened
/// is refused. Action words pass: whether somebody answers them is the service's to know. Proof:
/// tests/unit/protocol/preflight_test.cpp.
[[nodiscard]] PreflightReport preflight(const std::string& file, const cl::ClReaderOptions& options,
                                        const std::optional<PreflightMachine>& machine);

/// Numbers of the tools that the file calls and `tools` has not; none where it cannot be opened.
[[nodiscard]] std::vector<int> unknown_tools(const std::string& file,
                                             const cl::ClReaderOptions& options,
                                             const ToolTable& tools);

}  // namespace meridian::stream
