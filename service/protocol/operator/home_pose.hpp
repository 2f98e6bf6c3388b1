// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tool_table.hpp"

namespace meridian::stream {

/// Where the home of the machine puts tip and axis with a tool of the table in the spindle
/// (nothing: the one of the machine file), for a reader of programs (cl::ClReaderOptions::home).
[[nodiscard]] inline std::function<std::optional<ToolPose>(std::optional<std::uint32_t>)> home_pose(
    const MachineModel& model, const ToolTable& tools) {
  return [model, tools](std::optional<std::uint32_t> number) -> std::optional<ToolPose> {
    double length_mm = model.tool_length_mm;
    if (number) {
      const Tool* const tool = tools.find(static_cast<int>(*number));
      if (tool == nullptr) return std::nullopt;
      length_mm = tool->tip_length_mm();
    }
    JointVector home{};
    for (int i = 0; i < model.joint_count; ++i) home[i] = model.joints[i].home;
    return forward(model, length_mm, home);
  };
}

}  // namespace meridian::stream
