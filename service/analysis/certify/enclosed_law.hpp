// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/planner/time_piece.hpp"
#include "service/analysis/certify/interval.hpp"
#include "service/analysis/certify/taylor.hpp"

namespace meridian::certify {

/// Enclosure of where a time law is and how it moves, over a stretch of time or at an instant.
struct EnclosedState {
  Interval s, v, a;
};

namespace detail {

/// 1/f! + z/(f+2)! + z²/(f+4)! + ... relative to its first term, rest included. Everything for
/// |z| > 8, which no planner makes.
[[nodiscard]] inline Interval series(const Interval& z, int first) noexcept {
  constexpr int kTerms = 14;
  const double size = largest(z);
  if (!(size <= 8)) return kEverything;
  Interval term = 1, sum = 1;
  for (int n = 1; n <= kTerms; ++n) {
    const double m = first + 2 * n;
    term = term * z * inverse(Interval(m * (m - 1)));
    sum = sum + term;
    if (largest(term) < 1e-30) break;
  }
  // From here on a term is less than half of the one before it.
  return {sum.mid, sum.rad + largest(term)};
}

}  // namespace detail

/// The state of s''' = j + k s', `dt` after it was `from` (planner/time_law.hpp).
[[nodiscard]] inline EnclosedState flow(const EnclosedState& from, double j, double k,
                                        const Interval& dt) noexcept {
  const Interval square = dt * dt, z = square * k;
  const Interval s1 = dt * detail::series(z, 1);
  const Interval c2 = square * Interval(0.5) * detail::series(z, 2);
  const Interval d3 = square * dt * inverse(6) * detail::series(z, 3);
  const Interval moved = from.v * s1 + from.a * c2 + d3 * j;
  return {from.s + moved, from.v * detail::series(z, 0) + from.a * s1 + c2 * j,
          from.a + dt * j + moved * k};
}

/// s(t) of `piece` about its instants `t`, a stretch or one instant.
class EnclosedLaw {
 public:
  explicit EnclosedLaw(const TimePiece& piece) noexcept : piece_(piece) {}

  [[nodiscard]] EnclosedState at(double t) const noexcept {
    return flow({piece_.s0, piece_.v, piece_.a}, piece_.j, piece_.k, t);
  }
  /// The states that it has within `reach` of the instant of `centre`.
  [[nodiscard]] EnclosedState about(const EnclosedState& centre, double reach) const noexcept {
    return flow(centre, piece_.j, piece_.k, Interval(0, reach));
  }

  /// Taylor coefficients from a state: s''' = j + k s', and then s⁽ⁿ⁺²⁾ = k s⁽ⁿ⁾.
  template <int N>
  [[nodiscard]] Taylor<N> expand(const EnclosedState& state) const noexcept {
    static_assert(N >= 3);
    Taylor<N> out;
    out.set(0, state.s);
    out.set(1, state.v);
    out.set(2, state.a * Interval(0.5));
    out.set(3, (state.v * piece_.k + piece_.j) * inverse(6));
    for (int n = 4; n <= N; ++n) out.set(n, out[n - 2] * piece_.k * inverse(n * (n - 1.0)));
    return out;
  }

 private:
  const TimePiece& piece_;
};

}  // namespace meridian::certify
