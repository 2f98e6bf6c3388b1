// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/file/section.hpp"

namespace meridian::config {

/// Reads [stage], the actuator stage between two of the joints and their drives; the joints have
/// been read. What is accepted has no dead point and one assembly mode as far as it turns, and its
/// rotary joint's travel ends before. Throws ConfigError.
/// Proof: tests/unit/machine_file/machine_file_test.cpp, wrong_machine_file_test.cpp.
void read_stage(Section table, MachineModel& model);

}  // namespace meridian::config
