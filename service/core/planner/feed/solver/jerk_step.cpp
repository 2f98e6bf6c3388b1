// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/solver/jerk_step.hpp"

#include <algorithm>
#include <cmath>

namespace meridian {
namespace {

constexpr double kGapGoal = 1e-4;     // of the time
constexpr double kPrimalGoal = 1e-7;  // rows are scaled to about 1
constexpr double kPrimalGood = 1e-5;  // what is accepted when the rounds are over
constexpr double kToTheWall = 0.995;  // share of the step to the next bound that is gone
constexpr int kStallRounds = 6;       // the primal residual has to halve in them

}  // namespace

JerkStep::JerkStep(const CellGrid& grid, const FeedLimits& limits, int max_cells)
    : grid_(grid), limits_(limits) {
  const auto cells = static_cast<std::size_t>(max_cells);
  for (Values* v : {&h_, &left_, &right_, &rise_, &bar_, &c_, &step_, &gradient_, &pull_,
                    &diagonal_, &first_off_, &second_off_}) {
    v->resize(cells + 2);
  }
  middle_.resize(cells);
  rows_.resize(cells);
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
    const JerkCoefficients& w = middle_[i];
    time_ += h_[i] * root;
    for (int t = 0; t < 3; ++t) gradient_[i + t] -= w[t] * slope;

    CellRows& rows = rows_[i];
    Pack m00 = Pack::Zero(), m11 = m00, m22 = m00, m01 = m00, m12 = m00, m02 = m00;
    Pack pull0 = m00, pull1 = m00, pull2 = m00, gap = m00, residual = m00;
    for (int p = 0; p < rows.packs; ++p) {
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
    for (int p = 0; p < rows.packs; ++p) {
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
    for (int p = 0; p < rows.packs; ++p) {
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
    for (int p = 0; p < rows.packs; ++p) {
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
    for (int p = 0; p < rows.packs; ++p) {
      rows.slack[p] += step_primal_ * rows.step_slack[p];
      rows.lambda[p] += step_dual_ * rows.step_lambda[p];
    }
  }
}

bool JerkStep::solve(const JerkProblem& problem) noexcept {
  set_up(problem);
  start();
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
    find_step(share * share * share * gap_ / sample_count_, true);
    take_step();
  }
  return primal_ < kPrimalGood;
}

}  // namespace meridian
