// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"

namespace meridian::inspect {

/// Adds a warning for every number of a machine file whose unit can hardly be meant: rad for deg,
/// inch or m for mm, minutes for seconds; and for a word of NC programs that two joints have.
void find_unit_slips(const MachineModel& model, std::vector<std::string>& warnings);

}  // namespace meridian::inspect
