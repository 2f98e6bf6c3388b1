// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "meridian/geometry/rigid_transform.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "meridian/kinematics/work_frame.hpp"
#include "service/machine/file/config_error.hpp"

namespace meridian::config {

/// Reads a machine file (docs/machine-files.md) and checks everything in it. A file that is wrong
/// in any way, unknown keys included, throws ConfigError; what is returned needs no further check.
/// Proof: tests/unit/machine_file/machine_file_test.cpp.
[[nodiscard]] MachineModel load_machine(const std::filesystem::path& path);

/// The same for the text of a machine file, as a service publishes it; `name` is what messages call
/// it.
[[nodiscard]] MachineModel parse_machine(std::string_view text, const std::string& name);

/// Reads a tool table: [[tool]] with number, length_mm, radius_mm, and where it has them
/// corner_radius_mm, length_wear_mm, radius_wear_mm, holder_mm. Throws ConfigError.
/// Proof: tests/unit/machine_file/tool_file_test.cpp.
[[nodiscard]] ToolTable load_tools(const std::filesystem::path& path);
[[nodiscard]] ToolTable parse_tools(std::string_view text, const std::string& name);
/// The table as the text of a file, with what its tools are called (tool_names.hpp); parse_tools()
/// gives it back bit for bit.
[[nodiscard]] std::string to_text(const ToolTable& tools,
                                  const std::map<std::string, std::uint32_t>& names = {});

/// Reads `x,y,z` or `x,y,z,a,b,c` (mm and deg), the argument of --frame. Throws ConfigError whose
/// file is `--frame`. Proof: tests/unit/machine_file/frame_test.cpp.
[[nodiscard]] RigidTransform parse_frame(std::string_view text);

/// The same six numbers as a row of the set-up has them: equal numbers give equal bits.
[[nodiscard]] std::array<double, 6> parse_frame_values(std::string_view text);
[[nodiscard]] RigidTransform frame_of(const WorkFrame& row);

/// Puts the workpiece of `model` at `frame`.
void place_workpiece(MachineModel& model, const RigidTransform& X_MW);

/// Returns the rotation Rz(c) Ry(b) Rx(a) of angles in degrees; multiples of 90° are exact.
[[nodiscard]] Eigen::Matrix3d rotation_from_deg(double a_deg, double b_deg, double c_deg);

}  // namespace meridian::config
