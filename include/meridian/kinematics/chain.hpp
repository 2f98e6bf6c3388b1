// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <string>

#include "meridian/expected.hpp"
#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/joints.hpp"

namespace meridian {

/// One joint of a chain from the workpiece to the tool. Direction and point are those at home, in
/// the machine frame. A joint on the table side moves the workpiece.
struct ChainJoint {
  int joint = 0;  ///< its place in machine order
  bool is_rotary = false;
  bool is_table_side = false;
  Vector3 direction = Vector3::UnitZ();  ///< unit
  Vector3 point_mm = Vector3::Zero();    ///< on the axis; rotary joints only
};

/// Any machine with three linear and two rotary joints, in any order. Built once by
/// describe_chain(), which works out everything that does not depend on the pose.
/// Source: docs/kinematics.md, chapter 4.
struct ChainKinematics {
  static constexpr int kChainLength = 5;
  std::array<ChainJoint, kChainLength> chain{};  ///< workpiece to tool
  Vector3 home_axis = Vector3::UnitZ();          ///< k0: tool axis at home, tip to spindle
  Vector3 gauge_mm = Vector3::Zero();            ///< gauge point at home

  /// A rotary joint, a next to the workpiece or b next to the tool, and what is constant about it.
  struct Rotary {
    int joint = 0;
    double sign = 1;  ///< -1 on the table side
    Vector3 axis = Vector3::UnitZ();
    Vector3 point_mm = Vector3::Zero();
  };
  /// A linear joint. `group` is how many rotary joints stand between it and the workpiece.
  struct Linear {
    int joint = 0;
    int group = 0;
    Vector3 direction = Vector3::UnitX();  ///< turned round on the table side
  };
  Rotary a, b;
  std::array<Linear, 3> linear;
  int group = -1;  ///< of all three linear joints; -1: rotary joints stand between them
  Eigen::Matrix3d place = Eigen::Matrix3d::Identity();  ///< inverse of the linear directions

