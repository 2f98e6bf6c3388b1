// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/geometry/vector3.hpp"

namespace meridian::surface {

/// A milling cutter: flat (corner radius 0), toroidal, or ball end (corner radius half the
/// diameter). Units: mm.
struct Cutter {
  double diameter_mm = 10;
  double corner_radius_mm = 0;

  [[nodiscard]] bool is_ball() const { return 2.0 * corner_radius_mm >= diameter_mm; }
};

/// Returns the tool axis that leans by `lead_rad` in the feed direction and by `tilt_rad` to the
/// side, from the unit normal `normal`: K = Rot(f, tilt) Rot(N x f, lead) N, eq. 6.4. `feed` is a
/// direction in the tangent plane and need not be unit.
[[nodiscard]] Vector3 lean(const Vector3& normal, const Vector3& feed, double lead_rad,
                           double tilt_rad);

/// Returns the tool tip of a cutter that touches the surface in `contact` with its axis along
/// `axis`, eq. 6.3: tip = S + rc (N - K) + (D/2 - rc) e, e the unit part of N across K. For
/// K = N every point of a flat bottom touches; the tip is then the contact. All vectors unit.
[[nodiscard]] Vector3 tip_of_contact(const Cutter& cutter, const Vector3& contact,
                                     const Vector3& normal, const Vector3& axis);

/// Returns the largest concave curvature (1/mm) that the cutter reaches into at its contact with
/// its axis along `axis`: 1/rc at the corner for a torus, 1/R for a ball, and 0 for a flat end on
/// its face (every concave surface gouges it).
[[nodiscard]] double gouge_curvature(const Cutter& cutter, const Vector3& normal,
                                     const Vector3& axis);

}  // namespace meridian::surface
