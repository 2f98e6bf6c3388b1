// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

namespace meridian::certify {

/// All numbers within `rad` of `mid`: a set that is known to hold the exact result of what was
/// computed with it, rounding included.
///
/// Every operation gives a set that holds the result for every choice of numbers from its operands
/// (Moore; here by midpoint and radius, Rump 1999). The midpoint is what double would give, so its
/// error is half a unit in the last place of it; radii are sums of positive terms and are rounded
/// up by a factor that covers 16 roundings. Where a function is not defined or not smooth on all of
/// the operand, the result is everything: `rad` is infinite or not a number. So a bound is checked
/// as `upper(x) <= most`, never as its contrary. Proof: tests/unit/certify/interval_test.cpp.
struct Interval {
  double mid = 0, rad = 0;

  constexpr Interval() noexcept = default;
  constexpr Interval(double value) noexcept : mid(value) {}  // NOLINT(google-explicit-constructor)
  constexpr Interval(double midpoint, double radius) noexcept : mid(midpoint), rad(radius) {}
};

/// Above the share that a rounding takes from a midpoint; the same for sums of positive terms.
inline constexpr double kRounding = 0x1p-52;
inline constexpr double kRaised = 1 + 0x1p-48;
/// Above what is lost where numbers underflow.
inline constexpr double kUnderflow = 1e-300;

/// Square roots and angles of points whose square is below this are unbounded: the kinematics hold
/// a joint nearer than 1e-9 (rad, or mm) to where it has no direction of its own, which is a branch
/// that a set must not reach over.
inline constexpr double kMinSquare = 1e-17;

inline constexpr Interval kEverything{0, std::numeric_limits<double>::infinity()};

/// The set within `rad` of what rounds to `mid`.
[[nodiscard]] constexpr Interval rounded(double mid, double rad) noexcept {
  return {mid, rad * kRaised + (mid < 0 ? -mid : mid) * kRounding + kUnderflow};
}

/// Bounds of the numbers of `x`, and of their magnitudes.
[[nodiscard]] inline double upper(const Interval& x) noexcept {
  const double bound = x.mid + x.rad;
  return bound + std::abs(bound) * kRounding + kUnderflow;
}
[[nodiscard]] inline double lower(const Interval& x) noexcept {
  const double bound = x.mid - x.rad;
  return bound - std::abs(bound) * kRounding - kUnderflow;
}
[[nodiscard]] inline double largest(const Interval& x) noexcept {
  return (std::abs(x.mid) + x.rad) * kRaised;
}
[[nodiscard]] inline double smallest(const Interval& x) noexcept {
  const double bound = std::abs(x.mid) - x.rad;
  return bound > 0 ? bound * (2 - kRaised) : 0;
}

/// All numbers from `from` to `to`.
[[nodiscard]] inline Interval between(double from, double to) noexcept {
  const double mid = 0.5 * (from + to);
  const double reach = to - mid > mid - from ? to - mid : mid - from;
  return {mid, reach * kRaised + kUnderflow};
}

[[nodiscard]] constexpr Interval operator-(const Interval& a) noexcept { return {-a.mid, a.rad}; }
[[nodiscard]] constexpr Interval operator+(const Interval& a, const Interval& b) noexcept {
  return rounded(a.mid + b.mid, a.rad + b.rad);
}
[[nodiscard]] constexpr Interval operator-(const Interval& a, const Interval& b) noexcept {
  return rounded(a.mid - b.mid, a.rad + b.rad);
}
[[nodiscard]] inline Interval operator*(const Interval& a, const Interval& b) noexcept {
  return rounded(a.mid * b.mid, std::abs(a.mid) * b.rad + a.rad * (std::abs(b.mid) + b.rad));
}

[[nodiscard]] inline Interval inverse(const Interval& a) noexcept {
  const double size = std::abs(a.mid);
  if (!(size > a.rad)) return kEverything;
  return rounded(1 / a.mid, a.rad / (size * (size - a.rad)));
}
[[nodiscard]] inline Interval operator/(const Interval& a, const Interval& b) noexcept {
  return a * inverse(b);
}

/// Everything where `a` reaches below kMinSquare.
[[nodiscard]] inline Interval sqrt(const Interval& a) noexcept {
  const double min = (a.mid - a.rad) * (2 - kRaised);
  if (!(min > kMinSquare)) return kEverything;
  const double root = std::sqrt(a.mid);
  return rounded(root, a.rad / (root + std::sqrt(min)));
}

/// Sine and cosine; |sin(m + d) - sin m| <= |cos m| |d| + d²/2, and so the cosine. The library's
/// are right to a unit in the last place.
struct IntervalSinCos {
  Interval sin, cos;
};
[[nodiscard]] inline IntervalSinCos sin_cos_of(const Interval& a) noexcept {
  const double s = std::sin(a.mid), c = std::cos(a.mid), bend = 0.5 * a.rad * a.rad;
  return {rounded(s, std::abs(c) * a.rad + bend + 2 * kRounding * std::abs(s)),
          rounded(c, std::abs(s) * a.rad + bend + 2 * kRounding * std::abs(c))};
}

/// The angle of the points (x, y), in one winding over all of them; everything where one is nearer
/// to the origin than the root of kMinSquare. Its gradient is no larger than 1/r.
[[nodiscard]] inline Interval atan2(const Interval& y, const Interval& x) noexcept {
  const double near_x = smallest(x), near_y = smallest(y);
  const double square = (near_x * near_x + near_y * near_y) * (2 - kRaised);
  if (!(square > kMinSquare)) return kEverything;
  const double angle = std::atan2(y.mid, x.mid);
  return rounded(
      angle, (largest(x) * y.rad + largest(y) * x.rad) / square + 4 * kRounding * std::abs(angle));
}

}  // namespace meridian::certify
