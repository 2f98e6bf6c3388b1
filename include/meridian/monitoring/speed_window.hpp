// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "meridian/monitoring/report_clock.hpp"

namespace meridian::monitoring {

/// Mean speeds by two reports kSpan_s or 32 periods apart, so that the steps of an encoder and late
/// reports weigh little. RT: cycle. Proof: tests/unit/monitoring/limited_speed_test.cpp.
class SpeedWindow {
 public:
  static constexpr double kSpan_s = 0.064;

  void restart() noexcept { count_ = 0; }
  /// Takes a new report, `elapsed_s` after the one before.
  void add(const Limits& limits, const Inputs& in, double elapsed_s) noexcept {
    const double span = std::max(kSpan_s, limits.cycle_s * static_cast<double>(kPlaces));
    clock_s_ = count_ == 0 ? 0 : clock_s_ + elapsed_s;
    now_ = {clock_s_, in.measured, in.tip};
    slack_s_ = limits.cycle_s * kSlackPeriods;
    const double step = span / static_cast<double>(kPlaces - 1);
    if (count_ != 0 && clock_s_ - last_s_ < step) return;
    last_s_ = clock_s_;
    kept_[count_ % kPlaces] = now_;
    ++count_;
  }
  /// Whether the window is full: only then do speeds mean something.
  [[nodiscard]] bool is_full() const noexcept { return count_ >= kPlaces; }
  [[nodiscard]] double axis_speed(std::size_t i) const noexcept {
    return (now_.measured[i] - oldest().measured[i]) / time();
  }
  [[nodiscard]] double tip_speed() const noexcept {
    const Point &a = oldest().tip, &b = now_.tip;
    return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) / time();
  }

 private:
  static constexpr std::size_t kPlaces = 32;
  struct Kept {
    double time_s = 0;
    Values measured{};
    Point tip{};
  };
  [[nodiscard]] const Kept& oldest() const noexcept { return kept_[count_ % kPlaces]; }
  [[nodiscard]] double time() const noexcept { return clock_s_ - oldest().time_s + slack_s_; }

  std::array<Kept, kPlaces> kept_{};
  Kept now_;
  std::size_t count_ = 0;
  double clock_s_ = 0, last_s_ = 0, slack_s_ = 0;
};

/// Limited speed of axes and tip, in set-up mode. RT: cycle.
[[nodiscard]] inline Result check_limited_speed(const Limits& limits, const SpeedWindow& window,
                                                Mode mode) noexcept {
  if (mode != Mode::kSetUp || !window.is_full()) return {};
  const double tip = window.tip_speed();
  if (tip > limits.set_up_tip_speed) return {Finding::kTipSpeed, 0, tip};
  for (int i = 0; i < limits.axis_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const double speed = window.axis_speed(n);
    if (std::abs(speed) > limits.axes[n].set_up_speed) return {Finding::kAxisSpeed, i, speed};
  }
  return {};
}

}  // namespace meridian::monitoring
