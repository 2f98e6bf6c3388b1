// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "meridian/monitoring/report_clock.hpp"
#include "meridian/monitoring/sent_positions.hpp"
#include "meridian/monitoring/speed_window.hpp"

namespace meridian::monitoring {

/// Servo loops overshoot: a drive may report to be faster than its limit by this factor.
inline constexpr double kOvershoot = 1.25;

/// Plausibility of feedback: a jump is farther from the report before than the drive can move in
/// the time that ReportClock allows; frozen is a position that stays the same to the last bit while
/// the setpoints that were taken lead on; too fast is a mean speed that the drive, or the axis,
/// cannot have. RT: cycle. Proof: tests/unit/monitoring/plausible_feedback_test.cpp.
class PlausibleFeedback {
 public:
  void restart() noexcept { axes_ = {}; }

  /// Adds the new reports of the drives `fresh`.
  [[nodiscard]] Result check(const Limits& limits, const SentPositions& sent, const Inputs& in,
                             const ReportClock& clock, std::uint32_t fresh) noexcept {
    Result result;
    for (int i = 0; i < limits.axis_count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      if ((fresh >> n & 1U) == 0) continue;
      const Values* const taken = sent.find(in.cycle_seen[n]);
      const double* const led = taken != nullptr ? &(*taken)[n] : nullptr;
      const Result next = check_axis(limits, i, in.reported[n], led, clock.allowed_s(n));
      if (result.finding == Finding::kNone) result = next;
    }
    return result;
  }

 private:
  struct Axis {
    bool has_last = false, has_led = false;
    double last = 0;
    double led_from = 0;  ///< the setpoint when the position changed last
  };

  /// `led`: the setpoint that the drive had taken; nullptr: not known.
  [[nodiscard]] Result check_axis(const Limits& limits, int i, double at, const double* led,
                                  double allowed_s) noexcept {
    const AxisLimits& allowed = limits.axes[static_cast<std::size_t>(i)];
    Axis& axis = axes_[static_cast<std::size_t>(i)];
    const double step = at - axis.last;
    const bool has_changed = !axis.has_last || step != 0 || !axis.has_led;
    Result result;
    if (axis.has_last && std::abs(step) > allowed.drive_speed * kOvershoot * allowed_s) {
      result = {Finding::kJump, i, step};
    } else if (!has_changed && led != nullptr && std::abs(*led - axis.led_from) > allowed.frozen) {
      result = {Finding::kFrozen, i, *led - axis.led_from};
    }
    if (has_changed && led != nullptr) axis.led_from = *led;
    axis.has_led = led != nullptr;
    axis.last = at;
    axis.has_last = true;
    return result;
  }

  std::array<Axis, kAxes> axes_{};
};

/// Positions that pass faster than a drive can move, or than what drives move together may. RT:
/// cycle.
[[nodiscard]] inline Result check_too_fast(const Limits& limits,
                                           const SpeedWindow& window) noexcept {
  if (!window.is_full()) return {};
  for (int i = 0; i < limits.axis_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    if (window.is_drive_faster(n, limits.axes[n].drive_speed * kOvershoot)) {
      return {Finding::kDriveTooFast, i, window.drive_speed(n)};
    }
  }
  for (int i = 0; limits.has_stage && i < limits.axis_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    if (window.is_faster(n, limits.axes[n].speed * kOvershoot)) {
      return {Finding::kAxisTooFast, i, window.axis_speed(n)};
    }
  }
  return {};
}

}  // namespace meridian::monitoring
