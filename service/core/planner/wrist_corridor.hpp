// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "service/core/path/index_ring.hpp"
#include "service/core/planner/joint_span.hpp"
#include "service/core/planner/wrist_zone.hpp"

namespace meridian {

/// From spans of the path to spans that the joints of a 6R robot follow: where the tool comes into
/// line with the forearm within the axis tolerance, the roll is driven from one side to the other
/// and the bend runs through zero (WristZone).
///
///     push(span) ... finish() ─▶ next() ... next() until it returns nullptr
///
/// Spans beside the wrist's singular place are held back by up to kReach_mm of u until it is known
/// how close they come. What comes out depends on the spans alone. Other machines get their spans
/// as they are. Fixed store. Units: mm, rad. Context: planner thread. Source: docs/motion.md,
/// section
/// 10. Proof: tests/property/planner/robot_passes_test.cpp.
class WristCorridor : private SpanLookup {
 public:
  explicit WristCorridor(const MachineModel& model);

  struct Start {
    JointVector joints{};
    int branch = 0;
    double tool_length_mm = 0;
    Vector3 axis = Vector3::UnitZ();  ///< programmed there
    double tolerance_rad = 0;         ///< of the axis from the programmed one, smoothing included
  };
  void begin(const Start& start) noexcept;

  /// The axis programmed at `u`, in order. Ahead of spans.
  void mark(double u, const Vector3& axis) noexcept {
    if (is_used_) programmed_.add(u, axis);
  }

  /// Takes the next span. Only after next() returned nullptr.
  void push(const JointSpan& span) noexcept;
  /// No more spans.
  void finish() noexcept { is_finished_ = true; }
  /// Returns the next span, nullptr where more are needed; valid until the next call.
  [[nodiscard]] const JointSpan* next() noexcept;

 private:
  static constexpr std::size_t kSpans = 1024;
  static constexpr std::int64_t kProbes = 8;  ///< per span

  struct Held {
    JointSpan span;
    std::array<double, kProbes> distance{};  ///< to the singular place, from the span's begin on
  };
  [[nodiscard]] const BandSpan& span_at(double u) const noexcept override;
  [[nodiscard]] double u_of(std::int64_t probe) const noexcept;
  [[nodiscard]] double distance_of(std::int64_t probe) const noexcept;
  [[nodiscard]] std::int64_t end_probe() const noexcept { return kProbes * spans_.end_index(); }
  [[nodiscard]] double end_u() const noexcept;
  [[nodiscard]] double emitted_u() const noexcept;
  [[nodiscard]] double distance_at(double u) const noexcept;

  /// Decides about minima of the distance as far as enough of what follows is there.
  void scan() noexcept;
  /// Takes a zone about `nearest`, if there is one; false: not enough of what follows is there.
  [[nodiscard]] bool settle(double nearest) noexcept;
  [[nodiscard]] bool is_minimum(std::int64_t probe) const noexcept;
  [[nodiscard]] double refine_minimum(std::int64_t probe) const noexcept;
  [[nodiscard]] JointVector follow_to(double u) const noexcept;
  [[nodiscard]] bool may_emit() const noexcept;
  void emit() noexcept;

  const MachineModel& model_;
  bool is_used_ = false, is_finished_ = false, is_exact_ = false;
  double tool_length_mm_ = 0, tolerance_rad_ = 0;
  ProgrammedAxis programmed_;
  IndexRing<Held> spans_;
  std::int64_t probe_ = 0;  ///< next to decide about
  double emitted_x_ = 0;    ///< of the first span held
  JointVector known_{};     ///< joints at emitted_u()
  int branch_ = 0;          ///< where spans are handed out
  bool has_zone_ = false;
  bool is_held_ = false;  ///< behind the zone the roll rests, the tool still in line
  WristZone zone_;
  bool is_waiting_ = false;  ///< not used: the span to hand on is in out_
  JointSpan out_;
};

}  // namespace meridian
