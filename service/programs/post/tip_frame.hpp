// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/expected.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/programs/post/axis_words.hpp"
#include "service/programs/post/post_options.hpp"

namespace meridian::post {

/// The program zero of tool-centre words: the joints that put the tip on the workpiece's origin
/// with every rotary joint at zero. What a work offset measures.
///
/// Refused where the words X Y Z do not move the tip along the machine's axes there, each its own
/// way: a controller with tool-centre control takes them for granted.
[[nodiscard]] Expected<JointVector, PostError> find_program_zero(const MachineModel& model,
                                                                 const AxisWords& words);

/// Whether the spindle stands along +Z of the machine with every rotary joint at zero, as nearly
/// every control with tool-centre control takes for granted.
[[nodiscard]] bool is_spindle_along_z(const MachineModel& model);

/// `pose` (W) as tool-centre words say it: from the origin of W, axes parallel to the machine's.
[[nodiscard]] ToolPose in_program(const MachineModel& model, const ToolPose& pose);

}  // namespace meridian::post
