// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "meridian/monitoring/sent_positions.hpp"

namespace meridian::monitoring {

/// Two equal lags in series, which settle v * time constant behind an input of speed v.
/// With e1 = u - y1 and e2 = u - y2 over a period dt of an input u that stands, w = 2 / time
/// constant:
///
///     e1' = -w e1             e1(dt) = e1 exp(-w dt)
///     e2' = -w e2 + w e1      e2(dt) = (e2 + w dt e1) exp(-w dt)
struct TwoLags {
  double turn = 0, decay = 0;    ///< w dt and its exp(-)
  double first = 0, second = 0;  ///< y1, y2

  void set_up(double time_constant_s, double cycle_s) noexcept {
    turn = time_constant_s > 0 ? 2 * cycle_s / time_constant_s : 700;  // exp(-700) is nothing
    decay = std::exp(-turn);
  }
  void advance(double u) noexcept {
    const double e1 = u - first, e2 = u - second;
    first = u - e1 * decay;
    second = u - (e2 + turn * e1) * decay;
  }
};

/// Following error of each drive, in its own coordinate, against a model of it and not a constant:
/// a delay, and behind it two lags. The model runs through every setpoint up to the one that a
/// report names, so a late report is no error.
///
/// Where a drive had to bridge setpoints, or took more or fewer of them than cycles went by, it is
/// ahead of the model or behind it by as many periods at the speed of its setpoint. The bound is
/// wider by twice that travel, and what is added dies out as the drive's own lag does: the model is
/// never switched off. So it is after the first report, for a drive that moves then.
/// RT: cycle. Proof: tests/unit/monitoring/drive_model_test.cpp.
class DriveModel {
 public:
  explicit DriveModel(const Limits& limits) noexcept {
    for (std::size_t i = 0; i < kAxes; ++i) {
      const AxisLimits& axis = limits.axes[i];
      has_any_ = has_any_ || axis.has_model;
      const double waits_s = 2 * std::max(0, axis.delay_cycles) * limits.cycle_s;
      axes_[i].model.set_up(axis.time_constant_s, limits.cycle_s);
      axes_[i].wider.set_up(axis.time_constant_s + waits_s, limits.cycle_s);
    }
  }
  void restart() noexcept {
    for (Axis& axis : axes_) axis.is_running = false;
  }

  /// Adds one cycle and the new reports of the drives `fresh`.
  [[nodiscard]] Result check(const Limits& limits, const SentPositions& sent, const Inputs& in,
                             std::uint32_t fresh) noexcept {
    Result result;
    for (int i = 0; i < limits.axis_count && has_any_; ++i) {
      const auto n = static_cast<std::size_t>(i);
      if (!limits.axes[n].has_model) continue;
      axes_[n].waited += static_cast<std::uint64_t>(in.periods);
      if ((fresh >> n & 1U) == 0) continue;
      add_report(limits, n, sent, in);
      const double error = in.reported[n] - axes_[n].model.second;
      const double bound = limits.axes[n].model_error + axes_[n].wider.second;
      if (std::abs(error) > bound && result.finding == Finding::kNone) {
        result = {Finding::kDriveModel, i, error};
      }
    }
    return result;
  }

  /// By how much the bound of drive `i` is wider than AxisLimits::model_error now.
  [[nodiscard]] double wider(std::size_t i) const noexcept { return axes_[i].wider.second; }

 private:
  static constexpr std::uint64_t kCatchUp = 192;  ///< more is another run

  struct Axis {
    bool is_running = false, has_input = false;
    std::uint64_t cycle = 0;     ///< the model has taken the setpoint of this cycle
    std::uint64_t waited = 0;    ///< periods since the newest report
    std::uint64_t missing = 0;   ///< setpoints since the newest that was found
    double input = 0, step = 0;  ///< newest setpoint, and how far it moved in a period
    TwoLags model, wider;
  };

  static void start(const AxisLimits& limits, Axis& axis, const Inputs& in,
                    std::size_t n) noexcept {
    axis.is_running = true;
    axis.has_input = false;
    axis.cycle = in.cycle_seen[n];
    axis.missing = 0;
    axis.input = axis.model.first = axis.model.second = in.reported[n];
    axis.step = 0;
    axis.wider.first = limits.drive_speed * limits.time_constant_s;  // its first lag is not known
    axis.wider.second = 0;
  }

  void add_report(const Limits& limits, std::size_t n, const SentPositions& sent,
                  const Inputs& in) noexcept {
    Axis& axis = axes_[n];
    const std::uint64_t seen = in.cycle_seen[n];
    const bool is_known = axis.is_running && seen >= axis.cycle && seen - axis.cycle <= kCatchUp;
    if (!is_known) {
      start(limits.axes[n], axis, in, n);
    } else {
      const std::uint64_t taken = seen - axis.cycle;
      const std::uint64_t uneven = std::max(taken, axis.waited) - std::min(taken, axis.waited);
      double travel = std::abs(axis.step), missed = 0;
      while (axis.cycle < seen) {
        missed += advance(limits.axes[n], axis, n, sent);
        travel = std::max(travel, std::abs(axis.step));
      }
      const double added = 2 * travel * (static_cast<double>(uneven) + missed);
      axis.wider.first += added;
      axis.wider.second += added;
    }
    axis.waited = 0;
  }

  /// One period on, by the setpoint of the cycle after `Axis::cycle`; 1 where there was none.
  static double advance(const AxisLimits& limits, Axis& axis, std::size_t n,
                        const SentPositions& sent) noexcept {
    const auto delay = static_cast<std::uint64_t>(std::max(0, limits.delay_cycles));
    const std::uint64_t next = ++axis.cycle;
    const Values* const commanded = next > delay ? sent.find(next - delay) : nullptr;
    ++axis.missing;
    if (commanded != nullptr) {
      const double u = (*commanded)[n];
      axis.step = axis.has_input ? (u - axis.input) / static_cast<double>(axis.missing) : 0;
      axis.input = u;
      axis.has_input = true;
      axis.missing = 0;
    }
    axis.model.advance(axis.input);
    axis.wider.advance(0);
    return commanded == nullptr ? 1 : 0;
  }

  bool has_any_ = false;
  std::array<Axis, kAxes> axes_{};
};

}  // namespace meridian::monitoring
