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
    if (mode == Mode::kOff || !in.has_report) {
      known_mask_ = 0;
      return {};
    }
    const bool is_set_up = mode == Mode::kSetUp;
    if (is_set_up != is_set_up_) known_mask_ = 0;
    is_set_up_ = is_set_up;
    Result result;
    for (int i = 0; i < limits.axis_count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      if (!limits.axes[n].has_window || (in.known_mask >> n & 1U) == 0) continue;
      if (!check_axis(limits.axes[n], n, in.measured[n]) && result.finding == Finding::kNone) {
        result = {Finding::kPositionWindow, i, in.measured[n]};
      }
    }
    known_mask_ = in.known_mask;
    return result;
  }

 private:
  /// Whether the axis is inside of its window, or no farther out than it was.
  [[nodiscard]] bool check_axis(const AxisLimits& axis, std::size_t n, double at) noexcept {
    const double low = is_set_up_ ? axis.set_up_low : axis.low;
    const double high = is_set_up_ ? axis.set_up_high : axis.high;
    const bool is_new = (known_mask_ >> n & 1U) == 0;
    low_[n] = std::min(low, is_new ? at : std::max(low_[n], at));
    high_[n] = std::max(high, is_new ? at : std::min(high_[n], at));
    return at >= low_[n] - axis.window_margin && at <= high_[n] + axis.window_margin;
  }

  std::uint32_t known_mask_ = 0;  ///< axes whose `low_` and `high_` are of now
  bool is_set_up_ = false;
  Values low_{}, high_{};
};

}  // namespace meridian::monitoring
