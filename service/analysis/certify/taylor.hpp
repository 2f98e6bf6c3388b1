// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "meridian/geometry/jet.hpp"
#include "service/analysis/certify/interval.hpp"

namespace meridian::certify {

/// A Jet whose coefficients are intervals: c[k] holds f⁽ᵏ⁾(t)/k! for every t of a stretch.
///
/// The recurrences are those of Jet (geometry/jet.hpp), so that path and inverse kinematics, which
/// are written for any scalar, give enclosures as they give derivatives; Jet itself stays what the
/// cycle's instructions are counted for. Midpoints and radii lie apart, for whole rows of them are
/// added up at once. value_of() is the midpoint, by which the kinematics choose their branches:
/// next to where one could be chosen otherwise on the stretch, sqrt and atan2 give everything
/// (kMinSquare). Proof: tests/unit/certify/taylor_test.cpp.
template <int N>
struct Taylor {
  static_assert(N >= 1);
  std::array<double, N + 1> mid{}, rad{};

  constexpr Taylor() noexcept = default;
  constexpr Taylor(double value) noexcept : mid{value} {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] constexpr Interval operator[](int k) const noexcept {
    return {mid[static_cast<std::size_t>(k)], rad[static_cast<std::size_t>(k)]};
  }
  constexpr void set(int k, const Interval& x) noexcept {
    mid[static_cast<std::size_t>(k)] = x.mid;
    rad[static_cast<std::size_t>(k)] = x.rad;
  }

  /// Derivative of order `order`, all over the stretch.
  [[nodiscard]] Interval derivative(int order) const noexcept {
    double factorial = 1;
    for (int k = 2; k <= order; ++k) factorial *= k;
    return (*this)[order] * Interval(factorial);
  }

  Taylor& operator+=(const Taylor& b) noexcept {
    for (int k = 0; k <= N; ++k) set(k, (*this)[k] + b[k]);
    return *this;
  }
  Taylor& operator-=(const Taylor& b) noexcept {
    for (int k = 0; k <= N; ++k) set(k, (*this)[k] - b[k]);
    return *this;
  }
  Taylor& operator+=(double b) noexcept {
    set(0, (*this)[0] + b);
    return *this;
  }
  Taylor& operator-=(double b) noexcept {
    set(0, (*this)[0] - b);
    return *this;
  }
  Taylor& operator*=(double b) noexcept {
    for (int k = 0; k <= N; ++k) set(k, (*this)[k] * b);
    return *this;
  }
  Taylor& operator/=(double b) noexcept {
    const Interval per = inverse(b);
    for (int k = 0; k <= N; ++k) set(k, (*this)[k] * per);
    return *this;
  }

  friend Taylor operator-(const Taylor& a) noexcept {
    Taylor out = a;
    for (double& x : out.mid) x = -x;
    return out;
  }
  friend Taylor operator+(Taylor a, const Taylor& b) noexcept { return a += b; }
  friend Taylor operator-(Taylor a, const Taylor& b) noexcept { return a -= b; }
  friend Taylor operator+(Taylor a, double b) noexcept { return a += b; }
  friend Taylor operator+(double a, Taylor b) noexcept { return b += a; }
  friend Taylor operator-(Taylor a, double b) noexcept { return a -= b; }
  friend Taylor operator-(double a, const Taylor& b) noexcept { return -b + a; }
  friend Taylor operator*(Taylor a, double b) noexcept { return a *= b; }
  friend Taylor operator*(double a, Taylor b) noexcept { return b *= a; }
  friend Taylor operator/(Taylor a, double b) noexcept { return a /= b; }
  friend Taylor operator/(double a, const Taylor& b) noexcept { return Taylor(a) / b; }

