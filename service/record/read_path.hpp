// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "meridian/kinematics/tool_table.hpp"
#include "service/cl/cl_options.hpp"
#include "service/record/checked_path.hpp"

namespace meridian::record {

/// Adds the program of a CL file to `path`. Returns why the file is refused, empty where it is not.
[[nodiscard]] std::string read_path(const std::string& file, const cl::ClReaderOptions& options,
                                    const ToolTable& tools, CheckedPath& path);

}  // namespace meridian::record
