// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "service/core/planner/feed/cells/feed_cells.hpp"

namespace meridian {

/// The fastest b = u̇² at the boundaries of the cells first .. first + n - 1 that keeps velocity,
/// feed and acceleration of every joint, jerk left out, from `b_begin` to rest at the end.
///
/// In a cell ü = (b₁ - b₀)/2h; with the accelerations of both ends of the cell this is a pair of
/// linear inequalities per joint in (b₀, b₁): p b₁ + r b₀ <= A. Backward: the largest b₀ for which
/// some b₁ up to the bound behind it exists. Forward: the largest b₁ from the b₀ reached. The
/// result bounds from above every motion that keeps jerk, too.
///
/// `backward` and `b` have n + 1 places. Units: mm, rad, s. Source: docs/motion.md, eq. 8.5.
/// Proof: tests/property/planner/feed_test.cpp.
void two_pass(const CellGrid& grid, const FeedLimits& limits, std::int64_t first, double b_begin,
              std::span<double> backward, std::span<double> b) noexcept;

}  // namespace meridian
