// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/shape/spline_basis.hpp"

#include <algorithm>

namespace meridian::surface {
namespace {

using Row = std::array<double, kMaxDegree + 1>;

/// Piece s of the domain with knots[s] <= t < knots[s + 1]; the last piece also holds its end.
std::size_t piece_at(const std::vector<double>& knots, std::size_t degree, double t) noexcept {
  const auto begin = knots.begin() + static_cast<std::ptrdiff_t>(degree);
  const auto end = knots.end() - static_cast<std::ptrdiff_t>(degree) - 1;
  auto after = std::upper_bound(begin, end, t);
  if (after == end) after = std::lower_bound(begin, end, *end);  // t is the end of the domain
  return static_cast<std::size_t>(after - knots.begin()) - 1;
}

/// Values of degree q from those of degree q - 1 on piece s: entry i stands for function s - q + i.
Row raise(const std::vector<double>& knots, std::size_t s, std::size_t q, double t,
          const Row& lower) noexcept {
  Row out{};
  for (std::size_t i = 0; i < q; ++i) {
    const double left = knots[s + 1 + i - q], right = knots[s + 1 + i];
    const double share = lower[i] / (right - left);
    out[i] += (right - t) * share;
    out[i + 1] += (t - left) * share;
  }
  return out;
}

/// Derivatives of degree q from values (or derivatives) of degree q - 1.
Row derive(const std::vector<double>& knots, std::size_t s, std::size_t q,
           const Row& lower) noexcept {
  Row out{};
  for (std::size_t i = 0; i < q; ++i) {
    const double slope =
        static_cast<double>(q) * lower[i] / (knots[s + 1 + i] - knots[s + 1 + i - q]);
    out[i] -= slope;
    out[i + 1] += slope;
  }
  return out;
}

}  // namespace

BasisValues basis_values(const std::vector<double>& knots, int degree, double t) noexcept {
  const auto p = static_cast<std::size_t>(degree);
  t = std::clamp(t, knots[p], knots[knots.size() - 1 - p]);
  const std::size_t s = piece_at(knots, p, t);
  BasisValues out;
  out.first = s - p;
  Row value{1.0};
  for (std::size_t q = 1; q <= p; ++q) {
    if (q + 1 == p) out.order[2] = derive(knots, s, q, value);  // raised once more below
    if (q == p) out.order[1] = derive(knots, s, q, value);
    value = raise(knots, s, q, t, value);
  }
  out.order[0] = value;
  if (p >= 2) out.order[2] = derive(knots, s, p, out.order[2]);
  return out;
}

}  // namespace meridian::surface
