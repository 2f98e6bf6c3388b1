// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "meridian/cycle/stop/stop_law.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/planner/rate_limits.hpp"
#include "meridian/planner/rate_room.hpp"
#include "meridian/planner/time_piece.hpp"
#include "service/core/planner/feed/cells/cell_blocks.hpp"
#include "service/core/planner/feed/cells/feed_cells.hpp"
#include "service/core/planner/feed/rolling/feed_piece.hpp"
#include "service/core/planner/feed/stop/stop_stretch.hpp"
#include "service/core/planner/feed/stop/stop_walk.hpp"

namespace meridian {

/// Authority to stop on a planned feed: with which acceleration and jerk along the path a hold or a
/// FaultStop keeps every joint's limits all the way, and ends before the plan does. It holds for
/// every state of the piece, at whatever rate of plan time up to the one that it is granted for.
///
/// The stops from both ends of the piece are run through the cells ahead; one that starts slower is
/// nowhere faster. Where the stop from its begin stays below that from its end, it is run through
/// its own cell alone. Every cell has bounds of the joints' derivatives, so the most that stops may
/// use there is a sum; blocks of cells that pass as one are not looked at one by one. What stops
/// use too much of is lessened until all cells pass; where nothing is left it is sought for slower
/// rates (docs/motion.md, section 9).
/// Proof: tests/property/planner/smooth_stop_test.cpp.
class FeedStopMargin {
 public:
  explicit FeedStopMargin(const MachineModel& model) noexcept;

  /// The pieces to come lie in cells of `grid` before `rest_cell`, where the plan rests. The cells
  /// stay as they are until the next begin().
  void begin(const CellGrid& grid, std::int64_t rest_cell) noexcept;

  /// Fills in the authority of `time`, made of `piece`: at the full rate or the next one that has
  /// some, and for slow motions; 0 where there is none. In a tail, which comes to rest anyway, for
  /// slow motions only where there is none at the full rate.
  void grant(const FeedPiece& piece, TimePiece& time) noexcept { grant({&piece, 1}, {&time, 1}); }
  /// The same of StopStretch::kMaxParts pieces at most that follow one another and share one
  /// authority; where none is good for all of them, each gets its own.
  void grant(std::span<const FeedPiece> pieces, std::span<TimePiece> times) noexcept;

 private:
  FeedStopMargin(const MachineModel& model, const RateLimits& rates) noexcept;

  /// One over the limits.
  struct Caps {
    CellBound::Values acceleration = CellBound::Values::Zero();
    CellBound::Values jerk = CellBound::Values::Zero();
  };
  /// What stops of one kind may use, and what the piece before got.
  struct Search {
    Caps caps;
    StopMargin last;
  };
  /// Bounds of what stops do in a cell: ṡ², ṡ³, s̈ > 0, 3 ṡ|s̈| where s̈ < 0 and where s̈ > 0.
  struct Motion {
    double v2 = 0, v3 = 0, rising = 0, sinking_v = 0, rising_v = 0;
  };
  /// Shares of the limits that a motion uses: 1 is all.
  struct Share {
    double acceleration = 0, jerk = 0;
  };
  /// Largest use of limits by stops.
  struct Use {
    double acceleration = 0, jerk = 0;
    bool is_too_fast = false;   ///< for feed or velocity
    bool is_too_far = false;    ///< it ends behind the plan
    std::int64_t farthest = 0;  ///< cell that a stop ends in
    std::int64_t cell = 0;      ///< where most of the jerk is used, and by what
    Motion motion;
    [[nodiscard]] bool is_within() const noexcept {
      return !is_too_fast && !is_too_far && acceleration <= 1 && jerk <= 1;
    }
  };
  /// Shares of the jerk at the worst place: by deceleration on the bend, by the bend alone.
  struct Cause {
    double by_depth = 0, by_speed = 0;
  };

