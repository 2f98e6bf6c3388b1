// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/cl_block.hpp"

namespace meridian::inspect {

/// A CL program that moves every joint alone: from trial_joints() in small steps forwards (10 mm or
/// 5 degrees, backwards where travel ends) and back, one joint after the other, in rapids. Straight
/// blocks stand for a rotary joint's arcs, so the linear joints follow by some micrometres; joints
/// that the pose does not show (the spin of a 6R) rest. Frame: W. Proof:
/// tests/unit/inspect/inspect_test.cpp.
[[nodiscard]] std::vector<ClBlock> joint_pattern(const MachineModel& model);

/// Writes it as an APT CL file with a comment in front of each joint.
void write_joint_pattern(const MachineModel& model, std::ostream& out);

}  // namespace meridian::inspect
