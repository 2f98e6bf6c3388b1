// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/monitoring/monitored.hpp"

namespace meridian::monitoring {

/// The mode, from what the machine does and its guard. What moved when a guard opened has
/// Limits::guard_stop_s to come to rest; from its first rest on an open guard counts at once.
/// RT: cycle. Proof: tests/unit/monitoring/mode_test.cpp.
class ModeTracker {
 public:
  [[nodiscard]] Mode find(const Limits& limits, const Inputs& in) noexcept {
    const bool is_still = in.motion == Motion::kRest || in.motion == Motion::kOff;
    if (!in.is_guard_open) {
      open_s_ = 0;
      counts_as_shut_ = true;
    } else {
      open_s_ += limits.cycle_s * in.periods;
      if (is_still || open_s_ > limits.guard_stop_s) counts_as_shut_ = false;
    }
    switch (in.motion) {
      case Motion::kOff:
        return Mode::kOff;
      case Motion::kRest:
        return Mode::kStandstill;
      case Motion::kJog:
        return counts_as_shut_ ? Mode::kAutomatic : Mode::kSetUp;
      case Motion::kHoming:
        return counts_as_shut_ ? Mode::kOff : Mode::kStandstill;
      case Motion::kProgram:
        return counts_as_shut_ ? Mode::kAutomatic : Mode::kStandstill;
    }
    return Mode::kOff;
  }

 private:
  double open_s_ = 0;
  bool counts_as_shut_ = true;
};

}  // namespace meridian::monitoring
