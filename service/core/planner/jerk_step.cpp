// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/jerk_step.hpp"

#include <algorithm>
#include <cmath>

namespace meridian {
namespace {

constexpr double kLeastSlack = 1e-2;
constexpr double kGapGoal = 1e-4;     // of the time
constexpr double kPrimalGoal = 1e-7;  // rows are scaled to about 1
constexpr double kPrimalGood = 1e-5;  // what is accepted when the rounds are over
constexpr double kToTheWall = 0.995;  // share of the way to the next bound that is gone
constexpr double kFreeBegin = 11;     // the begin is given: its own rows bind nothing
constexpr double kLeastScale = 1e-3;  // of the limit: a row of a joint that hardly moves
constexpr int kStallRounds = 6;       // the primal residual has to halve in them

}  // namespace

JerkStep::JerkStep(const CellGrid& grid, const FeedLimits& limits) : grid_(grid), limits_(limits) {
  for (Values* v : {&h_, &left_, &right_, &rise_, &bar_, &c_, &step_, &gradient_, &pull_,
                    &diagonal_, &first_off_, &second_off_}) {
    v->resize(kCells + 2);
  }
  middle_.resize(kCells);
  rows_.resize(kCells);
  packs_ = (8 * limits_.count + 2 + kLanes - 1) / kLanes;
}

void JerkStep::set_up(const JerkProblem& problem) noexcept {
  cells_ = problem.cells;
  for (int i = 0; i < cells_; ++i) h_[i] = grid_[problem.first + i].h;
  for (int k = 0; k <= cells_; ++k) {
    const double before = h_[std::max(k - 1, 0)], behind = h_[std::min(k, cells_ - 1)];
    left_[k] = behind / (before + behind);
    right_[k] = before / (before + behind);
    rise_[k] = 2 / (before + behind);
  }
  bar_[0] = problem.bar_knots[0];
  bar_[cells_ + 1] = problem.bar_knots[cells_];
  for (int i = 0; i < cells_; ++i) bar_[i + 1] = problem.bar_middles[i];
  for (int i = 0; i < cells_; ++i) set_up_cell(problem, i);
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

void JerkStep::add_row(int cell, int row, const Coefficients& a, double limit) noexcept {
  const double a0 = a[0] * bar_[cell], a1 = a[1] * bar_[cell + 1], a2 = a[2] * bar_[cell + 2];
  const double scale =
      std::max({std::abs(a0), std::abs(a1), std::abs(a2), std::abs(limit) * kLeastScale, 1e-300});
  CellRows& rows = rows_[cell];
  const int pack = row / kLanes, lane = row % kLanes;
  rows.a0[pack][lane] = a0 / scale;
  rows.a1[pack][lane] = a1 / scale;
  rows.a2[pack][lane] = a2 / scale;
  rows.limit[pack][lane] = limit / scale;
}

void JerkStep::set_up_cell(const JerkProblem& problem, int i) noexcept {
  const FeedCell& cell = grid_[problem.first + i];
  const double h = h_[i];
  // b at the left boundary, b' at both, as combinations of the three coefficients.
  const Coefficients b0{left_[i], right_[i], 0};
  const Coefficients s0{-rise_[i], rise_[i], 0}, s1{0, -rise_[i + 1], rise_[i + 1]};
  int row = 0;
  const auto add_pair = [&](const Coefficients& value, const Coefficients& both, double limit) {
    add_row(i, row++, {value[0] + both[0], value[1] + both[1], value[2] + both[2]}, limit);
    add_row(i, row++, {both[0] - value[0], both[1] - value[1], both[2] - value[2]}, limit);
  };

  const double relax = i == 0 ? kFreeBegin : 1;
  const double bar = problem.bar_knots[i], root = std::sqrt(bar);
  for (int j = 0; j < limits_.count; ++j) {  // acceleration, and what the rate filter adds to it
    const double d1 = cell.at[0].d1[j], d2 = cell.at[0].d2[j];
    const double filter = limits_.slope * std::abs(d1);
    Coefficients value{}, both{};
    for (int t = 0; t < 3; ++t) {
      value[t] = 0.5 * d1 * s0[t] + d2 * b0[t];
      both[t] = filter / (2 * root) * b0[t];
    }
    const double limit = limits_.acceleration[j] * problem.accel_share[i] - 0.5 * filter * root;
    add_pair(value, both, limit * relax);
  }
  for (int t = 0; t < 3; ++t) {
    middle_[i][t] = b0[t] + (3 * s0[t] + s1[t]) * h / 8;
  }
  for (int p = 0; p < 3; ++p) {  // jerk at the begin, the middle and the end
    const double x = 0.5 * p;
    const CellSample& at = cell.at[p * FeedCell::kSteps / 2];
    const double around = p == 0   ? problem.bar_knots[i]
                          : p == 1 ? problem.bar_middles[i]
                                   : problem.bar_knots[i + 1];
    const double around_root = std::sqrt(around);
    for (int j = 0; j < limits_.count; ++j) {
      const double jerk = limits_.jerk[j] * problem.jerk_share[i];
      Coefficients value{}, both{};
      for (int t = 0; t < 3; ++t) {
        const double second = (s1[t] - s0[t]) / h;
        const double first = s0[t] + second * x * h;
        const double b = b0[t] + s0[t] * x * h + 0.5 * second * x * x * h * h;
        value[t] = at.d3[j] * b + 1.5 * at.d2[j] * first + 0.5 * at.d1[j] * second;
        both[t] = jerk / (2 * around * around_root) * b;
      }
      add_pair(value, both, 1.5 * jerk / around_root);
    }
  }
  const double most_here = grid_.most_b_at(problem.first + i);
  add_row(i, row++, b0, most_here * relax);
  add_row(i, row++, middle_[i], std::min(most_here, cell.most_b));
  for (; row < packs_ * kLanes; ++row) add_row(i, row, {0, 0, 0}, 1);
  for (int t = 0; t < 3; ++t) middle_[i][t] *= bar_[i + t];
}

void JerkStep::start() noexcept {
  double time = 0;
  for (int i = 0; i < cells_; ++i) time += h_[i] / std::sqrt(std::max(middle_of(i, c_), 1e-9));
  const double centre = time / (1.0 * cells_ * packs_ * kLanes);
  for (int i = 0; i < cells_; ++i) {
    CellRows& rows = rows_[i];
    for (int p = 0; p < packs_; ++p) {
      const Pack value = rows.a0[p] * c_[i] + rows.a1[p] * c_[i + 1] + rows.a2[p] * c_[i + 2];
      rows.slack[p] = (rows.limit[p] - value).max(kLeastSlack);
      rows.lambda[p] = centre / rows.slack[p];
      rows.step_slack[p] = rows.step_lambda[p] = Pack::Zero();
    }
  }
}

bool JerkStep::assemble() noexcept {
  const auto clear = [this](Values& v) { std::fill(v.begin(), v.begin() + cells_ + 2, 0.0); };
  for (Values* v : {&gradient_, &pull_, &diagonal_, &first_off_, &second_off_}) clear(*v);
  time_ = gap_ = primal_ = dual_ = 0;
  for (int i = 0; i < cells_; ++i) {
    const double b = middle_of(i, c_);
    if (!(b > 0)) return false;
    const double inverse = 1 / b, root = std::sqrt(inverse);
    const double slope = -0.5 * h_[i] * root * inverse, curvature = -1.5 * slope * inverse;
    const Coefficients& w = middle_[i];
    time_ += h_[i] * root;
    for (int t = 0; t < 3; ++t) gradient_[i + t] -= w[t] * slope;

    CellRows& rows = rows_[i];
    Pack m00 = Pack::Zero(), m11 = m00, m22 = m00, m01 = m00, m12 = m00, m02 = m00;
    Pack pull0 = m00, pull1 = m00, pull2 = m00, gap = m00, residual = m00;
    for (int p = 0; p < packs_; ++p) {
      const Pack &a0 = rows.a0[p], &a1 = rows.a1[p], &a2 = rows.a2[p];
      const Pack &s = rows.slack[p], &l = rows.lambda[p];
      const Pack per_slack = 1 / s;
      const Pack weight = l * per_slack;
      const Pack w0 = weight * a0, w1 = weight * a1;
      m00 += w0 * a0;
      m01 += w0 * a1;
      m02 += w0 * a2;
      m11 += w1 * a1;
      m12 += w1 * a2;
      m22 += weight * a2 * a2;
      pull0 += l * a0;
      pull1 += l * a1;
      pull2 += l * a2;
      gap += l * s;
      const Pack off = a0 * c_[i] + a1 * c_[i + 1] + a2 * c_[i + 2] + s - rows.limit[p];
      residual = residual.max(off.abs());
      rows.residual[p] = off;
      rows.inverse[p] = per_slack;
    }
    diagonal_[i] += m00.sum() + curvature * w[0] * w[0];
    diagonal_[i + 1] += m11.sum() + curvature * w[1] * w[1];
    diagonal_[i + 2] += m22.sum() + curvature * w[2] * w[2];
    first_off_[i + 1] += m01.sum() + curvature * w[0] * w[1];
    first_off_[i + 2] += m12.sum() + curvature * w[1] * w[2];
    second_off_[i + 2] += m02.sum() + curvature * w[0] * w[2];
    pull_[i] += pull0.sum();
    pull_[i + 1] += pull1.sum();
    pull_[i + 2] += pull2.sum();
    gap_ += gap.sum();
    primal_ = std::max(primal_, residual.maxCoeff());
  }
  for (int k = 2; k < cells_; ++k) dual_ = std::max(dual_, std::abs(pull_[k] - gradient_[k]));
  return std::isfinite(gap_) && std::isfinite(primal_);
}

void JerkStep::factorise() noexcept {
  // Unknowns 2 .. cells - 1; the four at the ends are given. L is kept in the off-diagonals.
  for (int k = 2; k < cells_; ++k) {
    double pivot = diagonal_[k] * (1 + 1e-12) + 1e-14;
    if (k >= 3) {
      double off = first_off_[k];
      if (k >= 4) {
        off -= second_off_[k] * first_off_[k - 1] * diagonal_[k - 2];
        pivot -= second_off_[k] * second_off_[k] * diagonal_[k - 2];
      }
      off /= diagonal_[k - 1];
      pivot -= off * off * diagonal_[k - 1];
      first_off_[k] = off;
    }
    diagonal_[k] = pivot;
    if (k + 2 < cells_) second_off_[k + 2] /= pivot;
  }
}

void JerkStep::substitute() noexcept {
  const int m = cells_;
  step_[0] = step_[1] = step_[m] = step_[m + 1] = 0;
  for (int k = 2; k < m; ++k) {
    if (k >= 3) step_[k] -= first_off_[k] * step_[k - 1];
    if (k >= 4) step_[k] -= second_off_[k] * step_[k - 2];
  }
  for (int k = m - 1; k >= 2; --k) {
    step_[k] /= diagonal_[k];
    if (k + 1 < m) step_[k] -= first_off_[k + 1] * step_[k + 1];
    if (k + 2 < m) step_[k] -= second_off_[k + 2] * step_[k + 2];
  }
}

void JerkStep::find_step(double centre, bool is_corrector) noexcept {
  const double second_order = is_corrector ? 1 : 0;
  // What slack times multiplier shall become, over the slack.
  const auto aim = [&](const CellRows& rows, int p) -> Pack {
    return (centre - second_order * (rows.step_slack[p] * rows.step_lambda[p])) * rows.inverse[p];
  };
  std::copy(gradient_.begin(), gradient_.begin() + cells_ + 2, step_.begin());
  for (int i = 0; i < cells_; ++i) {
    const CellRows& rows = rows_[i];
    Pack sum0 = Pack::Zero(), sum1 = sum0, sum2 = sum0;
    for (int p = 0; p < packs_; ++p) {
      const Pack t = rows.lambda[p] * rows.inverse[p] * rows.residual[p] + aim(rows, p);
      sum0 += rows.a0[p] * t;
      sum1 += rows.a1[p] * t;
      sum2 += rows.a2[p] * t;
    }
    step_[i] -= sum0.sum();
    step_[i + 1] -= sum1.sum();
    step_[i + 2] -= sum2.sum();
  }
  substitute();
  Pack primal = Pack::Constant(kToTheWall), dual = primal;
  for (int i = 0; i < cells_; ++i) {
    CellRows& rows = rows_[i];
    for (int p = 0; p < packs_; ++p) {
      const Pack &l = rows.lambda[p], &inverse = rows.inverse[p];
      const Pack ds = -rows.residual[p] - (rows.a0[p] * step_[i] + rows.a1[p] * step_[i + 1] +
                                           rows.a2[p] * step_[i + 2]);
      const Pack share = ds * inverse;
      const Pack dl = aim(rows, p) - l - l * share;
      rows.step_slack[p] = ds;
      rows.step_lambda[p] = dl;
      primal = primal.max(-share);
      dual = dual.max(-dl / l);
    }
  }
  step_primal_ = kToTheWall / primal.maxCoeff();
  step_dual_ = kToTheWall / dual.maxCoeff();
}

double JerkStep::gap_after_step() const noexcept {
  Pack gap = Pack::Zero();
  for (int i = 0; i < cells_; ++i) {
    const CellRows& rows = rows_[i];
    for (int p = 0; p < packs_; ++p) {
      gap += (rows.lambda[p] + step_dual_ * rows.step_lambda[p]) *
             (rows.slack[p] + step_primal_ * rows.step_slack[p]);
    }
  }
  return gap.sum();
}

void JerkStep::take_step() noexcept {
  for (int i = 0; i < cells_; ++i) {  // b stays positive
    const double change = middle_of(i, step_);
    if (change < 0) step_primal_ = std::min(step_primal_, -0.9 * middle_of(i, c_) / change);
  }
  for (int k = 0; k < cells_ + 2; ++k) c_[k] += step_primal_ * step_[k];
  for (int i = 0; i < cells_; ++i) {
    CellRows& rows = rows_[i];
    for (int p = 0; p < packs_; ++p) {
      rows.slack[p] += step_primal_ * rows.step_slack[p];
      rows.lambda[p] += step_dual_ * rows.step_lambda[p];
    }
  }
}

bool JerkStep::solve(const JerkProblem& problem) noexcept {
  set_up(problem);
  start();
  const double rows = 1.0 * cells_ * packs_ * kLanes;
  std::array<double, kRounds> history{};
  for (round_ = 0; round_ < kRounds; ++round_) {
    if (!assemble()) return false;
    history[static_cast<std::size_t>(round_)] = primal_;
    const bool is_at_goal =
        gap_ < kGapGoal * time_ && primal_ < kPrimalGoal && dual_ < kGapGoal * time_;
    if (is_at_goal) return true;
    const bool is_stalled =
        round_ > kStallRounds + 2 && primal_ > 10 * kPrimalGoal &&
        primal_ > 0.5 * history[static_cast<std::size_t>(round_ - kStallRounds)];
    if (is_stalled || !(gap_ < 1e6 * time_)) return primal_ < kPrimalGood;
    factorise();
    find_step(0, false);
    const double share = std::min(1.0, gap_after_step() / gap_);
    find_step(share * share * share * gap_ / rows, true);
    take_step();
  }
  return primal_ < kPrimalGood;
}

}  // namespace meridian
