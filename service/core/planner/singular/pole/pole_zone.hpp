// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/band_span.hpp"
#include "service/core/planner/feed/cells/joint_span.hpp"
#include "service/core/planner/route/route_ahead.hpp"
#include "service/core/planner/singular/pole/programmed_axis.hpp"

namespace meridian {

/// A piece of a stretch beside the pole on which the redundant joint is driven. Outside such
/// stretches the joints follow the path exactly.
// Flags: a stretch of one piece has all of them; each combination occurs.
struct PoleZone {
  double begin = 0, end = 0;  ///< u
  FreeQuintic free{};         ///< Bernstein values over [begin, end]
  int branch_before = 0, branch_after = 0;
  double deviation_rad = 0;  ///< largest angle to the programmed axis on the stretch
  bool is_through = false;   ///< the stretch comes out on another branch
  bool is_first = false;     ///< of its stretch
  bool is_last = false;      ///< the same
  bool is_held =
      false;  ///< the redundant joint is not exact at its end: another stretch goes on there
};

/// Finds spans by u.
class SpanLookup {
 public:
  virtual ~SpanLookup() = default;
  [[nodiscard]] virtual const BandSpan& span_at(double u) const noexcept = 0;
};

/// How the redundant joint comes to an end of a stretch.
enum class PoleJoin : std::uint8_t {
  kExact,  ///< with two derivatives to the exact one
  kHeld,   ///< with two derivatives to what is driven on the stretch beside
  kRest    ///< the machine rests there: by any slope; at the end anywhere inside the tolerance
};

/// What the exact path along a stretch is worth.
enum class ExactPath : std::uint8_t {
  kLeadsOn,     ///< it is taken where it is the quickest
  kEndsOnPole,  ///< any string is the better: it leaves the redundant joint no direction at its end
  kMeetsPole    ///< it has no azimuth there: a string, or nothing
};

/// A stretch of path close to the pole.
struct PolePass {
  double begin = 0, end = 0;  ///< u
  PoleJoin at_begin = PoleJoin::kExact, at_end = PoleJoin::kExact;
  ExactPath exact = ExactPath::kLeadsOn;
  int branch = 0;        ///< on the way in
  JointVector joints{};  ///< at the begin
  double rate = 0;       ///< of the redundant joint at the begin by u, where that is kHeld
  double seen_end = 0;   ///< where the stretch ends, as far as it is known: behind a kHeld end
  double known_end = 0;  ///< how far joints are to keep travel as well
  /// How far branches and windings at known_end carry; empty: all alike, or it is not known.
  std::span<const RouteAhead> ahead{};
};

/// What stays the same along a path.
struct PoleTask {
  const MachineModel& model;
  const SpanLookup& spans;
  const ProgrammedAxis& programmed;
  double tool_length_mm = 0;
  double tolerance_rad = 0;  ///< of the resulting axis from the programmed one
  bool is_exact = false;     ///< from the axis of the spans instead
};

/// The part of a quintic between shares `from` < `to` of its range.
[[nodiscard]] FreeQuintic part_of(const FreeQuintic& whole, double from, double to) noexcept;

}  // namespace meridian