  /// What stops may use that start with no more than `velocity`.
  struct Grant {
    StopMargin authority;
    double velocity = 0;
  };
  /// What stops may use, and the last cell that any of them comes to.
  struct Reach {
    StopMargin authority;
    std::int64_t farthest = 0;
  };
  /// What stops of slow machines may use, and of those next to rest.
  struct SlowGrant {
    StopMargin slow, rest;
  };

  /// Into `times`. False: there is no authority for all of a stretch of several pieces.
  [[nodiscard]] bool grant(const StopStretch& stretch, std::span<TimePiece> times) noexcept;
  /// At the full rate, or at the first of `rates` that has some.
  [[nodiscard]] Grant find(Search& search, const StopStretch& stretch,
                           std::span<const double> rates) const noexcept;
  [[nodiscard]] SlowGrant find_slow(const Caps& caps, const StopStretch& stretch) const noexcept;
  /// What the cells of the stretch allow next to rest.
  [[nodiscard]] StopMargin max_in(const Caps& caps, const StopStretch& stretch) const noexcept;
  /// What all cells from `first` to `last` allow next to rest.
  [[nodiscard]] StopMargin allowed_at_rest(const Caps& caps, std::int64_t first,
                                           std::int64_t last) const noexcept;
  /// `now` or less of it, that all stops from `stretch` may use; 0: there is none.
  [[nodiscard]] Reach lessen(const Caps& caps, const StopStretch& stretch, StopMargin now,
                             const StopMargin& largest) const noexcept;
  /// Whether a stop from `begin`, `in_cell` behind the begin of `cell`, passes the speed that this
  /// allows before its s̈ is down to zero.
  [[nodiscard]] static bool rises_too_far(const FeedCell& cell, const PathState& begin,
                                          double in_cell, double jerk) noexcept;
  /// Whether stops from between the ends of a piece end before the plan does, where those from its
  /// ends do: they may go farther where the plan brakes harder than they.
  [[nodiscard]] bool ends_before_plan(const StopStretch& stretch,
                                      const StopMargin& authority) const noexcept;
  /// Jerk of a stop from `p`, which a machine has at `rate`, or from there at a lower rate, that
  /// ends a braking which is deep already (StopLaw): there the authority does not bound it. kShare
  /// is taken out of it again: the plan itself may use all of the limit there.
  [[nodiscard]] double jerk_to_rest(const PathState& p, double rate) const noexcept;
  /// The use of all stops from `stretch`, or of some that use too much.
  [[nodiscard]] Use use_of(const Caps& caps, const StopStretch& stretch,
                           const StopMargin& authority) const noexcept;
  /// Adds the use of all stops under `walk`, which begins in `cell` at `rate`, in the cells before
  /// `end`.
  void add_use(const Caps& caps, std::int64_t cell, std::int64_t end, double rate, StopWalk walk,
               Use& use) const noexcept;
  /// Bounds of what stops under `walk` do in the cell that it enters. `by_rate`: of s̈, what a rate
  /// that changes adds to it where they begin.
  [[nodiscard]] static Motion motion_in_cell(const StopWalk& walk, double by_rate) noexcept;
  /// Whether stops that brake under `walk` use no more in any cell of `block` than what is allowed
  /// or used already.
  [[nodiscard]] bool passes(const Caps& caps, const CellBlock& block, const StopWalk& walk,
                            const Use& use) const noexcept;
  /// What `motion` uses of the limits, made as tight as that.
  [[nodiscard]] static Share share_of(const Caps& caps, const CellBound& bound, double made_tight,
                                      const StopMargin& authority, const Motion& motion) noexcept;
  [[nodiscard]] Cause cause_of(const Caps& caps, const Use& use) const noexcept;

  int count_ = 0;
  RateLimits rates_;
  RateRoom room_;  ///< of jerk
  Search hold_, fault_;
  const CellGrid* grid_ = nullptr;
  std::int64_t rest_cell_ = 0;
  CellBlocks blocks_;
};

}  // namespace meridian
