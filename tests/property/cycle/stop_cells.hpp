// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "service/core/planner/feed/cells/feed_cells.hpp"

namespace meridian::test {

/// Cells of the path ahead of a stop, finer towards its rest, with what the joints do in each. The
/// ends of path pieces, where derivatives jump, lie on knots.
class StopCells {
 public:
  static constexpr int kCells = 72;  ///< that in which it lands comes last

  StopCells(const MachineModel& machine, const FeedLimits& limits)
      : limits_(limits), grid_(machine, limits, {}), knots_(kCells + 1) {}

  /// From `begin` over `length`. `path` gives joints in jets at path lengths that grow; its end()
  /// is that of the path piece which it was asked for last.
  template <class Path>
  void make(double begin, double length, Path path) {
    set_knots(begin, length, path);
    for (int k = 0; k < kCells; ++k) {
      FeedCell& cell = grid_[k];
      cell.h = knots_[k + 1] - knots_[k];
      for (int i = 0; i <= FeedCell::kSteps; ++i) {
        const double x =
            std::clamp(static_cast<double>(i) / FeedCell::kSteps, kInside, 1 - kInside);
        sample(path(begin + knots_[k] + x * cell.h), cell.at[i]);
      }
      cell.max_b = kVelocity * cell.at[FeedCell::kSteps / 2].max_b;
    }
  }
  [[nodiscard]] const CellGrid& grid() const { return grid_; }
  [[nodiscard]] const std::vector<double>& knots() const { return knots_; }

 private:
  static constexpr double kPower = 2.5;      // of the length left, over evenly spaced knots
  static constexpr double kLanding = 0.2;    // of what the knots are spaced by
  static constexpr double kVelocity = 1.01;  // on ds²: the limit may fall inside of a cell
  static constexpr double kInside = 1e-6;    // of a cell, off its ends

  template <class Path>
  void set_knots(double begin, double length, Path path) {
    for (int k = 0; k <= kCells; ++k) {
      const double left = k == kCells ? 0 : 1 - (1 - kLanding) * k / (kCells - 1);
      knots_[k] = length * (1 - std::pow(left, kPower));
    }
    int moved = 0;
    for (int k = 1; k < kCells; ++k) {
      (void)path(begin + 0.5 * (knots_[k - 1] + knots_[k]));
      const double end = path.end() - begin;
      const bool is_near = std::abs(end - knots_[k]) < 0.5 * (knots_[k] - knots_[k - 1]);
      if (!is_near || moved == k - 1) continue;
      knots_[k] = end;
      moved = k;
    }
  }

  template <class Jets>
  void sample(const Jets& q, CellSample& out) const {
    out.max_b = 1e12;
    for (std::size_t i = 0; i < static_cast<std::size_t>(limits_.count); ++i) {
      out.d1[i] = q[i].derivative(1);
      out.d2[i] = q[i].derivative(2);
      out.d3[i] = q[i].derivative(3);
      const double d1 = std::max(std::abs(out.d1[i]), kZeroDerivative);
      out.max_b = std::min(out.max_b, square(limits_.velocity[i] / d1));
    }
  }

  FeedLimits limits_;
  CellGrid grid_;
  std::vector<double> knots_;
};

}  // namespace meridian::test
