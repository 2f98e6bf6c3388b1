// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "meridian/kinematics/tool_table.hpp"
#include "service/programs/cl/cl_error.hpp"
#include "service/programs/cl/cl_options.hpp"
#include "service/recording/record/check/path/checked_path.hpp"

namespace meridian::record {

/// Adds the program of a CL file to `path`, and what is odd about it to `warnings` where that is
/// given. Returns why the file is refused, everything that is in the way, a line each; empty where
/// it is not.
[[nodiscard]] std::string read_path(const std::string& file, const cl::ClReaderOptions& options,
                                    const ToolTable& tools, CheckedPath& path,
                                    std::vector<cl::ClWarning>* warnings = nullptr);

}  // namespace meridian::record
