// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "meridian/kinematics/machine_model.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::cli {

/// The machine as its service publishes it: its file, with the work frame and the soft limits that
/// are in force. Nothing where the file is longer than fits into the topic. Throws
/// config::ConfigError.
[[nodiscard]] std::optional<MachineModel> reported_machine(const dds::MachineInfo& info);

}  // namespace meridian::cli
