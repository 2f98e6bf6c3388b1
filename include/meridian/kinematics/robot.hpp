// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/joints.hpp"

namespace meridian {

/// Articulated machining robot: base yaw, shoulder, elbow and a wrist of two axes (5R: pitch and
/// tilt) or three (6R: spherical). Lengths of Sarraji, Table 1. Source: docs/kinematics.md,
/// chapter 5.
struct RobotKinematics {
  bool has_spherical_wrist = false;  ///< 6R
  double shoulder_height_mm = 0;     ///< a
  double upper_arm_mm = 0;           ///< b
  double forearm_mm = 0;             ///< c
  double wrist_mm = 0;               ///< wrist point to gauge line; d = wrist_mm + tool length
};

/// Closed forms of the robot in its base frame. Joint order 5R: yaw, shoulder, elbow, pitch, tilt;
/// 6R: yaw, shoulder, elbow, roll, bend, spin. Units: mm, rad. RT: cycle.
/// Source: docs/kinematics.md, chapter 5. Proof: tests/golden, tests/property/kinematics.
namespace robot {

enum Joint5 { kYaw, kShoulder, kElbow, kPitch, kTilt };
enum Joint6 { kRoll = 3, kBend, kSpin };

/// Eight branches: bit 0 front or back, bit 1 elbow up or down, bit 2 wrist plain or flipped.
inline constexpr int kBranchCount = 8;
inline constexpr int kBack = 1, kFlip = 4;  ///< bits of a branch

/// Bits of a branch with driven joints: the yaw, or yaw and roll; without them it is the roll.
inline constexpr int kYawDriven = 8, kYawAndRollDriven = 16;

/// Nearer to a wrist singularity than this the joint without a direction of its own is held. The
/// wrist point follows the axis asked for, so the tip is off by up to this angle times the tool.
inline constexpr double kWristHold_rad = 1e-12;

/// Nearer to the base axis than this the wrist point leaves the yaw free, which is held: the tip is
/// off by up to this distance. Above it the yaw is what rounding makes of it, and the tip exact.
inline constexpr double kShoulderHold_mm = 5e-10;

/// The signs β, ε, f of a branch.
struct BranchSigns {
  double front, elbow, flip;
};
[[nodiscard]] constexpr BranchSigns signs_of(int branch) noexcept {
  return {branch & 1 ? -1.0 : 1.0, branch & 2 ? -1.0 : 1.0, branch & 4 ? -1.0 : 1.0};
}

/// Directions of the arm: er horizontal away from the base axis, en normal to the arm plane.
template <class S>
struct ArmFrame {
  SinCos<S> yaw;
  [[nodiscard]] Vec3<S> from_arm(const S& r, const S& n, const S& z) const noexcept {
    return {yaw.cos * r - yaw.sin * n, yaw.sin * r + yaw.cos * n, z};
  }
  [[nodiscard]] Vec3<S> to_arm(const Vec3<S>& v) const noexcept {
    return {yaw.cos * v[0] + yaw.sin * v[1], yaw.cos * v[1] - yaw.sin * v[0], v[2]};
  }
};

/// Forward kinematics, eq. 5.1 and 5.2.
template <class S>
[[nodiscard]] inline Pose<S> forward(const RobotKinematics& k, double tool_length_mm,
                                     const Joints<S>& q) noexcept {
  const ArmFrame<S> arm{sin_cos(q[kYaw])};
  const SinCos<S> s = sin_cos(q[kShoulder]), e = sin_cos(S(q[kShoulder] + q[kElbow]));
  const S reach = k.upper_arm_mm * s.cos + k.forearm_mm * e.cos;
  const S height = k.upper_arm_mm * s.sin + k.forearm_mm * e.sin + k.shoulder_height_mm;
  Vec3<S> tool;
  if (k.has_spherical_wrist) {
    const SinCos<S> roll = sin_cos(q[kRoll]), bend = sin_cos(q[kBend]);
    // direction in the forearm's frame: x along it, y normal to the arm plane, z upwards
    const S x = bend.cos, y = -(bend.sin * roll.sin), z = bend.sin * roll.cos;
    tool = arm.from_arm(e.cos * x - e.sin * z, y, e.sin * x + e.cos * z);
  } else {
    const SinCos<S> psi = sin_cos(S(q[kShoulder] + q[kElbow] + q[kPitch]));
    const SinCos<S> tilt = sin_cos(q[kTilt]);
    tool = arm.from_arm(tilt.cos * psi.cos, tilt.sin, tilt.cos * psi.sin);
  }
  const double d = k.wrist_mm + tool_length_mm;
  const Vec3<S> wrist = arm.from_arm(reach, S(0.0), height);
  return {{wrist[0] + d * tool[0], wrist[1] + d * tool[1], wrist[2] + d * tool[2]},
          {-tool[0], -tool[1], -tool[2]}};
}

/// Where the tool direction leaves a wrist joint without a direction of its own: the sine of the
/// angle to that singular set, which is cos(tilt) of the 5R and sin(bend) of the 6R.
template <class S>
struct ArmSolution {
  ArmFrame<S> frame;
  Vec3<S> tool;  ///< tool direction in the arm's frame; 6R: in the forearm's
  S wrist_sine;
  bool is_reachable;
};

/// The wrist point of `pose`, seen from the shoulder. The axis must be unit.
template <class S>
[[nodiscard]] inline Vec3<S> wrist_point(const RobotKinematics& k, double tool_length_mm,
                                         const Pose<S>& pose) noexcept {
  const double d = k.wrist_mm + tool_length_mm;
  return {pose.tip[0] + d * pose.axis[0], pose.tip[1] + d * pose.axis[1],
          pose.tip[2] + d * pose.axis[2] - k.shoulder_height_mm};
}

/// Shoulder and elbow, eq. 5.4 and 5.5, in the arm plane of the yaw in `out.frame`: for the wrist
/// point `rho` from the base axis and `height` over the shoulder.
template <class S>
inline void solve_in_plane(const RobotKinematics& k, const S& rho, const S& height,
                           double elbow_sign, ArmSolution<S>& out, Joints<S>& q) noexcept {
  using std::sqrt;
  const double b = k.upper_arm_mm, c = k.forearm_mm, span = b + c;
  const S length = hypot(rho, height);
  S out_of = (span - length) * (span + length);
  S into = (length - b + c) * (length + b - c);
  const double margin = 1e-12 * span * span;
  out.is_reachable = value_of(out_of) >= -margin && value_of(into) >= -margin;
  if (value_of(out_of) < 0) out_of = S(0.0);
  if (value_of(into) < 0) into = S(0.0);
  const S y = sqrt(out_of), x = sqrt(into);
  const S eta = 2.0 * atan2(y, x);
  const S per_square = 1.0 / (out_of + into);
  const S elbow_sin = -elbow_sign * (2.0 * x * y) * per_square;
  const S elbow_cos = (into - out_of) * per_square;
  q[kElbow] = -elbow_sign * eta;
  q[kShoulder] = atan2(height, rho) - atan2(S(c * elbow_sin), S(b + c * elbow_cos));
}

/// Yaw, shoulder and elbow, eq. 5.3 to 5.5. The axis must be unit. Over the base axis (wrist point
/// on it) the yaw of `reference` is held.
template <class S>
[[nodiscard]] inline ArmSolution<S> solve_arm(const RobotKinematics& k, double tool_length_mm,
                                              const Pose<S>& pose, const BranchSigns& sign,
                                              const JointVector& reference, Joints<S>& q) noexcept {
  const Vec3<S> w = wrist_point(k, tool_length_mm, pose);
  ArmSolution<S> out;
  const double radius2 = value_of(w[0]) * value_of(w[0]) + value_of(w[1]) * value_of(w[1]);
  S rho;
  if (radius2 < kShoulderHold_mm * kShoulderHold_mm) {
    q[kYaw] = S(reference[kYaw]);
    out.frame.yaw = sin_cos(q[kYaw]);
    rho = out.frame.to_arm(w)[0];
  } else {
    const S radius = hypot(w[0], w[1]);
    const S per_rho = sign.front / radius;
    q[kYaw] = atan2(S(sign.front * w[1]), S(sign.front * w[0]));
    out.frame.yaw = {w[1] * per_rho, w[0] * per_rho};
    rho = sign.front * radius;
  }
  solve_in_plane(k, rho, w[2], sign.elbow, out, q);
  const Vec3<S> axis = out.frame.to_arm(pose.axis);
  out.tool = {-axis[0], -axis[1], -axis[2]};
  return out;
}

/// The joints of the wrist, eq. 5.6 to 5.9, behind the arm in `q`. Returns whether it is singular:
/// the joint that has no direction of its own then keeps its value of `reference`.
template <class S>
[[nodiscard]] inline bool solve_wrist(const RobotKinematics& k, const Vec3<S>& t, double flip,
                                      const JointVector& reference, Joints<S>& q) noexcept {
  if (!k.has_spherical_wrist) {
    const double in_plane = hypot(value_of(t[0]), value_of(t[2]));
    if (in_plane < kWristHold_rad) {
      q[kPitch] = S(reference[kPitch]);
      const SinCos<S> held = sin_cos(S(q[kShoulder] + q[kElbow] + q[kPitch]));
      q[kTilt] = atan2(t[1], S(held.cos * t[0] + held.sin * t[2]));
      return true;
    }
    q[kTilt] = atan2(t[1], S(flip * hypot(t[0], t[2])));
    const S psi = atan2(S(flip * t[2]), S(flip * t[0]));
    q[kPitch] = psi - q[kShoulder] - q[kElbow];
    return false;
  }
  const SinCos<S> e = sin_cos(S(q[kShoulder] + q[kElbow]));
  const S x = e.cos * t[0] + e.sin * t[2], z = e.cos * t[2] - e.sin * t[0];
  const S& y = t[1];
  q[kSpin] = S(reference[kSpin]);
  if (hypot(value_of(y), value_of(z)) < kWristHold_rad) {
    q[kRoll] = S(reference[kRoll]);
    const SinCos<S> roll = sin_cos(q[kRoll]);
    q[kBend] = atan2(S(z * roll.cos - y * roll.sin), x);
    return true;
  }
  q[kBend] = atan2(S(flip * hypot(y, z)), x);
  q[kRoll] = atan2(S(-flip * y), S(flip * z));
  return false;
}

/// Inverse kinematics, eq. 5.3 to 5.9. Returns whether the pose is in reach. Where the wrist is
/// singular, or the wrist point is on the base axis, the joint that has no direction of its own
/// keeps its value of `reference`. Windings are the caller's.
template <class S>
[[nodiscard]] inline bool solve(const RobotKinematics& k, double tool_length_mm,
                                const Pose<S>& pose, int branch, const JointVector& reference,
                                Joints<S>& q, bool& is_held) noexcept {
  q = {};
  const BranchSigns sign = signs_of(branch);
  const ArmSolution<S> arm = solve_arm(k, tool_length_mm, pose, sign, reference, q);
  if (!arm.is_reachable) return false;
  is_held = solve_wrist(k, arm.tool, sign.flip, reference, q);
  return true;
}

/// How far the wrist point of `pose` is from the base axis, mm. The axis must be unit.
[[nodiscard]] inline double shoulder_distance(const RobotKinematics& k, double tool_length_mm,
                                              const Pose<double>& pose) noexcept {
  const Vec3<double> w = wrist_point(k, tool_length_mm, pose);
  return hypot(w[0], w[1]);
}

/// The angle from the tool to the forearm's line, where the wrist of a 6R robot is singular, with
/// the front and the elbow of `branch`; π out of reach.
[[nodiscard]] inline double wrist_distance(const RobotKinematics& k, double tool_length_mm,
                                           const Pose<double>& pose, int branch,
                                           const JointVector& reference) noexcept {
  JointVector q{};
  const auto arm = solve_arm(k, tool_length_mm, pose, signs_of(branch), reference, q);
  if (!arm.is_reachable) return std::numbers::pi;
  const SinCos<double> e = sin_cos(q[kShoulder] + q[kElbow]);
  const double x = e.cos * arm.tool[0] + e.sin * arm.tool[2];
  const double z = e.cos * arm.tool[2] - e.sin * arm.tool[0];
  return atan2(hypot(arm.tool[1], z), std::abs(x));
}

/// sqrt(det JᵀJ), eq. 5.6 and 5.10: zero with the wrist on the base axis, the arm stretched or
/// folded, and the wrist singular.
[[nodiscard]] inline double measure(const RobotKinematics& k, const JointVector& q) noexcept {
  const double rho =
      k.upper_arm_mm * std::cos(q[kShoulder]) + k.forearm_mm * std::cos(q[kShoulder] + q[kElbow]);
  const double wrist = k.has_spherical_wrist ? std::sin(q[kBend]) : std::cos(q[kTilt]);
  return k.upper_arm_mm * k.forearm_mm * std::abs(rho * std::sin(q[kElbow]) * wrist);
}

}  // namespace robot
}  // namespace meridian
