// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/robot.hpp"

/// A robot whose yaw, roll or both are led past a singularity: the other joints follow the pose as
/// near as they can. Units: mm, rad. RT: cycle. Source: docs/kinematics.md, chapter 5. Proof:
/// tests/property/kinematics.
namespace meridian::robot {

/// The joints with the yaw at `yaw`, the elbow and the wrist of `branch`: the axis is that of
/// `pose`, the tip the nearest in the arm plane. The shoulder leads to the front or to the back,
/// whichever the wrist point asks for. Returns whether the pose is in reach. Windings are the
/// caller's. RT: cycle. Proof: tests/property/kinematics.
template <class S>
[[nodiscard]] inline bool solve_with_yaw(const RobotKinematics& k, double tool_length_mm,
                                         const Pose<S>& pose, int branch, const S& yaw,
                                         const JointVector& reference, Joints<S>& q) noexcept {
  q = {};
  const BranchSigns sign = signs_of(branch);
  ArmSolution<S> out;
  q[kYaw] = yaw;
  out.frame.yaw = sin_cos(yaw);
  const Vec3<S> w = out.frame.to_arm(wrist_point(k, tool_length_mm, pose));
  solve_in_plane(k, w[0], w[2], sign.elbow, out, q);
  if (!out.is_reachable) return false;
  const Vec3<S> axis = out.frame.to_arm(pose.axis);
  (void)solve_wrist(k, Vec3<S>{-axis[0], -axis[1], -axis[2]}, sign.flip, reference, q);
  return true;
}

/// Rounds of solve_with_roll(). Each leaves d times what the arm turns per mm of the one before, a
/// tenth in the middle of the reach.
inline constexpr int kRollRounds = 12;

/// The joints of a 6R robot with its roll at `roll`, the front and the elbow of `branch`: the tip
/// is that of `pose` as far as the rounds settle, the axis the nearest that the wrist has with that
/// roll; the bend takes the sign that fits. Returns whether the pose is in reach; so near to the
/// base axis that the yaw is free it is not. Windings are the caller's. RT: cycle. Proof:
/// tests/property/kinematics.
template <class S>
[[nodiscard]] inline bool solve_with_roll(const RobotKinematics& k, double tool_length_mm,
                                          const Pose<S>& pose, int branch, const S& roll,
                                          const JointVector& reference, Joints<S>& q) noexcept {
  const SinCos<S> r = sin_cos(roll);
  Pose<S> wanted = pose;  // its axis: the one that the wrist gives
  for (int round = 0; round < kRollRounds; ++round) {
    q = {};
    const ArmSolution<S> arm = solve_arm(k, tool_length_mm, wanted, signs_of(branch), reference, q);
    if (!arm.is_reachable) return false;
    const Vec3<S> a = arm.frame.to_arm(pose.axis);
    const SinCos<S> e = sin_cos(S(q[kShoulder] + q[kElbow]));
    const S x = -(e.cos * a[0] + e.sin * a[2]), z = e.sin * a[0] - e.cos * a[2];
    q[kBend] = atan2(S(z * r.cos + a[1] * r.sin), x);
    const SinCos<S> bend = sin_cos(q[kBend]);
    const S along = bend.cos, across = -(bend.sin * r.sin), up = bend.sin * r.cos;
    wanted.axis = arm.frame.from_arm(S(e.sin * up - e.cos * along), S(0.0) - across,
                                     S(0.0) - (e.sin * along + e.cos * up));
  }
  q[kRoll] = roll;
  q[kSpin] = S(reference[kSpin]);
  return true;
}

/// How many rad of axis count as much as one mm of tip where both may give: as their tolerances.
inline constexpr double kAxisPerTip_rad_per_mm = 0.2;

/// The joints of a 6R robot with its yaw at `yaw` and its roll at `roll`, the elbow of `branch`.
/// In the arm plane the tip is that of `pose` as far as the rounds settle. The bend has the least
/// sum of squares of the axis' angle and of what that moves the tip normal to the arm plane: with
/// the roll of solve_with_yaw() the joints are those of solve_with_yaw(). Returns whether the pose
/// is in reach. Windings are the caller's.
template <class S>
[[nodiscard]] inline bool solve_with_yaw_and_roll(const RobotKinematics& k, double tool_length_mm,
                                                  const Pose<S>& pose, int branch, const S& yaw,
                                                  const S& roll, const JointVector& reference,
                                                  Joints<S>& q) noexcept {
  const double d = k.wrist_mm + tool_length_mm;
  const double moved = kAxisPerTip_rad_per_mm * d, tip_weight = moved * moved;
  const BranchSigns sign = signs_of(branch);
  const SinCos<S> r = sin_cos(roll);
  ArmSolution<S> arm;
  arm.frame.yaw = sin_cos(yaw);
  const Vec3<S> a = arm.frame.to_arm(pose.axis), tip = arm.frame.to_arm(pose.tip);
  Vec3<S> wanted = a;  // the axis that the wrist gives
  for (int round = 0; round < kRollRounds; ++round) {
    q = {};
    solve_in_plane(k, S(tip[0] + d * wanted[0]), S(tip[2] + d * wanted[2] - k.shoulder_height_mm),
                   sign.elbow, arm, q);
    if (!arm.is_reachable) return false;
    const SinCos<S> e = sin_cos(S(q[kShoulder] + q[kElbow]));
    const S x = -(e.cos * a[0] + e.sin * a[2]), z = e.sin * a[0] - e.cos * a[2];
    const S across = z * r.cos + (1.0 + tip_weight) * (a[1] * r.sin);
    q[kBend] = atan2(S(across / (1.0 + tip_weight * (r.sin * r.sin))), x);
    const SinCos<S> bend = sin_cos(q[kBend]);
    const S up = bend.sin * r.cos;
    wanted = {S(e.sin * up - e.cos * bend.cos), S(bend.sin * r.sin),
              S(0.0) - (e.sin * bend.cos + e.cos * up)};
  }
  q[kYaw] = yaw;
  q[kRoll] = roll;
  q[kSpin] = S(reference[kSpin]);
  return true;
}

}  // namespace meridian::robot
