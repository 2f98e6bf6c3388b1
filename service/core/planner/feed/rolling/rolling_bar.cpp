// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "service/core/planner/feed/rolling/rolling_feed.hpp"

/// Where the jerk of a window is linearised.
namespace meridian {
namespace {

constexpr double kOldShare = 0.6;  // of the bound: an old plan above it is worth linearising at
constexpr double kMinBar = 1e-6;   // of the largest, or of the one before
constexpr double kNearBar = 0.05;  // of u̇²: the tangent there is as good as that at the plan
constexpr double kLoose = 0.9;     // of what rows leave: none of them binds
constexpr double kTiniestJerk = 1e-30;

/// u̇² at the distance `u` from a rest, under the jerk that the joints allow at the rest itself.
double beside_rest(const FeedLimits& limits, const CellSample& rest, double u) noexcept {
  double per_jerk = 0;
  for (int i = 0; i < limits.count; ++i) {
    per_jerk = std::max(per_jerk, std::abs(rest.d1[i]) / limits.full_jerk[i]);
  }
  return square(std::cbrt(square(6 * u)) / (2 * std::cbrt(std::max(per_jerk, kTiniestJerk))));
}

/// Share of the jerk that a tangent of b^-½ leaves where b is `ratio` times that of the tangent.
double left_by_tangent(double ratio) noexcept { return (1.5 - 0.5 * ratio) * std::sqrt(ratio); }

}  // namespace

void RollingFeed::choose_bar(Tangent tangent) noexcept {
  const int cells = new_.cells();
  double largest = 0;
  for (int k = 0; k <= cells; ++k) largest = std::max(largest, bound_[k]);
  for (int k = 0; k <= cells; ++k) {
    const std::int64_t cell = new_.first + k;
    const double steady =
        tangent == Tangent::kSteady ? steady_b(grid_, planned_, cell, cell + 1) : bound_[k];
    bar_knots_[k] = std::max(std::min(bound_[k], steady), kMinBar * largest);
  }
  lower_beside_rests(largest);
  std::fill_n(bar_slopes_.begin(), cells + 1, JerkCell::kUnknown);
  if (!is_at_rest_ && tangent == Tangent::kTail) {
    follow_tail();
  } else if (!is_at_rest_ && tangent != Tangent::kBound) {
    follow_old_plan();
  }
  for (int k = 0; k < cells; ++k) bar_middles_[k] = 0.5 * (bar_knots_[k] + bar_knots_[k + 1]);
}

void RollingFeed::take_old_plan(int knots) noexcept {
  const auto skipped = new_.first - old_.first;
  for (int k = 0; k < knots; ++k) {
    bar_knots_[k] = old_.b[k + skipped];
    bar_slopes_[k] = old_.slope[k + skipped];
  }
}

/// Up to where the old plan turns to its rest, which is no guide: there it falls behind the share
/// of the bound that it has before.
void RollingFeed::follow_old_plan() noexcept {
  const auto skipped = new_.first - old_.first;
  int last = std::min(new_.cells(), static_cast<int>(old_.cells() - skipped));
  double share = 0;
  for (int k = 0; k <= last / 2; ++k) share += old_.b[k + skipped] / bar_knots_[k];
  share *= kOldShare / (last / 2 + 1);
  while (last >= 0 && !(old_.b[last + skipped] > share * bar_knots_[last])) --last;
  take_old_plan(last + 1);
}

/// Slow about the old rest, but no more is asked of the jerk there than the old plan has shown.
void RollingFeed::follow_tail() noexcept {
  const int cells = new_.cells(), rest = static_cast<int>(old_.end - new_.first);
  take_old_plan(rest);
  const FeedCell& last = grid_[old_.end - 1];
  double u = last.h;
  for (int k = rest; k <= cells; ++k) {
    bar_knots_[k] = std::min(bar_knots_[k], beside_rest(planned_, last.at.back(), u));
    if (k < cells) u += grid_[new_.first + k].h;
  }
}

/// Beside a rest u̇² grows by u^4/3 under full jerk, and by u in a bound without jerk: a tangent at
/// that one would ask for a fraction of the jerk.
void RollingFeed::lower_beside_rests(double largest) noexcept {
  const int cells = new_.cells();
  const auto lower = [&](int knot, const CellSample& rest, double u) {
    const double b = beside_rest(planned_, rest, u);
    bar_knots_[knot] = std::min(bar_knots_[knot], b);
    return b < largest;
  };
  const FeedCell& last = grid_[new_.end - 1];
  double u = last.h;
  for (int k = cells; k >= 0 && lower(k, last.at.back(), u); --k) {
    if (k > 0) u += grid_[new_.first + k - 1].h;
  }
  if (!is_at_rest_) return;
  const FeedCell& first = grid_[next_];
  u = first.h;
  for (int k = 0; k <= cells && lower(k, first.at.front(), u); ++k) {
    if (k < cells) u += grid_[new_.first + k].h;
  }
}

/// Whether the result is, in its first `cells` cells, where jerk was linearised, or far from its
/// limits there: again would gain nothing.
bool RollingFeed::is_near_bar(int cells) const noexcept {
  for (int k = 0; k < std::min(cells, new_.cells()); ++k) {
    const bool has_tangent = !std::isnan(bar_slopes_[k]);
    const double ratio = new_.b[k] / bar_knots_[k];
    if (has_tangent && std::abs(ratio - 1) <= kNearBar) continue;
    const double left = (has_tangent ? 1 : jerk_without_tangent_) * left_by_tangent(ratio);
    if (!(std::max(uses_[k].acceleration, uses_[k].jerk) <= kLoose * left)) return false;
  }
  return true;
}

void RollingFeed::linearise_at_result() noexcept {
  const int cells = new_.cells();
  for (int k = 0; k <= cells; ++k) {
    bar_knots_[k] = std::max(new_.b[k], kMinBar * bar_knots_[k]);
    bar_slopes_[k] = new_.slope[k];
  }
  for (int k = 0; k < cells; ++k) bar_middles_[k] = solver_.middle(k);
}

}  // namespace meridian
