// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "meridian/geometry/atan2.hpp"
#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"

namespace meridian {

/// Returns the angle between two vectors, in [0, π], with full relative accuracy down to zero (no
/// arc cosine). Their lengths do not matter; a zero vector gives 0. Unit: rad.
/// Proof: tests/unit/geometry/great_circle_test.cpp.
[[nodiscard]] inline double angle_between(const Vector3& a, const Vector3& b) noexcept {
  return atan2(a.cross(b).norm(), a.dot(b));
}

/// The way of the tool axis from one block to the next: axis(φ) = cos(φ) begin + sin(φ) normal for
/// φ in [0, turn]. `normal` is a unit vector in the plane of the circle, square to `begin`.
struct GreatCircle {
  Vector3 begin;
  Vector3 normal;
  double turn = 0;  ///< rad, in [0, π]
  /// False where begin and end are opposite within 1e-9 rad: infinitely many great circles join
  /// them, and `normal` is one of them.
  bool is_unique = true;
};

/// Returns the great circle from unit vector `begin` to unit vector `end`. Equal axes give turn 0
/// and some normal. Proof: tests/unit/geometry/great_circle_test.cpp.
[[nodiscard]] inline GreatCircle find_great_circle(const Vector3& begin,
                                                   const Vector3& end) noexcept {
  // begin × end from the difference, which is exact for close axes: a short turn keeps its
  // direction.
  const Vector3 pole = begin.cross(Vector3(end - begin));
  const double sine = pole.norm();
  const double turn = atan2(sine, begin.dot(end));
  Vector3 normal = pole.cross(begin);
  const double length = normal.norm();
  if (length < 1e-9 && begin.dot(end) < 0) {
    return {begin, begin.unitOrthogonal(), turn, false};
  }
  if (!(length > 0)) return {begin, begin.unitOrthogonal(), 0.0, true};
  normal /= length;
  return {begin, normal, turn, true};
}

/// Returns the tool axis after a turn of `angle` along the circle through `begin` and `normal`.
/// RT: cycle.
template <class S>
[[nodiscard]] inline Vec3<S> axis_on_circle(const Vector3& begin, const Vector3& normal,
                                            const S& angle) noexcept {
  const auto [sine, cosine] = sin_cos(angle);
  return {cosine * begin[0] + sine * normal[0], cosine * begin[1] + sine * normal[1],
          cosine * begin[2] + sine * normal[2]};
}

}  // namespace meridian
