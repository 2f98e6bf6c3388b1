// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "meridian/path/path_piece.hpp"
#include "service/core/path/band_polyline.hpp"

/// One span of a quartic B-spline. Its eight knots are t[0..7], it runs from t[3] to t[4], and its
/// five control points are those whose support it lies in.
namespace meridian {

using SpanKnots = std::array<double, 8>;

/// The five basis functions that are not zero on the span, at `u` (Cox and de Boor).
inline void find_basis(const SpanKnots& t, double u, double (&n)[5]) noexcept {
  n[0] = 1;
  for (std::size_t j = 1; j <= 4; ++j) {
    double carried = 0;
    for (std::size_t k = 0; k < j; ++k) {
      const double right = t[4 + k] - u, left = u - t[4 + k - j];
      const double share = n[k] / (right + left);
      n[k] = carried + right * share;
      carried = left * share;
    }
    n[j] = carried;
  }
}

/// The span in powers of u - t[3]: control points of the derivatives, each run down to its value at
/// t[3] (de Boor).
[[nodiscard]] inline PoseQuartic find_quartic(const SpanKnots& t,
                                              std::array<Vector6, 5> points) noexcept {
  PoseQuartic out;
  const double u = t[3];
  double factorial = 1;
  for (std::size_t order = 0; order <= 4; ++order) {
    if (order > 1) factorial *= static_cast<double>(order);
    const std::size_t degree = 4 - order;
    std::array<Vector6, 5> e = points;
    for (std::size_t r = 1; r <= degree; ++r) {
      for (std::size_t j = degree; j >= r; --j) {
        const double from = t[3 + j - degree], to = t[4 + j - r];
        const double share = (u - from) / (to - from);
        for (std::size_t d = 0; d < 6; ++d) e[j][d] = e[j - 1][d] + share * (e[j][d] - e[j - 1][d]);
      }
    }
    for (std::size_t d = 0; d < 6; ++d) out[d][order] = e[degree][d] / factorial;
    for (std::size_t j = 0; j < degree; ++j) {
      const double rate = static_cast<double>(degree) / (t[4 + j] - t[4 + j - degree]);
      for (std::size_t d = 0; d < 6; ++d) points[j][d] = rate * (points[j + 1][d] - points[j][d]);
    }
  }
  return out;
}

}  // namespace meridian
