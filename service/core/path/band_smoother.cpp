// SPDX-License-Identifier: Apache-2.0
#include "service/core/path/band_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meridian {
namespace {

constexpr std::size_t kDegree = 4;
constexpr std::size_t kSamplesPerSpan = 8;
constexpr int kMinIterations = 4;
constexpr double kMinSpacing = 0.2;  // of a span, between vertices that are samples

std::size_t index(std::int64_t i) noexcept { return static_cast<std::size_t>(i); }

void add_product(Vector6& out, double factor, const Vector6& x) noexcept {
  for (std::size_t d = 0; d < 6; ++d) out[d] += factor * x[d];
}

/// Third divided difference over the four points `x`, times 6 (local spacing)³.
std::array<double, 4> find_third_difference(const std::array<double, 4>& x) noexcept {
  const double spacing = (x[3] - x[0]) / 3, scale = 6 * spacing * spacing * spacing;
  std::array<double, 4> out;
  for (std::size_t k = 0; k < 4; ++k) {
    double product = 1;
    for (std::size_t j = 0; j < 4; ++j) {
      if (j != k) product *= x[k] - x[j];
    }
    out[k] = scale / product;
  }
  return out;
}

}  // namespace

SpanKnots knots_of(const BandKnots& knots, std::int64_t s) noexcept {
  SpanKnots t;
  for (std::size_t k = 0; k < 8; ++k) t[k] = knots.t(s - 3 + static_cast<std::int64_t>(k));
  return t;
}

PoseQuartic quartic_of(const BandKnots& knots, const ControlPoints& points,
                       std::int64_t s) noexcept {
  return find_quartic(knots_of(knots, s),
                      {points[s - 4], points[s - 3], points[s - 2], points[s - 1], points[s]});
}

BandSmoother::BandSmoother(const BandTuning& tuning) : tuning_(tuning) {
  const std::size_t window = index(tuning.window), spans = window + kDegree;
  points_.resize(window + 2 * kDegree);
  for (auto* list : {&rhs_, &fixed_, &safe_, &candidate_}) list->resize(window);
  band_.resize(window);
  weight_.resize(window);
  is_open_.resize(spans);
  samples_.reserve(kSamplesPerSpan * spans);
  z_.resize(kSamplesPerSpan * spans);
  y_.resize(kSamplesPerSpan * spans);
}

SmoothedWindow BandSmoother::smooth(const BandPolyline& line, const BandKnots& knots,
                                    ControlPoints& points, std::int64_t first, std::int64_t end,
                                    std::int64_t count) noexcept {
  first_ = first;
  end_ = end;
  size_ = index(end - first);
  s0_ = std::max<std::int64_t>(first, kDegree);
  s1_ = std::min<std::int64_t>(end + kDegree, count);
  for (std::size_t d = 0; d < 6; ++d) {
    scale_[d] = 1 / (d < 3 ? line.tolerance().tip_mm : line.tolerance().axis_rad);
  }
  for (std::size_t p = 0; p < size_ + 2 * kDegree; ++p) {
    const std::int64_t i =
        first - static_cast<std::int64_t>(kDegree) + static_cast<std::int64_t>(p);
    points_[p].fill(0);
    if (i < 0 || i >= count) continue;
    for (std::size_t d = 0; d < 6; ++d) points_[p][d] = points[i][d] * scale_[d];
  }
  collect_samples(line, knots);
  build_matrix(knots, count);
  factorise();
  iterate();
  for (std::size_t i = 0; i < size_; ++i) {
    safe_[i] = points[first + static_cast<std::int64_t>(i)];
    for (std::size_t d = 0; d < 6; ++d) candidate_[i][d] = points_[i + kDegree][d] / scale_[d];
  }
  SmoothedWindow out;
  verify(line, knots, points, out);
  return out;
}

void BandSmoother::collect_samples(const BandPolyline& line, const BandKnots& knots) noexcept {
  samples_.clear();
  std::int64_t segment = knots.segment(s0_);
  for (std::int64_t s = s0_; s < s1_; ++s) {
    const SpanKnots t = knots_of(knots, s);
    const double begin = t[3], end = t[4], middle = 0.5 * (begin + end);
    segment = line.segment_at(begin, segment);
    add_sample(line, t, s, begin, segment);
    add_sample(line, t, s, middle, line.segment_at(middle, segment));
    const double spacing = kMinSpacing * (end - begin);
    std::int64_t i = segment + 1;
    while (i <= line.last() && line[i].u < end) {
      add_sample(line, t, s, line[i].u, line.segment_at(line[i].u, i - 1));
      i = line.find_from(line[i].u + spacing, i + 1);
    }
  }
}

void BandSmoother::add_sample(const BandPolyline& line, const SpanKnots& t, std::int64_t s,
                              double u, std::int64_t segment) noexcept {
  Sample sample;
  sample.at = index(s - first_);  // control point s - 4 has place s - first_
  find_basis(t, u, sample.n);
  const Vector6 y = line.at(u, segment);
  for (std::size_t d = 0; d < 6; ++d) sample.y[d] = y[d] * scale_[d];
  const BandVertex& end = line[segment + 1];
  sample.tip = tuning_.radius * line.share_of(end);
  sample.axis = sample.tip * line.axis_tolerance_of(end) * scale_[5];
  samples_.push_back(sample);
}

void BandSmoother::add_entry(std::size_t i, std::size_t j, double value) noexcept {
  const bool i_free = i >= kDegree && i < kDegree + size_;
  const bool j_free = j >= kDegree && j < kDegree + size_;
  if (!i_free) return;
  if (!j_free) {
    add_product(fixed_[i - kDegree], value, points_[j]);
  } else if (i >= j) {
    band_[i - kDegree][i - j] += value;
  }
}

