// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/free_spline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meridian {
namespace {

constexpr int kSplineRounds = 16;
constexpr double kGapGrowth = 0.3;  // of gaps, by u
constexpr double kMinGap_mm = 1e-4;
constexpr std::size_t kMinPieces = 8;
constexpr double kSnapped_mm = 1e-4, kSnappedShare = 0.05,
                 kMaxSnapped = 0.3;  // knots so close to a span's end

using Node = PoleWalls::Node;

/// A straight line between the nodes: the value at `u` of what `value_of` says of them.
template <class F>
double between(std::span<const Node> nodes, std::size_t& at, double u, F value_of) noexcept {
  while (at + 2 < nodes.size() && nodes[at + 1].u < u) ++at;
  const double whole = nodes[at + 1].u - nodes[at].u;
  const double share = std::clamp((u - nodes[at].u) / whole, 0.0, 1.0);
  return (1 - share) * value_of(at) + share * value_of(at + 1);
}

/// The blossom of the cubic with controls d[0..3] over the knots t[0..5], at three places: with the
/// same ones it is its value, with the ends of its range its Bernstein values.
double blossom(const double* d, const double* t, double a, double b, double c) noexcept {
  const auto mix = [](double left, double right, double from, double to, double at) {
    const double share = (at - from) / (to - from);
    return (1 - share) * left + share * right;
  };
  const double d1 = mix(d[0], d[1], t[0], t[3], a), d2 = mix(d[1], d[2], t[1], t[4], a),
               d3 = mix(d[2], d[3], t[2], t[5], a);
  const double e2 = mix(d1, d2, t[1], t[3], b), e3 = mix(d2, d3, t[2], t[4], b);
  return mix(e2, e3, t[2], t[3], c);
}

/// A cubic's four Bernstein values as a quintic's six.
FreeQuintic as_quintic(const std::array<double, 4>& c) noexcept {
  return {c[0],
          0.4 * c[0] + 0.6 * c[1],
          0.1 * c[0] + 0.6 * c[1] + 0.3 * c[2],
          0.3 * c[1] + 0.6 * c[2] + 0.1 * c[3],
          0.6 * c[2] + 0.4 * c[3],
          c[3]};
}

/// `u`, or the end of a span that is so close that the part between would be too short.
double snapped(const SpanLookup& spans, double u, double gap) noexcept {
  const double close = std::max(kSnappedShare * gap, std::min(kSnapped_mm, kMaxSnapped * gap));
  const BandSpan& span = spans.span_at(u);
  if (std::abs(u - span.u0) < close) return span.u0;
  const double end = span.u0 + span.length;
  return std::abs(end - u) < close ? end : u;
}

}  // namespace

FreeSpline::FreeSpline()
    : gaps_(PoleWalls::kNodes),
      sums_(PoleWalls::kNodes),
      knots_(kControls + kDegree + 1),
      controls_(kControls),
      windows_(kControls) {}

void FreeSpline::grade(std::span<const Node> nodes) noexcept {
  for (std::size_t n = 1; n < nodes.size(); ++n) {
    gaps_[n] = std::min(gaps_[n], gaps_[n - 1] + kGapGrowth * (nodes[n].u - nodes[n - 1].u));
  }
  for (std::size_t n = nodes.size() - 1; n-- > 0;) {
    gaps_[n] = std::min(gaps_[n], gaps_[n + 1] + kGapGrowth * (nodes[n + 1].u - nodes[n].u));
  }
}

bool FreeSpline::set_knots(const SpanLookup& spans, std::span<const Node> nodes) noexcept {
  sums_[0] = 0;
  for (std::size_t n = 1; n < nodes.size(); ++n) {
    sums_[n] = sums_[n - 1] + 2 * (nodes[n].u - nodes[n - 1].u) / (gaps_[n - 1] + gaps_[n]);
  }
  const double sum = sums_[nodes.size() - 1];
  if (!(sum < static_cast<double>(kPieces))) return false;
  pieces_ = std::max(kMinPieces, static_cast<std::size_t>(std::ceil(sum)));
  // On a short stretch knots lie closer than their gaps: what is snapped must not meet another.
  const double closer = std::min(1.0, sum / static_cast<double>(kMinPieces));
  const double begin = nodes.front().u, end = nodes.back().u;
  std::fill_n(knots_.begin(), kDegree + 1, begin);
  std::size_t at = 0;
  for (std::size_t k = 1; k < pieces_; ++k) {
    const double wanted = sum * static_cast<double>(k) / static_cast<double>(pieces_);
    while (at + 2 < nodes.size() && sums_[at + 1] < wanted) ++at;
    const double share = (wanted - sums_[at]) / (sums_[at + 1] - sums_[at]);
    const double u = nodes[at].u + share * (nodes[at + 1].u - nodes[at].u);
    knots_[k + kDegree] = snapped(spans, u, closer * gaps_[at]);
  }
  std::fill_n(knots_.begin() + static_cast<std::ptrdiff_t>(pieces_ + kDegree), kDegree + 1, end);
  return true;
}

