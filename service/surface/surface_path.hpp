// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "service/surface/cutter.hpp"
#include "service/surface/nurbs_surface.hpp"

namespace meridian::surface {

/// How a cutter goes over a patch: forward lines along v, one beside the other along u, alternating
/// in direction (zigzag). Units: mm, rad, mm/s.
struct PathPlan {
  Cutter cutter;
  double lead_rad = 0, tilt_rad = 0;
  double feed_mm_per_s = 20;
  int lines = 21;            ///< 0: as many as `scallop_mm` asks for
  int points_per_line = 21;  ///< 0: as many as `chord_tolerance_mm` asks for
  double scallop_mm = 0.01;
  double chord_tolerance_mm = 0.005;
};

/// One cutter location with the contact that it comes from.
struct SurfacePoint {
  double u, v;
  Vector3 contact, normal, tip, axis;
  int line;  ///< from 0
};

/// The path, and what its author should know about it.
struct SurfacePath {
  std::vector<SurfacePoint> points;
  int lines = 0;
  double length_mm = 0;
  double largest_chord_error_mm =
      0;                          ///< tip chord from the true tip curve, between points of a line
  double largest_scallop_mm = 0;  ///< between neighbouring lines, from the step and the curvatures
  double least_concave_radius_mm = 0;  ///< 0: the patch is concave nowhere
  struct Gouge {
    double u, v, surface_radius_mm, cutter_radius_mm;
  };
  std::vector<Gouge> gouges;  ///< points where the cutter is blunter than the surface
};

/// Walks over the patch. Throws std::invalid_argument where the plan makes no sense for the cutter
/// (no step, a negative tolerance, a flat end that must bound its scallop without lead or tilt).
/// Source: docs/kinematics.md, chapter 6. Proof: tests/unit/surface/surface_path_test.cpp.
[[nodiscard]] SurfacePath walk(const NurbsSurface& patch, const PathPlan& plan);

}  // namespace meridian::surface
