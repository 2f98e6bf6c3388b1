// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "meridian/monitoring/report_clock.hpp"

namespace meridian::monitoring {

/// Mean speeds of axes, drives and tip over kWindow_s or kWindowPeriods periods, whichever is
/// longer, by the times of the two reports at its ends: steps of an encoder and late reports weigh
/// little, and nothing adds up. Lost periods make it longer. kSlackPeriods are added to the time,
/// so that a late report is no speed: what it says is a sixteenth too low at most. RT: cycle.
/// Proof: tests/unit/monitoring/limited_speed_test.cpp.
class SpeedWindow {
 public:
  static constexpr double kWindow_s = 0.064;
  static constexpr std::size_t kWindowPeriods = 64;

  explicit SpeedWindow(const Limits& limits) noexcept
      : cycle_s_(limits.cycle_s),
        slack_s_(limits.cycle_s * kSlackPeriods),
        stride_(std::max(
            1, static_cast<int>(std::lround(kWindow_s / static_cast<double>(kWindowPeriods) /
                                            limits.cycle_s)))) {}
  void restart() noexcept { count_ = 0, skipped_ = 0; }
  /// Takes one cycle.
  void add(const Inputs& in) noexcept {
    now_ = {in.measured, in.reported, in.tip, in.arrival_ns, in.cycle_seen};
    if (++skipped_ < stride_ && count_ != 0) return;
    skipped_ = 0;
    before_ = kept_[count_ % kWindowPeriods];
    kept_[count_ % kWindowPeriods] = now_;
    ++count_;
  }
  /// Whether there were reports for the whole window: only then do speeds mean something.
  [[nodiscard]] bool is_full() const noexcept { return count_ > kWindowPeriods; }
  [[nodiscard]] bool is_faster(std::size_t i, double speed) const noexcept {
    return is_faster(i, now_.measured[i] - before_.measured[i], speed);
  }
  [[nodiscard]] bool is_drive_faster(std::size_t i, double speed) const noexcept {
    return is_faster(i, now_.reported[i] - before_.reported[i], speed);
  }
  [[nodiscard]] double axis_speed(std::size_t i) const noexcept {
    return (now_.measured[i] - before_.measured[i]) / time_s(i);
  }
  [[nodiscard]] double drive_speed(std::size_t i) const noexcept {
    return (now_.reported[i] - before_.reported[i]) / time_s(i);
  }
  /// Of the first `axis_count` axes' tip, by the longest of their times.
  [[nodiscard]] double tip_speed(int axis_count) const noexcept {
    double longest_s = slack_s_;
    for (std::size_t i = 0; i < static_cast<std::size_t>(axis_count); ++i) {
      longest_s = std::max(longest_s, time_s(i));
    }
    return distance(now_.tip, before_.tip) / longest_s;
  }

 private:
  struct Kept {
    Values measured{}, reported{};
    Point tip{};
    std::array<std::int64_t, kAxes> arrival_ns{};
    std::array<std::uint64_t, kAxes> cycle_seen{};
  };
  [[nodiscard]] static double distance(const Point& a, const Point& b) noexcept {
    const double x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
    return std::sqrt(x * x + y * y + z * z);
  }
  [[nodiscard]] bool is_faster(std::size_t i, double moved, double speed) const noexcept {
    const double distance = std::abs(moved);  // at rest the first comparison is enough
    return distance > speed * slack_s_ && distance > speed * time_s(i);
  }
  [[nodiscard]] double time_s(std::size_t i) const noexcept {
    return slack_s_ + time_between(cycle_s_, now_.arrival_ns[i], before_.arrival_ns[i],
                                   now_.cycle_seen[i], before_.cycle_seen[i]);
  }

  double cycle_s_, slack_s_;
  int stride_, skipped_ = 0;  ///< cycles between two that are kept
  std::size_t count_ = 0;
  std::array<Kept, kWindowPeriods> kept_{};
  Kept now_, before_;
};

/// Limited speed of axes and tip, in set-up mode. RT: cycle.
[[nodiscard]] inline Result check_limited_speed(const Limits& limits, const SpeedWindow& window,
                                                Mode mode) noexcept {
  if (mode != Mode::kSetUp || !window.is_full()) return {};
  const double tip = window.tip_speed(limits.axis_count);
  if (tip > limits.set_up_tip_speed) return {Finding::kTipSpeed, 0, tip};
  for (int i = 0; i < limits.axis_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    if (window.is_faster(n, limits.axes[n].set_up_speed)) {
      return {Finding::kAxisSpeed, i, window.axis_speed(n)};
    }
  }
  return {};
}

}  // namespace meridian::monitoring
