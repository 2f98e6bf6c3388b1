// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "service/core/path/index_ring.hpp"
#include "service/core/planner/singular/pole/pole_zone.hpp"

namespace meridian {

/// Spans of a path that are held back, and how far the axis is from the pole on them, at equal
/// steps of every span. Fixed store. Units: mm, rad.
class PoleProbes : public SpanLookup {
 public:
  static constexpr int kProbes = 6;  ///< per span
  /// A probe: span number times kProbes plus number on the span.
  using ProbeIndex = std::int64_t;

  explicit PoleProbes(const MachineModel& model) : model_(model), spans_(kSpans) {}

  /// `is_probing`: whether the pole matters.
  void begin(bool is_probing) noexcept;
  void push(const BandSpan& span) noexcept;
  void drop_front() noexcept { spans_.drop_before(spans_.begin_index() + 1); }

  [[nodiscard]] bool is_empty() const noexcept {
    return spans_.begin_index() == spans_.end_index();
  }
  [[nodiscard]] bool is_full() const noexcept { return spans_.is_full(); }
  [[nodiscard]] const BandSpan& front() const noexcept { return spans_[spans_.begin_index()].band; }
  /// The least distance among the probes of the front span.
  [[nodiscard]] double front_distance() const noexcept;
  [[nodiscard]] double end_u() const noexcept;
  [[nodiscard]] const BandSpan& span_at(double u) const noexcept override;

  [[nodiscard]] ProbeIndex begin_probe() const noexcept { return spans_.begin_index() * kProbes; }
  [[nodiscard]] ProbeIndex end_probe() const noexcept { return spans_.end_index() * kProbes; }
  [[nodiscard]] double u_of(ProbeIndex probe) const noexcept;
  /// Of the axis from the pole.
  [[nodiscard]] double distance_of(ProbeIndex probe) const noexcept;
  [[nodiscard]] double distance_at(double u) const noexcept;
  /// Where the path is closest to the pole between the neighbours of `place`.
  [[nodiscard]] double find_nearest(ProbeIndex probe) const noexcept;

 private:
  static constexpr std::size_t kSpans = 4096;

  struct Probed {
    BandSpan band;
    std::array<double, kProbes> distance{};
  };

  const MachineModel& model_;
  IndexRing<Probed> spans_;
  bool is_probing_ = false;
};

}  // namespace meridian
