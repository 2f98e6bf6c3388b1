// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "meridian/path/build_piece.hpp"
#include "service/core/planner/feed/cells/feed_cells.hpp"
#include "service/core/planner/feed/solver/jerk_step.hpp"
#include "support/machines.hpp"

/// Cells whose lengths and derivatives a test sets, and problems of the feed on them.
namespace meridian::test {

/// A grid of `count` cells (40 at least) in which one quantity with limits follows the path evenly
/// and nothing else moves, until a test says otherwise.
struct MadeCells {
  explicit MadeCells(int count, double h = 0.5, double max_b = 1e4)
      : grid(model, make_feed_limits(model, {0, 0}), {}) {
    JointVector end{};
    end[0] = 1;
    FeedSpan span;
    span.path = make_joint_move({}, end, 0);
    span.length = span.path.length;
    span.cells = count;
    grid.begin({}, model.tool_length_mm);
    (void)grid.push(span);
    (void)grid.finish();
    for (std::int64_t k = grid.first(); k < grid.last(); ++k) {
      grid[k].h = h;
      grid[k].max_b = max_b;
      for (CellSample& at : grid[k].at) {
        at = {};
        at.d1[0] = 1;
        at.max_b = max_b;
      }
    }
  }

  MachineModel model = bench_machine();
  CellGrid grid;
};

/// Limits of the first `count` quantities, all alike, and no reserve for the rate.
inline FeedLimits even_limits(int count, double velocity, double acceleration, double jerk) {
  FeedLimits limits;
  limits.count = count;
  for (int i = 0; i < count; ++i) {
    limits.velocity[i] = velocity;
    limits.acceleration[i] = acceleration;
    limits.jerk[i] = limits.full_jerk[i] = jerk;
  }
  return limits;
}

/// A problem with its arrays: jerk is linearised at `bar` everywhere, shares are 1.
struct MadeProblem {
  MadeProblem(int cells, double bar)
      : bar_knots(cells + 1, bar),
        bar_middles(cells, bar),
        accel_share(cells + 1, 1),
        jerk_share(cells + 1, 1) {}
  [[nodiscard]] JerkProblem between(const FeedState& begin, const FeedState& end,
                                    std::int64_t first = 0) const {
    return {first,
            static_cast<int>(bar_middles.size()),
            begin,
            end,
            bar_knots.data(),
            bar_middles.data(),
            accel_share.data(),
            jerk_share.data()};
  }
  /// The next programme is linearised at the result of the last.
  void linearise_at(const JerkStep& solved) {
    for (std::size_t k = 0; k < bar_knots.size(); ++k) bar_knots[k] = solved.b(int(k));
    for (std::size_t k = 0; k < bar_middles.size(); ++k) bar_middles[k] = solved.middle(int(k));
  }

  std::vector<double> bar_knots, bar_middles, accel_share, jerk_share;
};

}  // namespace meridian::test
