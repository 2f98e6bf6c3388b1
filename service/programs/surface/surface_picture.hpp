// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/programs/surface/patch_file.hpp"
#include "service/programs/surface/surface_path.hpp"
#include "service/programs/surface/wrist_points.hpp"

namespace meridian::surface {

/// Draws patch, path, tool axes, gouging contacts and `wrists` in space, the principal curvature
/// towards the cutter over the parameters, and the chord error of every block, with gnuplot. `file`
/// ends in .png or .svg. Returns what went wrong.
[[nodiscard]] std::optional<std::string> draw(const PatchJob& job, const SurfacePath& path,
                                              const std::vector<WristPoint>& wrists,
                                              const std::string& file);

}  // namespace meridian::surface
