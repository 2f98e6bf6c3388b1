// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/file/section.hpp"

namespace meridian::config {

/// The box of the tip of a machine file, [tip_box], which the tip of its own tool is in at home;
/// not set where the file has none. Throws ConfigError. Proof:
/// tests/unit/machine_file/tip_box_file_test.cpp.
[[nodiscard]] TipBox read_tip_box(Section& file, const MachineModel& model);

}  // namespace meridian::config
