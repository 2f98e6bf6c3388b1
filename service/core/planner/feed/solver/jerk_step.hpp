// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "service/core/planner/feed/cells/feed_cells.hpp"
#include "service/core/planner/feed/solver/jerk_rows.hpp"

/// The fastest feed inside velocity, acceleration and jerk of every joint, as one convex programme.
/// Source: docs/motion.md, section 8.
namespace meridian {

/// b = u̇² and its derivative by u at a boundary of cells.
struct FeedState {
  double b = 0, slope = 0;
};

/// What to solve. b is a quadratic in every cell, b and b' are continuous; `knots` places are the
/// boundaries, one more than cells. Everything is read during solve() only.
struct JerkProblem {
  std::int64_t first = 0;  ///< first cell
  int cells = 0;
  FeedState begin, end;
  const double* bar_knots = nullptr;    ///< b around which jerk is linearised, > 0
  const double* bar_middles = nullptr;  ///< the same in the middle of every cell
  const double* accel_share = nullptr;  ///< of A, at the boundaries
  const double* jerk_share = nullptr;   ///< of J, in the cells
  const double* bar_slopes = nullptr;   ///< b' at the boundaries beside bar_knots; NaN: not known
};

/// Minimises the time of a window by a primal-dual interior point with Mehrotra's predictor and
/// corrector. The unknowns are the coefficients of b as a quadratic B-spline; a row of the
/// programme touches three of them, so a Newton step is one pentadiagonal LDLᵀ. Jerk |l₃(c)| <= J
/// b^-½ is replaced by the tangent of b^-½ at `bar`, which lies below: what it returns keeps jerk
/// at both ends and the middle of every cell.
///
/// Fixed store for `max_cells` of a problem, at most kRounds rounds, no clock: the same problem
/// gives the same bits.
class JerkStep {
 public:
  static constexpr int kCells = 160;  ///< no store is for more
  static constexpr int kRounds = 45;

  JerkStep(const CellGrid& grid, const FeedLimits& limits, int max_cells);

  /// Whether a plan was found, which b(), slope() and middle() then give. Cells in [2, max_cells].
  [[nodiscard]] bool solve(const JerkProblem& problem) noexcept;

  [[nodiscard]] double b(int knot) const noexcept {
    return left_[knot] * c_[knot] * bar_[knot] + right_[knot] * c_[knot + 1] * bar_[knot + 1];
  }
  [[nodiscard]] double slope(int knot) const noexcept {
    return rise_[knot] * (c_[knot + 1] * bar_[knot + 1] - c_[knot] * bar_[knot]);
  }
  [[nodiscard]] double middle(int cell) const noexcept { return middle_of(cell, c_); }

  /// Rounds of the last solve().
  [[nodiscard]] int rounds() const noexcept { return round_; }

 private:
  static constexpr int kLanes = 4;
  static constexpr int kPacks = (JerkRows::kMax + kLanes - 1) / kLanes;
  using Pack = Eigen::Array<double, kLanes, 1>;
  using Values = std::vector<double>;

  /// Rows a·c <= limit of one cell with their slacks and multipliers, four at a time.
  struct CellRows {
    int packs = 0;
    std::array<Pack, kPacks> a0, a1, a2, limit, slack, lambda, step_slack, step_lambda;
    std::array<Pack, kPacks> residual, inverse;  ///< a·c + slack - limit, and 1/slack
  };

  void set_up(const JerkProblem& problem) noexcept;
  void set_up_cells(const JerkProblem& problem) noexcept;
  [[nodiscard]] JerkCell describe(const JerkProblem& problem, int cell) const noexcept;
  void put_row(int cell, int row, const JerkRow& from) noexcept;
  void set_ends(const JerkProblem& problem) noexcept;
  void start() noexcept;
  [[nodiscard]] double middle_of(int cell, const Values& c) const noexcept {
    return middle_[cell][0] * c[cell] + middle_[cell][1] * c[cell + 1] +
           middle_[cell][2] * c[cell + 2];
  }
  /// Gradient, Newton matrix and residuals at c_. False: b is not positive somewhere.
  [[nodiscard]] bool assemble() noexcept;
  void factorise() noexcept;
  /// Step towards complementarity `centre`; with the second order term of the step before it.
  void find_step(double centre, bool is_corrector) noexcept;
  void substitute() noexcept;
  [[nodiscard]] double gap_after_step() const noexcept;
  void take_step() noexcept;

  const CellGrid& grid_;
  FeedLimits limits_;
  int cells_ = 0, round_ = 0;
  int sample_count_ = 0;  ///< for rows, those that fill up a pack included
  double time_ = 0, gap_ = 0, primal_ = 0, dual_ = 0;
  double step_primal_ = 0, step_dual_ = 0;
  Values h_, left_, right_, rise_;  ///< spline: b_k = left c_k + right c_{k+1}, b'_k = rise (..)
  Values bar_, c_, step_, gradient_, pull_;
  Values diagonal_, first_off_, second_off_;
  std::vector<JerkCoefficients> middle_;
  std::vector<CellRows> rows_;
  JerkRows found_;
};

}  // namespace meridian
