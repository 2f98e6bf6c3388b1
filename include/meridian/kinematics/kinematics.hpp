// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <type_traits>

#include "meridian/geometry/jet.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/chain.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/lai_chain.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/robot.hpp"
#include "meridian/kinematics/travel.hpp"
#include "meridian/kinematics/winding.hpp"

/// What everybody calls: joints to pose and back, for double and for jets, in the workpiece frame W
/// of the machine. Which family of machines it is, is decided here and nowhere else. Nothing here
/// allocates or throws. Units: mm, rad. Source: docs/kinematics.md.
namespace meridian {

/// Nearer to the pole than this the redundant joint has no direction of its own and is held.
inline constexpr double kPoleHold_rad = 1e-9;

enum class SolveStatus : std::uint8_t {
  kOk,      ///< joints give back tip and axis
  kAtPole,  ///< inside kPoleHold_rad of the pole: redundant joint held, tip exact, axis within 1e-9
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
                                             const Pose<S>& X_WT) noexcept {
  const Eigen::Matrix3d& R_MW = model.X_MW.rotation;
  const Vector3& p_MW = model.X_MW.origin_mm;
  const auto in_M = [&R_MW](const Vec3<S>& v_W, int i) {
    return R_MW(i, 0) * v_W[0] + R_MW(i, 1) * v_W[1] + R_MW(i, 2) * v_W[2];
  };
  return {{in_M(X_WT.tip, 0) + p_MW[0], in_M(X_WT.tip, 1) + p_MW[1], in_M(X_WT.tip, 2) + p_MW[2]},
          {in_M(X_WT.axis, 0), in_M(X_WT.axis, 1), in_M(X_WT.axis, 2)}};
}

/// The inverse of pose_in_machine(): X_WT = X_WM * X_MT.
template <class S>
[[nodiscard]] inline Pose<S> pose_in_workpiece(const MachineModel& model,
                                               const Pose<S>& X_MT) noexcept {
  const Eigen::Matrix3d& R_MW = model.X_MW.rotation;
  const Vector3& p_MW = model.X_MW.origin_mm;
  const auto in_W = [&R_MW](const Vec3<S>& v_M, int i) {
    return R_MW(0, i) * v_M[0] + R_MW(1, i) * v_M[1] + R_MW(2, i) * v_M[2];
  };
  const Vec3<S> p_M{X_MT.tip[0] - p_MW[0], X_MT.tip[1] - p_MW[1], X_MT.tip[2] - p_MW[2]};
  return {{in_W(p_M, 0), in_W(p_M, 1), in_W(p_M, 2)},
          {in_W(X_MT.axis, 0), in_W(X_MT.axis, 1), in_W(X_MT.axis, 2)}};
}

/// By how much the tool axis misses the pole, signed; 0 where it does not.
[[nodiscard]] inline double pole_offset_rad(const MachineModel& model) noexcept {
  return model.family == MachineFamily::kChain ? model.chain.pole_offset_rad : 0;
}

/// Returns tip and tool axis in W of the joints `q`.
/// RT: cycle. Proof: tests/golden, tests/property/kinematics.
template <class S>
[[nodiscard]] inline Pose<S> forward(const MachineModel& model, double tool_length_mm,
                                     const Joints<S>& q) noexcept {
  switch (model.family) {
    case MachineFamily::kChain:
      return pose_in_workpiece(model, chain::forward(model.chain, tool_length_mm, q));
    case MachineFamily::kRobot:
      return pose_in_workpiece(model, robot::forward(model.robot, tool_length_mm, q));
    case MachineFamily::kLai:
      break;
  }
  return pose_in_workpiece(model, lai::forward(model.lai, model.lai.pivot_mm + tool_length_mm, q));
}

/// forward() with the tool axis as it really is: of a machine whose tool axis misses the pole it is
/// off there (docs/kinematics.md, eq. 4.12).
[[nodiscard]] inline ToolPose true_pose(const MachineModel& model, double tool_length_mm,
                                        const JointVector& q) noexcept {
  ToolPose pose = forward(model, tool_length_mm, q);
  if (pole_offset_rad(model) != 0) {
    pose.axis = model.X_MW.rotation.transpose() * chain::true_axis(model.chain, q);
  }
  return pose;
}

/// How many solutions of the inverse kinematics a pose has: `branch` runs from 0 below it.
[[nodiscard]] inline int branch_count(const MachineModel& model) noexcept {
  return model.family == MachineFamily::kRobot ? robot::kBranchCount : 2;
}

/// Whether joints may turn as sharply as one pleases off the poles of the tool axis too: of a robot
/// at its singular places, of slides where the rotary joints turn them into one plane, about the
/// axes that a chain without a pole does not reach.
[[nodiscard]] inline bool has_inner_singularities(const MachineModel& model) noexcept {
  if (model.family != MachineFamily::kChain) return model.family == MachineFamily::kRobot;
  const ChainKinematics& k = model.chain;
  return k.slides_align || !(k.has_pole || k.has_opposite_pole);
}

/// Index of the rotary joint that the pole leaves free; -1 where the machine has no pole of the
/// tool axis (robots are singular by where the arm stands, not by where the tool points).
[[nodiscard]] inline int redundant_joint(const MachineModel& model) noexcept {
  if (model.family == MachineFamily::kLai) return lai::kTheta1;
  const bool has_pole = model.family == MachineFamily::kChain &&
                        (model.chain.has_pole || model.chain.has_opposite_pole);
  return has_pole ? model.chain.a.joint : -1;
}

/// Returns the direction of the pole in W, unit: the tool axis along the redundant joint's own
/// axis. Of a machine with two opposite poles, either. Zero where it has none.
[[nodiscard]] inline Vector3 pole_direction(const MachineModel& model) noexcept {
  if (redundant_joint(model) < 0) return Vector3::Zero();
  Vector3 pole_M = Vector3::UnitZ();
  if (model.family == MachineFamily::kChain) {
    pole_M = model.chain.has_pole ? model.chain.a.axis : Vector3(-model.chain.a.axis);
  }
  return model.X_MW.rotation.transpose() * pole_M;
}

/// Returns the angle from the tool axis to the nearest pole, accurate down to zero; π where the
/// machine has no pole. The length of `k_W` does not matter.
[[nodiscard]] inline double pole_distance(const MachineModel& model, const Vector3& k_W) noexcept {
  const Vector3 k_M = model.X_MW.rotation * k_W;
  switch (model.family) {
    case MachineFamily::kChain:
      return chain::pole_distance(model.chain, k_M);
    case MachineFamily::kRobot:
      return std::numbers::pi;
    case MachineFamily::kLai:
      break;
  }
  return atan2(hypot(k_M[0], k_M[1]), std::abs(k_M[2]));
}

namespace detail {

/// Whether every value in `q` is a finite number.
template <class S>
[[nodiscard]] inline bool all_finite(const Joints<S>& q) noexcept {
  double zero = 0;
  for (const S& joint : q) zero += value_of(joint) * 0.0;
  return zero == 0.0;
}

/// By whether the branch is another than 0: looked up, for a processor cannot guess it.
inline constexpr std::array<double, 2> kBranchSign{1.0, -1.0};

/// `v` made exactly unit.
template <class S>
[[nodiscard]] inline Vec3<S> made_unit(const Vec3<S>& v) noexcept {
  constexpr double kNearlyUnit = 1e-8;  // of the square; its own square is below a rounding
  using std::sqrt;
  const S square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  S per_norm;
  if (std::is_same_v<S, double> && std::abs(value_of(square) - 1.0) < kNearlyUnit) {
    per_norm = 1.5 - 0.5 * square;
  } else {
    per_norm = 1.0 / sqrt(square);
  }
  return {v[0] * per_norm, v[1] * per_norm, v[2] * per_norm};
}

/// The families beside the first stay calls of their own: inlined into solve() they would cost
/// every machine the registers.
///
/// Puts rotary joint `i` into the winding nearest to `reference`.
template <class S>
inline void wind(Joints<S>& q, int i, const JointVector& reference) noexcept {
  q[i] += kTurn_rad * whole_turns(value_of(q[i]), reference[i]);
}

template <class S>
[[nodiscard]] inline SolveStatus solve_lai(const MachineModel& model, double tool_length_mm,
                                           const Pose<S>& X_MT, int branch,
                                           const JointVector& reference, Joints<S>& q) noexcept {
  const double length = model.lai.pivot_mm + tool_length_mm;
  const double square = value_of(X_MT.axis[0]) * value_of(X_MT.axis[0]) +
                        value_of(X_MT.axis[1]) * value_of(X_MT.axis[1]);
  if (square < kPoleHold_rad * kPoleHold_rad) {
    q = lai::solve_held(model.lai, length, X_MT, S(reference[lai::kTheta1]));
    wind(q, lai::kTheta2, reference);
    return SolveStatus::kAtPole;
  }
  const S radius = hypot(X_MT.axis[0], X_MT.axis[1]);
  q = lai::solve(model.lai, length, X_MT, kBranchSign[branch != 0], radius);
  wind(q, lai::kTheta1, reference);
  wind(q, lai::kTheta2, reference);
  return SolveStatus::kOk;
}

template <class S>
[[nodiscard, gnu::noinline]] inline SolveStatus solve_chain(const MachineModel& model,
                                                            double tool_length_mm,
                                                            const Pose<S>& X_MT, int branch,
                                                            const JointVector& reference,
                                                            Joints<S>& q) noexcept {
  const ChainKinematics& k = model.chain;
  const Vec3<S> z = made_unit(chain::in_frame_a(k, X_MT.axis));
  if (chain::is_at_pole(k, z, kPoleHold_rad)) {
    const bool is_solved = chain::solve_held(k, tool_length_mm, X_MT, S(reference[k.a.joint]), q);
    wind(q, k.b.joint, reference);
    return is_solved ? SolveStatus::kAtPole : SolveStatus::kUnreachable;
  }
  const bool is_solved = chain::solve(k, tool_length_mm, X_MT.tip, z, kBranchSign[branch != 0], q);
  wind(q, k.a.joint, reference);
  wind(q, k.b.joint, reference);
  return is_solved ? SolveStatus::kOk : SolveStatus::kUnreachable;
}

template <class S>
[[nodiscard, gnu::noinline]] inline SolveStatus solve_robot(const MachineModel& model,
                                                            double tool_length_mm,
                                                            const Pose<S>& any, int branch,
                                                            const JointVector& reference,
                                                            Joints<S>& q) noexcept {
  const Pose<S> X_MT{any.tip, made_unit(any.axis)};
  bool is_held = false;
  if (!robot::solve(model.robot, tool_length_mm, X_MT, branch, reference, q, is_held)) {
    return SolveStatus::kUnreachable;
  }
  for (int i = 0; i < model.joint_count; ++i) wind(q, i, reference);
  return is_held ? SolveStatus::kAtPole : SolveStatus::kOk;
}

}  // namespace detail

/// Returns the joints that put the tool at `X_WT` with the redundant joint (see redundant_joint) at
/// `free`.
///
/// The tip is exact for any value; the axis is the nearest one that the machine has with its free
/// joint there (docs/kinematics.md, eq. 2.6). Pole turns and relaxed passages use it. Status: kOk
/// or kUnreachable. Frame: W. RT: cycle. Proof: tests/property/kinematics.
template <class S>
[[nodiscard]] inline Solution<S> solve_held(const MachineModel& model, double tool_length_mm,
                                            const Pose<S>& X_WT, const S& free) noexcept {
  const Pose<S> X_MT = pose_in_machine(model, X_WT);
  Solution<S> out{{}, SolveStatus::kOk};
  bool is_reachable = true;
  switch (model.family) {
    case MachineFamily::kLai:
      out.q = lai::solve_held(model.lai, model.lai.pivot_mm + tool_length_mm, X_MT, free);
      break;
    case MachineFamily::kChain:
      is_reachable = chain::solve_held(model.chain, tool_length_mm, X_MT, free, out.q);
      break;
    case MachineFamily::kRobot:
      is_reachable = false;
      break;
  }
  if (!is_reachable || !detail::all_finite(out.q)) out.status = SolveStatus::kUnreachable;
  return out;
}

/// Returns the joints that put the tool at `X_WT`, on `branch` and with every rotary joint in the
/// winding nearest to `reference`.
///
/// It follows: neighbouring poses of a path give neighbouring joints, so a rotary joint that leaves
/// travel shows there (first_joint_outside_travel) and never jumps a whole turn. Who starts a path
/// afresh calls wind_into_travel() on the result. Inside kPoleHold_rad of the pole the redundant
/// joint is held at the value that `reference` has, the tilt takes the sign that fits it whatever
/// `branch` is, and the status is kAtPole. `branch` outside its range counts as 1. Travel is not
/// checked here. Frame: W. RT: cycle. Proof: tests/golden, tests/property/kinematics.
template <class S>
[[nodiscard]] inline Solution<S> solve(const MachineModel& model, double tool_length_mm,
                                       const Pose<S>& X_WT, int branch,
                                       const JointVector& reference) noexcept {
  const Pose<S> X_MT = pose_in_machine(model, X_WT);
  Solution<S> out;
  switch (model.family) {
    case MachineFamily::kLai:
      out.status = detail::solve_lai(model, tool_length_mm, X_MT, branch, reference, out.q);
      break;
    case MachineFamily::kChain:
      out.status = detail::solve_chain(model, tool_length_mm, X_MT, branch, reference, out.q);
      break;
    case MachineFamily::kRobot:
      out.status = detail::solve_robot(model, tool_length_mm, X_MT, branch, reference, out.q);
      break;
  }
  if (!detail::all_finite(out.q)) out.status = SolveStatus::kUnreachable;
  return out;
}

}  // namespace meridian
