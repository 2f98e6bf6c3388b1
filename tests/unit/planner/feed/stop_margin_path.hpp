// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meridian/cycle/stop/stop_law.hpp"
#include "service/core/planner/feed/stop/feed_stop_margin.hpp"
#include "unit/planner/feed/made_cells.hpp"

/// A path whose bends a test sets, and what stops on it use and may use.
namespace meridian::test::feed_stop_margin {

inline constexpr int kCells = 80;
inline constexpr double kH = 0.5;                                    // mm, of a cell
inline constexpr double kAccel = 0.99 * 3000, kJerk = 0.99 * 60000;  // of the first joint
inline constexpr double kSlow = 0.4;                                 // rate up to which slow_* are
inline constexpr double kFaultAccel = 0.99 * 6000, kFaultJerk = 0.99 * 240000;

/// Cells along which the first joint goes d1 times as fast as the path, and bends by d2 and d3.
struct Path {
  Path() {
    for (int k = 0; k < kCells; ++k) {
      cells.grid[k].x = k * kH;
      set(k, 1);
    }
    margin.begin(cells.grid, kCells - 1);
  }
  void set(int cell, double d1, double d2 = 0, double d3 = 0) {
    FeedCell& here = cells.grid[cell];
    for (CellSample& at : here.at) {
      at.d1[0] = d1;
      at.d2[0] = d2;
      at.d3[0] = d3;
    }
    const auto side = [](double value, CellBound::Sides& sides) {
      sides.up[0] = std::max(value, 0.0);
      sides.down[0] = std::max(-value, 0.0);
    };
    here.bound = {};
    side(d1, here.bound.d1);
    side(d2, here.bound.d2);
    side(d3, here.bound.d3);
    here.bound.rate[0] = std::abs(d1);
    margin.begin(cells.grid, kCells - 1);
  }
  /// A piece from the middle of `cell` on, at v and a, for 1 ms.
  TimePiece grant(int cell, double v, double a = 0, bool is_tail = false) {
    TimePiece time;
    time.duration = 1e-3;
    time.s0 = (cell + 0.25) * kH;
    time.v = v;
    time.a = a;
    time.is_tail = is_tail;
    FeedPiece piece;
    piece.cell = cell;
    margin.grant(piece, time);
    return time;
  }

  /// The largest share of a limit that stops from `time` use, from both ends and between, slower
  /// ones included, and how far they go.
  struct Use {
    double worst = 0, farthest = 0;
  };
  [[nodiscard]] Use use(const TimePiece& time, const StopMargin& margin_of, bool is_fault,
                        double fastest = 1) const {
    Use out;
    for (const double rate : {1.0, 0.8, 0.5, 0.2}) {
      for (int k = 0; k <= 4; ++k) {
        PathState begin = state_at(time, k * time.duration / 4);
        begin = {begin.s, rate * fastest * begin.ds, rate * rate * fastest * fastest * begin.dds,
                 0};
        const StopLaw law(begin, margin_of);
        for (int n = 0; n < 60; ++n) {
          const PathState at = law.at(n * law.duration() / 60);
          const auto cell = std::min(kCells - 1, static_cast<int>(at.s / kH));
          const CellSample& here = cells.grid[cell].at[0];
          const double v = at.ds;
          const double accel = std::abs(here.d2[0] * v * v + here.d1[0] * at.dds);
          const double jerk =
              std::abs(here.d3[0] * v * v * v + 3 * here.d2[0] * v * at.dds + here.d1[0] * at.ddds);
          out.worst = std::max(
              {out.worst, accel / (is_fault ? 6000 : 3000), jerk / (is_fault ? 240000 : 60000)});
          out.farthest = std::max(out.farthest, at.s);
        }
      }
    }
    return out;
  }
  void expect_safe(const TimePiece& time) const {
    EXPECT_LE(use(time, {time.stop_accel, time.stop_jerk}, false).worst, 1);
    EXPECT_LE(use(time, {time.fault_accel, time.fault_jerk}, true).worst, 1);
    EXPECT_LE(use(time, {time.slow_stop_accel, time.slow_stop_jerk}, false, kSlow).worst, 1);
    EXPECT_LE(use(time, {time.slow_fault_accel, time.slow_fault_jerk}, true, kSlow).worst, 1);
  }

  MadeCells cells{kCells, kH, 1e6};
  FeedStopMargin margin{cells.model};
};

}  // namespace meridian::test::feed_stop_margin
