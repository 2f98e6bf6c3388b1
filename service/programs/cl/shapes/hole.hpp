// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "service/programs/cl/shapes/hole_cycle.hpp"

namespace meridian::cl {

/// One step of a hole: to a level above its top along the tool axis (below zero: in the hole), or
/// what happens at rest.
struct HoleMove {
  enum class Kind : std::uint8_t { kRapid, kFeed, kFeedOut, kDwell, kSpindleStop, kSpindleStart };
  Kind kind = Kind::kRapid;
  double level_mm = 0;
};

/// Levels of one hole, mm above its top.
struct HoleLevels {
  double retract_mm = 0;  ///< where the tool goes when the hole is done
  double to_mm = 1;       ///< mm in a unit of the cycle's own lengths
};

/// From the rapid level's side down into the hole and out to the retract level. The tool stands on
/// the axis of the hole, not below its rapid level. Between pecks it comes back down at rapid to
/// kPeckGap_mm above where it was, or half a peck where that is less; a chip is broken by going
/// back kChipBack_mm where the cycle does not say how far. CYCLE/MILL stays at the bottom. Proof:
/// tests/unit/cl/hole_test.cpp.
[[nodiscard]] std::vector<HoleMove> moves_of(const HoleCycle& cycle, const HoleLevels& levels);

inline constexpr double kPeckGap_mm = 1.0;
inline constexpr double kChipBack_mm = 0.5;

}  // namespace meridian::cl