void BandSmoother::build_matrix(const BandKnots& knots, std::int64_t count) noexcept {
  for (std::size_t i = 0; i < size_; ++i) {
    band_[i].fill(0);
    fixed_[i].fill(0);
  }
  const std::int64_t to = std::min(count - 3, end_);
  for (std::int64_t i = std::max<std::int64_t>(0, first_ - 3); i < to; ++i) {
    const auto w = find_third_difference(
        {knots.greville(i), knots.greville(i + 1), knots.greville(i + 2), knots.greville(i + 3)});
    const std::size_t p = index(i - first_ + static_cast<std::int64_t>(kDegree));
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t j = 0; j < 4; ++j) add_entry(p + k, p + j, tuning_.smoothness * w[k] * w[j]);
    }
  }
  for (const Sample& sample : samples_) {
    for (std::size_t k = 0; k < 5; ++k) {
      for (std::size_t j = 0; j < 5; ++j) {
        add_entry(sample.at + k, sample.at + j, sample.n[k] * sample.n[j]);
      }
    }
  }
}

void BandSmoother::factorise() noexcept {
  for (std::size_t i = 0; i < size_; ++i) {
    for (std::size_t back = std::min(i, kDegree) + 1; back-- > 0;) {
      const std::size_t j = i - back;
      double sum = band_[i][back];
      for (std::size_t k = i > kDegree ? i - kDegree : 0; k < j; ++k) {
        if (j - k <= kDegree) sum -= band_[i][i - k] * band_[j][j - k];
      }
      band_[i][back] = back > 0 ? sum / band_[j][0] : std::sqrt(std::max(sum, 1e-14));
    }
  }
}

/// Solves for the free points: forward and back substitution on the factor, into points_.
void BandSmoother::solve() noexcept {
  for (std::size_t i = 0; i < size_; ++i) {
    Vector6 x = rhs_[i];
    for (std::size_t back = 1; back <= std::min(i, kDegree); ++back) {
      add_product(x, -band_[i][back], rhs_[i - back]);
    }
    for (std::size_t d = 0; d < 6; ++d) rhs_[i][d] = x[d] / band_[i][0];
  }
  for (std::size_t i = size_; i-- > 0;) {
    Vector6 x = rhs_[i];
    for (std::size_t on = 1; on <= std::min(size_ - 1 - i, kDegree); ++on) {
      add_product(x, -band_[i + on][on], rhs_[i + on]);
    }
    for (std::size_t d = 0; d < 6; ++d) rhs_[i][d] = x[d] / band_[i][0];
    points_[i + kDegree] = rhs_[i];
  }
}

Vector6 BandSmoother::value_at(const Sample& sample) const noexcept {
  Vector6 out{};
  for (std::size_t k = 0; k < 5; ++k) add_product(out, sample.n[k], points_[sample.at + k]);
  return out;
}

void BandSmoother::iterate() noexcept {
  for (std::size_t q = 0; q < samples_.size(); ++q) {
    z_[q] = value_at(samples_[q]);
    y_[q].fill(0);
  }
  double moved = std::numeric_limits<double>::infinity();
  for (int n = 0; n < tuning_.iterations; ++n) {
    if (n >= kMinIterations && moved <= tuning_.settled) break;
    pull_points();
    solve();
    moved = move_samples();
  }
}

/// The right-hand side, in rhs_: where the samples pull the points to.
void BandSmoother::pull_points() noexcept {
  std::vector<Vector6>& sum = rhs_;
  for (std::size_t i = 0; i < size_; ++i) {
    for (std::size_t d = 0; d < 6; ++d) sum[i][d] = -fixed_[i][d];
  }
  for (std::size_t q = 0; q < samples_.size(); ++q) {
    const Sample& sample = samples_[q];
    Vector6 pulled;
    for (std::size_t d = 0; d < 6; ++d) pulled[d] = z_[q][d] - y_[q][d];
    for (std::size_t k = 0; k < 5; ++k) {
      const std::size_t p = sample.at + k;
      if (p >= kDegree && p < kDegree + size_) add_product(sum[p - kDegree], sample.n[k], pulled);
    }
  }
}

/// Moves the samples to the spline, as far as their band lets them. By how much at most they or
/// their multipliers moved, in tolerances.
double BandSmoother::move_samples() noexcept {
  double moved = 0;
  for (std::size_t q = 0; q < samples_.size(); ++q) {
    const Sample& sample = samples_[q];
    const Vector6 v = value_at(sample);
    Vector6 e;  // from the polyline, relaxed, with the multiplier
    for (std::size_t d = 0; d < 6; ++d) {
      e[d] =
          tuning_.relaxation * v[d] + (1 - tuning_.relaxation) * z_[q][d] + y_[q][d] - sample.y[d];
    }
    const double tip = std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
    const double axis = std::sqrt(e[3] * e[3] + e[4] * e[4] + e[5] * e[5]);
    const double tip_share = tip > sample.tip ? sample.tip / tip : 1;
    const double axis_share = axis > sample.axis ? sample.axis / axis : 1;
    for (std::size_t d = 0; d < 6; ++d) {
      const double inside = (d < 3 ? tip_share : axis_share) * e[d];
      const double z = sample.y[d] + inside, y = e[d] - inside;
      moved = std::max({moved, std::abs(z_[q][d] - z), std::abs(y_[q][d] - y)});
      y_[q][d] = y;
      z_[q][d] = z;
    }
  }
  return moved;
}

}  // namespace meridian
