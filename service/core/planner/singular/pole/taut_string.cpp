// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/taut_string.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace meridian {
namespace {

/// A straight part of the route: as far as window `last`, by `slope`.
struct Straight {
  std::size_t last = 0;
  double slope = 0;
};

StringWindow opened(const StringWindow& window) noexcept {
  if (window.low <= window.high) return window;
  const double middle = 0.5 * (window.low + window.high);
  return {window.t, middle, middle};
}

/// From `value` in window `from` straight on until the way has to bend.
Straight see_ahead(std::span<const StringWindow> windows, std::size_t from, double value) noexcept {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  Straight smallest{from, -kAny},
      largest{from, kAny};  // the slopes that are open, and what closes them
  for (std::size_t n = from + 1; n < windows.size(); ++n) {
    const StringWindow window = opened(windows[n]);
    const double dt = window.t - windows[from].t;
    const double low = (window.low - value) / dt, high = (window.high - value) / dt;
    if (low > largest.slope) return largest;
    if (high < smallest.slope) return smallest;
    if (low >= smallest.slope) smallest = {n, low};
    if (high <= largest.slope) largest = {n, high};
  }
  if (smallest.slope > 0) return smallest;
  if (largest.slope < 0) return largest;
  return {windows.size() - 1, 0};
}

}  // namespace

void pull_taut(std::span<const StringWindow> windows, double begin,
               std::span<double> values) noexcept {
  if (windows.empty()) return;
  values[0] = begin;
  for (std::size_t at = 0; at + 1 < windows.size();) {
    const Straight straight = see_ahead(windows, at, values[at]);
    for (std::size_t n = at + 1; n <= straight.last; ++n) {
      const StringWindow window = opened(windows[n]);
      const double value = values[at] + straight.slope * (window.t - windows[at].t);
      values[n] = std::clamp(value, window.low, window.high);  // rounding
    }
    at = straight.last;
  }
}

}  // namespace meridian
