// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "meridian/geometry/jet.hpp"
#include "meridian/kinematics/joints.hpp"

namespace meridian {

enum class StageKind : std::uint8_t {
  kIdentity,   ///< every joint has a drive of its own
  kTwoSlider,  ///< two sliders with rods carry one linear and one rotary joint
  kPinSlot     ///< two sliders whose pins run in radial slots of the table
};

/// Drives of a stage.
inline constexpr int kStageDrives = 2;

/// What stands between two of the joints and their drives: a stage with two sliders u1, u2 that
/// carries a slide s and a table angle φ, with s = sign_s · joint + offset_s and φ likewise.
/// The drives take the places of the two joints in drive order, u1 that of the linear one.
/// Source: docs/kinematics.md, chapter 3. Units: mm, rad.
struct ActuatorStage {
  StageKind kind = StageKind::kIdentity;
  int linear_joint = 0, rotary_joint = 0;
  double sign_s = 1, offset_s_mm = 0;
  double sign_phi = 1, offset_phi_rad = 0;
  double radius_mm = 0;  ///< r: table centre to pin
  double rail_mm = 0;    ///< h: centre line to the rail of a slider
  double rod_mm = 0;     ///< L
  double side1 = 1,
         side2 = 1;        ///< assembly: rod ahead of its slider (+1) or behind; equal: trailing
  double phi_max_rad = 0;  ///< the stage turns no farther, either way
};

/// Closed forms of the stage. RT: cycle. Proof: tests/golden, tests/property/kinematics.
namespace stage {

/// Slide and table angle.
template <class S>
struct Carriage {
  S s, phi;
};

template <class S>
[[nodiscard]] inline Carriage<S> carriage_of(const ActuatorStage& g, const Joints<S>& q) noexcept {
  return {g.sign_s * q[g.linear_joint] + g.offset_s_mm,
          g.sign_phi * q[g.rotary_joint] + g.offset_phi_rad};
}

/// Whether the table angle is inside the stage's range.
[[nodiscard]] inline bool is_in_reach(const ActuatorStage& g, const JointVector& q) noexcept {
  if (g.kind == StageKind::kIdentity) return true;
  return std::abs(carriage_of(g, q).phi) <= g.phi_max_rad;
}

/// Returns the drive coordinates of the joints `q`, eq. 3.2 and 3.6. Outside is_in_reach() the
/// result may be meaningless.
template <class S>
[[nodiscard]] inline Joints<S> drives_of(const ActuatorStage& g, const Joints<S>& q) noexcept {
  if (g.kind == StageKind::kIdentity) return q;
  using std::sqrt;
  const auto [s, phi] = carriage_of(g, q);
  const SinCos<S> turn = sin_cos(phi);
  Joints<S> u = q;
  if (g.kind == StageKind::kPinSlot) {
    const S pull = g.rail_mm * turn.sin / turn.cos;
    u[g.linear_joint] = s - pull;
    u[g.rotary_joint] = s + pull;
    return u;
  }
  const S d = g.radius_mm * turn.cos - g.rail_mm;
  const S rod = sqrt(S((g.rod_mm - d) * (g.rod_mm + d)));
  u[g.linear_joint] = s - g.radius_mm * turn.sin - g.side1 * rod;
  u[g.rotary_joint] = s + g.radius_mm * turn.sin - g.side2 * rod;
  return u;
}

/// Returns the joints of the drive coordinates `u`, eq. 3.4 to 3.6; not finite where no joints have
/// them.
[[nodiscard]] inline JointVector joints_of(const ActuatorStage& g, const JointVector& u) noexcept {
  if (g.kind == StageKind::kIdentity) return u;
  const double u1 = u[g.linear_joint], u2 = u[g.rotary_joint], r = g.radius_mm, h = g.rail_mm;
  double s = 0.5 * (u1 + u2), phi = 0;
  if (g.kind == StageKind::kPinSlot) {
    phi = atan2(u2 - u1, 2.0 * h);
  } else if (g.side1 == g.side2) {
    const double x = (u2 - u1) / (2.0 * r);
    phi = atan2(x, std::sqrt((1.0 - x) * (1.0 + x)));
    const double d = r * std::cos(phi) - h;
    s += g.side1 * std::sqrt((g.rod_mm - d) * (g.rod_mm + d));
  } else {
    const double d = 0.5 * g.side1 * (u2 - u1);
    const double n = (d * d + r * r + h * h - g.rod_mm * g.rod_mm) / (2.0 * r);
    phi = g.side1 * (atan2(d, h) - std::atan2(std::sqrt(d * d + h * h - n * n), n));
  }
  JointVector q = u;
  q[g.linear_joint] = (s - g.offset_s_mm) * g.sign_s;
  q[g.rotary_joint] = (phi - g.offset_phi_rad) * g.sign_phi;
  return q;
}

/// Returns the velocity of the joints `q` that drive velocities make, the inverse of the derivative
/// of drives_of(). Not finite at a dead point.
[[nodiscard]] inline JointVector joint_velocity_of(const ActuatorStage& g, const JointVector& q,
                                                   const JointVector& velocity) noexcept {
  if (g.kind == StageKind::kIdentity) return velocity;
  Joints<Jet<1>> turning;
  for (int i = 0; i < kMaxJoints; ++i) turning[i] = Jet<1>(q[i]);
  turning[g.rotary_joint] = Jet<1>::variable(q[g.rotary_joint]);
  const Joints<Jet<1>> u = drives_of(g, turning);
  const double by1 = u[g.linear_joint].derivative(1), by2 = u[g.rotary_joint].derivative(1);
  const double u1 = velocity[g.linear_joint], u2 = velocity[g.rotary_joint];
  const double turn = (u2 - u1) / (by2 - by1);
  JointVector out = velocity;
  out[g.linear_joint] = g.sign_s * (u1 - by1 * turn);
  out[g.rotary_joint] = turn;
  return out;
}

/// Determinant of d(u1, u2)/d(s, φ), mm/rad: how far the stage is from a dead point, eq. 3.3.
[[nodiscard]] inline double determinant(const ActuatorStage& g, const JointVector& q) noexcept {
  if (g.kind == StageKind::kIdentity) return 1.0;
  const double phi = carriage_of(g, q).phi, sine = std::sin(phi), cosine = std::cos(phi);
  if (g.kind == StageKind::kPinSlot) return 2.0 * g.rail_mm / (cosine * cosine);
  const double d = g.radius_mm * cosine - g.rail_mm;
  const double rod_rate = d * g.radius_mm * sine / std::sqrt((g.rod_mm - d) * (g.rod_mm + d));
  return 2.0 * g.radius_mm * cosine + (g.side1 - g.side2) * rod_rate;
}

/// Largest way that either drive makes for a turn of the table, mm/rad, within the stage's range:
/// what an error of φ costs.
[[nodiscard]] inline double lever_mm(const ActuatorStage& g) noexcept {
  if (g.kind == StageKind::kIdentity) return 0;
  const double sine = std::sin(g.phi_max_rad), cosine = std::cos(g.phi_max_rad);
  if (g.kind == StageKind::kPinSlot) return std::abs(g.rail_mm) / (cosine * cosine);
  // |d(±r sin φ)| is r at most; |w'| = |d| r |sin φ| / w, with |d| and sin φ at their largest.
  const double d =
      std::max(std::abs(g.radius_mm - g.rail_mm), std::abs(g.radius_mm * cosine - g.rail_mm));
  return g.radius_mm * (1 + d * sine / std::sqrt((g.rod_mm - d) * (g.rod_mm + d)));
}

}  // namespace stage
}  // namespace meridian
