// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "service/core/path/band_polyline.hpp"
#include "service/core/path/index_ring.hpp"

namespace meridian {

/// How near together knots have to be at every vertex: the mean spline stays within 0.8 tolerances
/// of the polyline, and gaps grow by 0.3 per mm (docs/motion.md, 1.2). Works forward through the
/// vertices as they come; what it writes into BandVertex::gap is final once is_final() says so.
class BandGaps {
 public:
  void begin() noexcept { front_ = 0; }

  /// Finds the gaps of all vertices behind which enough is known.
  void advance(BandPolyline& line) noexcept;

  /// Whether no later vertex can change the gap at vertex `i`.
  [[nodiscard]] bool is_final(const BandPolyline& line, std::int64_t i) const noexcept;

  /// The first vertex that is still needed.
  [[nodiscard]] std::int64_t needed_from() const noexcept {
    return front_ > kVertexReach ? front_ - kVertexReach - 1 : 0;
  }

 private:
  std::int64_t front_ = 0;  ///< vertices before this one have been worked on
};

/// Knots of the quartic spline: five at the begin, steps that keep the gaps, five at the end. Knot
/// k is t(k); control point i belongs to knots i .. i + 5.
class BandKnots {
 public:
  explicit BandKnots(std::size_t capacity) : ring_(capacity) {}

  void begin() noexcept;

  /// Sets the next knot, or all last ones. Returns false where later vertices have to come first or
  /// all are set.
  bool advance(const BandPolyline& line, const BandGaps& gaps) noexcept;

  [[nodiscard]] double t(std::int64_t k) const noexcept { return ring_[k].t; }
  /// A segment of the polyline at or before the one that holds knot `k`.
  [[nodiscard]] std::int64_t segment(std::int64_t k) const noexcept { return ring_[k].segment; }
  [[nodiscard]] std::int64_t count() const noexcept { return ring_.end_index(); }
  /// Whether the last knot is set.
  [[nodiscard]] bool is_complete() const noexcept { return is_complete_; }
  void drop_before(std::int64_t k) noexcept { ring_.drop_before(k); }

  /// Place of control point `i` on the mean spline: the mean of its inner knots.
  [[nodiscard]] double greville(std::int64_t i) const noexcept {
    return 0.25 * (t(i + 1) + t(i + 2) + t(i + 3) + t(i + 4));
  }

 private:
  struct Knot {
    double t = 0;
    std::int64_t segment = 0;
  };

  IndexRing<Knot> ring_;
  /// A segment at or before the one that holds the last knot, as far as vertices had come when the
  /// next one was asked for: where to look, no more.
  std::int64_t near_ = 0;
  bool is_complete_ = false;
};

}  // namespace meridian
