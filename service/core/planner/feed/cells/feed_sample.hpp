// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/machine_model.hpp"
#include "service/core/planner/feed/cells/feed_limits.hpp"
#include "service/core/planner/feed/cells/feed_span.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"

/// What the feed planner knows of one place of a path. Units: mm, rad, s. Source: docs/motion.md,
/// section 8.
namespace meridian {

inline constexpr double kCurvatureShare = 0.7;    ///< of a limit, allowed for curvature in a cell
inline constexpr double kZeroDerivative = 1e-12;  ///< a derivative that counts as zero
inline constexpr double kMinTight = 0.2;          ///< share of A and J that is never taken away

[[nodiscard]] constexpr double square(double x) noexcept { return x * x; }

/// Derivatives of joints and drives by u at one place, and the largest u̇² that feed, velocity, and
/// the curvature terms of acceleration and jerk allow there.
struct CellSample {
  LimitedVector d1{}, d2{}, d3{};
  double max_b = 0;
};

/// Takes the sample at `x` of `span.path`, `feed_share` of its feeds being planned; `reference`,
/// the joints at the place before, become those there. kUnreachable is the only fault.
[[nodiscard]] PathFault take_sample(const MachineModel& model, const FeedLimits& limits,
                                    double feed_share, const FeedSpan& span, double x,
                                    JointVector& reference, CellSample& out) noexcept;

/// Time by u at a sample: the most of velocity and feed, and of what curvature takes.
[[nodiscard]] double time_per_u(const FeedLimits& limits, const CellSample& at) noexcept;

}  // namespace meridian
