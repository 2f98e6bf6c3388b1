// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/solve_driven.hpp"
#include "meridian/path/path_piece.hpp"
#include "meridian/path/pose_at.hpp"

namespace meridian {

/// Returns the joints at `pose`, that of the kSpline `piece` at path length `s`, with its redundant
/// joints at the values of its quintics. Out of line: no other path has its code. Units: mm, rad.
/// RT: cycle. Proof: tests/property/planner/singular_sweep_test.cpp.
template <class S>
[[nodiscard, gnu::noinline]] Solution<S> joints_on_driven_spline(
    const MachineModel& model, const PathPiece& piece, const Pose<S>& pose, const S& s,
    const JointVector& reference) noexcept {
  const S share = s / piece.length;
  const bool has_roll = (piece.branch & robot::kYawAndRollDriven) != 0;
  return solve_driven(model, piece.tool_length_mm, pose, quintic_at(piece.free_quintic, share),
                      has_roll ? quintic_at(piece.roll_quintic, share) : S(0.0), piece.branch,
                      reference);
}

}  // namespace meridian
