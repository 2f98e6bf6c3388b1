// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/kinematics/limited.hpp"
#include "meridian/planner/time_piece.hpp"
#include "meridian/rt/stop_law.hpp"
#include "service/core/planner/feed_cells.hpp"
#include "service/core/planner/feed_piece.hpp"

namespace meridian {

/// Authority to stop on a planned feed: with which acceleration and jerk along the path a hold or a
/// FaultStop from a piece keeps every joint's limits all the way, and ends before the plan does.
///
/// Where the path bends as sharply as the plan's speed allows there is no formula for it, so stops
/// are run through: of a ladder of accelerations and jerks the sharpest whose stops from both ends
/// of the piece pass. The search starts at what the piece before got.
class FeedAuthority {
 public:
  explicit FeedAuthority(const MachineModel& model) noexcept;

  /// The pieces to come lie in cells of `grid` before `rest_cell`, where the plan rests.
  void begin(const CellGrid& grid, std::int64_t rest_cell) noexcept;

  /// Fills in the authority of `time`, made of `piece`: none for a hold where no stop passes, the
  /// least harmful one for a FaultStop.
  void grant(const FeedPiece& piece, TimePiece& time) noexcept;

 private:
  static constexpr int kAccels = 10, kJerks = 10;

  /// One over the limits.
  struct Caps {
    LimitedVector velocity{}, acceleration{}, jerk{};
  };
  /// A place in the ladder.
  struct Rung {
    int accel = 0, jerk = 0;
  };
  struct Ladder {
    Caps caps;
    Rung last;
  };

  [[nodiscard]] double find(Ladder& ladder, const FeedPiece& piece, const PathState& begin,
                            const PathState& end, StopAuthority& out) noexcept;
  /// Largest use of a limit by the stop from `begin` in `cell`, or some use above `enough`.
  [[nodiscard]] double use_of(const Caps& caps, std::int64_t cell, PathState begin,
                              const StopAuthority& authority, double enough) const noexcept;

  int count_ = 0;
  Ladder hold_, fault_;
  const CellGrid* grid_ = nullptr;
  std::int64_t rest_cell_ = 0;
};

}  // namespace meridian
