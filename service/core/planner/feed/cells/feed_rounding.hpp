// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/path_piece.hpp"
#include "service/core/planner/feed/cells/feed_limits.hpp"

/// What rounding of poses takes of the jerk beside a singularity. Source: docs/motion.md, section
/// 8. Proof: tests/unit/planner/feed/feed_rounding_test.cpp.
namespace meridian {

/// Share of jerk left beside what rounding shows as in third differences of joints that are solved
/// for, at `x` of `path` where they are at `joints`: near the pole of the tool axis; of a robot
/// near the base axis, where its wrist is stretched, and most where both are near.
[[nodiscard]] double share_beside_singularity(const MachineModel& model, const FeedLimits& limits,
                                              const PathPiece& path, double x,
                                              const JointVector& joints) noexcept;

}  // namespace meridian
