// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "meridian/kinematics/machine_model.hpp"

namespace meridian::ros {

/// The machine as a robot description (URDF): its links are the frames of scene::LinkFrames with
/// the same names, its joints those of the machine with their limits, its shapes the simple bodies
/// of scene::bodies_of; `tool` and `workpiece` are fixed where the model has them. Units: m, rad.
/// Proof: tests/unit/ros/urdf_test.cpp, and check_urdf for every machine file that is shipped.
[[nodiscard]] std::string urdf_of(const MachineModel& model);

}  // namespace meridian::ros
