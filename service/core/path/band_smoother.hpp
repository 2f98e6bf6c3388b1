// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "meridian/path/band_spline.hpp"
#include "service/core/path/band_knots.hpp"
#include "service/core/path/band_polyline.hpp"
#include "service/core/path/index_ring.hpp"
#include "service/core/path/quartic.hpp"

namespace meridian {

using ControlPoints = IndexRing<Vector6>;

/// Span `s` of the spline: from knot s to knot s + 1, control points s - 4 .. s.
[[nodiscard]] SpanKnots knots_of(const BandKnots& knots, std::int64_t s) noexcept;
[[nodiscard]] PoseQuartic quartic_of(const BandKnots& knots, const ControlPoints& points,
                                     std::int64_t s) noexcept;

/// What one window did.
struct SmoothedWindow {
  bool is_inside = false;  ///< every span that it touches is verified
  bool is_pulled = false;
  bool is_reset = false;
  double largest = 0;  ///< bound of the deviation, in tolerances
};

/// Corner rounding inside the blend tolerance: smooths a window of control points, least squares of
/// third differences under a ball about every sample of the polyline, by ADMM on one banded
/// Cholesky factor; then verifies every span and pulls back those that do not keep the tolerances
/// towards the points as they were, which were verified before. Source: docs/motion.md, 1.3
/// and 1.4. Allocates at construction. Proof:
/// tests/unit/path/band_smoother_test.cpp, tests/property/path.
class BandSmoother {
 public:
  explicit BandSmoother(const BandTuning& tuning);

  /// Moves control points [first, end); all others stay. `count`: of control points in all.
  [[nodiscard]] SmoothedWindow smooth(const BandPolyline& line, const BandKnots& knots,
                                      ControlPoints& points, std::int64_t first, std::int64_t end,
                                      std::int64_t count) noexcept;

 private:
  /// A point where the spline is held: sum of n[k] times the five points from `at` on, within
  /// `tip`, `axis` of `y`. All in tolerances.
  struct Sample {
    std::size_t at = 0;
    double n[5] = {};
    Vector6 y{};
    double tip = 0, axis = 0;
  };

  void collect_samples(const BandPolyline& line, const BandKnots& knots) noexcept;
  void add_sample(const BandPolyline& line, const SpanKnots& t, std::int64_t s, double u,
                  std::int64_t segment) noexcept;
  void build_matrix(const BandKnots& knots, std::int64_t count) noexcept;
  void add_entry(std::size_t i, std::size_t j, double value) noexcept;
  void factorise() noexcept;
  void solve() noexcept;
  void iterate() noexcept;
  void pull_points() noexcept;
  [[nodiscard]] double move_samples() noexcept;
  [[nodiscard]] Vector6 value_at(const Sample& sample) const noexcept;
  void verify(const BandPolyline& line, const BandKnots& knots, ControlPoints& points,
              SmoothedWindow& out) noexcept;
  void pull(int round, std::int64_t span) noexcept;
  void open_pulled() noexcept;

  BandTuning tuning_;
  std::int64_t first_ = 0, end_ = 0;  ///< free control points
  std::int64_t s0_ = 0, s1_ = 0;      ///< spans that they touch
  std::size_t size_ = 0;              ///< end_ - first_
  Vector6 scale_{};                   ///< one over the tolerances
  std::vector<Vector6> points_;       ///< in tolerances; place 0 is control point first_ - 4
  std::vector<Vector6> rhs_, fixed_;  ///< of the normal equations; `fixed_`: share of what stays
  std::vector<std::array<double, 5>> band_;  ///< lower band of the matrix, then of its factor
  std::vector<Sample> samples_;
  std::vector<Vector6> z_, y_;  ///< ADMM: place inside the ball and multiplier per sample
  std::vector<Vector6> safe_, candidate_;
  std::vector<double> weight_;  ///< 0: candidate, 1: safe
  std::vector<char> is_open_;   ///< spans to be verified again
};

}  // namespace meridian
