// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>

#include "service/programs/surface/shape/nurbs_surface.hpp"

namespace meridian::surface {

/// How a surface lies and bends at one point. Curvatures are positive where the surface curves
/// towards its normal (concave for a cutter on that side). Units: mm, 1/mm. Frame: W.
struct SurfaceShape {
  Vector3 at, normal;            ///< normal is unit
  Vector3 tangent_u, tangent_v;  ///< unit, along growing u and growing v
  Vector3 tangent_2;             ///< normal x tangent_u
  Eigen::Matrix2d curvature;     ///< second fundamental form in (tangent_u, tangent_2)
  double min_curvature = 0;      ///< principal
  double largest_curvature = 0;  ///< principal

  /// Curvature of the normal section along the unit tangent `t`.
  [[nodiscard]] double curvature_along(const Vector3& t) const noexcept {
    const Eigen::Vector2d d{t.dot(tangent_u), t.dot(tangent_2)};
    return d.dot(curvature * d);
  }
};

/// Shape at (u, v); the normal is du x dv, turned round where `is_flipped`. None where the surface
/// has no normal to rely on: at a pole, where an edge has shrunk to a point, or where both
/// derivatives run the same way. `surface` gives the scale by which that is checked.
///
/// Source: docs/surface.md, eq. 1.6 to 1.9. Proof: tests/unit/surface/nurbs_surface_test.cpp.
[[nodiscard]] std::optional<SurfaceShape> shape_at(const NurbsSurface& surface, double u, double v,
                                                   bool is_flipped) noexcept;

/// Distance from `point` to the surface, from the parameters (u, v) on by Newton's method, and the
/// parameters of its foot, which stay inside the domain.
struct Foot {
  double u = 0, v = 0, distance_mm = std::numeric_limits<double>::infinity();
};
[[nodiscard]] Foot nearest_foot(const NurbsSurface& surface, const Vector3& point, double u,
                                double v) noexcept;

}  // namespace meridian::surface
