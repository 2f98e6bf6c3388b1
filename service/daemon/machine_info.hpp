// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "service/daemon/service.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::interpolator {

/// What the service `service_id` publishes of its machine as it starts, before any set-up: names,
/// limits, workpiece frame, and the texts of machine file and tool table where they fit the topic.
[[nodiscard]] dds::MachineInfo machine_info(const ServiceParts& parts, std::uint64_t service_id);

}  // namespace meridian::interpolator
