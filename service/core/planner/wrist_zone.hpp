// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/core/planner/pole_zone.hpp"

namespace meridian {

/// A stretch of path beside the singular place of a 6R robot's wrist on which the roll is driven,
/// the bend follows it, and with them the tool axis, which stays inside its tolerance; the tip is
/// exact. Outside it the joints follow the path.
struct WristZone {
  double begin = 0, end = 0;  ///< u; equal: none
  FreeQuintic roll{};         ///< Bernstein values over [begin, end]
  int branch_before = 0, branch_after = 0;
  double deviation_rad = 0;  ///< largest angle to the programmed axis
};

/// Where a zone may lie: about `nearest`, between `from` and `to`.
struct WristPlace {
  double nearest = 0, from = 0, to = 0;
  bool is_start = false;  ///< the path begins at `from`, in line: the roll rests there as it is
  bool is_end = false;    ///< the path ends at `to`, in line: the roll comes to rest anywhere
  int branch = 0;         ///< on the way in
  JointVector joints{};   ///< at `from`
};

/// Farthest that a zone begins ahead of the nearest point, and ends behind it.
inline constexpr double kWristReach_mm = 20;

/// Picks the zone with the least time between `from` and `to`. Candidates are quintics of the roll
/// that meet the exact way with two derivatives at both ends, out on the same branch or on the one
/// with the bend turned round: straight through, the roll hardly turns. One whose axis leaves the
/// tolerance about the programmed one, whose joints leave travel, or whose tip is off, is none.
/// Bounded work, no memory. Source: docs/motion.md, section 10.
[[nodiscard]] WristZone find_wrist_zone(const PoleTask& task, const WristPlace& place) noexcept;

}  // namespace meridian
