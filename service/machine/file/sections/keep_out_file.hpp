// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/machine_model.hpp"
#include "service/machine/file/section.hpp"

namespace meridian::config {

/// The keep-out boxes of a machine file, [[keep_out]], for the joints of `model`.
/// Throws ConfigError. Proof: tests/unit/machine_file/keep_out_file_test.cpp.
[[nodiscard]] KeepOut read_keep_out(Section& file, const MachineModel& model);

}  // namespace meridian::config
