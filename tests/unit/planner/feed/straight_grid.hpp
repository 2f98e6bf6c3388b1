// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "meridian/path/build_piece.hpp"
#include "service/core/planner/feed/cells/feed_cells.hpp"
#include "support/machines.hpp"

/// A grid of cells of straight spans.
namespace meridian::test {

/// A grid without reserve for the rate, and spans that move joint 0 alone from where it is.
struct StraightGrid {
  explicit StraightGrid(const MachineModel& m = bench_machine(), const CellSettings& cells = {})
      : model(m),
        limits(make_feed_limits(model, {0, 0})),
        settings(cells),
        grid(model, limits, settings) {
    grid.begin(at, model.tool_length_mm);
  }
  FeedSpan next(double length, int cells = 0) {
    FeedSpan span;
    JointVector end = at;
    end[0] += length;
    span.path = make_joint_move(at, end, 0);
    span.path.tool_length_mm = model.tool_length_mm;
    span.length = span.path.length;
    span.cells = cells;
    at = end;
    return span;
  }
  /// One span straight from pose to pose, at whose begin the grid begins.
  FeedSpan begin_line(const ToolPose& from, const ToolPose& to, int cells) {
    FeedSpan span;
    span.path = make_line(from, to);
    span.path.tool_length_mm = model.tool_length_mm;
    span.length = span.path.length;
    span.cells = cells;
    grid.begin(solve(model, model.tool_length_mm, from, 0, JointVector{}).q, model.tool_length_mm);
    return span;
  }
  PathFault push(double length, int cells = 0) { return grid.push(next(length, cells)); }
  /// Expects cells without a gap, from the begin of every span to its end.
  void expect_gapless(std::vector<double> lengths) const {
    std::vector<double> sums(lengths.size(), 0);
    for (std::int64_t k = grid.first(); k < grid.last(); ++k) {
      ASSERT_LT(grid[k].span, lengths.size());
      EXPECT_NEAR(grid[k].x, sums[grid[k].span], 1e-9) << k;
      sums[grid[k].span] += grid[k].h;
    }
    for (std::size_t n = 0; n < lengths.size(); ++n) EXPECT_NEAR(sums[n], lengths[n], 1e-9) << n;
  }

  MachineModel model;
  FeedLimits limits;
  CellSettings settings;
  JointVector at{};
  CellGrid grid;
};

}  // namespace meridian::test
