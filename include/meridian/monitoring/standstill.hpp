// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "meridian/monitoring/monitored.hpp"

namespace meridian::monitoring {

/// Standstill: every axis stays where it was Limits::settle_s after it was to stand. It asks for no
/// setpoint. RT: cycle. Proof: tests/unit/monitoring/standstill_test.cpp.
class Standstill {
 public:
  [[nodiscard]] Result check(const Limits& limits, const Inputs& in, Mode mode) noexcept {
    if (mode != Mode::kStandstill) {
      time_s_ = 0;
      is_settled_ = false;
      return {};
    }
    time_s_ += limits.cycle_s * in.periods;
    if (!in.has_report || time_s_ < limits.settle_s) return {};
    if (!is_settled_) rest_position_ = in.measured;
    is_settled_ = true;
    for (int i = 0; i < limits.axis_count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      const double moved = in.measured[n] - rest_position_[n];
      if (std::abs(moved) > limits.axes[n].standstill) return {Finding::kStandstill, i, moved};
    }
    return {};
  }

 private:
  double time_s_ = 0;
  bool is_settled_ = false;
  Values rest_position_{};
};

}  // namespace meridian::monitoring
