// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "meridian/expected.hpp"
#include "meridian/kinematics/machine_model.hpp"

namespace meridian {

/// Reads a machine file (docs/machine-files.md) and checks everything in it. The error is one line
/// with file, line, key, value, what is allowed and the remedy. Link meridian::config.
/// Context: start-up. Proof: tests/unit/machine_file/load_machine_test.cpp.
[[nodiscard]] Expected<MachineModel, std::string> load_machine(const std::string& path);

}  // namespace meridian