  /// A sum of n products of doubles is off by n roundings of the sum of their magnitudes at most.
  friend Taylor operator*(const Taylor& a, const Taylor& b) noexcept {
    Taylor out;
    std::array<double, N + 1> reach{};  // of b
    for (std::size_t k = 0; k <= N; ++k) reach[k] = std::abs(b.mid[k]) + b.rad[k];
    for (std::size_t k = 0; k <= N; ++k) {
      double product = 0, size = 0, off = 0;
      for (std::size_t i = 0; i <= k; ++i) {
        product += a.mid[i] * b.mid[k - i];
        size += std::abs(a.mid[i]) * std::abs(b.mid[k - i]);
        off += std::abs(a.mid[i]) * b.rad[k - i] + a.rad[i] * reach[k - i];
      }
      out.mid[k] = product;
      out.rad[k] = (off + size * static_cast<double>(N + 1) * kRounding) * kRaised + kUnderflow;
    }
    return out;
  }
  friend Taylor operator/(const Taylor& a, const Taylor& b) noexcept {
    Taylor out;
    const Interval per = inverse(b[0]);
    for (int k = 0; k <= N; ++k) {
      Interval sum = a[k];
      for (int i = 1; i <= k; ++i) sum = sum - b[i] * out[k - i];
      out.set(k, sum * per);
    }
    return out;
  }
};

template <int N>
[[nodiscard]] inline Taylor<N> sqrt(const Taylor<N>& a) noexcept {
  Taylor<N> out;
  const Interval root = sqrt(a[0]), half = Interval(0.5) * inverse(root);
  out.set(0, root);
  for (int k = 1; k <= N; ++k) {
    Interval sum = a[k];
    for (int i = 1; i < k; ++i) sum = sum - out[i] * out[k - i];
    out.set(k, sum * half);
  }
  return out;
}

template <int N>
[[nodiscard]] inline SinCos<Taylor<N>> sin_cos(const Taylor<N>& a) noexcept {
  SinCos<Taylor<N>> out;
  const IntervalSinCos first = sin_cos_of(a[0]);
  out.sin.set(0, first.sin);
  out.cos.set(0, first.cos);
  for (int k = 1; k <= N; ++k) {
    Interval s, c;
    for (int i = 1; i <= k; ++i) {
      const Interval slope = Interval(i) * a[i];
      s = s + slope * out.cos[k - i];
      c = c - slope * out.sin[k - i];
    }
    out.sin.set(k, s / Interval(k));
    out.cos.set(k, c / Interval(k));
  }
  return out;
}

/// Angle of the point (x, y) from its derivative (x y' - y x')/(x² + y²).
template <int N>
[[nodiscard]] inline Taylor<N> atan2(const Taylor<N>& y, const Taylor<N>& x) noexcept {
  Taylor<N> out;
  out.set(0, atan2(y[0], x[0]));
  const Taylor<N> square = x * x + y * y;
  const Interval per_square = inverse(square[0]);
  for (int k = 0; k < N; ++k) {  // (k+1) out[k+1] is coefficient k of the derivative
    Interval sum;
    for (int i = 0; i <= k; ++i) {
      sum = sum + Interval(i + 1) * (x[k - i] * y[i + 1] - y[k - i] * x[i + 1]);
      if (i > 0) sum = sum - Interval(k + 1 - i) * square[i] * out[k + 1 - i];
    }
    out.set(k + 1, sum * per_square / Interval(k + 1));
  }
  return out;
}

/// The value of the midpoint: what chooses between branches.
template <int N>
[[nodiscard]] constexpr double value_of(const Taylor<N>& a) noexcept {
  return a.mid[0];
}

/// The derivative as a function of its own, one order shorter; its last coefficient is everything.
template <int N>
[[nodiscard]] inline Taylor<N> derivative_of(const Taylor<N>& a) noexcept {
  Taylor<N> out;
  for (int k = 0; k < N; ++k) out.set(k, a[k + 1] * Interval(k + 1));
  out.set(N, kEverything);
  return out;
}

}  // namespace meridian::certify

namespace Eigen {

template <int N>
struct NumTraits<meridian::certify::Taylor<N>> : GenericNumTraits<double> {
  using Real = meridian::certify::Taylor<N>;
  using NonInteger = meridian::certify::Taylor<N>;
  using Nested = meridian::certify::Taylor<N>;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2 * (N + 1),
    AddCost = 4 * (N + 1),
    MulCost = 8 * (N + 1) * (N + 2)
  };
};

}  // namespace Eigen
