// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/shapes/arc.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace meridian::cl {
namespace {

constexpr double kLongestNormal = 1e9;  // beyond it a number lost its point; squares must be finite

/// Angle from a to b, right-handed about the unit vector n, in (0, 2π].
double sweep(const Vector3& a, const Vector3& b, const Vector3& n) {
  const double angle = std::atan2(n.dot(a.cross(b)), a.dot(b));
  return angle > 0 ? angle : angle + 2 * std::numbers::pi;
}

}  // namespace

Arc solve_arc(const Vector3& begin, const Vector3& end, const Vector3& centre,
              const Vector3& normal) {
  Arc arc;
  if (!(normal.norm() > 1e-6 && normal.norm() < kLongestNormal)) {
    arc.status = Arc::Status::kNoRadius;
    return arc;
  }
  arc.normal = normal.normalized();
  arc.centre = centre + arc.normal * arc.normal.dot(begin - centre);
  Vector3 a = begin - arc.centre;
  a -= arc.normal * arc.normal.dot(a);
  const double rise = arc.normal.dot(end - begin);
  Vector3 b = end - arc.centre - arc.normal * rise;
  const double radius_a = a.norm();
  const double radius_b = b.norm();
  arc.mismatch_mm = radius_b - radius_a;
  if (!(radius_a > 1e-6)) {
    arc.status = Arc::Status::kNoRadius;
    return arc;
  }
  if (!(std::abs(arc.mismatch_mm) <= kArcMismatch_mm)) {
    arc.status = Arc::Status::kNotOneCircle;
    return arc;
  }
  arc.radius = radius_a;
  const Vector3 chord = b - a;
  const double chord_length = chord.norm();
  if (chord_length < kArcClosed_mm) {
    arc.sweep_rad = 2 * std::numbers::pi;
    arc.end = begin + arc.normal * rise;
    return arc;
  }
  // Up to half a turn the arc hardly feels a centre that moves along its chord; beyond, its far
  // side moves by twice as much.
  const double shift = arc.mismatch_mm * (radius_a + radius_b) / (2 * chord_length);
  const bool is_short = sweep(a, b, arc.normal) <= std::numbers::pi;
  if (std::abs(shift) <= (is_short ? 0.1 * radius_a : 4 * std::abs(arc.mismatch_mm))) {
    const Vector3 move = chord * (shift / chord_length);
    arc.centre += move;
    a -= move;
    b -= move;
    arc.radius = a.norm();
    arc.end = end;
  } else {
    arc.end = arc.centre + b * (radius_a / radius_b) + arc.normal * rise;
  }
  arc.sweep_rad = sweep(a, b, arc.normal);
  return arc;
}

}  // namespace meridian::cl
