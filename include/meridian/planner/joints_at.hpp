// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/geometry/vector3.hpp"
#include "meridian/kinematics/joints.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/solve_driven.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/path_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/driven_spline.hpp"

namespace meridian {

/// Returns the joints of `piece` at path length `s`, rotary joints in the winding nearest to
/// `reference`: the joints at the last evaluated place of the path, joints_begin for the first one.
///
/// kTurn pieces and pieces with a driven redundant joint take it from the piece: `reference`
/// matters for their tilt only. Status kUnreachable means: do not use the joints. Units: mm, rad.
/// RT: cycle. Proof: tests/unit/planner/joints_at_test.cpp.
template <class S>
[[nodiscard]] inline Solution<S> joints_at(const MachineModel& model, const PathPiece& piece,
                                           const S& s, const JointVector& reference) noexcept {
  const bool is_point = !(piece.length > 0);
  if (piece.kind == PathKind::kJoint) {
    Solution<S> out{{}, SolveStatus::kOk};
    const S share = is_point ? S(0.0) : S(s / piece.length);
    for (int i = 0; i < model.joint_count; ++i) {
      out.q[i] = piece.joints_begin[i] + (piece.joints_end[i] - piece.joints_begin[i]) * share;
    }
    return out;
  }
  const Pose<S> pose = pose_at(piece, s);
  if (piece.kind == PathKind::kSpline && piece.is_free_driven) {
    return joints_on_driven_spline(model, piece, pose, s, reference);
  }
  if (piece.is_free_driven || piece.kind == PathKind::kTurn) {
    const double by = piece.free_end - piece.free_begin;
    const S free =
        is_point || by == 0 ? S(piece.free_begin) : S(piece.free_begin + by * (s / piece.length));
    return solve_driven(model, piece.tool_length_mm, pose, free, piece.branch, reference);
  }
  return solve(model, piece.tool_length_mm, pose, piece.branch, reference);
}

}  // namespace meridian
