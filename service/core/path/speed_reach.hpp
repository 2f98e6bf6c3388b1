// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "service/core/path/band_polyline.hpp"
#include "service/core/path/index_ring.hpp"

namespace meridian {

/// The largest of what vertices ask for, over a stretch of u that moves forward. Fixed store: where
/// it is full the oldest goes, and what is left asks for no more.
class LargestAhead {
 public:
  explicit LargestAhead(std::size_t capacity) : ring_(capacity) {}

  void clear() noexcept { ring_.clear(); }
  /// Adds what is asked for up to `u`.
  void add(double u, double value) noexcept {
    while (!is_empty() && ring_.back().value <= value) ring_.drop_last();
    ring_.push_over_oldest({u, value});
  }
  /// Drops what was asked for no farther than `u`.
  void drop_to(double u) noexcept {
    while (!is_empty() && ring_[ring_.begin_index()].u <= u) {
      ring_.drop_before(ring_.begin_index() + 1);
    }
  }
  /// Infinite where nothing is asked for.
  [[nodiscard]] double largest() const noexcept {
    return is_empty() ? std::numeric_limits<double>::infinity() : ring_[ring_.begin_index()].value;
  }

 private:
  struct Asked {
    double u = 0;
    double value = 0;
  };
  [[nodiscard]] bool is_empty() const noexcept { return ring_.begin_index() == ring_.end_index(); }

  IndexRing<Asked> ring_;  ///< falling values: an earlier and smaller one counts no more
};

/// How fast blocks within kSpeedReach_mm of a stretch ask tip and axis to be at most: what bounds
/// both where blocks in inverse time are rounded. What comes out follows from the blocks alone.
/// Source: docs/motion.md, section 1.5. Proof: tests/unit/path/speed_reach_test.cpp. Allocates at
/// construction.
class SpeedReach {
 public:
  SpeedReach() : tip_(kCapacity), turn_(kCapacity) {}

  void begin() noexcept {
    tip_.clear();
    turn_.clear();
    next_ = 1;
  }

  /// Goes on to the stretch [u0, u1], which ends on the segment of vertex `end`: blocks count that
  /// are within reach of all of it. Stretches follow one another.
  void go_to(const BandPolyline& line, double u0, double u1, std::int64_t end) noexcept {
    const std::int64_t last = std::min(line.last(), end + kVertexReach);
    for (; next_ <= last && line[next_ - 1].u < u0 + kSpeedReach_mm; ++next_) {
      const BandVertex& vertex = line[next_];
      tip_.add(vertex.u, vertex.asked_mm_per_s);
      turn_.add(vertex.u, vertex.asked_rad_per_s);
    }
    tip_.drop_to(u1 - kSpeedReach_mm);
    turn_.drop_to(u1 - kSpeedReach_mm);
  }

  [[nodiscard]] double tip_mm_per_s() const noexcept { return tip_.largest(); }
  [[nodiscard]] double turn_rad_per_s() const noexcept { return turn_.largest(); }

 private:
  static constexpr std::size_t kCapacity = 4 * static_cast<std::size_t>(kVertexReach);

  LargestAhead tip_, turn_;
  std::int64_t next_ = 1;  ///< vertex that was not added
};

}  // namespace meridian
