// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/taut_string.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace meridian {
namespace {

/// A straight part of the way: as far as window `last`, by `slope`.
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
  Straight least{from, -kAny}, most{from, kAny};  // the slopes that are open, and what closes them
  for (std::size_t n = from + 1; n < windows.size(); ++n) {
    const StringWindow window = opened(windows[n]);
    const double dt = window.t - windows[from].t;
    const double low = (window.low - value) / dt, high = (window.high - value) / dt;
    if (low > most.slope) return most;
    if (high < least.slope) return least;
    if (low >= least.slope) least = {n, low};
    if (high <= most.slope) most = {n, high};
  }
  if (least.slope > 0) return least;
  if (most.slope < 0) return most;
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
