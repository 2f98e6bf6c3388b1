// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "service/machine/inspect/picture/skeleton.hpp"

namespace meridian::inspect {

/// Draws axes, pivots, tool and workpiece frame in space and in three views, with gnuplot; arrows
/// show positive motion. `file` ends in .png or .svg. Returns what went wrong.
[[nodiscard]] std::optional<std::string> draw(const MachineModel& model, const Skeleton& skeleton,
                                              const std::string& file);

}  // namespace meridian::inspect
