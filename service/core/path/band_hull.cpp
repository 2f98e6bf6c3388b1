// SPDX-License-Identifier: Apache-2.0
#include "service/core/path/band_hull.hpp"

#include <algorithm>
#include <cmath>

namespace meridian {
namespace {

using Points = std::array<Vector6, 5>;

constexpr int kMaxHalvings = 3;
constexpr double kEnough = 0.99 * 0.99;  // squared: a bound below needs no halving
constexpr double kQuick = 0.99;          // a bound by places below it needs no Bernstein points

/// Squares of one over the tolerances of tip and axis.
struct Scale {
  double tip, axis;
};

/// One over the squares of the tolerances on the segment that ends in `b`.
Scale scale_of(const BandPolyline& line, const BandVertex& b) noexcept {
  const double share = line.share_of(b);
  const double tip = share * line.tolerance().tip_mm, axis = share * line.axis_tolerance_of(b);
  return {1 / (tip * tip), 1 / (axis * axis)};
}

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

/// Squares of lengths of tip and axis.
struct Squares {
  double tip = 0, axis = 0;
};

Squares squares_of(const Vector6& x) noexcept {
  return {x[0] * x[0] + x[1] * x[1] + x[2] * x[2], x[3] * x[3] + x[4] * x[4] + x[5] * x[5]};
}

/// Largest squares of the second derivative on a span: it is a quadratic, inside its Bernstein
/// points.
Squares largest_bend(const PoseQuartic& c, double length) noexcept {
  std::array<Vector6, 3> bend;
  for (std::size_t d = 0; d < 6; ++d) {
    bend[0][d] = 2 * c[d][2];
    bend[1][d] = bend[0][d] + 3 * length * c[d][3];
    bend[2][d] = bend[0][d] + length * (6 * c[d][3] + 12 * length * c[d][4]);
  }
  Squares out;
  for (const Vector6& x : bend) {
    const Squares at = squares_of(x);
    out = {std::max(out.tip, at.tip), std::max(out.axis, at.axis)};
  }
  return out;
}

/// The coefficients of a span, those of one power side by side.
using Powers = std::array<Vector6, 5>;

Powers powers_of(const PoseQuartic& quartic) noexcept {
  Powers out;
  for (std::size_t d = 0; d < 6; ++d) {
    for (std::size_t k = 0; k < 5; ++k) out[k][d] = quartic[d][k];
  }
  return out;
}

/// Squares of what is between the span at `x` and `place` of the polyline.
Squares difference_at(const Powers& c, double x, const Vector6& point) noexcept {
  Vector6 off;
  for (std::size_t d = 0; d < 6; ++d) {
    off[d] = c[0][d] + x * (c[1][d] + x * (c[2][d] + x * (c[3][d] + x * c[4][d]))) - point[d];
  }
  return squares_of(off);
}

/// The bound by places: at vertices and ends the difference itself, between two of them, `width`
/// apart, where the polyline is straight, at most width²/8 of the span's second derivative more.
double bound_by_points(const BandPolyline& line, const PoseQuartic& quartic, double begin,
                       double end, std::int64_t i) noexcept {
  const Powers powers = powers_of(quartic);
  const Squares bend = largest_bend(quartic, end - begin);
  double worst = 0, width = 0;
  Scale scale{}, max{};
  const BandVertex* known = nullptr;  // the vertex whose segment `scale` is of
  Squares before = difference_at(powers, 0, line.at(begin, i));
  for (double u = begin; u < end; ++i) {
    const BandVertex& b = line[i + 1];
    const bool is_inner = i + 1 < line.last() && b.u < end;
    const double to = is_inner ? b.u : end;
    const Squares after = difference_at(powers, to - begin, is_inner ? b.x : line.at(to, i));
    if (known == nullptr || b.is_of_arc != known->is_of_arc || b.side != known->side) {
      scale = scale_of(line, b);
      max = {std::max(max.tip, scale.tip), std::max(max.axis, scale.axis)};
      known = &b;
    }
    worst = std::max({worst, std::max(before.tip, after.tip) * scale.tip,
                      std::max(before.axis, after.axis) * scale.axis});
    width = std::max(width, to - u);
    before = after;
    u = to;
  }
  const double between = std::max(bend.tip * max.tip, bend.axis * max.axis);
  return std::sqrt(worst) + 0.125 * width * width * std::sqrt(between);
}

}  // namespace

double bound_deviation(const BandPolyline& line, const PoseQuartic& quartic, double begin,
                       double end, std::int64_t segment) noexcept {
  const std::int64_t i = line.segment_at(begin, segment);
  const double bound = bound_by_points(line, quartic, begin, end, i);
  return bound < kQuick ? bound : bound_by_hull(line, quartic, begin, end, i);
}

double bound_by_hull(const BandPolyline& line, const PoseQuartic& quartic, double begin, double end,
                     std::int64_t segment) noexcept {
  std::int64_t i = line.segment_at(begin, segment);
  double worst = 0;
  for (double u = begin; u < end; ++i) {
    const BandVertex& a = line[i];
    const BandVertex& b = line[i + 1];
    const double to = i + 1 < line.last() ? std::min(end, b.u) : end;
    const Points points = find_difference(quartic, a, b, u - begin, to - u, begin);
    worst = std::max(worst, bound_square(points, scale_of(line, b), kMaxHalvings));
    u = to;
  }
  return std::sqrt(worst);
}

}  // namespace meridian
