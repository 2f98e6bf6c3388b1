// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/machine/inspect/picture/machine_posture.hpp"

namespace meridian::inspect {

/// Draws a machine where it stands at these points of a program, in space and in three views, with
/// gnuplot: what carries the tool, the tool, what carries the workpiece, and of a hybrid machine
/// its sliders and rods; the first point pale, the last one dark. `file` ends in .png or .svg.
/// Returns what went wrong.
[[nodiscard]] std::optional<std::string> draw_along(const MachineModel& model,
                                                    const std::vector<MachinePosture>& postures,
                                                    const std::string& file);

}  // namespace meridian::inspect
