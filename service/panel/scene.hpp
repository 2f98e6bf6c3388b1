// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/soft_limits.hpp"
#include "meridian/kinematics/tool_table.hpp"
#include "service/machine/file/sections/mesh_file.hpp"

/// What a picture of a machine needs, worked out from its model alone.
namespace meridian::panel {

/// Returns `model` as JSON for the page: joints as screws in the machine frame M, which is the
/// frame of the kinematics with every joint at zero. A joint moves what it carries by `direction`
/// times its value, or turns it about the line through `point`; `head` lists the joints from the
/// base to the tool, `table` from the base to the workpiece. So in M
///
///     X_MT = exp(head 1) ... exp(head n) home_T      X_MW = exp(table 1) ... exp(table n) home_W
///
/// and the tip in W is forward() of the kinematics. Bodies are drawn by the travel of `model`;
/// `soft_limits` stand beside it, and the boxes of both; `meshes` are named with the joint that
/// they hang on. Units: mm, rad, s. Off the real-time path. Source: docs/kinematics.md, chapters 2,
/// 4 and 5. Proof: tests/panel/scene_test.js, tests/panel/scene_limits_test.cpp.
[[nodiscard]] std::string describe_scene(const MachineModel& model, const ToolTable& tools,
                                         const SoftLimits& soft_limits = {},
                                         const std::vector<config::Mesh>& meshes = {});

}  // namespace meridian::panel
