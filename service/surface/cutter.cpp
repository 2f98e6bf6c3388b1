// SPDX-License-Identifier: Apache-2.0
#include "service/surface/cutter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace meridian::surface {
namespace {

/// Below this sine of the lean the bottom of the cutter lies flat on the surface.
constexpr double kFlat = 1e-9;

}  // namespace

Vector3 lean(const Vector3& normal, const Vector3& feed, double lead_rad, double tilt_rad) {
  const Vector3 forward = feed.normalized();
  const Eigen::AngleAxisd lead(lead_rad, normal.cross(forward).normalized());
  const Eigen::AngleAxisd tilt(tilt_rad, forward);
  return (tilt * (lead * normal)).normalized();
}

Vector3 tip_of_contact(const Cutter& cutter, const Vector3& contact, const Vector3& normal,
                       const Vector3& axis) {
  const Vector3 across = normal - normal.dot(axis) * axis;
  const double sine = across.norm();
  if (sine < kFlat && !cutter.is_ball()) return contact;
  const double rc = cutter.corner_radius_mm;
  const Vector3 corner = contact + rc * (normal - axis);
  return sine < kFlat ? corner : Vector3(corner + (0.5 * cutter.diameter_mm - rc) / sine * across);
}

double gouge_curvature(const Cutter& cutter, const Vector3& normal, const Vector3& axis) {
  if (cutter.is_ball()) return 2.0 / cutter.diameter_mm;
  const double sine = normal.cross(axis).norm();
  if (sine < kFlat) return 0.0;
  // across the feed the cutter's bottom circle shows the radius (D/2 - rc)/sin(lean) + rc
  const double wide =
      (0.5 * cutter.diameter_mm - cutter.corner_radius_mm) / sine + cutter.corner_radius_mm;
  return std::min(1.0 / wide,
                  cutter.corner_radius_mm > 0 ? 1.0 / cutter.corner_radius_mm : 1.0 / wide);
}

}  // namespace meridian::surface
