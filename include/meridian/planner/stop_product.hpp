// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace meridian {

/// Largest ṡ |s̈| on a stop with |s⃛| = `jerk` and |s̈| <= `accel` whose speed is `top` where s̈ = 0.
///
/// While the stop turns from s̈ = 0 to its deepest deceleration ṡ = top - s̈²/2j, and ṡ |s̈| is
/// largest at s̈² = 2/3 j top or at the deepest; afterwards both fall. The same holds while it lets
/// go of a positive s̈ on the way to the top. It grows with every argument. Units: mm, s. RT: cycle.
/// Proof: tests/property/cycle/stop_margin_test.cpp.
[[nodiscard]] inline double largest_stop_product(double top, double accel, double jerk) noexcept {
  if (!(jerk > 0)) return top * accel;
  const double at = std::min(accel, std::sqrt(jerk * top * (2.0 / 3.0)));
  return (top - at * at / (2 * jerk)) * at;
}

}  // namespace meridian