bool FreeSpline::narrow(std::span<const Node> nodes, std::span<const StringWindow> windows,
                        const Shape& shape) noexcept {
  bool is_any_narrow = false;
  std::size_t first = 0, middle = 0;
  for (std::size_t i = 0; i < pieces_ + kDegree; ++i) {
    const double begin = knots_[i + shape.bold], end = knots_[i + kDegree + 1 - shape.bold];
    const double u = (knots_[i + 1] + knots_[i + 2] + knots_[i + 3]) / 3;
    StringWindow& window = windows_[i];
    window = {between(nodes, middle, u, [&](std::size_t n) { return nodes[n].t; }),
              -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    while (first + 1 < nodes.size() && nodes[first + 1].u <= begin) ++first;
    double smallest = std::numeric_limits<double>::infinity();
    std::size_t last = first;
    for (;; ++last) {
      window.low = std::max(window.low, windows[last].low);
      window.high = std::min(window.high, windows[last].high);
      smallest = std::min(smallest, windows[last].high - windows[last].low);
      if (last + 1 == nodes.size() || nodes[last].u >= end) break;
    }
    const bool is_fixed = i < fixed_at_begin_ || i + fixed_at_end_ >= pieces_ + kDegree;
    // Where the joint may be anywhere there is no width to keep: no share of it is a number.
    const bool is_anywhere = std::isinf(window.high - window.low);
    if (is_fixed || is_anywhere || window.high - window.low >= shape.width_share * smallest)
      continue;
    for (std::size_t n = first; n <= last; ++n) {
      if (gaps_[n] <= kMinGap_mm) continue;
      gaps_[n] = std::max(0.5 * gaps_[n], kMinGap_mm);
      is_any_narrow = true;
    }
  }
  return is_any_narrow;
}

void FreeSpline::fix_ends(const FreeEnd& begin, const FreeEnd& end) noexcept {
  const std::size_t last = pieces_ + kDegree - 1;
  const auto fix = [this](const FreeEnd& at, std::size_t from, int step, double h1, double h2) {
    const auto control = [&](int n) -> double& {
      return controls_[static_cast<std::size_t>(static_cast<int>(from) + step * n)];
    };
    if (at.count == 0) return;
    control(0) = at.of[0];
    if (at.count < 3) return;
    const double slope =
        at.of[1] + 0.5 * at.of[2] * h1;  // between the second control and the third
    control(1) = control(0) + at.of[1] * h1 / 3;
    control(2) = control(1) + slope * (h1 + h2) / 3;
  };
  const double* t = knots_.data() + kDegree;
  fix(begin, 0, 1, t[1] - t[0], t[2] - t[1]);
  t = knots_.data() + last + 1;
  fix(end, last, -1, t[-1] - t[0], t[-2] - t[-1]);
}

bool FreeSpline::fit(const SpanLookup& spans, std::span<const Node> nodes,
                     std::span<const StringWindow> windows, const FreeEnd& begin,
                     const FreeEnd& end, const Shape& shape) noexcept {
  fixed_at_begin_ = begin.count;
  fixed_at_end_ = end.count;
  std::fill_n(gaps_.begin(), nodes.size(), shape.max_gap_mm);
  for (int round = 0;; ++round) {
    grade(nodes);
    if (round == kSplineRounds || !set_knots(spans, nodes)) return false;
    if (!narrow(nodes, windows, shape)) break;
  }
  fix_ends(begin, end);
  const std::size_t first = fixed_at_begin_ > 0 ? fixed_at_begin_ - 1 : 0;
  std::size_t count = pieces_ + kDegree - first;
  if (fixed_at_end_ > 0) {
    count -= fixed_at_end_ - 1;
    StringWindow& last = windows_[first + count - 1];
    last.low = last.high = controls_[first + count - 1];
  }
  pull_taut({windows_.data() + first, count}, controls_[first], {controls_.data() + first, count});
  for (int sweep = 0; sweep < shape.sweeps; ++sweep) relax(first, first + count - 1);
  return true;
}

void FreeSpline::relax(std::size_t first, std::size_t last) noexcept {
  constexpr double kOver = 1.5;
  const std::size_t end = pieces_ + kDegree - 1;
  for (std::size_t i = first + 1; i < last; ++i) {
    double slope = 0, bend = 0;  // of the sum of squares, by the control value
    for (std::size_t k = std::max<std::size_t>(i - 1, 1); k <= i + 1 && k < end; ++k) {
      const double a = windows_[k].t - windows_[k - 1].t, b = windows_[k + 1].t - windows_[k].t;
      const std::array<double, 3> by{1 / (a * (a + b)), -1 / (a * b), 1 / (b * (a + b))};
      const double second =
          by[0] * controls_[k - 1] + by[1] * controls_[k] + by[2] * controls_[k + 1];
      const double mine = by[i + 1 - k];
      slope += (a + b) * second * mine;
      bend += (a + b) * mine * mine;
    }
    const StringWindow& window = windows_[i];
    if (!(window.low < window.high)) continue;
    controls_[i] = std::clamp(controls_[i] - kOver * slope / bend, window.low, window.high);
  }
}

PoleZone FreeSpline::piece(std::size_t n) const noexcept {
  const double *d = controls_.data() + n, *t = knots_.data() + n + 1;
  const double a = t[2], b = t[3];
  PoleZone out;
  out.begin = a;
  out.end = b;
  out.free = as_quintic({blossom(d, t, a, a, a), blossom(d, t, a, a, b), blossom(d, t, a, b, b),
                         blossom(d, t, b, b, b)});
  return out;
}

}  // namespace meridian
