// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "service/core/planner/feed/cells/feed_cells.hpp"

/// What a motion uses of the limits inside cells. Source: docs/motion.md, section 8.
namespace meridian {

/// Largest use of each limit; 1 is all of it. `b`: of max_b, which is feed and joint velocity.
struct FeedUse {
  double velocity = 0, acceleration = 0, jerk = 0, b = 0;

  [[nodiscard]] double worst() const noexcept { return std::max({velocity, acceleration, jerk}); }
};

/// b = u̇² as a quadratic of a cell: value and derivative at its begin, derivative at its end.
struct CellLaw {
  double b = 0, slope = 0, slope_end = 0;
};

/// u̇, ü, u⃛ at the samples of a cell.
struct CellMotion {
  std::array<double, FeedCell::kSteps + 1> v{}, a{}, j{};
};

/// The use of `motion` in `cell`: nine samples, and the tops of the parabolas through three of
/// them. Velocity over the rate filter's slope counts as acceleration.
[[nodiscard]] FeedUse use_of_motion(const FeedLimits& limits, const FeedCell& cell,
                                    const CellMotion& motion) noexcept;

/// The use of `law` in `cell`: nine samples, and the tops of the parabolas through three of them.
/// A b that is not positive somewhere counts as a use without bound. Velocity over the rate
/// filter's slope counts as acceleration. Proof: tests/unit/planner/feed_check_test.cpp.
[[nodiscard]] FeedUse use_of(const FeedLimits& limits, const FeedCell& cell,
                             const CellLaw& law) noexcept;

/// No less than use_of() but for what its parabolas rise above the samples: by the bounds of the
/// cell, at a fraction of the cost.
[[nodiscard]] FeedUse max_use_of(const FeedLimits& limits, const FeedCell& cell,
                                 const CellLaw& law) noexcept;

/// Adds the use of u̇, ü, u⃛ at one sample.
void add_use(const FeedLimits& limits, const CellSample& at, double v, double a, double j,
             FeedUse& use) noexcept;

}  // namespace meridian
