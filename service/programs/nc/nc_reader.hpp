// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/programs/cl/cl_options.hpp"
#include "service/programs/nc/tool_names.hpp"

namespace meridian::nc {

/// What teaches a reader of CL files NC programs (cl::ClReaderOptions::nc), without a machine:
/// rotary words under G43.4 are refused then.
[[nodiscard]] decltype(cl::ClReaderOptions::nc) reader_of_programs();

/// The same for programs of this machine, whose tools may be called by the names in `named`.
[[nodiscard]] decltype(cl::ClReaderOptions::nc) reader_of_programs(const MachineModel& model,
                                                                   const ToolTable& tools,
                                                                   NamedTools named = {});

}  // namespace meridian::nc
