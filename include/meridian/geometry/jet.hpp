// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <type_traits>

#include "meridian/geometry/atan2.hpp"

namespace meridian {

/// A number with its first `N` derivatives by one variable: the truncated Taylor arithmetic that
/// gives derivatives along a path from the very code that gives the values.
///
/// Write a function for a scalar S, call it with `Jet<3>::variable(s)`, read `derivative(1..3)` of
/// the result. Stored are Taylor coefficients c[k] = f⁽ᵏ⁾/k!, for which a product is a plain
/// convolution. The value of every operation equals the operation on double bit for bit, except
/// that hypot() is sqrt(x² + y²). Where a function has no derivative (sqrt and hypot at 0, atan2 at
/// the origin, abs at 0) the coefficients from order 1 on are not finite or one-sided; the value
/// stays right. RT: cycle. Proof: tests/unit/geometry/jet_test.cpp.
template <int N>
struct Jet {
  static_assert(N >= 1);
  std::array<double, N + 1> c{};

  constexpr Jet() noexcept = default;
  /// A constant.
  constexpr Jet(double value) noexcept : c{value} {}  // NOLINT(google-explicit-constructor)

  /// The variable itself: derivative 1, higher ones 0.
  [[nodiscard]] static constexpr Jet variable(double value) noexcept {
    return with_derivative(value, 1.0);
  }

  /// A quantity whose first derivative is `first`, the higher ones 0.
  [[nodiscard]] static constexpr Jet with_derivative(double value, double first) noexcept {
    Jet out(value);
    out.c[1] = first;
    return out;
  }

  /// A quantity from its value and derivatives of order 1..N, in that order.
  [[nodiscard]] static constexpr Jet from_derivatives(
      const std::array<double, N + 1>& derivatives) noexcept {
    Jet out;
    double factorial = 1;
    for (int k = 0; k <= N; ++k) {
      if (k > 1) factorial *= k;
      out.c[k] = derivatives[k] / factorial;
    }
    return out;
  }

  [[nodiscard]] constexpr double value() const noexcept { return c[0]; }

  /// Derivative of order `order`, 0 (the value) to N.
  [[nodiscard]] constexpr double derivative(int order) const noexcept {
    double factorial = 1;
    for (int k = 2; k <= order; ++k) factorial *= k;
    return c[order] * factorial;
  }

  constexpr Jet& operator+=(const Jet& b) noexcept {
    for (int k = 0; k <= N; ++k) c[k] += b.c[k];
    return *this;
  }
  constexpr Jet& operator-=(const Jet& b) noexcept {
    for (int k = 0; k <= N; ++k) c[k] -= b.c[k];
    return *this;
  }
  constexpr Jet& operator*=(const Jet& b) noexcept { return *this = *this * b; }
  constexpr Jet& operator/=(const Jet& b) noexcept { return *this = *this / b; }
  constexpr Jet& operator+=(double b) noexcept {
    c[0] += b;
    return *this;
  }
  constexpr Jet& operator-=(double b) noexcept {
    c[0] -= b;
    return *this;
  }
  constexpr Jet& operator*=(double b) noexcept {
    for (double& x : c) x *= b;
    return *this;
  }
  constexpr Jet& operator/=(double b) noexcept {
    for (double& x : c) x /= b;
    return *this;
  }

  friend constexpr Jet operator+(const Jet& a) noexcept { return a; }
  friend constexpr Jet operator-(const Jet& a) noexcept {
    Jet out;
    for (int k = 0; k <= N; ++k) out.c[k] = -a.c[k];
    return out;
  }
  friend constexpr Jet operator+(Jet a, const Jet& b) noexcept { return a += b; }
  friend constexpr Jet operator-(Jet a, const Jet& b) noexcept { return a -= b; }
  friend constexpr Jet operator+(Jet a, double b) noexcept { return a += b; }
  friend constexpr Jet operator+(double a, Jet b) noexcept { return b += a; }
  friend constexpr Jet operator-(Jet a, double b) noexcept { return a -= b; }
  friend constexpr Jet operator-(double a, const Jet& b) noexcept { return -b + a; }
  friend constexpr Jet operator*(Jet a, double b) noexcept { return a *= b; }
  friend constexpr Jet operator*(double a, Jet b) noexcept { return b *= a; }
  friend constexpr Jet operator/(Jet a, double b) noexcept { return a /= b; }
  friend constexpr Jet operator/(double a, const Jet& b) noexcept { return Jet(a) / b; }

  friend constexpr Jet operator*(const Jet& a, const Jet& b) noexcept {
    Jet out;
    for (int k = 0; k <= N; ++k) {
      double sum = a.c[0] * b.c[k];
      for (int i = 1; i <= k; ++i) sum += a.c[i] * b.c[k - i];
      out.c[k] = sum;
    }
    return out;
  }
  friend constexpr Jet operator/(const Jet& a, const Jet& b) noexcept {
    Jet out(a.c[0] / b.c[0]);
    for (int k = 1; k <= N; ++k) {
      double sum = a.c[k];
      for (int i = 1; i <= k; ++i) sum -= b.c[i] * out.c[k - i];
      out.c[k] = sum / b.c[0];
    }
    return out;
  }

