// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "meridian/kinematics/soft_limits.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::cli {

/// The order of `words` (set, a joint and both ends in mm or degrees; clear and a joint, or clear
/// alone; keep-out, a name, and each joint of the box with both ends; open and a name, or open
/// alone; tip and two corners X,Y,Z over the base in mm; clear tip) for the joints that `machine`
/// names; or prints what is wrong.
[[nodiscard]] std::optional<LimitsOrder> limits_order(const std::vector<std::string>& words,
                                                      const dds::MachineInfo& machine);

/// A line for each joint with its travel in force, in mm or degrees, as `set` takes it; * before
/// those that are shrunk, their whole travel behind; then a line for each keep-out box that was put
/// up, and one for the tip box.
/// Proof: tests/unit/cli/limits_options_test.cpp.
[[nodiscard]] std::string limits_text(const dds::MachineInfo& machine);

}  // namespace meridian::cli
