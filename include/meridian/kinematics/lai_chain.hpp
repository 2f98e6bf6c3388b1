// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/lai.hpp"

/// The machine of Lai et al. in the frame of its kinematics, C axis through the origin. Joint order
/// b3, b2, b4, theta1, theta2; `length` is tilt axis to tool tip, l = l5 + lt. Units: mm, rad.
/// Source: docs/kinematics.md, chapter 2. RT: cycle.
namespace meridian::lai {

enum Joint { kB3, kB2, kB4, kTheta1, kTheta2, kJointCount };

/// Forward kinematics, eq. 2.2.
template <class S>
[[nodiscard]] inline Pose<S> forward(const LaiKinematics& constants, double length,
                                     const Joints<S>& q) noexcept {
  const auto [s1, c1] = sin_cos(q[kTheta1]);
  const auto [s2, c2] = sin_cos(q[kTheta2]);
  const S u = q[kB3] - length * s2;
  const S v = q[kB2] - constants.e_mm;
  return {{c1 * u - s1 * v, s1 * u + c1 * v, constants.h_mm - q[kB4] - length * c2},
          {c1 * s2, s1 * s2, c2}};
}

/// The linear joints that put the tip on `tip` for any rotary position whatever, eq. 2.5.
template <class S>
inline void place_tip(const LaiKinematics& constants, double length, const Vec3<S>& tip,
                      const SinCos<S>& theta1, const SinCos<S>& theta2, Joints<S>& q) noexcept {
  q[kB3] = tip[0] * theta1.cos + tip[1] * theta1.sin + length * theta2.sin;
  q[kB2] = tip[1] * theta1.cos - tip[0] * theta1.sin + constants.e_mm;
  q[kB4] = constants.h_mm - tip[2] - length * theta2.cos;
}

/// Inverse kinematics off the pole, eq. 2.3 to 2.5: branch +1 tilts into [0, π], branch -1 into
/// [-π, 0]. `radius` is hypot(Kx, Ky) > 0; sines and cosines come from the axis itself, without a
/// call. The axis need not be exactly unit. Windings are the caller's.
template <class S>
[[nodiscard]] inline Joints<S> solve(const LaiKinematics& constants, double length,
                                     const Pose<S>& X_MT, double branch_sign,
                                     const S& radius) noexcept {
  const S x = branch_sign * X_MT.axis[0];
  const S y = branch_sign * X_MT.axis[1];
  const S r = branch_sign * radius;
  const S per_radius = 1.0 / radius;
  const S per_norm = 1.0 / hypot(radius, X_MT.axis[2]);
  Joints<S> q{};
  q[kTheta1] = atan2(y, x);
  q[kTheta2] = atan2(r, X_MT.axis[2]);
  place_tip(constants, length, X_MT.tip, SinCos<S>{y * per_radius, x * per_radius},
            SinCos<S>{r * per_norm, X_MT.axis[2] * per_norm}, q);
  return q;
}

/// Inverse kinematics with theta1 given, eq. 2.6: the tip is exact, the axis is the one nearest to
/// the wanted axis that this theta1 allows. theta2 lies in [-π, π].
template <class S>
[[nodiscard]] inline Joints<S> solve_held(const LaiKinematics& constants, double length,
                                          const Pose<S>& X_MT, const S& theta1) noexcept {
  const SinCos<S> turn = sin_cos(theta1);
  const S along = X_MT.axis[0] * turn.cos + X_MT.axis[1] * turn.sin;
  const S per_norm = 1.0 / hypot(along, X_MT.axis[2]);
  Joints<S> q{};
  q[kTheta1] = theta1;
  q[kTheta2] = atan2(along, X_MT.axis[2]);
  place_tip(constants, length, X_MT.tip, turn, SinCos<S>{along * per_norm, X_MT.axis[2] * per_norm},
            q);
  return q;
}

/// sqrt(det JᵀJ) = |sin theta2|, eq. 2.8: zero on the pole and nowhere else inside the tilt's
/// travel.
[[nodiscard]] inline double measure(const JointVector& q) noexcept {
  return std::abs(std::sin(q[kTheta2]));
}

}  // namespace meridian::lai
