// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>

#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/lai_chain.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/winding.hpp"

/// What everybody calls: joints to pose and back, for double and for jets, in the workpiece frame W
/// of the machine. Which family of machines it is, is decided here and nowhere else. Nothing here
/// allocates or throws. Units: mm, rad. Source: docs/kinematics.md.
namespace meridian {

/// Nearer to the pole than this the free joint has no direction of its own and is held.
inline constexpr double kPoleHold_rad = 1e-9;

enum class SolveStatus : std::uint8_t {
  kOk,          ///< joints give back tip and axis
  kAtPole,      ///< inside kPoleHold_rad of the pole: free joint held, tip exact, axis within 1e-9
  kUnreachable  ///< no such joints, or the pose is not finite: do not use `q`
};

template <class S>
struct Solution {
  Joints<S> q;
  SolveStatus status;
};

/// The pose in the frame of the kinematics: X_MT = X_MW * X_WT.
template <class S>
[[nodiscard]] inline Pose<S> pose_in_machine(const MachineModel& model,
                                             const Pose<S>& pose) noexcept {
  const Eigen::Matrix3d& r = model.frame_rotation;
  const Vector3& o = model.frame_origin_mm;
  const auto turned = [&r](const Vec3<S>& v, int i) {
    return r(i, 0) * v[0] + r(i, 1) * v[1] + r(i, 2) * v[2];
  };
  return {{turned(pose.tip, 0) + o[0], turned(pose.tip, 1) + o[1], turned(pose.tip, 2) + o[2]},
          {turned(pose.axis, 0), turned(pose.axis, 1), turned(pose.axis, 2)}};
}

/// The inverse of pose_in_machine().
template <class S>
[[nodiscard]] inline Pose<S> pose_in_workpiece(const MachineModel& model,
                                               const Pose<S>& pose) noexcept {
  const Eigen::Matrix3d& r = model.frame_rotation;
  const Vector3& o = model.frame_origin_mm;
  const auto turned = [&r](const Vec3<S>& v, int i) {
    return r(0, i) * v[0] + r(1, i) * v[1] + r(2, i) * v[2];
  };
  const Vec3<S> tip{pose.tip[0] - o[0], pose.tip[1] - o[1], pose.tip[2] - o[2]};
  return {{turned(tip, 0), turned(tip, 1), turned(tip, 2)},
          {turned(pose.axis, 0), turned(pose.axis, 1), turned(pose.axis, 2)}};
}

/// Returns tip and tool axis in W of the joints `q`.
/// RT: cycle. Proof: tests/golden, tests/property/kinematics.
template <class S>
[[nodiscard]] inline Pose<S> forward(const MachineModel& model, double tool_length_mm,
                                     const Joints<S>& q) noexcept {
  const double length = model.kinematics.pivot_mm + tool_length_mm;
  return pose_in_workpiece(model, lai::forward(model.kinematics, length, q));
}

/// How many solutions of the inverse kinematics a pose has: `branch` runs from 0 below it.
[[nodiscard]] inline int branch_count(const MachineModel&) noexcept { return 2; }

/// Index of the rotary joint that the pole leaves free; -1 where the machine has no pole.
[[nodiscard]] inline int free_joint(const MachineModel&) noexcept { return lai::kTheta1; }

/// Returns the angle from the tool axis to the nearest pole, in [0, π/2], accurate down to zero.
/// Frame of `axis`: W; its length does not matter.
[[nodiscard]] inline double pole_distance(const MachineModel& model, const Vector3& axis) noexcept {
  const Vector3 k = model.frame_rotation * axis;
  return std::atan2(hypot(k[0], k[1]), std::abs(k[2]));
}

namespace detail {

/// Whether every value in `q` is a finite number.
template <class S>
[[nodiscard]] inline bool all_finite(const Joints<S>& q) noexcept {
  double zero = 0;
  for (const S& joint : q) zero += value_of(joint) * 0.0;
  return zero == 0.0;
}

}  // namespace detail

/// Returns the joints that put the tool at `pose` with the free joint (see free_joint) at `free`.
///
/// The tip is exact for any value; the axis is the nearest one that the machine has with its free
/// joint there (docs/kinematics.md, eq. 2.6). Pole turns and eased passages use it. Status: kOk or
/// kUnreachable. Frame: W. RT: cycle. Proof: tests/property/kinematics.
template <class S>
[[nodiscard]] inline Solution<S> solve_held(const MachineModel& model, double tool_length_mm,
                                            const Pose<S>& pose, const S& free) noexcept {
  const double length = model.kinematics.pivot_mm + tool_length_mm;
  Solution<S> out{lai::solve_held(model.kinematics, length, pose_in_machine(model, pose), free),
                  SolveStatus::kOk};
  if (!detail::all_finite(out.q)) out.status = SolveStatus::kUnreachable;
  return out;
}

/// Returns the joints that put the tool at `pose`, on `branch` and with every rotary joint in the
/// winding nearest to `reference`.
///
/// It follows: neighbouring poses of a path give neighbouring joints, so a rotary joint that leaves
/// travel shows there (first_joint_outside_travel) and never jumps a whole turn. Who starts a path
/// afresh calls wind_into_travel() on the result. Inside kPoleHold_rad of the pole the free joint
/// is held at the value that `reference` has, the tilt takes the sign that fits it whatever
/// `branch` is, and the status is kAtPole. `branch` outside its range counts as 1. Travel is not
/// judged here. Frame: W. RT: cycle. Proof: tests/golden, tests/property/kinematics.
template <class S>
[[nodiscard]] inline Solution<S> solve(const MachineModel& model, double tool_length_mm,
                                       const Pose<S>& pose, int branch,
                                       const JointVector& reference) noexcept {
  const double length = model.kinematics.pivot_mm + tool_length_mm;
  const Pose<S> in_machine = pose_in_machine(model, pose);
  const double square = value_of(in_machine.axis[0]) * value_of(in_machine.axis[0]) +
                        value_of(in_machine.axis[1]) * value_of(in_machine.axis[1]);
  Solution<S> out;
  if (square < kPoleHold_rad * kPoleHold_rad) {
    out.q = lai::solve_held(model.kinematics, length, in_machine, S(reference[lai::kTheta1]));
    out.status = SolveStatus::kAtPole;
  } else {
    const S radius = hypot(in_machine.axis[0], in_machine.axis[1]);
    out.q = lai::solve(model.kinematics, length, in_machine, branch == 0 ? 1.0 : -1.0, radius);
    out.q[lai::kTheta1] +=
        kTurn_rad * whole_turns(value_of(out.q[lai::kTheta1]), reference[lai::kTheta1]);
    out.status = SolveStatus::kOk;
  }
  out.q[lai::kTheta2] +=
      kTurn_rad * whole_turns(value_of(out.q[lai::kTheta2]), reference[lai::kTheta2]);
  if (!detail::all_finite(out.q)) out.status = SolveStatus::kUnreachable;
  return out;
}

/// Moves every rotary joint that has travel to the winding inside it that is nearest to
/// `reference`; where none is inside, to the winding nearest to `reference`. Endless joints go to
/// the nearest winding. For the first pose of a path: nothing that follows a path may call it.
/// Unit: rad. Proof: tests/property/kinematics.
inline void wind_into_travel(const MachineModel& model, const JointVector& reference,
                             JointVector& q) noexcept {
  constexpr double kMargin_rad = 1e-9;
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& joint = model.joints[i];
    if (!joint.is_rotary) continue;
    q[i] = joint.is_endless ? unwind(q[i], reference[i])
                            : unwind_inside(q[i], reference[i], joint.limits.travel_min,
                                            joint.limits.travel_max, kMargin_rad);
  }
}

