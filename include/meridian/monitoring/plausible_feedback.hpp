// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "meridian/monitoring/sent_positions.hpp"
#include "meridian/monitoring/speed_window.hpp"

namespace meridian::monitoring {

/// Servo loops overshoot: an axis may report to be faster than its limit by this factor.
inline constexpr double kOvershoot = 1.25;

/// Plausibility of feedback: a jump is farther from the report before than the axis can move in the
/// time between, with kSlackPeriods of slack; frozen is a position that stays the same to the last
/// bit while the setpoints that were taken lead on; too fast is a mean speed that the axis cannot
/// have. RT: cycle. Proof: tests/unit/monitoring/plausible_feedback_test.cpp.
class PlausibleFeedback {
 public:
  void restart() noexcept { has_last_ = false; }

  /// Takes a new report, `elapsed_s` after the one before. `is_paused`: reports come in no rhythm.
  [[nodiscard]] Result check(const Limits& limits, const SentPositions& sent, const Inputs& in,
                             double elapsed_s, bool is_paused) noexcept {
    const Values* const taken = sent.find(in.cycle_seen);
    const double time_s = elapsed_s + limits.cycle_s * kSlackPeriods;
    Result result;
    for (int i = 0; i < limits.axis_count && has_last_; ++i) {
      const auto n = static_cast<std::size_t>(i);
      const AxisLimits& axis = limits.axes[n];
      const double step = in.measured[n] - last_[n];
      if (!is_paused && std::abs(step) > axis.speed * kOvershoot * time_s) {
        result = {Finding::kJump, i, step};
        break;
      }
      if (step != 0 || !has_led_) continue;
      const double led = taken != nullptr ? (*taken)[n] - led_from_[n] : 0;
      if (std::abs(led) > axis.frozen) {
        result = {Finding::kFrozen, i, led};
        break;
      }
    }
    remember(limits, in, taken);
    return result;
  }

 private:
  void remember(const Limits& limits, const Inputs& in, const Values* taken) noexcept {
    for (int i = 0; i < limits.axis_count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      const bool has_changed = !has_last_ || in.measured[n] != last_[n] || !has_led_;
      if (has_changed && taken != nullptr) led_from_[n] = (*taken)[n];
    }
    has_led_ = taken != nullptr;
    last_ = in.measured;
    has_last_ = true;
  }

  bool has_last_ = false, has_led_ = false;
  Values last_{};
  Values led_from_{};  ///< the setpoint of each axis when its position changed last
};

/// Positions that pass faster than an axis can move. RT: cycle.
[[nodiscard]] inline Result check_too_fast(const Limits& limits,
                                           const SpeedWindow& window) noexcept {
  if (!window.is_full()) return {};
  for (int i = 0; i < limits.axis_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const double speed = window.axis_speed(n);
    if (std::abs(speed) > limits.axes[n].speed * kOvershoot) return {Finding::kTooFast, i, speed};
  }
  return {};
}

}  // namespace meridian::monitoring