  /// Comparisons look at the value alone.
  friend constexpr bool operator==(const Jet& a, const Jet& b) noexcept { return a.c[0] == b.c[0]; }
  friend constexpr auto operator<=>(const Jet& a, const Jet& b) noexcept {
    return a.c[0] <=> b.c[0];
  }
};

template <int N>
[[nodiscard]] inline Jet<N> sqrt(const Jet<N>& a) noexcept {
  Jet<N> out(std::sqrt(a.c[0]));
  const double half = 0.5 / out.c[0];
  for (int k = 1; k <= N; ++k) {
    double sum = a.c[k];
    for (int i = 1; i < k; ++i) sum -= out.c[i] * out.c[k - i];
    out.c[k] = sum * half;
  }
  return out;
}

/// Sine and cosine of one angle, which cost little more than one of them.
template <class S>
struct SinCos {
  S sin, cos;
};

[[nodiscard]] inline SinCos<double> sin_cos(double a) noexcept {
  return {std::sin(a), std::cos(a)};
}

template <int N>
[[nodiscard]] inline SinCos<Jet<N>> sin_cos(const Jet<N>& a) noexcept {
  SinCos<Jet<N>> out{Jet<N>(std::sin(a.c[0])), Jet<N>(std::cos(a.c[0]))};
  for (int k = 1; k <= N; ++k) {
    double s = 0, c = 0;
    for (int i = 1; i <= k; ++i) {
      s += i * a.c[i] * out.cos.c[k - i];
      c -= i * a.c[i] * out.sin.c[k - i];
    }
    out.sin.c[k] = s / k;
    out.cos.c[k] = c / k;
  }
  return out;
}

template <int N>
[[nodiscard]] inline Jet<N> sin(const Jet<N>& a) noexcept {
  return sin_cos(a).sin;
}
template <int N>
[[nodiscard]] inline Jet<N> cos(const Jet<N>& a) noexcept {
  return sin_cos(a).cos;
}

/// Angle of the point (x, y) from its derivative (x y' - y x')/(x² + y²).
template <int N>
[[nodiscard]] inline Jet<N> atan2(const Jet<N>& y, const Jet<N>& x) noexcept {
  Jet<N> out(atan2(y.c[0], x.c[0]));
  const Jet<N> square = x * x + y * y;
  for (int k = 0; k < N; ++k) {  // (k+1) out[k+1] is coefficient k of the derivative
    double sum = 0;
    for (int i = 0; i <= k; ++i) {
      sum += (i + 1) * (x.c[k - i] * y.c[i + 1] - y.c[k - i] * x.c[i + 1]);
      if (i > 0) sum -= square.c[i] * (k + 1 - i) * out.c[k + 1 - i];
    }
    out.c[k + 1] = sum / (square.c[0] * (k + 1));
  }
  return out;
}

/// sqrt(x² + y²). It does not guard against overflow and underflow: lengths here lie between
/// 1e-150 and 1e150.
template <class S>
[[nodiscard]] inline S hypot(const S& x, const S& y) noexcept {
  using std::sqrt;
  return sqrt(x * x + y * y);
}

template <int N>
[[nodiscard]] constexpr Jet<N> abs(const Jet<N>& a) noexcept {
  return a.c[0] < 0 ? -a : a;
}

template <int N>
[[nodiscard]] inline bool isfinite(const Jet<N>& a) noexcept {
  for (const double x : a.c) {
    if (!std::isfinite(x)) return false;
  }
  return true;
}

/// The value of a scalar without its derivatives.
[[nodiscard]] constexpr double value_of(double a) noexcept { return a; }
template <int N>
[[nodiscard]] constexpr double value_of(const Jet<N>& a) noexcept {
  return a.c[0];
}

static_assert(std::is_trivially_copyable_v<Jet<1>> && std::is_trivially_copyable_v<Jet<3>>);

}  // namespace meridian

namespace Eigen {

template <int N>
struct NumTraits<meridian::Jet<N>> : GenericNumTraits<double> {
  using Real = meridian::Jet<N>;
  using NonInteger = meridian::Jet<N>;
  using Nested = meridian::Jet<N>;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = N + 1,
    AddCost = N + 1,
    MulCost = (N + 1) * (N + 2)
  };
};

template <int N, class Operation>
struct ScalarBinaryOpTraits<meridian::Jet<N>, double, Operation> {
  using ReturnType = meridian::Jet<N>;
};
template <int N, class Operation>
struct ScalarBinaryOpTraits<double, meridian::Jet<N>, Operation> {
  using ReturnType = meridian::Jet<N>;
};

}  // namespace Eigen
