// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/chain_kinematics.hpp"
#include "meridian/kinematics/joints.hpp"

namespace meridian {

/// Closed forms of the chain in the machine frame. Units: mm, rad. RT: cycle, except describe.
/// Source: docs/kinematics.md, chapter 4. Proof: tests/golden, tests/property/kinematics.
namespace chain {

/// How far a half-angle sine may fall below zero by rounding before the axis is out of reach.
inline constexpr double kReachMargin_rad = 1e-12;

/// A tool axis that misses rotary joint a by no more than this is meant to meet it.
inline constexpr double kMaxPoleOffset_rad = 2e-3;
/// So many offsets beside the pole half of the offset is in the tool axis. The solutions turn by
/// 1/32 rad at most for it.
inline constexpr double kPoleWidth = 16;

/// Volume of the linear directions below which they do not span space.
inline constexpr double kMinVolume = 1e-9;
/// Below this one, Cramer's rule would cost the tip digits by itself.
inline constexpr double kRefinedVolume = 0.1;

template <class S>
[[nodiscard]] inline S dot(const Vector3& a, const Vec3<S>& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// `v` turned about the unit vector `axis` (Rodrigues).
template <class S, class V>
[[nodiscard]] inline Vec3<S> turn(const Vector3& axis, const SinCos<S>& angle,
                                  const V& v) noexcept {
  const auto along = axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
  const S rest = S(1.0) - angle.cos;
  return {
      angle.cos * v[0] + angle.sin * (axis[1] * v[2] - axis[2] * v[1]) + rest * (axis[0] * along),
      angle.cos * v[1] + angle.sin * (axis[2] * v[0] - axis[0] * v[2]) + rest * (axis[1] * along),
      angle.cos * v[2] + angle.sin * (axis[0] * v[1] - axis[1] * v[0]) + rest * (axis[2] * along)};
}

/// Where the tip is with every linear joint at zero, eq. 4.3.
template <class S>
[[nodiscard]] inline Vec3<S> unmoved_tip(const ChainKinematics& k, double tool_length_mm,
                                         const SinCos<S>& a, const SinCos<S>& b) noexcept {
  const Vector3 from_b = k.gauge_mm - tool_length_mm * k.home_axis - k.b.point_mm;
  Vec3<S> p = turn<S>(k.b.axis, b, from_b);
  for (int i = 0; i < 3; ++i) p[i] += k.b.point_mm[i] - k.a.point_mm[i];
  p = turn<S>(k.a.axis, a, p);
  for (int i = 0; i < 3; ++i) p[i] += k.a.point_mm[i];
  return p;
}

/// Where linear joint `i` moves the tip, with the rotary joints turned.
template <class S>
[[nodiscard]] inline Vec3<S> column(const ChainKinematics& k, int i, const SinCos<S>& a,
                                    const SinCos<S>& b) noexcept {
  const ChainKinematics::Linear& linear = k.linear[i];
  const Vector3& d = linear.direction;
  if (linear.group == 0) return {S(d[0]), S(d[1]), S(d[2])};
  if (linear.group == 1) return turn<S>(k.a.axis, a, d);
  return turn<S>(k.a.axis, a, turn<S>(k.b.axis, b, d));
}

template <class S>
[[nodiscard]] inline Vec3<S> cross(const Vec3<S>& a, const Vec3<S>& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class S>
[[nodiscard]] inline S scalar_product(const Vec3<S>& a, const Vec3<S>& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// By how much the angle χ is lacking where the tool axis is nearest to the pole that it misses,
/// half of it kPoleWidth times the offset farther off: eq. 4.12. `chord2` is |K - a|².
template <class S>
[[nodiscard]] inline S lack_at(const ChainKinematics& k, const S& chord2) noexcept {
  const double width = kPoleWidth * k.pole_offset_rad, width2 = width * width;
  return (k.pole_offset_rad * width2) / (chord2 + width2);
}

/// Rot(b, β) k0 with χ as it is beside the pole. Each round leaves less than 1/20 of the error.
template <class S>
[[nodiscard]] inline Vec3<S> axis_beside_pole(const ChainKinematics& k,
                                              const SinCos<S>& b) noexcept {
  constexpr int kRounds = 14;
  const Vec3<S> along = turn<S>(k.b.axis, b, k.home_axis);
  const Vec3<S> across = turn<S>(k.b.axis, b, k.outwards);
  Vec3<S> out = along;
  for (int round = 0; round < kRounds; ++round) {
    S chord2(0.0);
    for (int i = 0; i < 3; ++i) chord2 += (out[i] - k.a.axis[i]) * (out[i] - k.a.axis[i]);
    const SinCos<S> by = sin_cos(lack_at(k, chord2));
    for (int i = 0; i < 3; ++i) out[i] = by.cos * along[i] - by.sin * across[i];
  }
  return out;
}

/// Where the tool axis really points: eq. 4.2. forward() differs from it beside a pole that is
/// missed.
[[nodiscard]] inline Vector3 true_axis(const ChainKinematics& k, const JointVector& q) noexcept {
  const SinCos<double> a = sin_cos(k.a.sign * q[static_cast<std::size_t>(k.a.joint)]);
  const SinCos<double> b = sin_cos(k.b.sign * q[static_cast<std::size_t>(k.b.joint)]);
  return turn<double>(k.a.axis, a, turn<double>(k.b.axis, b, k.home_axis));
}

/// Forward kinematics, eq. 4.1; of a machine that misses its pole with the axis of eq. 4.12.
template <class S>
[[nodiscard]] inline Pose<S> forward(const ChainKinematics& k, double tool_length_mm,
                                     const Joints<S>& q) noexcept {
  const SinCos<S> a = sin_cos(S(k.a.sign * q[k.a.joint]));
  const SinCos<S> b = sin_cos(S(k.b.sign * q[k.b.joint]));
  const bool misses_pole = k.pole_offset_rad != 0;
  const Vec3<S> tilted = misses_pole ? axis_beside_pole(k, b) : turn<S>(k.b.axis, b, k.home_axis);
  Pose<S> out{unmoved_tip(k, tool_length_mm, a, b), turn<S>(k.a.axis, a, tilted)};
  for (int i = 0; i < 3; ++i) {
    const Vec3<S> d = column(k, i, a, b);
    for (int row = 0; row < 3; ++row) out.tip[row] += d[row] * q[k.linear[i].joint];
  }
  return out;
}

/// `v` in the frame of joint a.
template <class S>
[[nodiscard]] inline Vec3<S> in_frame_a(const ChainKinematics& k, const Vec3<S>& v) noexcept {
  const Eigen::Matrix3d& f = k.frame_a;
  return {f(0, 0) * v[0] + f(0, 1) * v[1] + f(0, 2) * v[2],
          f(1, 0) * v[0] + f(1, 1) * v[1] + f(1, 2) * v[2],
          f(2, 0) * v[0] + f(2, 1) * v[1] + f(2, 2) * v[2]};
}

/// Sines and cosines of half the angle θ between the tool axis and a, and sin² θ.
template <class S>
struct HalfAngle {
  S sin, cos, sine2;
};

/// `z` is the tool axis in the frame of joint a, unit.
template <class S>
[[nodiscard]] inline HalfAngle<S> half_angle(const Vec3<S>& z) noexcept {
  using std::sqrt;
  const S sine2 = z[0] * z[0] + z[1] * z[1];
  const S apart = 1.0 - z[2], along = 1.0 + z[2];
  return {0.5 * sqrt(sine2 + apart * apart), 0.5 * sqrt(sine2 + along * along), sine2};
}

/// Sines and cosines of m and p, eq. 4.5.
template <class S>
struct Cone {
  S m_sin, m_cos, p_sin, p_cos;
};
template <class S>
struct PoleCone : Cone<S> {
  S share;  ///< sin χ of the machine over that of the cone
};

[[nodiscard]] inline Cone<double> cone_of(const ChainKinematics& k) noexcept {
  return {k.m_sin, k.m_cos, k.p_sin, k.p_cos};
}

/// Beside the pole that the tool axis misses, the cone that goes through it; farther off that of
/// the machine, eq. 4.12.
template <class S>
[[nodiscard]] inline PoleCone<S> pole_cone(const ChainKinematics& k,
                                           const HalfAngle<S>& half) noexcept {
  const SinCos<S> by = sin_cos(-0.5 * lack_at(k, 4.0 * (half.sin * half.sin)));
  const Cone<S> cone{k.m_sin * by.cos + k.m_cos * by.sin, k.m_cos * by.cos - k.m_sin * by.sin,
                     k.p_sin * by.cos + k.p_cos * by.sin, k.p_cos * by.cos - k.p_sin * by.sin};
  const double own = k.p_sin * k.m_cos + k.p_cos * k.m_sin;  // χ = p + m
  return {cone, own / (cone.p_sin * cone.m_cos + cone.p_cos * cone.m_sin)};
}

/// The spherical triangle of the two rotary axes and the tool axis by its half-angle formulas,
/// eq. 4.5 and 4.6.
template <class S>
struct Triangle {
  S n1, n2, n3, n4;
  S root;  ///< sqrt(n1 n2 n3 n4): half the orientation part of the measure, eq. 4.10
  bool is_reachable;
};

template <class S, class C>
[[nodiscard]] inline Triangle<S> triangle(const HalfAngle<S>& half, const Cone<C>& cone) noexcept {
  using std::sqrt;
  Triangle<S> t{half.sin * cone.m_cos + half.cos * cone.m_sin,
                half.sin * cone.m_cos - half.cos * cone.m_sin,
                half.cos * cone.p_sin - half.sin * cone.p_cos,
                half.cos * cone.p_sin + half.sin * cone.p_cos,
                S(0.0),
                true};
  const double min =
      std::min(std::min(value_of(t.n1), value_of(t.n2)), std::min(value_of(t.n3), value_of(t.n4)));
  if (!(min >= 0)) {
    t.is_reachable = min >= -kReachMargin_rad;
    for (S* n : {&t.n1, &t.n2, &t.n3, &t.n4}) {
      if (!(value_of(*n) >= 0)) *n = S(0.0);
    }
  }
  t.root = sqrt((t.n1 * t.n2) * (t.n3 * t.n4));
  return t;
}

/// `v` turned by `angle` about z.
template <class S>
[[nodiscard]] inline Vec3<S> turn_about_z(const SinCos<S>& angle, const Vec3<S>& v) noexcept {
  return {angle.cos * v[0] - angle.sin * v[1], angle.sin * v[0] + angle.cos * v[1], v[2]};
}

/// What the linear joints have to add for the tip to come to `tip`, in the frame of a, or of b
/// where they stand behind it: eq. 4.9 of a machine whose linear joints are neighbours.
template <class S>
[[nodiscard]] inline Vec3<S> displacement_of_slides(const ChainKinematics& k, double tool_length_mm,
                                                    const Vec3<S>& tip, const SinCos<S>& a,
                                                    const SinCos<S>& b) noexcept {
  const double s = k.psi_sin, c = k.psi_cos;
  Vec3<S> displacement = in_frame_a(k, tip);
  for (int i = 0; i < 3; ++i) displacement[i] -= k.origin_a[i];
  Vec3<S> there;
  for (int i = 0; i < 3; ++i) there[i] = S(k.b_to_gauge[i] - tool_length_mm * k.home_axis_b[i]);
  if (k.group != 0) displacement = turn_about_z(SinCos<S>{-a.sin, a.cos}, displacement);
  if (k.group == 2) {
    for (int i = 0; i < 3; ++i) displacement[i] -= k.a_to_b[i];
    displacement = {c * displacement[0] - s * displacement[2], displacement[1],
                    s * displacement[0] + c * displacement[2]};
    displacement = turn_about_z(SinCos<S>{-b.sin, b.cos}, displacement);
  } else {
    there = turn_about_z(b, there);
    there = {c * there[0] + s * there[2] + k.a_to_b[0], there[1] + k.a_to_b[1],
             c * there[2] - s * there[0] + k.a_to_b[2]};
    if (k.group == 0) there = turn_about_z(a, there);
  }
  return {displacement[0] - there[0], displacement[1] - there[1], displacement[2] - there[2]};
}

/// The linear joints that put the tip on `tip` with the rotary joints as given, eq. 4.9. Returns
/// whether the linear directions span space there. Where they nearly lie in one plane, what
/// rounding has left of the way is solved for again: the tip stays exact, the joints are as far off
/// as the measure says.
template <class S>
[[nodiscard]] inline bool place_tip(const ChainKinematics& k, double tool_length_mm,
                                    const Vec3<S>& tip, const SinCos<S>& a, const SinCos<S>& b,
                                    Joints<S>& q) noexcept {
  if (k.group >= 0) {
    const Vec3<S> displacement = displacement_of_slides(k, tool_length_mm, tip, a, b);
    for (int i = 0; i < 3; ++i) {
      q[k.linear[i].joint] = k.slide_inverse(i, 0) * displacement[0] +
                             k.slide_inverse(i, 1) * displacement[1] +
                             k.slide_inverse(i, 2) * displacement[2];
    }
    return true;
  }
  const Vec3<S> start = unmoved_tip(k, tool_length_mm, a, b);
  const Vec3<S> displacement{tip[0] - start[0], tip[1] - start[1], tip[2] - start[2]};
  const std::array<Vec3<S>, 3> d{column(k, 0, a, b), column(k, 1, a, b), column(k, 2, a, b)};
  const std::array<Vec3<S>, 3> dual{cross(d[1], d[2]), cross(d[2], d[0]), cross(d[0], d[1])};
  const S volume = scalar_product(d[0], dual[0]);
  if (!(std::abs(value_of(volume)) > kMinVolume)) return false;
  const S per_volume = 1.0 / volume;
  for (int i = 0; i < 3; ++i)
    q[k.linear[i].joint] = scalar_product(dual[i], displacement) * per_volume;
  if (std::abs(value_of(volume)) < kRefinedVolume) {
    Vec3<S> rest = displacement;
    for (int i = 0; i < 3; ++i) {
      for (int row = 0; row < 3; ++row) rest[row] -= d[i][row] * q[k.linear[i].joint];
    }
    for (int i = 0; i < 3; ++i) q[k.linear[i].joint] += scalar_product(dual[i], rest) * per_volume;
  }
  return true;
}

/// What solve() does with the angles between the axes as `cone` has them.
template <class S, class AnyCone>
[[nodiscard]] inline bool solve_on(const ChainKinematics& k, double tool_length_mm,
                                   const Vec3<S>& tip, const Vec3<S>& z, const HalfAngle<S>& half,
                                   const AnyCone& cone, double branch_sign, Joints<S>& q) noexcept {
  const Triangle<S> t = triangle(half, cone);
  if (!t.is_reachable) return false;
  // n1 n3 + n2 n4 = sin θ sin ψ and n1 n2 + n3 n4 = sin ψ sin χ: sines and cosines need no norm.
  const S twice_root = (2.0 * branch_sign) * t.root;
  const S a_cos = t.n2 * t.n4 - t.n1 * t.n3, b_cos = t.n3 * t.n4 - t.n1 * t.n2;
  const S per_sines = 1.0 / (k.psi_sin * half.sine2);
  const SinCos<S> a{(z[1] * a_cos - z[0] * twice_root) * per_sines,
                    (z[0] * a_cos + z[1] * twice_root) * per_sines};
  SinCos<S> b{-(twice_root * k.b0_cos + b_cos * k.b0_sin),
              b_cos * k.b0_cos - twice_root * k.b0_sin};
  if constexpr (std::is_same_v<AnyCone, PoleCone<S>>) {
    b = {cone.share * b.sin, cone.share * b.cos};
  }
  q = {};
  q[k.a.joint] = k.a.sign * atan2(a.sin, a.cos);
  q[k.b.joint] = k.b.sign * atan2(b.sin, b.cos);
  return place_tip(k, tool_length_mm, tip, a, b, q);
}

/// Inverse kinematics off the poles, eq. 4.5 to 4.9; `branch_sign` is τ, `z` the tool axis in the
/// frame of joint a, unit. Returns whether the pose is in reach; windings are the caller's.
template <class S>
[[nodiscard]] inline bool solve(const ChainKinematics& k, double tool_length_mm, const Vec3<S>& tip,
                                const Vec3<S>& z, double branch_sign, Joints<S>& q) noexcept {
  const HalfAngle<S> half = half_angle(z);
  if (k.pole_offset_rad != 0) {
    return solve_on(k, tool_length_mm, tip, z, half, pole_cone(k, half), branch_sign, q);
  }
  return solve_on(k, tool_length_mm, tip, z, half, cone_of(k), branch_sign, q);
}

/// The joints with rotary joint a given: the tip exact, the axis the nearest that is left,
/// eq. 4.11.
template <class S>
[[nodiscard]] inline bool solve_held(const ChainKinematics& k, double tool_length_mm,
                                     const Pose<S>& X_MT, const S& free, Joints<S>& q) noexcept {
  const SinCos<S> a = sin_cos(S(k.a.sign * free));
  const SinCos<S> back{-a.sin, a.cos};
  const Vec3<S> z = turn<S>(k.a.axis, back, X_MT.axis);
  const S angle = atan2(dot(k.tilt_sin, z), dot(k.tilt_cos, z));
  q = {};
  q[k.a.joint] = free;
  q[k.b.joint] = k.b.sign * angle;
  return place_tip(k, tool_length_mm, X_MT.tip, a, sin_cos(angle), q);
}

/// Whether the tool axis `z`, unit, in the frame of joint a, is nearer to a pole than `hold_rad`.
template <class S>
[[nodiscard]] inline bool is_at_pole(const ChainKinematics& k, const Vec3<S>& z,
                                     double hold_rad) noexcept {
  const double x = value_of(z[0]), y = value_of(z[1]);
  if (x * x + y * y >= hold_rad * hold_rad) return false;
  return value_of(z[2]) > 0 ? k.has_pole : k.has_opposite_pole;
}

/// Angle from the axis to the nearest pole, in [0, π]; π where the machine has none.
[[nodiscard]] double pole_distance(const ChainKinematics& k, const Vector3& axis) noexcept;

/// det D of eq. 4.3: the volume that the linear directions span, signed, at the angles `q`.
[[nodiscard]] double slide_volume(const ChainKinematics& k, const JointVector& q) noexcept;

/// sqrt(det JᵀJ), eq. 4.10: zero on the poles, at the limits of reach, and where the linear joints
/// do not span space.
[[nodiscard]] double measure(const ChainKinematics& k, const JointVector& q) noexcept;

/// Least and largest angle between the tool axis and rotary axis a, eq. 4.4.
struct Reach {
  double min_rad, largest_rad;
};
[[nodiscard]] Reach reach(const ChainKinematics& k) noexcept;

}  // namespace chain
}  // namespace meridian
