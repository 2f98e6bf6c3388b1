// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "meridian/drive.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/drives/kit/group.hpp"

namespace meridian::drive {

/// The axes of a machine in drive order; those of an actuator stage in place of the joints
/// that it carries.
[[nodiscard]] std::vector<Axis> axes_of_model(const MachineModel& model);
/// The checked model of a machine file. Throws DriveError.
[[nodiscard]] MachineModel load_model(const std::string& machine_file);

/// What is asked for, filled up from the machine file and checked: joints that are none, twice or
/// too many, searches that have no velocity, numbers that are none. Throws DriveError.
/// Proof: tests/unit/drive_kit/machine_axes_test.cpp.
[[nodiscard]] Options complete(const Options& asked);

/// The group of complete options, whose axes stand where `hardware` reads them.
[[nodiscard]] GroupSpec group_of(const Options& options, Hardware& hardware);

}  // namespace meridian::drive
