// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "meridian/monitoring/sent_positions.hpp"

namespace meridian::monitoring {

/// Following error against a model of each drive in the place of a constant: a delay, and behind it
/// two equal lags, which settle v * time_constant_s behind a setpoint of speed v. With e1 = u - y1
/// and e2 = u - y2 over a period dt of a setpoint u that stands, w = 2 / time constant:
///
///     e1' = -w e1             e1(dt) = e1 exp(-w dt)
///     e2' = -w e2 + w e1      e2(dt) = (e2 + w dt e1) exp(-w dt)
///
/// It runs through every setpoint up to the one that a report names, so a late report is no error.
/// Where the drives had to bridge setpoints, nothing is checked until that has died out.
/// RT: cycle. Proof: tests/unit/monitoring/drive_model_test.cpp.
class DriveModel {
 public:
  explicit DriveModel(const Limits& limits) noexcept {
    for (std::size_t i = 0; i < kAxes; ++i) {
      const double lag_s = limits.axes[i].time_constant_s;
      has_any_ = has_any_ || limits.axes[i].has_model;
      turn_[i] = lag_s > 0 ? 2 * limits.cycle_s / lag_s : 700;  // exp(-700) is nothing
      decay_[i] = std::exp(-turn_[i]);
    }
  }
  void restart() noexcept { is_running_ = false; }

  /// Takes a new report.
  [[nodiscard]] Result check(const Limits& limits, const SentPositions& sent,
                             const Inputs& in) noexcept {
    if (!has_any_) return {};
    if (!is_running_ || in.cycle_seen < cycle_ || in.cycle_seen - cycle_ > kCatchUp) {
      start(in);
      return {};
    }
    if (in.periods > 1 || bridged_ > kBridged) pause_ = kPause;
    bridged_ = in.cycle_seen == cycle_ ? bridged_ + 1 : 0;
    for (; cycle_ < in.cycle_seen; ++cycle_) advance(limits, sent);
    if (pause_ > 0) --pause_;
    if (pause_ > 0 || bridged_ > 0) return {};
    for (int i = 0; i < limits.axis_count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      const double error = in.measured[n] - second_[n];
      if (limits.axes[n].has_model && std::abs(error) > limits.axes[n].model_error) {
        return {Finding::kDriveModel, i, error};
      }
    }
    return {};
  }

 private:
  static constexpr std::uint64_t kCatchUp = 64;  ///< more is another run
  static constexpr int kPause = 50;              ///< reports
  static constexpr int kBridged = 2;  ///< periods without a setpoint leave no error behind

  void start(const Inputs& in) noexcept {
    is_running_ = true;
    cycle_ = in.cycle_seen;
    first_ = second_ = in.measured;
    pause_ = kPause;
    bridged_ = 0;
  }
  /// One period on, by the setpoint of the cycle behind `cycle_`.
  void advance(const Limits& limits, const SentPositions& sent) noexcept {
    for (int i = 0; i < limits.axis_count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      const AxisLimits& axis = limits.axes[n];
      const auto delay = static_cast<std::uint64_t>(std::max(0, axis.delay_cycles));
      const Values* const commanded = cycle_ + 1 > delay ? sent.find(cycle_ + 1 - delay) : nullptr;
      if (!axis.has_model || commanded == nullptr) continue;
      const double u = (*commanded)[n];
      const double e1 = u - first_[n], e2 = u - second_[n];
      first_[n] = u - e1 * decay_[n];
      second_[n] = u - (e2 + turn_[n] * e1) * decay_[n];
    }
  }

  bool has_any_ = false, is_running_ = false;
  Values turn_{}, decay_{};  ///< of one period
  int pause_ = 0;
  std::uint64_t cycle_ = 0;  ///< the model has taken the setpoint of this cycle
  int bridged_ = 0;          ///< reports since the drives took a setpoint
  Values first_{}, second_{};
};

}  // namespace meridian::monitoring
