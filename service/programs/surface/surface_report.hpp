// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "service/programs/surface/patch_file.hpp"
#include "service/programs/surface/surface_path.hpp"

namespace meridian::surface {

/// Cutters that bend less than the surface by no more than this are taken to fit it: what rounding
/// makes of a cutter of the surface's own radius. Units: 1/mm.
inline constexpr double kGougeCurvature = 1e-9;

/// What a path is like. Curvature radii are infinite where the surface nowhere curves that way.
/// Units: mm, rad, s.
struct SurfaceReport {
  std::size_t lines = 0;
  std::size_t contacts = 0;  ///< cut blocks after the plunge
  double length_mm = 0;      ///< path of the tip from first to last contact, on the surface
  double seconds_at_feed = 0;
  double convex_radius_mm = 0;   ///< smallest principal radius of curvature away from the cutter
  double concave_radius_mm = 0;  ///< smallest principal radius of curvature towards it
  double chord_error_mm = 0;     ///< of the lines
  double crossing_chord_error_mm = 0;  ///< of the ways between them
  double scallop_mm = 0;
  double largest_turn_rad = 0;                    ///< of the tool axis in one block
  double min_tilt_rad = 0, largest_tilt_rad = 0;  ///< of the tool axis from z
  std::size_t gouges = 0;  ///< contacts where the cutter bends less than the surface
  Contact worst_gouge{};
};

[[nodiscard]] SurfaceReport measure(const PatchJob& job, const SurfacePath& path);

[[nodiscard]] std::string to_text(const SurfaceReport& report, const PatchJob& job);

}  // namespace meridian::surface
