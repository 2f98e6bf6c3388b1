// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "meridian/cycle/jog/ramp_phases.hpp"

namespace meridian {

/// Bounds of the rate of plan time: |w'| <= slope, |w''| <= curvature. The planner leaves room for
/// them in every plan (planner/rate_limits.hpp). Units: 1/s, 1/s².
struct RateBounds {
  double slope = 1.0;
  double curvature = 10.0;
};

/// The rate w = d(plan time)/dt, which follows the feed override and brings a held machine back to
/// speed. It moves to each new target by a ramp (lay_out_ramp()) inside the bounds and lands there
/// exactly, with w' = 0.
///
/// A ramp is laid out when the target changes and then only read, so nothing can chatter. Targets
/// in [0, 1] keep w in [0, 1]: at any time full braking would end between the targets so far.
///
/// Phases may end inside a cycle; plan time is the exact integral of w. Source: docs/motion.md,
/// section 3. RT: cycle. Proof: tests/property/cycle/rate_filter_test.cpp.
class RateFilter {
 public:
  explicit RateFilter(const RateBounds& bounds = {}) noexcept
      : bounds_(bounds), in_force_(bounds) {}

  [[nodiscard]] double rate() const noexcept { return now_.w; }
  [[nodiscard]] double slope() const noexcept { return now_.slope; }
  [[nodiscard]] double target() const noexcept { return target_; }
  [[nodiscard]] bool is_settled() const noexcept { return ramp_.is_over(); }

  /// Puts the rate at `w` with w' = 0; allowed only where the plan is at rest, or for w = 0 after
  /// a stop.
  void reset(double w) noexcept {
    now_ = {w, 0};
    target_ = w;
    ramp_ = {};
    in_force_ = bounds_;
  }

  /// Sets a new target, limited to [0, 1]; NaN is ignored.
  void aim(double target) noexcept {
    if (std::isnan(target)) return;
    target = std::clamp(target, 0.0, 1.0);
    if (target == target_) return;
    target_ = target;
    ramp_ = lay_out_ramp(now_.w, now_.slope, target_, bounds_.slope, bounds_.curvature);
  }

  /// Brings the rate to 0 inside `bounds`, which are as wide as its own or wider, until reset().
  void stop(const RateBounds& bounds) noexcept {
    in_force_ = bounds;
    target_ = 0;
    ramp_ = lay_out_ramp(now_.w, now_.slope, target_, bounds.slope, bounds.curvature);
  }

  /// Plan time that passes until the rate is 0 where it is aimed there now: the least that there
  /// is.
  [[nodiscard]] double plan_time_to_rest() const noexcept {
    constexpr double kForever_s = 1e9;
    RateFilter braking = *this;
    braking.aim(0);
    return braking.advance(kForever_s);
  }

  /// The largest steady rate from which `plan_time` is enough to come to rest:
  /// w²/2Ω₁ + w Ω₁/2Ω₂ = plan_time, or √(w³/Ω₂) where the slope stays below Ω₁.
  [[nodiscard]] double rate_with_rest_in(double plan_time) const noexcept {
    const double slope = bounds_.slope, c = bounds_.curvature;
    if (!(plan_time > 0)) return 0;
    if (plan_time * c * c <= slope * slope * slope) return std::cbrt(plan_time * plan_time * c);
    const double half = slope / (2 * c);
    return slope * (std::sqrt(half * half + 2 * plan_time / slope) - half);
  }

  /// Moves on by `dt` and returns the plan time that passes meanwhile, never negative.
  double advance(double dt) noexcept {
    double plan_time = 0;
    while (!ramp_.is_over() && dt >= ramp_.left[ramp_.phase]) {
      plan_time += move(ramp_.left[ramp_.phase]);
      dt -= ramp_.left[ramp_.phase];
      ++ramp_.phase;
      if (ramp_.is_over()) now_ = {target_, 0};
    }
    if (ramp_.is_over()) return plan_time + now_.w * dt;
    plan_time += move(dt);
    ramp_.left[ramp_.phase] -= dt;
    return plan_time;
  }

 private:
  struct Point {
    double w = 0, slope = 0;
  };

  /// Moves on inside the phase; plan time is the integral of w.
  double move(double t) noexcept {
    const double c = ramp_.bend[ramp_.phase];
    const double passed = t * (now_.w + t * (now_.slope / 2 + t * c / 6));
    now_.w = std::clamp(now_.w + t * (now_.slope + t * c / 2), 0.0, 1.0);
    now_.slope = std::clamp(now_.slope + t * c, -in_force_.slope, in_force_.slope);
    return std::max(0.0, passed);
  }

  RateBounds bounds_;
  RateBounds in_force_;  ///< those of stop() until reset()
  Point now_{};
  double target_ = 0;
  RampPhases ramp_;
};

}  // namespace meridian