  Vector3 azimuth_sin, azimuth_cos;  ///< of K about a, from b: dot products, eq. 4.7
  Vector3 tilt_sin, tilt_cos;        ///< of the axis about b, from k0: dot products, eq. 4.11
  double b0_sin = 0, b0_cos = 1;     ///< azimuth of k0 about b, from a
  double m_sin = 0, m_cos = 1;       ///< m = (angle(b, k0) - angle(a, b)) / 2
  double p_sin = 0, p_cos = 1;       ///< p = (angle(b, k0) + angle(a, b)) / 2
  bool has_pole = false;             ///< K = a leaves joint a free
  bool has_opposite_pole = false;    ///< so does K = -a
};

/// Returns the chain with its constants worked out, or the reason why it cannot work: the five
/// joints are not three linear and two rotary ones, a direction is not unit, the rotary axes are
/// parallel, the tool axis is parallel to rotary axis b (it could not tilt), or the linear
/// directions at home do not span space. At start-up only.
[[nodiscard]] Expected<ChainKinematics, std::string> describe_chain(
    const std::array<ChainJoint, ChainKinematics::kChainLength>& chain, const Vector3& home_axis,
    const Vector3& gauge_mm);

/// Closed forms of the chain in the machine frame. Units: mm, rad. RT: cycle, except describe.
/// Source: docs/kinematics.md, chapter 4. Proof: tests/golden, tests/property/kinematics.
namespace chain {

/// How far a half-angle sine may fall below zero by rounding before the axis is out of reach.
inline constexpr double kReachMargin_rad = 1e-12;

/// Volume of the linear directions below which they do not span space.
inline constexpr double kLeastVolume = 1e-9;
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

/// Forward kinematics, eq. 4.1.
template <class S>
[[nodiscard]] inline Pose<S> forward(const ChainKinematics& k, double tool_length_mm,
                                     const Joints<S>& q) noexcept {
  const SinCos<S> a = sin_cos(S(k.a.sign * q[k.a.joint]));
  const SinCos<S> b = sin_cos(S(k.b.sign * q[k.b.joint]));
  Pose<S> out{unmoved_tip(k, tool_length_mm, a, b),
              turn<S>(k.a.axis, a, turn<S>(k.b.axis, b, k.home_axis))};
  for (int i = 0; i < 3; ++i) {
    const Vec3<S> d = column(k, i, a, b);
    for (int row = 0; row < 3; ++row) out.tip[row] += d[row] * q[k.linear[i].joint];
  }
  return out;
}

/// The spherical triangle of the two rotary axes and the tool axis by its half-angle formulas,
/// eq. 4.5 and 4.6. The axis must be unit.
template <class S>
struct Triangle {
  S n1, n2, n3, n4;
  S root;  ///< sqrt(n1 n2 n3 n4): half the orientation part of the measure, eq. 4.10
  bool is_reachable;
};

template <class S>
[[nodiscard]] inline Triangle<S> triangle(const ChainKinematics& k, const Vec3<S>& axis) noexcept {
  const Vec3<S> apart{axis[0] - k.a.axis[0], axis[1] - k.a.axis[1], axis[2] - k.a.axis[2]};
  const Vec3<S> along{axis[0] + k.a.axis[0], axis[1] + k.a.axis[1], axis[2] + k.a.axis[2]};
  using std::sqrt;
  const S half_sin = 0.5 * sqrt(scalar_product(apart, apart));
  const S half_cos = 0.5 * sqrt(scalar_product(along, along));
  Triangle<S> t{half_sin * k.m_cos + half_cos * k.m_sin,
                half_sin * k.m_cos - half_cos * k.m_sin,
                half_cos * k.p_sin - half_sin * k.p_cos,
                half_cos * k.p_sin + half_sin * k.p_cos,
                S(0.0),
                true};
  for (S* n : {&t.n1, &t.n2, &t.n3, &t.n4}) {
    if (value_of(*n) >= 0) continue;
    if (!(value_of(*n) >= -kReachMargin_rad)) t.is_reachable = false;
    *n = S(0.0);
  }
  t.root = sqrt((t.n1 * t.n2) * (t.n3 * t.n4));
  return t;
}

/// What the linear joints have to add for the tip to come to `tip`, in the frame where they stand:
/// eq. 4.9 of a machine whose linear joints are neighbours.
template <class S>
[[nodiscard]] inline Vec3<S> way_of_slides(const ChainKinematics& k, double tool_length_mm,
                                           const Vec3<S>& tip, const SinCos<S>& a,
                                           const SinCos<S>& b) noexcept {
  const Vector3 a_to_b = k.b.point_mm - k.a.point_mm;
  const Vector3 from_b = k.gauge_mm - tool_length_mm * k.home_axis - k.b.point_mm;
  Vec3<S> way{tip[0] - k.a.point_mm[0], tip[1] - k.a.point_mm[1], tip[2] - k.a.point_mm[2]};
  Vec3<S> there;
  if (k.group == 2) {
    way = turn<S>(k.a.axis, SinCos<S>{-a.sin, a.cos}, way);
    for (int i = 0; i < 3; ++i) way[i] -= a_to_b[i];
    way = turn<S>(k.b.axis, SinCos<S>{-b.sin, b.cos}, way);
    there = {S(from_b[0]), S(from_b[1]), S(from_b[2])};
  } else {
    there = turn<S>(k.b.axis, b, from_b);
    for (int i = 0; i < 3; ++i) there[i] += a_to_b[i];
    if (k.group == 0) {
      there = turn<S>(k.a.axis, a, there);
    } else {
      way = turn<S>(k.a.axis, SinCos<S>{-a.sin, a.cos}, way);
    }
  }
  return {way[0] - there[0], way[1] - there[1], way[2] - there[2]};
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
    const Vec3<S> way = way_of_slides(k, tool_length_mm, tip, a, b);
    for (int i = 0; i < 3; ++i) {
      q[k.linear[i].joint] =
          k.place(i, 0) * way[0] + k.place(i, 1) * way[1] + k.place(i, 2) * way[2];
    }
    return true;
  }
  const Vec3<S> start = unmoved_tip(k, tool_length_mm, a, b);
  const Vec3<S> way{tip[0] - start[0], tip[1] - start[1], tip[2] - start[2]};
  const std::array<Vec3<S>, 3> d{column(k, 0, a, b), column(k, 1, a, b), column(k, 2, a, b)};
  const std::array<Vec3<S>, 3> dual{cross(d[1], d[2]), cross(d[2], d[0]), cross(d[0], d[1])};
  const S volume = scalar_product(d[0], dual[0]);
  if (!(std::abs(value_of(volume)) > kLeastVolume)) return false;
  const S per_volume = 1.0 / volume;
  for (int i = 0; i < 3; ++i) q[k.linear[i].joint] = scalar_product(dual[i], way) * per_volume;
  if (std::abs(value_of(volume)) < kRefinedVolume) {
    Vec3<S> rest = way;
    for (int i = 0; i < 3; ++i) {
      for (int row = 0; row < 3; ++row) rest[row] -= d[i][row] * q[k.linear[i].joint];
    }
    for (int i = 0; i < 3; ++i) q[k.linear[i].joint] += scalar_product(dual[i], rest) * per_volume;
  }
  return true;
}

/// Inverse kinematics off the poles, eq. 4.5 to 4.9; `branch_sign` is τ. The axis must be unit.
/// Returns whether the pose is in reach; windings are the caller's.
template <class S>
[[nodiscard]] inline bool solve(const ChainKinematics& k, double tool_length_mm,
                                const Pose<S>& pose, double branch_sign, Joints<S>& q) noexcept {
  const Triangle<S> t = triangle(k, pose.axis);
  if (!t.is_reachable) return false;
  const S twice_root = (2.0 * branch_sign) * t.root;
  const S n13 = t.n1 * t.n3, n24 = t.n2 * t.n4, n12 = t.n1 * t.n2, n34 = t.n3 * t.n4;
  const S at_a = 1.0 / (n13 + n24), at_b = 1.0 / (n12 + n34);
  const S a_sin = twice_root * at_a, a_cos = (n24 - n13) * at_a;
  const S b_sin = twice_root * at_b, b_cos = (n34 - n12) * at_b;

  const S k_sin = dot(k.azimuth_sin, pose.axis), k_cos = dot(k.azimuth_cos, pose.axis);
  const S per_azimuth = 1.0 / hypot(k_sin, k_cos);
  const SinCos<S> a{(k_sin * a_cos - k_cos * a_sin) * per_azimuth,
                    (k_cos * a_cos + k_sin * a_sin) * per_azimuth};
  const SinCos<S> b{-(b_sin * k.b0_cos + b_cos * k.b0_sin), b_cos * k.b0_cos - b_sin * k.b0_sin};
  q = {};
  q[k.a.joint] = k.a.sign * atan2(a.sin, a.cos);
  q[k.b.joint] = k.b.sign * atan2(b.sin, b.cos);
  return place_tip(k, tool_length_mm, pose.tip, a, b, q);
}

/// The joints with rotary joint a given: the tip exact, the axis the nearest that is left,
/// eq. 4.11.
template <class S>
[[nodiscard]] inline bool solve_held(const ChainKinematics& k, double tool_length_mm,
                                     const Pose<S>& pose, const S& free, Joints<S>& q) noexcept {
  const SinCos<S> a = sin_cos(S(k.a.sign * free));
  const SinCos<S> back{-a.sin, a.cos};
  const Vec3<S> z = turn<S>(k.a.axis, back, pose.axis);
  const S angle = atan2(dot(k.tilt_sin, z), dot(k.tilt_cos, z));
  q = {};
  q[k.a.joint] = free;
  q[k.b.joint] = k.b.sign * angle;
  return place_tip(k, tool_length_mm, pose.tip, a, sin_cos(angle), q);
}

/// Whether the unit vector `axis` is nearer to a pole than `hold_rad`.
[[nodiscard]] inline bool is_at_pole(const ChainKinematics& k, const Vector3& axis,
                                     double hold_rad) noexcept {
  const Vector3& a = k.a.axis;
  const double x = axis[1] * a[2] - axis[2] * a[1], y = axis[2] * a[0] - axis[0] * a[2];
  const double z = axis[0] * a[1] - axis[1] * a[0];
  if (x * x + y * y + z * z >= hold_rad * hold_rad) return false;
  const double along = axis[0] * a[0] + axis[1] * a[1] + axis[2] * a[2];
  return along > 0 ? k.has_pole : k.has_opposite_pole;
}

/// Angle from the axis to the nearest pole, in [0, π]; π where the machine has none.
[[nodiscard]] double pole_distance(const ChainKinematics& k, const Vector3& axis) noexcept;

/// sqrt(det JᵀJ), eq. 4.10: zero on the poles, at the limits of reach, and where the linear joints
/// do not span space.
[[nodiscard]] double measure(const ChainKinematics& k, const JointVector& q) noexcept;

/// Least and largest angle between the tool axis and rotary axis a, eq. 4.4.
struct Reach {
  double least_rad, largest_rad;
};
[[nodiscard]] Reach reach(const ChainKinematics& k) noexcept;

}  // namespace chain
}  // namespace meridian
