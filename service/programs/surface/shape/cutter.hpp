// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "meridian/geometry/vector3.hpp"
#include "service/programs/surface/shape/surface_shape.hpp"

namespace meridian::surface {

/// A cutter of revolution with a rounded corner: ball end where the corner radius is half the
/// diameter, flat end where it is zero, toroidal between. Its tip is where its axis leaves it.
/// Units: mm.
struct Cutter {
  double diameter_mm = 10;
  double corner_radius_mm = 5;

  [[nodiscard]] double radius_mm() const noexcept { return 0.5 * diameter_mm; }
  [[nodiscard]] bool is_ball() const noexcept { return 2 * corner_radius_mm >= diameter_mm; }
};

/// Tool axis from the unit normal, leant by `lead_rad` towards the unit feed direction (in the
/// tangent plane), then by `tilt_rad` about it, away from normal x feed. Source: docs/surface.md,
/// eq. 2.1. Proof: tests/unit/surface/cutter_test.cpp.
[[nodiscard]] Vector3 leant_axis(const Vector3& normal, const Vector3& feed, double lead_rad,
                                 double tilt_rad) noexcept;

/// Tool pose whose cutter touches the surface at `contact` with unit `normal`, axis as given. A
/// cutter that stands on its flat bottom touches with the middle of it. Source: docs/surface.md,
/// eq. 2.2. Proof: tests/unit/surface/cutter_test.cpp; corpus N_torus_cl.csv.
[[nodiscard]] ToolPose touching(const Cutter& cutter, const Vector3& contact, const Vector3& normal,
                                const Vector3& axis) noexcept;

/// Curvature of the cutter where it touches, in the tangent plane of `shape`, as a matrix like
/// SurfaceShape::curvature. Zero where it stands on its flat bottom; a sharp corner counts as one
/// of a nanometre's radius. Source: docs/surface.md, eq. 2.3. Units: 1/mm.
[[nodiscard]] Eigen::Matrix2d curvature_of(const Cutter& cutter, const SurfaceShape& shape,
                                           const Vector3& axis) noexcept;

/// Least curvature, over all directions, by which the cutter bends more than the surface; negative:
/// the cutter cuts into it. Source: docs/surface.md, eq. 2.4. Units: 1/mm.
[[nodiscard]] double clearance_curvature(const Cutter& cutter, const SurfaceShape& shape,
                                         const Vector3& axis) noexcept;

}  // namespace meridian::surface
