// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace meridian::hal {

/// Ends of periods on a grid that follows a thread's wake-ups slowly: their jitter is not in the
/// times by which the component interpolates. RT. Proof: tests/unit/hal/period_grid_test.cpp.
class PeriodGrid {
 public:
  explicit PeriodGrid(std::int64_t period_ns) noexcept : period_ns_(period_ns) {}

  /// The end of the period of a thread that woke at `now_ns`; the period before it took `dt_s`.
  /// Two periods off, the grid begins anew.
  [[nodiscard]] std::int64_t end_of(std::int64_t now_ns, double dt_s) noexcept {
    const std::int64_t asked = now_ns + period_ns_;
    const std::int64_t grid = end_ns_ + static_cast<std::int64_t>(std::llround(1e9 * dt_s));
    const std::int64_t off = asked - grid;
    end_ns_ = std::abs(off) < 2 * period_ns_ ? grid + off / kSlowness : asked;
    return end_ns_;
  }

 private:
  static constexpr std::int64_t kSlowness = 64;  ///< periods
  std::int64_t period_ns_, end_ns_ = 0;
};

}  // namespace meridian::hal
