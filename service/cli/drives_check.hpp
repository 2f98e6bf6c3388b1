// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "service/drives/simulated/check/drive_check.hpp"
#include "service/transport/participant.hpp"

namespace meridian::cli {

/// `meridian drives --check`: plays the service against the drives of `participant`'s machine and
/// prints which rules they break. Returns the exit code.
[[nodiscard]] int check_drives(const dds::ParticipantOptions& participant,
                               const MachineModel& model, drives::Operator operator_is);

}  // namespace meridian::cli