/// Returns the first joint that is farther than `margin` outside its travel (or not a number); -1
/// where all are inside. Endless joints have no travel. Units: mm and rad alike. RT: cycle.
[[nodiscard]] inline int first_joint_outside_travel(const MachineModel& model, const JointVector& q,
                                                    double margin) noexcept {
  for (int i = 0; i < model.joint_count; ++i) {
    const JointLimits& limits = model.joints[i].limits;
    const bool is_inside = model.joints[i].is_endless ? std::isfinite(q[i])
                                                      : q[i] >= limits.travel_min - margin &&
                                                            q[i] <= limits.travel_max + margin;
    if (!is_inside) return i;
  }
  return -1;
}

/// Rows Px, Py, Pz, Kx, Ky, Kz in W; one column per joint of the machine. Fixed storage.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxJoints>;

/// Returns the derivative of forward() by the joints. Units: mm and rad per mm and rad.
[[nodiscard]] inline Jacobian jacobian(const MachineModel& model, double tool_length_mm,
                                       const JointVector& q) noexcept {
  const double length = model.kinematics.pivot_mm + tool_length_mm;
  const Eigen::Matrix<double, 6, 5> in_machine = lai::jacobian(model.kinematics, length, q);
  Jacobian out(6, 5);
  out.topRows<3>().noalias() = model.frame_rotation.transpose() * in_machine.topRows<3>();
  out.bottomRows<3>().noalias() = model.frame_rotation.transpose() * in_machine.bottomRows<3>();
  return out;
}

/// Returns sqrt(det JᵀJ), the distance from singularity: 0 on the pole. It depends on neither frame
/// nor tool.
[[nodiscard]] inline double measure(const MachineModel&, const JointVector& q) noexcept {
  return lai::measure(q);
}

}  // namespace meridian
