// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/cl_block.hpp"
#include "service/core/planner/route/route_ahead.hpp"

namespace meridian {

/// How a robot stands where a program begins.
struct RobotStart {
  double tool_length_mm = 0;
  ToolPose pose{Vector3::Zero(), Vector3::UnitZ()};
  int branch = 0;
  JointVector joints{};
};

/// Returns how many of `blocks` a robot can follow from `start` until a joint leaves its travel,
/// the pose the reach, or the tool is changed. Nearer to a singular place than `slack` the
/// redundant joint is followed no further than out on either side of it, as a pass may lead
/// (RobotPass). Bounded work, no memory. Units: mm, rad. Proof:
/// tests/property/planner/robot_start_test.cpp.
[[nodiscard]] int follow_ahead(const MachineModel& model, const LookAheadSlack& slack,
                               const RobotStart& start, std::span<const ClBlock> blocks) noexcept;

}  // namespace meridian
