// SPDX-License-Identifier: Apache-2.0
#include "service/core/path/band_knots.hpp"

#include <algorithm>
#include <cmath>

namespace meridian {
namespace {

constexpr double kLargestGap_mm = 2.0;
constexpr double kGrowth = 0.3;     // of the gap per mm of u
constexpr double kMeanShare = 0.8;  // of the tolerances, for the mean spline
constexpr double kSpread = 0.65;    // deviation of the mean spline <= 0.65 gaps of a route
constexpr double kCorner = 0.33;    // and <= 0.33 gaps of the jumps of direction
constexpr double kSupport = 2.5;    // a jump is felt so many gaps away
constexpr double kShrink = 0.8;     // gaps are tried in this ratio
/// Ways ahead that the gap at a vertex can depend on before grading, in gaps: more than the
/// support, and no less than what grading adds (1/kGrowth), so that both keep to kVertexReach
/// vertices.
constexpr double kReach = 3.5;

/// Longest gap so that no more than kVertexReach vertices are needed on either side of `i`.
double gap_by_density(const BandPolyline& line, std::int64_t i) noexcept {
  double gap = kLargestGap_mm;
  if (i + kVertexReach <= line.last()) {
    gap = std::min(gap, (line[i + kVertexReach].u - line[i].u) / kReach);
  }
  if (i >= kVertexReach) gap = std::min(gap, (line[i].u - line[i - kVertexReach].u) / kSupport);
  return gap;
}

/// Bound of the mean spline's deviation, in tolerances, that gaps of `gap` give where they feel the
/// jumps of direction behind vertex `from` up to vertex `to`; `before` is the one ahead of `from`.
double mean_deviation(const BandPolyline& line, std::int64_t before, std::int64_t from,
                      std::int64_t to, double gap) noexcept {
  const BandVertex &low = line[from], &high = line[to];
  const double axis_tolerance = line.axis_tolerance_between(line[before], high);
  const double tip = (high.tip_turns - low.tip_turns) / line.tolerance().tip_mm;
  const double axis = (high.axis_turns - low.axis_turns) / axis_tolerance;
  return kCorner * gap * std::max(tip, axis);
}

/// The same of gaps about vertex `i`, which feel no vertex before `from`: moved on to the first
/// that they feel.
double mean_deviation(const BandPolyline& line, std::int64_t i, double gap,
                      std::int64_t& from) noexcept {
  const std::int64_t low = std::max<std::int64_t>(i - kVertexReach, 0);
  const double u = line[i].u;
  from = line.find_from(u - kSupport * gap, from);
  const std::int64_t to = std::min(line.find_after(u + kSupport * gap, i), line.last());
  return mean_deviation(line, std::max(low, from - 1), from, to, gap);
}

/// Whether gaps of `gap`, no longer than gap_by_density(), do about vertex `i` even if they feel
/// every jump within kVertexReach vertices: mostly so on dense data, and needs no search.
bool is_straight(const BandPolyline& line, std::int64_t i, double gap) noexcept {
  const std::int64_t low = std::max<std::int64_t>(i - kVertexReach, 0);
  const std::int64_t high = std::min(i + kVertexReach, line.last());
  return mean_deviation(line, low, low, high, gap) <= kMeanShare;
}

/// Largest gap that needs no look at the blocks: the polyline is 1-Lipschitz in u.
double min_gap(const BandTolerance& tolerance) noexcept {
  const double axis_tolerance = (tolerance.pole ? kBesidePoleShare : 1.0) * tolerance.axis_rad;
  return kMeanShare / kSpread * std::min(tolerance.tip_mm, kAxisLength_mm_per_rad * axis_tolerance);
}

double find_gap(const BandPolyline& line, std::int64_t i) noexcept {
  const double min = min_gap(line.tolerance());
  const double dense = gap_by_density(line, i);
  if (i == 0 || i == line.last()) return std::max(dense, min);
  if (dense > min && is_straight(line, i, dense)) return dense;
  std::int64_t from = std::max<std::int64_t>(i - kVertexReach, 0);
  for (double gap = dense; gap > min; gap *= kShrink) {
    if (mean_deviation(line, i, gap, from) <= kMeanShare) return gap;
  }
  return min;
}

}  // namespace

void BandGaps::advance(BandPolyline& line) noexcept {
  for (;; ++front_) {
    const std::int64_t i = front_;
    if (i > line.last()) return;
    const bool is_known = line.is_complete() || i + kVertexReach <= line.last() ||
                          line[line.last()].u - line[i].u > kReach * kLargestGap_mm;
    if (!is_known) return;
    line[i].gap = find_gap(line, i);
    if (i == 0) continue;
    line[i].gap = std::min(line[i].gap, line[i - 1].gap + kGrowth * (line[i].u - line[i - 1].u));
    for (std::int64_t k = i; k > line.first(); --k) {
      const double max = line[k].gap + kGrowth * (line[k].u - line[k - 1].u);
      if (!(line[k - 1].gap > max)) break;
      line[k - 1].gap = max;
    }
  }
}

bool BandGaps::is_final(const BandPolyline& line, std::int64_t i) const noexcept {
  if (i >= front_) return false;
  if (line.is_complete() && front_ > line.last()) return true;
  return kGrowth * (line[front_ - 1].u - line[i].u) > 1.001 * line[i].gap;
}

void BandKnots::begin() noexcept {
  ring_.clear();
  is_complete_ = false;
  near_ = 0;
  for (int k = 0; k < 5; ++k) ring_.push({});
}

bool BandKnots::advance(const BandPolyline& line, const BandGaps& gaps) noexcept {
  if (is_complete_ || line.last() < 1) return false;
  const Knot before = ring_.back();
  const std::int64_t i = near_ = line.segment_at(before.t, std::max(before.segment, near_));
  if (!gaps.is_final(line, i + 1)) return false;
  const BandVertex& a = line[i];
  const BandVertex& b = line[i + 1];
  const double gap = std::min({kLargestGap_mm, a.gap + kGrowth * (before.t - a.u),
                               b.gap + kGrowth * std::max(0.0, b.u - before.t)});
  const double step = gap / (1 + kGrowth);
  const double end = line[line.last()].u;
  if (!line.is_complete() || before.t + 1.5 * step < end) {
    ring_.push({before.t + step, i});
    return true;
  }
  if (count() == 5) {  // shorter than a step: still four spans
    for (int k = 1; k < 4; ++k) ring_.push({0.25 * k * end, 0});
  }
  for (int k = 0; k < 5; ++k) ring_.push({end, ring_.back().segment});
  is_complete_ = true;
  return true;
}

}  // namespace meridian
