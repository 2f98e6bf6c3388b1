// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/shape/surface_shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace meridian::surface {
namespace {

/// Shortest derivative, as a share of patch size over domain, and smallest sine between the two
/// derivatives from which a normal is still good to about 1e-7 rad.
constexpr double kSingular = 1e-9;

}  // namespace

std::optional<SurfaceShape> shape_at(const NurbsSurface& surface, double u, double v,
                                     bool is_flipped) noexcept {
  const SurfacePoint s = surface.evaluate(u, v);
  const auto [u0, u1] = surface.domain_u();
  const auto [v0, v1] = surface.domain_v();
  const double length_u = s.du.norm(), length_v = s.dv.norm();
  const double min = kSingular * surface.size_mm();
  if (!(length_u * (u1 - u0) > min && length_v * (v1 - v0) > min)) return std::nullopt;
  SurfaceShape out;
  out.at = s.at;
  out.tangent_u = s.du / length_u;
  out.tangent_v = s.dv / length_v;
  const Vector3 across = out.tangent_u.cross(s.dv);
  const double breadth = across.norm();
  if (!(breadth > kSingular * length_v)) return std::nullopt;
  out.normal = across / (is_flipped ? -breadth : breadth);
  out.tangent_2 = out.normal.cross(out.tangent_u);
  // Both tangents as sums of du and dv (eq. 1.7): tangent_u = du / length_u, tangent_2 = a du + b
  // dv.
  const double b = 1.0 / s.dv.dot(out.tangent_2);
  const double a = -b * s.dv.dot(out.tangent_u) / length_u;
  const double l = s.duu.dot(out.normal), m = s.duv.dot(out.normal), n = s.dvv.dot(out.normal);
  const double k11 = l / (length_u * length_u);
  const double k12 = (l * a + m * b) / length_u;
  const double k22 = l * a * a + 2 * m * a * b + n * b * b;
  out.curvature << k11, k12, k12, k22;
  const double middle = 0.5 * (k11 + k22), radius = std::hypot(0.5 * (k11 - k22), k12);
  out.min_curvature = middle - radius;
  out.largest_curvature = middle + radius;
  return out;
}

Foot nearest_foot(const NurbsSurface& surface, const Vector3& point, double u, double v) noexcept {
  constexpr int kSteps = 12;
  const auto [u0, u1] = surface.domain_u();
  const auto [v0, v1] = surface.domain_v();
  Foot best;
  for (int step = 0; step < kSteps; ++step) {
    const SurfacePoint s = surface.evaluate(u, v);
    const Vector3 gap = s.at - point;
    if (gap.norm() >= best.distance_mm) break;
    best = {u, v, gap.norm()};
    // Half the squared distance: gradient, and Hessian where it is positive, else Gauss and
    // Newton's.
    const double gu = gap.dot(s.du), gv = gap.dot(s.dv);
    double huu = s.du.squaredNorm() + gap.dot(s.duu), hvv = s.dv.squaredNorm() + gap.dot(s.dvv);
    double huv = s.du.dot(s.dv) + gap.dot(s.duv);
    if (!(huu > 0 && huu * hvv > huv * huv)) {
      huu = s.du.squaredNorm();
      hvv = s.dv.squaredNorm();
      huv = s.du.dot(s.dv);
    }
    const double determinant = huu * hvv - huv * huv;
    if (!(determinant > 0)) break;
    u = std::clamp(u - (hvv * gu - huv * gv) / determinant, u0, u1);
    v = std::clamp(v - (huu * gv - huv * gu) / determinant, v0, v1);
  }
  return best;
}

}  // namespace meridian::surface
