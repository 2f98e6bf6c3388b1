// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "meridian/cycle/jog/ramp_phases.hpp"

/// The motion of one joint that an operator jogs: a velocity is followed by jerk alone, and the
/// joint comes to rest before the end of its room, whatever is asked for. Units: mm or rad, s.
/// RT: cycle. Proof: tests/property/cycle/jog_motion_test.cpp.
namespace meridian {

/// Where a jogged joint is and how it moves.
struct JogPoint {
  double q = 0, v = 0, a = 0;
};

/// What the motion may use.
struct JogRates {
  double velocity = 0, acceleration = 0, jerk = 0;
};

/// Returns the point `t` later under constant jerk.
[[nodiscard]] inline JogPoint moved(const JogPoint& p, double jerk, double t) noexcept {
  return {p.q + t * (p.v + t * (p.a / 2 + t * jerk / 6)), p.v + t * (p.a + t * jerk / 2),
          p.a + t * jerk};
}

/// The way from a point to a constant velocity in the least time that acceleration and jerk allow
/// (lay_out_ramp()). The velocity stays between the one that braking from here would leave and the
/// one that is aimed at.
class JogRamp {
 public:
  JogRamp() = default;
  JogRamp(const JogPoint& from, double velocity, const JogRates& rates) noexcept
      : aim_(velocity),
        ramp_(lay_out_ramp(from.v, from.a, velocity, rates.acceleration, rates.jerk)) {}

  /// Moves `p`, which is on this way, on by `dt`; at the end of the way the velocity is exact.
  void advance(JogPoint& p, double dt) noexcept {
    while (!ramp_.is_over() && dt >= ramp_.left[ramp_.phase]) {
      p = moved(p, ramp_.bend[ramp_.phase], ramp_.left[ramp_.phase]);
      dt -= ramp_.left[ramp_.phase];
      ++ramp_.phase;
      if (ramp_.is_over()) p = {p.q, aim_, 0};
    }
    if (ramp_.is_over()) {
      p.q += aim_ * dt;
      return;
    }
    p = moved(p, ramp_.bend[ramp_.phase], dt);
    ramp_.left[ramp_.phase] -= dt;
  }

  /// Widens [low, high] by the positions of the rest of the way from `p`; returns the last.
  double spread(JogPoint p, double& low, double& high) const noexcept {
    const auto take = [&](double q) {
      low = std::min(low, q);
      high = std::max(high, q);
    };
    take(p.q);
    for (int i = ramp_.phase; i < RampPhases::kCount; ++i) {
      // The turning points of v + a t + j t²/2.
      const double j = ramp_.bend[i], square = p.a * p.a - 2 * j * p.v;
      if (j != 0 && square > 0) {
        const double root = std::sqrt(square);
        for (const double t : {(-p.a - root) / j, (-p.a + root) / j}) {
          if (t > 0 && t < ramp_.left[i]) take(moved(p, j, t).q);
        }
      } else if (j == 0 && p.a != 0 && -p.v / p.a > 0 && -p.v / p.a < ramp_.left[i]) {
        take(moved(p, 0, -p.v / p.a).q);
      }
      p = moved(p, j, ramp_.left[i]);
      take(p.q);
    }
    return p.q;
  }

 private:
  double aim_ = 0;
  RampPhases ramp_;
};

/// A jogged joint between two cycles. `low` and `high` are the ends of its room; outside of it, it
/// may move inwards only.
struct JogAxis {
  JogPoint at;
  JogRates rates;
  double low = 0, high = 0;
  JogRamp ramp;            ///< what is followed
  double asked = 0;        ///< velocity that `ramp` was laid out for
  bool is_ending = false;  ///< `ramp` comes to rest at an end of the room

  [[nodiscard]] bool is_at_rest() const noexcept { return at.v == 0 && at.a == 0; }
};

/// Whether `p` and full braking from it stay in the room of `axis`; where that is left already,
/// whether they lead inwards all the way and no farther than to the other end.
[[nodiscard]] inline bool may_be_at(const JogAxis& axis, const JogPoint& p) noexcept {
  constexpr double kRounding = 1e-12;
  double low = p.q, high = p.q;
  const double end = JogRamp(p, 0, axis.rates).spread(p, low, high);
  if (p.q < std::min(axis.low, axis.at.q) || p.q > std::max(axis.high, axis.at.q)) return false;
  if (p.q > axis.high) {
    return end - low <= kRounding && end >= std::min(axis.low, axis.at.q) - kRounding;
  }
  if (p.q < axis.low) {
    return high - end <= kRounding && end <= std::max(axis.high, axis.at.q) + kRounding;
  }
  return low >= axis.low && high <= axis.high;
}

/// Brakes from where the axis is, with `rates`.
inline void brake(JogAxis& axis, const JogRates& rates) noexcept {
  if (axis.is_at_rest()) {
    axis.ramp = {};
    return;
  }
  axis.rates = rates;
  axis.ramp = JogRamp(axis.at, 0, rates);
  axis.asked = 0;
  axis.is_ending = true;
}

/// Goes on towards the end of the room for as long as braking still ends in it, found by halving
/// the cycle, and brakes from there: what remains of the cycle is the begin of the braking.
inline void turn_to_end(JogAxis& axis, double dt) noexcept {
  double safe = 0, beyond = dt;
  for (int n = 0; n < 48; ++n) {
    const double middle = 0.5 * (safe + beyond);
    JogPoint p = axis.at;
    JogRamp ramp = axis.ramp;
    ramp.advance(p, middle);
    (may_be_at(axis, p) ? safe : beyond) = middle;
  }
  axis.ramp.advance(axis.at, safe);
  axis.ramp = JogRamp(axis.at, 0, axis.rates);
  axis.ramp.advance(axis.at, dt - safe);
  axis.is_ending = true;
}

/// One cycle of `dt` towards `velocity` (beyond the rates: as fast as they allow; NaN: at rest).
///
/// Every point that is left behind was one from which braking ends in the room, so that braking is
/// always a way on. The last cycle before braking is cut where braking ends exactly at the end of
/// the room; the joint then rests there until something else is asked for.
inline void follow(JogAxis& axis, double velocity, double dt) noexcept {
  const double max = axis.rates.velocity;
  const double asked = std::isnan(velocity) ? 0 : std::clamp(velocity, -max, max);
  JogRamp ramp = axis.ramp;
  if (asked != axis.asked) {
    ramp = JogRamp(axis.at, asked, axis.rates);
  } else if (axis.is_ending) {
    axis.ramp.advance(axis.at, dt);
    return;
  }
  JogPoint next = axis.at;
  JogRamp rest = ramp;
  rest.advance(next, dt);
  axis.asked = asked;
  if (may_be_at(axis, next)) {
    axis.at = next;
    axis.ramp = rest;
    axis.is_ending = false;
    return;
  }
  if (!axis.is_ending) axis.ramp = ramp;
  turn_to_end(axis, dt);
}

}  // namespace meridian
