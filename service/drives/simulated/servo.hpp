// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace meridian::drives {

enum class LagKind : std::uint8_t {
  kFirstOrder,   ///< a position loop alone
  kSecondOrder,  ///< position and velocity loop, critically damped: the velocity is smooth
};

/// How a drive lags behind its setpoint. At constant velocity v both kinds settle at a following
/// error of v · time_constant_s; 0 follows at once.
struct ServoLag {
  LagKind kind = LagKind::kSecondOrder;
  double time_constant_s = 0.002;
};

/// Position and velocity of a driven joint. Units: mm or rad, s.
struct ServoState {
  double position = 0, velocity = 0;
};

/// Returns the state after `dt_s` with the target standing still at `target`: the exact solution,
/// so that any period is stable. Proof: tests/unit/simulated_drives/servo_test.cpp.
[[nodiscard]] inline ServoState follow(const ServoState& from, double target, double dt_s,
                                       const ServoLag& lag) noexcept {
  const double error = from.position - target;
  if (!(lag.time_constant_s > 0)) return {target, dt_s > 0 ? -error / dt_s : 0};
  if (lag.kind == LagKind::kFirstOrder) {
    const double left = error * std::exp(-dt_s / lag.time_constant_s);
    return {target + left, -left / lag.time_constant_s};
  }
  const double w = 2 / lag.time_constant_s;
  const double slope = from.velocity + w * error;
  const double decay = std::exp(-w * dt_s);
  return {target + (error + slope * dt_s) * decay, (from.velocity - w * slope * dt_s) * decay};
}

}  // namespace meridian::drives
