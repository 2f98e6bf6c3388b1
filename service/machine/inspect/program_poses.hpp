// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/programs/cl/cl_reader.hpp"

namespace meridian::inspect {

/// Where a program wants the tool, frame W.
struct ProgramPose {
  ToolPose pose;
  double tool_length_mm = 0;
  std::uint32_t line = 0;
  double feed_time_s = 0;  ///< from the pose before, by the feed alone; rapid: 0
};

/// Every pose that a program goes to, and poses between where arcs or turns of the tool axis lead
/// through others. A tool that `tools` has not keeps the length before it. The error is the
/// reader's first. Proof: tests/unit/inspect/placing_test.cpp.
[[nodiscard]] Expected<std::vector<ProgramPose>, cl::ClError> read_poses(cl::ClReader& reader,
                                                                         const MachineModel& model,
                                                                         const ToolTable& tools);

}  // namespace meridian::inspect
