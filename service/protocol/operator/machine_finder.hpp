// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "service/transport/convert/messages.hpp"

namespace meridian::stream {

/// Returns what services in the DDS domain say about the machines they serve, sorted by name; waits
/// up to `timeout` for the first and a moment longer for others. `machine`, where not empty, is the
/// only one that is looked for. A service that only claims a machine is left out. Throws DdsError.
[[nodiscard]] std::vector<dds::MachineInfo> find_machines(std::uint32_t domain,
                                                          const std::string& machine,
                                                          std::chrono::milliseconds timeout);

}  // namespace meridian::stream
