// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/planner/time_piece.hpp"

namespace meridian {

/// Where a time piece is on its path and how it moves. Units: mm, s.
struct PathState {
  double s = 0;
  double ds = 0;
  double dds = 0;
  double ddds = 0;
};

/// Returns the state of the motion s''' = j + k s' that starts as `piece` says, `t` seconds later.
///
/// Exact up to rounding for |k| t² <= 1; a planner keeps its pieces that short. A piece that is no
/// kMove rests: every derivative is zero, `s` stays s0. RT: cycle.
/// Proof: tests/unit/planner/time_law_test.cpp.
[[nodiscard]] inline PathState state_at(const TimePiece& piece, double t) noexcept {
  if (piece.k == 0) {
    const double ddds = piece.j;
    const double dds = piece.a + piece.j * t;
    const double ds = piece.v + t * (piece.a + t * piece.j / 2);
    return {piece.s0 + t * (piece.v + t * (piece.a / 2 + t * (piece.j / 6))), ds, dds, ddds};
  }
  // C0 = cosh, S = sinh/√k, C = (cosh - 1)/k, D = (sinh/√k - t)/k of √k t, one series for any sign.
  const double z = piece.k * t * t;
  constexpr auto series = [](double x, double first) {
    // 1/f! + x/(f+2)! + x²/(f+4)! + ..., relative to its first term
    double term = 1, sum = 1;
    for (int n = 1; n <= 9; ++n) {
      const double m = first + 2.0 * n;
      term *= x / (m * (m - 1));
      sum += term;
    }
    return sum;
  };
  const double c0 = series(z, 0);
  const double s1 = t * series(z, 1);
  const double c2 = t * t / 2 * series(z, 2);
  const double d3 = t * t * t / 6 * series(z, 3);
  const double moved = piece.v * s1 + piece.a * c2 + piece.j * d3;
  const double ds = piece.v * c0 + piece.a * s1 + piece.j * c2;
  return {piece.s0 + moved, ds, piece.a + piece.j * t + piece.k * moved, piece.j + piece.k * ds};
}

}  // namespace meridian
