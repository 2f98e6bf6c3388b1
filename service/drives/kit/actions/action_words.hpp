// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "service/transport/convert/messages.hpp"

namespace meridian::drive {

/// Returns "spindle clockwise 8000 rev/min" and the like.
[[nodiscard]] std::string describe(const dds::Action& action);

}  // namespace meridian::drive
