// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/shape/cutter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace meridian::surface {
namespace {

/// Smaller sines between axis and normal are flat bottom on surface.
constexpr double kStandsFlat = 1e-9;
constexpr double kSharpCorner_mm = 1e-6;

}  // namespace

Vector3 leant_axis(const Vector3& normal, const Vector3& feed, double lead_rad,
                   double tilt_rad) noexcept {
  const Vector3 side = normal.cross(feed);
  const Vector3 leading = std::cos(lead_rad) * normal + std::sin(lead_rad) * feed;
  const double upright = leading.dot(normal);  // what the tilt about `feed` turns
  return (leading + upright * ((std::cos(tilt_rad) - 1) * normal - std::sin(tilt_rad) * side))
      .normalized();
}

ToolPose touching(const Cutter& cutter, const Vector3& contact, const Vector3& normal,
                  const Vector3& axis) noexcept {
  const double corner = std::min(cutter.corner_radius_mm, cutter.radius_mm());
  Vector3 tip = contact + corner * (normal - axis);
  const Vector3 outward = normal - normal.dot(axis) * axis;
  const double sine = outward.norm();
  if (sine > kStandsFlat) tip += (cutter.radius_mm() - corner) / sine * outward;
  return {tip, axis};
}

Eigen::Matrix2d curvature_of(const Cutter& cutter, const SurfaceShape& shape,
                             const Vector3& axis) noexcept {
  const double corner = std::clamp(cutter.corner_radius_mm, kSharpCorner_mm, cutter.radius_mm());
  if (cutter.is_ball()) return Eigen::Matrix2d::Identity() / corner;
  const Eigen::Vector2d lean{axis.dot(shape.tangent_u), axis.dot(shape.tangent_2)};
  const double sine = lean.norm();
  if (!(sine > kStandsFlat)) return Eigen::Matrix2d::Zero();
  const Eigen::Vector2d meridian = lean / sine;
  const Eigen::Matrix2d along = meridian * meridian.transpose();
  const double parallel = sine / (cutter.radius_mm() - corner + corner * sine);
  return along / corner + parallel * (Eigen::Matrix2d::Identity() - along);
}

double clearance_curvature(const Cutter& cutter, const SurfaceShape& shape,
                           const Vector3& axis) noexcept {
  const Eigen::Matrix2d more = curvature_of(cutter, shape, axis) - shape.curvature;
  return 0.5 * (more(0, 0) + more(1, 1)) - std::hypot(0.5 * (more(0, 0) - more(1, 1)), more(0, 1));
}

}  // namespace meridian::surface
