// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>

#include "service/core/planner/feed/rolling/rolling_feed.hpp"
#include "service/core/planner/feed/solver/two_pass.hpp"

/// What is tried one after the other until a window has a plan.
namespace meridian {
namespace {

constexpr int kMinCells = 4;         // of a window
constexpr int kRestReach = 11;       // cells beside a rest whose limits its speed keeps
constexpr double kSlowShare = 1e-3;  // of u̇² at the rest's own bound: a cell within reach is slow
constexpr double kBesideSlow = 0.25;  // of u̇² at that bound, beside a slow cell
constexpr double kJump = 0.03;        // of u̇², from cell to cell

/// u̇² beside a rest, of what the cells within reach keep up and what the cell at the rest does, as
/// far as others let it. A slow span among them bounds nothing but itself: at its speed the cell at
/// the rest would be crept along.
double beside_slow(double steady, double own) noexcept {
  return steady < kSlowShare * own ? kBesideSlow * own : steady;
}

}  // namespace

bool RollingFeed::plan_window() noexcept {
  // A steady one behind a bound without jerk: the old plan may have slowed down for a place at
  // which that bound is so far above what jerk allows that no tangent there lets the new one pass.
  // The tail at last: it is slow about the old rest, but known to be possible up to there.
  static constexpr Attempt kLadder[] = {
      {Tangent::kOldPlan, 1, 0, RestRoom::kOwn},
      {Tangent::kOldPlan, 1, 0},
      {Tangent::kSteady, 1, 0},
      {Tangent::kOldPlan, 1, 0, RestRoom::kLargest, true},
      {Tangent::kBound, 1, 0},
      {Tangent::kOldPlan, 0.3, 0},
      {Tangent::kOldPlan, 1, 7},
      {Tangent::kBound, 0.3, 13},
      {Tangent::kOldPlan, 0.3, 19},
      {Tangent::kBound, 0.05, 0},
      {Tangent::kOldPlan, 0.05, 11},
      {Tangent::kBound, 0.01, 5},
      {Tangent::kTail, 1, 0},
      {Tangent::kTail, 0.3, 0},
  };
  return std::any_of(std::begin(kLadder), std::end(kLadder),
                     [this](const Attempt& how) { return attempt(how); });
}

std::int64_t RollingFeed::find_jump(std::int64_t first, std::int64_t end) const noexcept {
  for (std::int64_t k = end - 1; k > first; --k) {
    const double ratio = grid_[k].max_b / grid_[k - 1].max_b;
    if (ratio < kJump || ratio * kJump > 1) return k;
  }
  return end;
}

bool RollingFeed::attempt(const Attempt& how) noexcept {
  const std::int64_t first = is_at_rest_ ? next_ + 1 : next_;
  std::int64_t end = window_end();
  if (how.shorter > 0) {
    const bool is_last = grid_.is_complete() && end == grid_.last();
    end -= how.shorter;
    if (is_last || end < first + kMinCells + 2) return false;
  }
  if (how.is_to_jump) {
    const std::int64_t jump = find_jump(first + kMinCells + 2, end);
    if (jump == end) return false;
    end = jump;
  }
  if (end - first < kMinCells) return false;
  const bool is_past_tail = how.tangent == Tangent::kTail;
  if (is_past_tail && (is_at_rest_ || old_.end >= end)) return false;
  if (is_at_rest_) {
    const double max_b = how.softness * start_b(first, end);
    start_ = find_rest_cell(planned_, grid_[next_], true, max_b, how.room);
    state_ = start_.state;
  }
  pass_twice(first, end, state_.b);
  new_.first = first;
  new_.end = end;
  const double max_b = how.softness * stop_b(first, end);
  new_.stop = find_rest_cell(planned_, grid_[end - 1], false, max_b, how.room);
  // About a rest that it need not have, a plan is worth little: the next one takes its place early.
  new_.max_commit_cells = is_past_tail ? settings_.commit_cells : settings_.max_commit_cells;
  choose_bar(how.tangent);
  const bool has_guide = !is_at_rest_ && !is_past_tail;
  return refine(settings_.refinements + (has_guide ? 0 : settings_.more_from_rest));
}

void RollingFeed::pass_twice(std::int64_t first, std::int64_t end, double b_begin) noexcept {
  const auto boundaries = static_cast<std::size_t>(end - first) + 1;
  two_pass(grid_, planned_, first, b_begin, {backward_.data(), boundaries},
           {bound_.data(), boundaries});
}

double RollingFeed::start_b(std::int64_t first, std::int64_t end) noexcept {
  const auto reach = std::min(next_ + kRestReach + 1, end);
  const double steady = steady_b(grid_, planned_, next_, reach);
  const double own = steady_b(grid_, planned_, next_, first);
  if (steady >= kSlowShare * own) return steady;
  pass_twice(first, end, 0);
  return beside_slow(steady, std::min(own, backward_[0]));
}

double RollingFeed::stop_b(std::int64_t first, std::int64_t end) const noexcept {
  const auto last = static_cast<std::size_t>(end - 1 - first);
  const double reachable = 4 * backward_[last];
  const auto reach = std::max(first, end - kRestReach - 1);
  const double steady = std::min(reachable, steady_b(grid_, planned_, reach, end));
  return beside_slow(steady, std::min(bound_[last], steady_b(grid_, planned_, end - 1, end)));
}

}  // namespace meridian
