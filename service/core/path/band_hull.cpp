// SPDX-License-Identifier: Apache-2.0
#include "service/core/path/band_hull.hpp"

#include <algorithm>
#include <cmath>

namespace meridian {
namespace {

using Points = std::array<Vector6, 5>;

constexpr int kMostHalvings = 3;
constexpr double kEnough = 0.99 * 0.99;  // squared: a bound below needs no halving

/// Squares of one over the tolerances of tip and axis.
struct Scale {
  double tip, axis;
};

double largest_square(const Points& b, const Scale& scale) noexcept {
  double largest = 0;
  for (const Vector6& p : b) {
    const double tip = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
    const double axis = p[3] * p[3] + p[4] * p[4] + p[5] * p[5];
    largest = std::max({largest, tip * scale.tip, axis * scale.axis});
  }
  return largest;
}

double bound_square(const Points& b, const Scale& scale, int halvings) noexcept {
  const double largest = largest_square(b, scale);
  if (largest < kEnough || halvings == 0) return largest;
  Points left, right, e = b;
  for (std::size_t q = 0; q < 5; ++q) {  // de Casteljau at the middle
    left[q] = e[0];
    right[4 - q] = e[4 - q];
    for (std::size_t j = 0; j + q < 4; ++j) {
      for (std::size_t d = 0; d < 6; ++d) e[j][d] = 0.5 * (e[j][d] + e[j + 1][d]);
    }
  }
  return std::max(bound_square(left, scale, halvings - 1),
                  bound_square(right, scale, halvings - 1));
}

/// Bernstein points of the difference on the part of the span from `from` (u less the span's begin)
/// over `width`; `a`, `b` are the ends of its segment.
Points find_difference(const PoseQuartic& quartic, const BandVertex& a, const BandVertex& b,
                       double from, double width, double begin) noexcept {
  Points out;
  const double du = b.u - a.u, along = begin + from - a.u;
  for (std::size_t d = 0; d < 6; ++d) {
    std::array<double, 5> c = quartic[d];
    if (from != 0) {  // Taylor shift
      for (std::size_t r = 0; r < 4; ++r) {
        for (std::size_t k = 4; k-- > r;) c[k] += from * c[k + 1];
      }
    }
    const double slope = (b.x[d] - a.x[d]) / du;
    c[0] -= a.x[d] + slope * along;
    c[1] -= slope;
    double power = width;
    for (std::size_t k = 1; k < 5; ++k, power *= width) c[k] *= power;
    out[0][d] = c[0];
    out[1][d] = c[0] + 0.25 * c[1];
    out[2][d] = c[0] + 0.5 * c[1] + c[2] / 6;
    out[3][d] = c[0] + 0.75 * c[1] + 0.5 * c[2] + 0.25 * c[3];
    out[4][d] = c[0] + c[1] + c[2] + c[3] + c[4];
  }
  return out;
}

}  // namespace

double bound_deviation(const BandPolyline& line, const PoseQuartic& quartic, double begin,
                       double end, std::int64_t segment) noexcept {
  std::int64_t i = line.segment_at(begin, segment);
  double worst = 0;
  for (double u = begin; u < end; ++i) {
    const BandVertex& a = line[i];
    const BandVertex& b = line[i + 1];
    const double to = i + 1 < line.last() ? std::min(end, b.u) : end;
    const double tip = b.share * line.tolerance().tip_mm, axis = b.share * b.axis_tolerance;
    const Points points = find_difference(quartic, a, b, u - begin, to - u, begin);
    worst =
        std::max(worst, bound_square(points, {1 / (tip * tip), 1 / (axis * axis)}, kMostHalvings));
    u = to;
  }
  return std::sqrt(worst);
}

}  // namespace meridian
