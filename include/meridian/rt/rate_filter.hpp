// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace meridian {

/// Bounds of the rate of plan time: |w'| <= slope, |w''| <= curvature. The planner leaves room for
/// them in every plan (planner/rate_limits.hpp). Units: 1/s, 1/s².
struct RateBounds {
  double slope = 1.0;
  double curvature = 10.0;
};

/// The rate w = d(plan time)/dt, which follows the feed override and brings a held machine back to
/// speed. It moves to each new target in the least time that the bounds allow and lands there
/// exactly, with w' = 0:
///
///     w'  slope ┤   ┌──────┐           three phases: w'' = ±curvature to the peak slope,
///               │  /        \          slope held (only on long ways), w'' = ∓curvature to w' = 0
///             0 ┼─/──────────\────
///
/// A profile is laid out when the target changes and then only read, so nothing can chatter. If w'
/// points the wrong way the first phase turns it round. Targets in [0, 1] keep w in [0, 1]: at any
/// time full braking would end between the targets so far.
///
/// Phases may end inside a cycle; plan time is the exact integral of w. Source: docs/motion.md,
/// section 3. RT: cycle. Proof: tests/property/rt/rate_filter_test.cpp.
class RateFilter {
 public:
  explicit RateFilter(const RateBounds& bounds = {}) noexcept : bounds_(bounds) {}

  [[nodiscard]] double rate() const noexcept { return now_.w; }
  [[nodiscard]] double slope() const noexcept { return now_.slope; }
  [[nodiscard]] double target() const noexcept { return target_; }
  [[nodiscard]] bool is_settled() const noexcept { return phase_ == kPhases; }

  /// Puts the rate at `w` with w' = 0; allowed only where the plan is at rest, or for w = 0 after
  /// a stop.
  void reset(double w) noexcept {
    now_ = {w, 0};
    target_ = w;
    phase_ = kPhases;
  }

  /// Sets a new target, limited to [0, 1]; NaN is ignored.
  void aim(double target) noexcept {
    if (std::isnan(target)) return;
    target = std::clamp(target, 0.0, 1.0);
    if (target == target_) return;
    target_ = target;
    lay_out();
  }

  /// Moves on by `dt` and returns the plan time that passes meanwhile, never negative.
  double advance(double dt) noexcept {
    double plan_time = 0;
    while (phase_ < kPhases && dt >= left_[phase_]) {
      plan_time += move(left_[phase_]);
      dt -= left_[phase_];
      ++phase_;
      if (phase_ == kPhases) now_ = {target_, 0};
    }
    if (phase_ < kPhases) {
      plan_time += move(dt);
      left_[phase_] -= dt;
      return plan_time;
    }
    return plan_time + now_.w * dt;
  }

 private:
  struct Point {
    double w = 0, slope = 0;
  };
  static constexpr int kPhases = 3;

  void lay_out() noexcept {
    const double c = bounds_.curvature;
    const double rest = now_.w + 0.5 * now_.slope * std::abs(now_.slope) / c;  // after full braking
    const double way = target_ >= rest ? 1.0 : -1.0;
    const double slope = way * now_.slope;
    const double distance = way * (target_ - now_.w);
    const double peak =
        std::min(bounds_.slope, std::sqrt(std::max(0.0, c * distance + 0.5 * slope * slope)));
    const double moved = (peak * peak - 0.5 * slope * slope) / c;  // in the first and third phase
    left_[0] = std::max(0.0, (peak - slope) / c);
    left_[1] = peak > 0 ? std::max(0.0, (distance - moved) / peak) : 0.0;
    left_[2] = peak / c;
    curvature_[0] = way * c;
    curvature_[1] = 0;
    curvature_[2] = -way * c;
    phase_ = 0;
  }

  /// Moves on inside the phase; plan time is the integral of w.
  double move(double t) noexcept {
    const double c = curvature_[phase_];
    const double passed = t * (now_.w + t * (now_.slope / 2 + t * c / 6));
    now_.w = std::clamp(now_.w + t * (now_.slope + t * c / 2), 0.0, 1.0);
    now_.slope = std::clamp(now_.slope + t * c, -bounds_.slope, bounds_.slope);
    return std::max(0.0, passed);
  }

  RateBounds bounds_;
  Point now_{};
  double target_ = 0;
  int phase_ = kPhases;
  double left_[kPhases] = {};
  double curvature_[kPhases] = {};
};

}  // namespace meridian
