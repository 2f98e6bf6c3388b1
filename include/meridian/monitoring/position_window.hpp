// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "meridian/monitoring/monitored.hpp"

namespace meridian::monitoring {

/// Position windows of each mode, by measured positions of axes that know where they are. What is
/// outside when a window comes into force may come back, and stand, but goes no farther out.
/// RT: cycle. Proof: tests/unit/monitoring/position_window_test.cpp.
class PositionWindow {
 public:
  [[nodiscard]] Result check(const Limits& limits, const Inputs& in, Mode mode) noexcept {
    const std::uint32_t known = mode == Mode::kOff || !in.has_report ? 0 : in.known_mask;
    automatic_.known_mask &= mode == Mode::kSetUp ? 0 : known;
    set_up_.known_mask &= in.is_guard_open ? known : 0;
    if (mode == Mode::kOff || !in.has_report) return {};
    const bool is_set_up = mode == Mode::kSetUp;
    Edges& edges = is_set_up ? set_up_ : automatic_;
    Result result;
    for (int i = 0; i < limits.axis_count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      if (!limits.axes[n].has_window || (in.known_mask >> n & 1U) == 0) continue;
      const AxisLimits& axis = limits.axes[n];
      const double low = is_set_up ? axis.set_up_low : axis.low;
      const double high = is_set_up ? axis.set_up_high : axis.high;
      const double at = in.measured[n];
      edges.update(n, low, high, at);
      const bool is_inside =
          at >= edges.low[n] - axis.window_margin && at <= edges.high[n] + axis.window_margin;
      if (!is_inside && result.finding == Finding::kNone) {
        result = {Finding::kPositionWindow, i, at};
      }
    }
    edges.known_mask = in.known_mask;
    return result;
  }

 private:
  /// How far out an axis may be: the window, or where it was when the window came into force.
  struct Edges {
    std::uint32_t known_mask = 0;  ///< axes whose values are of now
    Values low{}, high{};

    void update(std::size_t n, double window_low, double window_high, double at) noexcept {
      const bool is_new = (known_mask >> n & 1U) == 0;
      low[n] = std::min(window_low, is_new ? at : std::max(low[n], at));
      high[n] = std::max(window_high, is_new ? at : std::min(high[n], at));
    }
  };

  Edges automatic_;
  Edges set_up_;  ///< from the first jog with an open guard on, until that is shut
};

}  // namespace meridian::monitoring
