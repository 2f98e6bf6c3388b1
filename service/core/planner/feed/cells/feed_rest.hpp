// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "service/core/planner/feed/cells/feed_cells.hpp"
#include "service/core/planner/feed/solver/feed_check.hpp"
#include "service/core/planner/feed/solver/jerk_step.hpp"

/// Motions that begin or end at rest, where b = u̇² is no quadratic. Source: docs/motion.md,
/// section 8.
namespace meridian {

/// The first or last cell of a motion: u = jerk t³/6 from rest, or the same backwards to rest.
struct RestCell {
  FeedState state;  ///< where it meets the neighbour; slope is that of a start, a stop has -slope
  double duration = 0;
  double jerk = 0;
};

/// Largest u̇² that the cells from `first` to `last` - 1 can keep up without help of b'.
[[nodiscard]] double steady_b(const CellGrid& grid, const FeedLimits& limits, std::int64_t first,
                              std::int64_t last) noexcept;

/// Room that a first or last cell leaves for the rate of plan time: what its own acceleration and
/// velocity ask for, or the largest that a neighbour may.
enum class RestRoom : std::uint8_t { kOwn, kLargest };

/// The fastest, to a fortieth of its jerk, that keeps most of every limit in `cell` and leaves it
/// with u̇² <= 0.8 `max_b`. Always finds one.
[[nodiscard]] RestCell find_rest_cell(const FeedLimits& limits, const FeedCell& cell, bool is_start,
                                      double max_b, RestRoom room = RestRoom::kOwn) noexcept;

/// The last resort, from rest to rest: jerk +J, -J, -J, +J for a quarter of the duration each.
/// Velocity, acceleration and jerk of every joint scale with 1/T, 1/T², 1/T³, so the T that keeps
/// every limit is a closed form and always exists.
struct Crawl {
  int cells = 0;
  double length = 0;
  double duration = 0;

  /// u̇, ü, u⃛ and the time at which `x` of the length is reached, for duration 1 and length 1. On
  /// the border between two phases the jerk of the later one.
  struct Shape {
    double t = 0, v = 0, a = 0, j = 0;
  };
  [[nodiscard]] static Shape shape_at(double x) noexcept;
};

/// The crawl over `cells` cells from `first`.
[[nodiscard]] Crawl crawl_over(const CellGrid& grid, const FeedLimits& limits, std::int64_t first,
                               int cells) noexcept;

/// The use of `crawl` from cell `first` on, between the samples too; of max_b and every limit.
[[nodiscard]] FeedUse use_of(const FeedLimits& limits, const CellGrid& grid, std::int64_t first,
                             const Crawl& crawl) noexcept;

/// `crawl`, so much slower that it keeps `limits` between the samples too. Source: docs/motion.md,
/// section 8. Proof: tests/unit/planner/feed_check_test.cpp.
[[nodiscard]] Crawl checked(const FeedLimits& limits, const CellGrid& grid, std::int64_t first,
                            Crawl crawl) noexcept;

}  // namespace meridian
