// SPDX-License-Identifier: Apache-2.0

/// What makes the smoother safe: nothing that it found is kept before every span is verified.

#include <algorithm>

#include "service/core/path/band_hull.hpp"
#include "service/core/path/band_smoother.hpp"

namespace meridian {
namespace {

constexpr int kRounds = 12;       // after which the whole window is put back
constexpr int kGentleRounds = 5;  // that put points back by steps of a fifth

}  // namespace

/// Raises the weight of the safe points about `span`, more and over a wider part every round.
void BandSmoother::pull(int round, std::int64_t span) noexcept {
  const std::int64_t width = 2 + 2 * round;
  const double max = round >= kGentleRounds ? 1.0 : 0.2 * (round + 1);
  const std::int64_t low = std::max<std::int64_t>(span - 4 - width, first_);
  const std::int64_t high = std::min(span + width, end_ - 1);
  for (std::int64_t i = low; i <= high; ++i) {
    const std::int64_t off = std::max<std::int64_t>({0, span - 4 - i, i - span});
    const double share = 1 - static_cast<double>(off) / static_cast<double>(width + 1);
    double& weight = weight_[static_cast<std::size_t>(i - first_)];
    weight = std::min(1.0, std::max(weight, max * share));
  }
}

void BandSmoother::verify(const BandPolyline& line, const BandKnots& knots, ControlPoints& points,
                          SmoothedWindow& out) noexcept {
  std::fill_n(weight_.begin(), size_, 0.0);
  std::fill(is_open_.begin(), is_open_.end(), char{1});
  for (int round = 0;; ++round) {
    for (std::size_t i = 0; i < size_; ++i) {
      Vector6& point = points[first_ + static_cast<std::int64_t>(i)];
      for (std::size_t d = 0; d < 6; ++d) {
        point[d] = weight_[i] == 1
                       ? safe_[i][d]
                       : candidate_[i][d] + weight_[i] * (safe_[i][d] - candidate_[i][d]);
      }
    }
    bool is_inside = true;
    for (std::int64_t s = s0_; s < s1_; ++s) {
      char& is_open = is_open_[static_cast<std::size_t>(s - s0_)];
      if (is_open == 0) continue;
      const double deviation = bound_deviation(line, quartic_of(knots, points, s), knots.t(s),
                                               knots.t(s + 1), knots.segment(s));
      is_open = 0;
      if (deviation <= 1) {
        out.largest = std::max(out.largest, deviation);
        continue;
      }
      is_inside = false;
      if (round < kRounds) pull(round, s);
    }
    out.is_inside = is_inside;
    if (is_inside || round > kRounds) return;
    out.is_pulled = true;
    if (round == kRounds) {
      out.is_reset = true;
      std::fill_n(weight_.begin(), size_, 1.0);
    }
    open_pulled();
  }
}

/// Spans of points that were pulled are to be verified anew.
void BandSmoother::open_pulled() noexcept {
  for (std::int64_t s = s0_; s < s1_; ++s) {
    for (std::int64_t i = std::max(s - 4, first_); i <= std::min(s, end_ - 1); ++i) {
      if (weight_[static_cast<std::size_t>(i - first_)] > 0) {
        is_open_[static_cast<std::size_t>(s - s0_)] = 1;
      }
    }
  }
}

}  // namespace meridian
