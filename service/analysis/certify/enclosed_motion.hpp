// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/path_piece.hpp"
#include "service/analysis/certify/taylor.hpp"

namespace meridian::certify {

/// Coefficients that are kept: the third derivative and what bounds its changes over a stretch.
inline constexpr int kOrder = 6;
using Enclosure = Taylor<kOrder>;

/// What has limits, as functions of time about an instant or all over a stretch.
struct EnclosedMotion {
  Limited<Enclosure> q;      ///< joints and drives; windings are those nearest to the piece's begin
  Enclosure tip_square;      ///< tip speed squared, (mm/s)², one order less
  bool is_reported = false;  ///< false: out of reach, or a joint is held for want of a direction
};

/// From path length to what has limits, by the functions that the cycle calls (planner/joints_at).
/// `s` encloses the path length as a function of time.
[[nodiscard]] EnclosedMotion enclose(const MachineModel& model, const PathPiece& path,
                                     const Enclosure& s, const JointVector& reference,
                                     bool wants_tip);

}  // namespace meridian::certify
