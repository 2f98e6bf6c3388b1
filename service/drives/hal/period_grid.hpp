// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace meridian::hal {

/// Ends of setpoints on a grid that follows a thread's wake-ups slowly: neither their jitter is in
/// the times by which the component interpolates, nor that two setpoints come at once, then none.
/// RT. Proof: tests/unit/hal/period_grid_test.cpp.
class PeriodGrid {
 public:
  explicit PeriodGrid(std::int64_t period_ns) noexcept : period_ns_(period_ns) {}

  /// The end of a setpoint that is `elapsed_s` behind the one before, of a thread that woke at
  /// `now_ns`. Never before the last end; 32 periods off, the grid begins anew: setpoints that were
  /// held up come at once a little later, and belong where they were. Whose sender counts cycles
  /// faster than they pass does not run ahead: what is far ahead would be followed so much later.
  [[nodiscard]] std::int64_t end_of(std::int64_t now_ns, double elapsed_s) noexcept {
    const std::int64_t asked = now_ns + period_ns_;
    const std::int64_t grid = end_ns_ + static_cast<std::int64_t>(std::llround(1e9 * elapsed_s));
    const std::int64_t off = asked - grid;
    const bool is_near = end_ns_ != 0 && std::abs(off) < kFarOff * period_ns_;
    const std::int64_t end = is_near ? grid + off / kSlowness : asked;
    end_ns_ = std::max(end_ns_, std::min(end, asked + kAhead * period_ns_));
    return end_ns_;
  }

 private:
  static constexpr std::int64_t kSlowness = 256;
  static constexpr std::int64_t kFarOff = 32, kAhead = 8;  ///< periods
  std::int64_t period_ns_, end_ns_ = 0;
};

}  // namespace meridian::hal
