// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/machine_model.hpp"

namespace meridian::inspect {

/// Where a machine stood when its tool touched something. Units: mm, rad.
struct Touch {
  JointVector joints{};
  double tool_length_mm = 0;  ///< gauge line to tip
  double radius_mm = 0;       ///< of the tool
  bool is_ball = false;       ///< its end is a ball of that radius; else it is flat
  /// Which way the tool went to touch, a unit vector in the frame of the kinematics.
  Vector3 toward = Vector3::Zero();
};

/// A touch as a row of a file, and the row above all of them.
[[nodiscard]] std::string touch_header();
[[nodiscard]] std::string to_row(const Touch& touch);

/// Reads the rows of `text`, every number bit for bit; empty rows, the header and those that begin
/// with # are passed over. The error names file, line and what is wrong.
/// Proof: tests/unit/inspect/touches_test.cpp.
[[nodiscard]] Expected<std::vector<Touch>, std::string> read_touches(std::string_view text,
                                                                     const std::string& file);

/// Where `touch` held the tool, in the frame of the kinematics, wherever the workpiece lies.
[[nodiscard]] ToolPose pose_of(const Touch& touch, MachineModel machine);

}  // namespace meridian::inspect
