// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/file/section.hpp"

namespace meridian::config {

/// Reads [kinematics] and the joints that its family has: `lai` by its table, `chain` joint by
/// joint from the workpiece to the tool, `robot5` and `robot6` by their lengths. Throws
/// ConfigError.
void read_kinematics(Section table, Section& joints, MachineModel& model);

/// Reads travel, limits and following error of a joint or drive, linear or rotary as it says.
void read_limits(Section& section, JointSpec& joint);

/// Reads the address that NC programs call a joint or drive by, where there is one.
void read_nc_word(Section& section, JointSpec& joint);

/// Reads limits and home of one joint; name and kind are set. Refuses every key that is not a limit
/// and was not asked for before.
void read_joint(Section section, JointSpec& joint);

}  // namespace meridian::config
