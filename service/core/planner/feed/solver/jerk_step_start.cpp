// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "service/core/planner/feed/solver/jerk_step.hpp"

/// Rows of the programme of a window, and the point at which its rounds start.
namespace meridian {
namespace {

constexpr double kMinSlack = 1e-2;
constexpr double kMinScale = 1e-3;  // of the limit: a row of a joint that hardly moves

}  // namespace

void JerkStep::set_up(const JerkProblem& problem) noexcept {
  cells_ = problem.cells;
  for (int i = 0; i < cells_; ++i) h_[i] = grid_[problem.first + i].h;
  for (int k = 0; k <= cells_; ++k) {
    const double before = h_[std::max(k - 1, 0)], after = h_[std::min(k, cells_ - 1)];
    left_[k] = after / (before + after);
    right_[k] = before / (before + after);
    rise_[k] = 2 / (before + after);
  }
  bar_[0] = problem.bar_knots[0];
  bar_[cells_ + 1] = problem.bar_knots[cells_];
  for (int i = 0; i < cells_; ++i) bar_[i + 1] = problem.bar_middles[i];
  set_up_cells(problem);
  for (int k = 0; k < cells_ + 2; ++k) c_[k] = 0.5;
  set_ends(problem);
}

void JerkStep::set_ends(const JerkProblem& problem) noexcept {
  const int m = cells_;
  const FeedState& begin = problem.begin;
  const FeedState& end = problem.end;
  c_[0] = (begin.b - right_[0] / rise_[0] * begin.slope) / bar_[0];
  c_[1] = (begin.b + left_[0] / rise_[0] * begin.slope) / bar_[1];
  c_[m] = (end.b - right_[m] / rise_[m] * end.slope) / bar_[m];
  c_[m + 1] = (end.b + left_[m] / rise_[m] * end.slope) / bar_[m + 1];
}

void JerkStep::put_row(int cell, int row, const JerkRow& from) noexcept {
  const JerkCoefficients& a = from.a;
  const double a0 = a[0] * bar_[cell], a1 = a[1] * bar_[cell + 1], a2 = a[2] * bar_[cell + 2];
  const double scale = std::max(
      {std::abs(a0), std::abs(a1), std::abs(a2), std::abs(from.limit) * kMinScale, 1e-300});
  CellRows& rows = rows_[cell];
  const int pack = row / kLanes, lane = row % kLanes;
  rows.a0[pack][lane] = a0 / scale;
  rows.a1[pack][lane] = a1 / scale;
  rows.a2[pack][lane] = a2 / scale;
  rows.limit[pack][lane] = from.limit / scale;
}

/// What is known of a cell beforehand, |b'| at its end left out.
JerkCell JerkStep::describe(const JerkProblem& problem, int i) const noexcept {
  JerkCell at;
  at.cell = &grid_[problem.first + i];
  at.is_first = i == 0;
  at.b = {left_[i], right_[i], 0};
  at.slope = {-rise_[i], rise_[i], 0};
  at.end = {0, -rise_[i + 1], rise_[i + 1]};
  for (int t = 0; t < 3; ++t) {
    at.middle[t] = at.b[t] + (3 * at.slope[t] + at.end[t]) * h_[i] / 8;
  }
  at.bar = {problem.bar_knots[i], problem.bar_middles[i], problem.bar_knots[i + 1]};
  if (const double* const slope = problem.bar_slopes) {
    at.bar_slope = {slope[i], 0.5 * (slope[i] + slope[i + 1]), slope[i + 1]};
  }
  const bool is_last = i + 1 == cells_;
  const double max_begin = grid_.max_b_at(problem.first + i);
  at.max_b = {at.is_first ? problem.begin.b : max_begin, std::min(max_begin, at.cell->max_b),
              is_last ? problem.end.b : grid_.max_b_at(problem.first + i + 1)};
  at.accel_share = problem.accel_share[i];
  at.jerk_share = problem.jerk_share[i];
  if (at.is_first) {
    at.max_slope = std::abs(problem.begin.slope);
  } else {
    bound_slope(limits_, at);
  }
  return at;
}

void JerkStep::set_up_cells(const JerkProblem& problem) noexcept {
  JerkCell at = describe(problem, 0);
  sample_count_ = 0;
  for (int i = 0; i < cells_; ++i) {
    JerkCell next;
    if (i + 1 < cells_) next = describe(problem, i + 1);
    at.max_end = i + 1 < cells_ ? next.max_slope : std::abs(problem.end.slope);
    found_.find(limits_, at);
    const int packs = rows_[i].packs = (found_.count() + kLanes - 1) / kLanes;
    for (int row = 0; row < packs * kLanes; ++row) {
      put_row(i, row, row < found_.count() ? found_[row] : JerkRow{{}, 1});
    }
    sample_count_ += packs * kLanes;
    for (int t = 0; t < 3; ++t) middle_[i][t] = at.middle[t] * bar_[i + t];
    at = next;
  }
}

void JerkStep::start() noexcept {
  double time = 0;
  for (int i = 0; i < cells_; ++i) time += h_[i] / std::sqrt(std::max(middle_of(i, c_), 1e-9));
  const double centre = time / sample_count_;
  for (int i = 0; i < cells_; ++i) {
    CellRows& rows = rows_[i];
    for (int p = 0; p < rows.packs; ++p) {
      const Pack value = rows.a0[p] * c_[i] + rows.a1[p] * c_[i + 1] + rows.a2[p] * c_[i + 2];
      rows.slack[p] = (rows.limit[p] - value).max(kMinSlack);
      rows.lambda[p] = centre / rows.slack[p];
      rows.step_slack[p] = rows.step_lambda[p] = Pack::Zero();
    }
  }
}

}  // namespace meridian
