// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "meridian/planner/time_law.hpp"

namespace meridian {

/// Acceleration and jerk along the path that a stop may use. Units: mm, s.
struct StopMargin {
  double accel = 0, jerk = 0;
};

/// The stop in the least time from a given path state, v >= 0, by jerk and acceleration alone:
///
///     a  a0 ┤\                       phase 0: jerk ∓ to the deepest deceleration
///         0 ┼─\───────────/──        phase 1: constant deceleration (only from high speed)
///    -accel ┤  \_________/           phase 2: jerk + to rest, v and a vanish together
///
/// The deceleration reached is limited by `accel`, or by the speed that there is to lose. Where a0
/// is already so deep that the speed is gone before the deceleration is (v < a0²/2j), phase 2 alone
/// remains, with the larger jerk that ends exactly at rest: the plan that came here was itself
/// about to end that way.
///
/// Against the plan: a motion that keeps the same bounds and ends at rest further on is never
/// slower anywhere on the path than this stop, so the stop neither passes the plan's rest nor is
/// faster than planned (docs/decisions/0001-stop-in-path-length.md). RT: cycle. Proof:
/// tests/property/cycle/stop_law_test.cpp.
class StopLaw {
 public:
  StopLaw() = default;

  /// Lays out the stop from `begin`; a negative speed (rounding) counts as zero.
  StopLaw(const PathState& begin, const StopMargin& authority) noexcept : begin_(begin) {
    const double v = begin_.ds = std::max(0.0, begin.ds);
    const double a = begin.dds, j = std::max(authority.jerk, kMin);
    if (v == 0) {
      begin_.dds = 0;
    } else if (a < 0 && a * a >= 2 * j * v) {
      duration_[2] = -2 * v / a;  // v = a²/2j' with the jerk j' that fits
      jerk_[2] = a * a / (2 * v);
    } else {
      lay_out(v, a, std::max(authority.accel, kMin), j);
    }
    at_[0] = begin_;
    at_[1] = move(at_[0], jerk_[0], duration_[0]);
    at_[2] = move(at_[1], 0, duration_[1]);
    rest_ = std::max(begin_.s, move(at_[2], jerk_[2], duration_[2]).s);
  }

  /// Time to rest, s.
  [[nodiscard]] double duration() const noexcept {
    return duration_[0] + duration_[1] + duration_[2];
  }
  /// Path length that the stop takes, mm.
  [[nodiscard]] double distance() const noexcept { return rest_ - begin_.s; }

  /// Path state `t` after the begin; from duration() on exactly at rest at the end of the stop.
  [[nodiscard]] PathState at(double t) const noexcept {
    if (t >= duration()) return {rest_, 0, 0, 0};
    if (t < duration_[0]) return limit(move(at_[0], jerk_[0], t));
    t -= duration_[0];
    if (t < duration_[1]) return limit(move(at_[1], 0, t));
    // Seen from the rest, so that speed and deceleration vanish without cancellation.
    const double left = duration_[2] - (t - duration_[1]);
    const double j = jerk_[2];
    return limit({rest_ - j * left * left * left / 6, j * left * left / 2, -j * left, j});
  }

 private:
  static constexpr double kMin = 1e-9;  ///< authority below it would never end a stop

  void lay_out(double v, double a, double accel, double j) noexcept {
    // Deepest deceleration without a constant phase: the speed lost turning a to -d and -d to 0.
    // From above, (a² + 2 j v) / 2 = d²; from below (a < -accel) the first phase eases off.
    const double free_depth = std::sqrt(std::max(0.0, j * v + a * a / 2));
    const double depth = std::min(free_depth, accel);
    if (-a > depth) {  // deeper than allowed now: ease off to `accel`
      duration_[0] = (-a - depth) / j;
      jerk_[0] = j;
    } else {
      duration_[0] = (a + depth) / j;
      jerk_[0] = -j;
    }
    const double v_after = v + duration_[0] * (a - depth) / 2;
    duration_[1] = std::max(0.0, (v_after - depth * depth / (2 * j)) / depth);
    duration_[2] = depth / j;
    jerk_[2] = j;
  }

  [[nodiscard]] static PathState move(const PathState& p, double j, double t) noexcept {
    return {p.s + t * (p.ds + t * (p.dds / 2 + t * j / 6)), p.ds + t * (p.dds + t * j / 2),
            p.dds + t * j, j};
  }
  [[nodiscard]] PathState limit(const PathState& p) const noexcept {
    return {std::clamp(p.s, begin_.s, rest_), std::max(0.0, p.ds), p.dds, p.ddds};
  }

  PathState begin_{};
  PathState at_[3] = {};
  double duration_[3] = {};
  double jerk_[3] = {};
  double rest_ = 0;
};

}  // namespace meridian
