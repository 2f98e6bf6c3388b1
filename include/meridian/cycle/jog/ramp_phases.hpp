// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace meridian {

/// The way of a value to a target, where it comes to rest, in the least time that a bound of its
/// first derivative and one of its second allow:
///
///     u'  peak ┤   ┌──────┐           three phases: u'' = ±bend until the peak slope (which turns
///              │  /        \          a slope that points the wrong way round first), the peak
///            0 ┼─/──────────\────     held (only on long ways), u'' = ∓bend until u' = 0
///
/// Two things move so: the rate of plan time, and the velocity of a joint that is jogged, with
/// acceleration for its slope and jerk for its bend. Phases may end inside a cycle. RT: cycle.
/// Proof: tests/property/cycle/rate_filter_test.cpp, tests/property/cycle/jog_motion_test.cpp.
struct RampPhases {
  static constexpr int kCount = 3;
  double left[kCount] = {};  ///< what is left of each phase, s
  double bend[kCount] = {};  ///< u'' in it
  int phase = kCount;        ///< the one that goes on; kCount: the target is reached

  [[nodiscard]] bool is_over() const noexcept { return phase == kCount; }
};

/// Lays the way out from `value`, which changes by `slope`, to `target`, with |u'| <= `max_slope`
/// and |u''| <= `bend`.
[[nodiscard]] inline RampPhases lay_out_ramp(double value, double slope, double target,
                                             double max_slope, double bend) noexcept {
  const double rest = value + 0.5 * slope * std::abs(slope) / bend;  // after full braking
  const double sign = target >= rest ? 1.0 : -1.0;
  const double along = sign * slope, distance = sign * (target - value);
  const double peak =
      std::min(max_slope, std::sqrt(std::max(0.0, bend * distance + 0.5 * along * along)));
  const double gained = (peak * peak - 0.5 * along * along) / bend;  // in the first and third phase
  RampPhases ramp;
  ramp.left[0] = std::max(0.0, (peak - along) / bend);
  ramp.left[1] = peak > 0 ? std::max(0.0, (distance - gained) / peak) : 0.0;
  ramp.left[2] = peak / bend;
  ramp.bend[0] = sign * bend;
  ramp.bend[2] = -sign * bend;
  ramp.phase = 0;
  return ramp;
}

}  // namespace meridian
