// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/band_span.hpp"
#include "service/core/planner/ahead_way.hpp"
#include "service/core/planner/joint_span.hpp"
#include "service/core/planner/programmed_axis.hpp"

namespace meridian {

/// A stretch of path beside the pole on which the free joint is driven. Outside it the joints
/// follow the path exactly.
struct PoleZone {
  double begin = 0, end = 0;  ///< u
  FreeQuintic free{};         ///< Bernstein values over [begin, end]
  int branch_before = 0, branch_after = 0;
  double deviation_rad = 0;  ///< largest angle to the programmed axis
  bool is_held = false;      ///< the free joint comes to rest at its end, still close to the pole
  int carries = 0;           ///< blocks behind it at least, of what PolePlace::ahead tells
};

/// Finds spans by u.
class SpanLookup {
 public:
  virtual ~SpanLookup() = default;
  [[nodiscard]] virtual const BandSpan& span_at(double u) const noexcept = 0;
};

/// Where a zone may lie: around a run [core_begin, core_end] of path close to the pole.
struct PolePlace {
  double core_begin = 0, core_end = 0;
  double reach = 0;          ///< farthest from the core that a zone may begin or end
  bool is_dwelling = false;  ///< on the pole for a while: the exact way has no azimuth there
  bool is_start = false;     ///< the free joint rests at the begin of the core, anywhere
  bool is_end = false;       ///< it comes to rest at the end of the core
  int branch = 0;            ///< on the way in
  JointVector joints{};      ///< at the start, or near the begin of the reach for the winding
  double known_end = 0;      ///< how far behind the core joints are to keep travel as well
  /// How far branches and windings at known_end carry; empty: all alike, or it is not known.
  std::span<const AheadWay> ahead{};
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

/// Picks the zone with the least time over the whole reach, of those that lead to a branch and
/// winding that carries farthest; begin == end: the exact way has it.
///
/// Candidates are quintics that meet the exact free joint with two derivatives at both ends, on
/// either branch behind: 24 widths, 7 skews. A candidate whose tool axis leaves the tolerance about
/// the programmed axis, or whose joints leave travel there or behind, as far as the path is known,
/// is none. Neither is the exact way where joints leave travel on it; where nothing is left, travel
/// behind the zone is not asked for. Time is counted without regard to
/// what lies around: the largest of |P'|/F, |q'|/V, √(|q''|/A), ∛(|q'''|/J) over all joints.
/// Source: docs/motion.md, section 10. Bounded work, no memory.
[[nodiscard]] PoleZone find_pole_zone(const PoleTask& task, const PolePlace& place) noexcept;

/// The part of a quintic between shares `from` < `to` of its range.
[[nodiscard]] FreeQuintic part_of(const FreeQuintic& whole, double from, double to) noexcept;

}  // namespace meridian
