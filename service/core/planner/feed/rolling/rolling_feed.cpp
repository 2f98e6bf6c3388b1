// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/rolling/rolling_feed.hpp"

#include <algorithm>
#include <cmath>

namespace meridian {
namespace {

// Shares of the limits that are planned; checked is against the limits themselves.
constexpr double kVelocityShare = 0.9999;
constexpr double kAccelShare = 0.999;
constexpr double kJerkShare = 0.998;
/// Plans use that much less of the limits at the far end of a window, growing evenly: the tail of a
/// plan is strictly inside the limits of the next one, which therefore has an interior. Behind the
/// last window of a path there is none.
constexpr double kFunnel = 0.02;
constexpr int kTightenings = 4;
constexpr int kHistory = 240;  // cells kept behind the next one, at most: three windows and more
constexpr int kSpare = 8;      // cells of the store
constexpr int kTrials = 2;     // results far from it that tighten no cell
constexpr double kSure = 0.9;  // use by a cell's bounds: no closer look is needed
constexpr double kFeedSlack = 1.002;  // on u̇², beside CellSettings::feed_share

int window_of(const FeedSettings& settings) noexcept {
  return std::clamp(settings.window_cells, 20, JerkStep::kCells);
}

}  // namespace

FeedSettings feed_settings(const MachineModel& model) noexcept {
  const RateLimits rates = rate_limits(model.override_ramp_s);
  FeedSettings settings;
  settings.reserve = {rates.slope_per_s, rates.curvature_per_s2};
  return settings;
}

RollingFeed::RollingFeed(const MachineModel& model, const FeedSettings& settings)
    : settings_(settings),
      limits_(make_feed_limits(model, settings.reserve)),
      planned_(limits_.scaled(kVelocityShare, kAccelShare, kJerkShare)),
      grid_(model, planned_, settings.cells),
      solver_(grid_, planned_, window_of(settings)),
      pieces_(window_of(settings)) {
  settings_.window_cells = window_of(settings);
  history_ = std::min(kHistory, settings.cells.kept_cells - settings_.window_cells - kSpare);
  settings_.commit_cells = std::clamp(settings.commit_cells, 1, settings_.window_cells - 10);
  settings_.max_commit_cells =
      std::clamp(settings.max_commit_cells, settings_.commit_cells, settings_.window_cells - 10);
  for (auto* v :
       {&backward_, &bound_, &bar_knots_, &bar_middles_, &bar_slopes_, &accel_share_, &jerk_share_,
        &old_.b, &old_.slope, &new_.b, &new_.slope, &best_.b, &best_.slope}) {
    v->resize(static_cast<std::size_t>(settings_.window_cells) + 2);
  }
  uses_.resize(static_cast<std::size_t>(settings_.window_cells) + 2);
  for (int i = 0; i < limits_.count; ++i) {
    jerk_without_tangent_ = std::min(jerk_without_tangent_, limits_.jerk[i] / limits_.full_jerk[i]);
  }
}

void RollingFeed::begin(const JointVector& joints, int branch, double tool_length_mm) noexcept {
  grid_.begin(joints, tool_length_mm);
  branch_ = branch;
  next_ = 0;
  is_at_rest_ = true;
  old_.first = old_.end = 0;
  window_ = {};
}

std::int64_t RollingFeed::window_end() const noexcept {
  const std::int64_t end = next_ + settings_.window_cells;
  return grid_.is_complete() ? std::min(end, grid_.last()) : end;
}

/// Cells that have to be there before the next window is planned. At the begin of a path they are
/// graded: there have to be as many more, so that a fault on the path is known as early as ever.
std::int64_t RollingFeed::cells_needed() const noexcept {
  const bool is_begin = next_ == 0 && !grid_.is_complete();
  return window_end() + (is_begin ? grid_.added_at_begin() : 0);
}

bool RollingFeed::is_failing() const noexcept {
  auto hash = static_cast<std::uint32_t>(count_.windows) * 2654435761U;
  hash ^= hash >> 15U;
  hash *= 2246822519U;
  hash ^= hash >> 13U;
  return (hash & 0xffffU) < settings_.failing_share * 65536;
}

void RollingFeed::resume_from(std::int64_t cell) noexcept {
  if (cell < grid_.first() || cell > grid_.last()) return;
  next_ = cell;
  is_at_rest_ = true;
  old_.first = old_.end = cell;
  grid_.restore_from(cell);  // how many windows were planned behind it only the clock knows
}

bool RollingFeed::try_plan() noexcept {
  grid_.drop_before(next_ - history_);
  (void)grid_.make_cells();  // fault() tells
  if (is_done() || grid_.last() < cells_needed()) return false;
  ++count_.windows;
  window_rounds_ = 0;
  if (!is_failing() && plan_window()) {
    commit(true);
  } else if (is_at_rest_) {
    commit_crawl();
  } else {
    ++count_.kept;
    commit(false);
  }
  return true;
}

bool RollingFeed::refine(int wanted) noexcept {
  const int cells = new_.cells();
  const bool is_last = grid_.is_complete() && new_.end == grid_.last();
  const double funnel = is_last ? 0 : kFunnel;
  int good = 0, trials = 0;
  for (int round = 0; round < kTightenings + wanted; ++round) {
    for (int k = 0; k <= cells; ++k) {
      const double behind = static_cast<double>(k - settings_.commit_cells) /
                            (settings_.window_cells - settings_.commit_cells);
      const double share = 1 - funnel * std::clamp(behind, 0.0, 1.0);
      accel_share_[k] = jerk_share_[k] = share * grid_[new_.first + k].tight;
    }
    if (window_rounds_ >= settings_.max_rounds) break;
    ++count_.solves;
    const bool is_solved = solver_.solve({new_.first,
                                          cells,
                                          state_,
                                          {new_.stop.state.b, -new_.stop.state.slope},
                                          bar_knots_.data(),
                                          bar_middles_.data(),
                                          accel_share_.data(),
                                          jerk_share_.data(),
                                          bar_slopes_.data()});
    count_.rounds += solver_.rounds();
    window_rounds_ += solver_.rounds();
    count_.max_rounds = std::max(count_.max_rounds, window_rounds_);
    if (!is_solved) break;
    take_result();
    const bool is_good = check();
    // Far from a tangent a result may break a limit, and no cell is at fault; without one it is.
    const bool is_far = !is_near_bar(settings_.max_commit_cells),
               has_tangent = !std::isnan(bar_slopes_[0]);
    const bool is_trial = is_far && has_tangent && good == 0 && ++trials <= kTrials;
    if (!is_good && !is_trial && round < kTightenings) tighten();
    // Of the last window all cells stand.
    const bool has_more = is_far || (is_good && is_last && !is_near_bar(cells));
    if (has_more && (is_good || has_tangent)) linearise_at_result();
    if (!is_good) {
      if (!is_trial) ++count_.tightened;
      continue;
    }
    std::swap(best_.b, new_.b);
    std::swap(best_.slope, new_.slope);
    if (++good == wanted || !has_more) break;
  }
  if (good == 0) return false;
  std::swap(best_.b, new_.b);
  std::swap(best_.slope, new_.slope);
  return true;
}

void RollingFeed::take_result() noexcept {
  const int cells = new_.cells();
  for (int k = 0; k <= cells; ++k) {
    new_.b[k] = solver_.b(k);
    new_.slope[k] = solver_.slope(k);
  }
  // The ends are given: not even rounding may come between two plans.
  new_.b[0] = state_.b;
  new_.slope[0] = state_.slope;
}

bool RollingFeed::check() noexcept {
  bool is_good = true;
  for (int k = 0; k < new_.cells(); ++k) {
    const FeedCell& cell = grid_[new_.first + k];
    const CellLaw law{new_.b[k], new_.slope[k], new_.slope[k + 1]};
    FeedUse& use = uses_[k] = max_use_of(limits_, cell, law);
    if (use.worst() > kSure || use.b > 1) use = use_of(limits_, cell, law);
    is_good = is_good && use.worst() <= 1 && use.b <= kFeedSlack;
  }
  return is_good;
}

void RollingFeed::tighten() noexcept {
  const int cells = new_.cells();
  for (int k = 0; k < cells; ++k) {
    const double worst = uses_[k].worst();
    if (worst > 1) {
      for (int n = std::max(0, k - 1); n <= std::min(cells - 1, k + 1); ++n) {
        FeedCell& near = grid_[new_.first + n];
        const double by = n == k ? std::min(worst, 1.5) + 0.004 : 1.002;
        near.tight = std::max(kMinTight, near.tight / by);
      }
    } else if (uses_[k].b > kFeedSlack) {
      grid_[new_.first + k].max_b /= std::min(uses_[k].b, 1.1) + 0.002;
    }
  }
}

}  // namespace meridian
