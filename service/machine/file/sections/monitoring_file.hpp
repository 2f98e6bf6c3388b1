// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/monitoring/monitored.hpp"
#include "service/machine/file/section.hpp"

namespace meridian::config {

/// Reads `[monitoring]` of `model`, whose joints and tolerances are read: what it does not say
/// comes from them (docs/machine-files.md). Throws ConfigError. Proof:
/// tests/unit/machine_file/monitoring_file_test.cpp.
[[nodiscard]] monitoring::Limits read_monitoring(Section section, const MachineModel& model);

/// The same from the machine file `path`, which load_machine() has taken.
[[nodiscard]] monitoring::Limits load_monitoring(const std::filesystem::path& path,
                                                 const MachineModel& model);

}  // namespace meridian::config
