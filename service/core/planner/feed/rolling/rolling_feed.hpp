// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/core/planner/feed/cells/feed_cells.hpp"
#include "service/core/planner/feed/cells/feed_rest.hpp"
#include "service/core/planner/feed/cells/joint_span.hpp"
#include "service/core/planner/feed/rolling/feed_piece.hpp"
#include "service/core/planner/feed/solver/feed_check.hpp"
#include "service/core/planner/feed/solver/jerk_step.hpp"

namespace meridian {

struct FeedSettings {
  CellSettings cells;
  RateReserve reserve;
  int window_cells = 120;     ///< planned at a time, to a rest at their end; 20 to 160
  int commit_cells = 40;      ///< of them kept, at least
  int max_commit_cells = 60;  ///< kept where braking to that rest begins farther on
  int max_rounds = 240;       ///< of the solver per window; then the plan before it stands
  /// Convex programmes per window at most, each around the result of the last. There is another
  /// one where the last leads away from the plan around which it was made.
  int refinements = 3;
  int more_from_rest = 1;  ///< of them, where the plan before is no guide: from a rest, past one
  /// Share of the windows that are declared to have no plan: for tests of what then happens.
  double failing_share = 0;
};

/// The settings that leave to the rate filter what the cycle of `model` may take.
[[nodiscard]] FeedSettings feed_settings(const MachineModel& model) noexcept;

/// A planned window: pieces that stand, then the rest of its plan up to rest, which a later window
/// may replace. The last window of a path and every crawl have no tail.
struct FeedWindow {
  bool is_from_rest = false;
  std::span<const FeedPiece> committed, tail;
  std::int64_t rest_cell = 0;  ///< cell before which the window comes to rest, tail included
};

/// What was done, for reports and tests.
struct FeedCount {
  std::int64_t windows = 0, solves = 0, rounds = 0, kept = 0, stops = 0, crawls = 0, tightened = 0;
  std::int64_t max_rounds = 0;  ///< of one window
};

/// The feed over a stream of spans, window by window, inside velocity, acceleration and jerk limit
/// of every joint and the programmed feed; every plan ends at rest inside the spans that are there.
/// It is time-optimal path parameterisation (TOPP) with jerk limits over a look-ahead.
///
/// A window is planned when the cells it covers are there and not earlier, so what is planned
/// follows from the spans alone, not from when they came. A window without a plan of its own keeps
/// the tail of the one before; at rest the last resort is a crawl. Both always exist: the motion
/// is never without a plan that ends at rest.
///
/// Fixed store, bounded work per window, no clock. Units: mm, rad, s. Context: planner thread.
/// Source: docs/motion.md, section 8. Proof: tests/property/planner/feed_test.cpp.
class RollingFeed {
 public:
  RollingFeed(const MachineModel& model, const FeedSettings& settings);

  /// Starts a path, at rest at its begin, on `branch` of the inverse kinematics; `joints` tell the
  /// windings.
  void begin(const JointVector& joints, int branch, double tool_length_mm) noexcept;

  /// Whether push() would take another span.
  [[nodiscard]] bool has_room() const noexcept { return grid_.has_room(); }
  /// Takes the next span. A fault (travel, reach) ends the path: nothing of the span is planned.
  [[nodiscard]] PathFault push(const JointSpan& span) noexcept { return grid_.push(span); }
  [[nodiscard]] PathFault push(const FeedSpan& span) noexcept { return grid_.push(span); }
  /// A span on the branch of begin().
  [[nodiscard]] PathFault push(const BandSpan& span) noexcept {
    JointSpan on_branch;
    on_branch.band = span;
    on_branch.branch = branch_;
    return push(on_branch);
  }
  /// The path ends with the last span, at rest.
  [[nodiscard]] PathFault finish() noexcept { return grid_.finish(); }

  /// Behind a fault: the path ends at `x` of `span`, the `number`th, at rest; or behind what was
  /// planned, and behind `smallest` cells, where that is farther. A span ahead of it that was no
  /// cell yet may have a fault of its own: fault() says so.
  void end_at(const JointSpan& span, std::uint64_t number, double x,
              std::int64_t smallest) noexcept {
    grid_.end_at(span, number, x, std::max(smallest, is_at_rest_ ? next_ : old_.end));
  }

  /// What push(), finish() or, where cells had to wait for room, try_plan() found.
  [[nodiscard]] const PathFault& fault() const noexcept { return grid_.fault(); }
  /// Counts spans from 0 since begin().
  [[nodiscard]] std::uint64_t faulty_span() const noexcept { return grid_.faulty_span(); }
  [[nodiscard]] double faulty_x() const noexcept { return grid_.faulty_x(); }

  /// Plans the next window if its cells are there; window() is then valid until the next call.
  [[nodiscard]] bool try_plan() noexcept;
  [[nodiscard]] const FeedWindow& window() const noexcept { return window_; }

  /// The machine ran the tail of a window and rests before `cell` (FeedWindow::rest_cell): the next
  /// window starts there from rest. For one of the last three windows.
  void resume_from(std::int64_t cell) noexcept;

  /// Whether all of a finished path is committed.
  [[nodiscard]] bool is_done() const noexcept {
    return grid_.is_complete() && next_ == grid_.last();
  }
  [[nodiscard]] const CellGrid& grid() const noexcept { return grid_; }
  [[nodiscard]] const FeedLimits& limits() const noexcept { return limits_; }
  [[nodiscard]] const FeedCount& count() const noexcept { return count_; }

 private:
  /// A plan from the boundary before `first` to rest before `end`; its last cell is `stop`.
  struct Plan {
    std::int64_t first = 0, end = 0;
    std::vector<double> b, slope;  ///< at boundaries first .. end - 1
    RestCell stop;
    int max_commit_cells = 0;  ///< of its cells that may stand
    [[nodiscard]] int cells() const noexcept { return static_cast<int>(end - first) - 1; }
  };
  /// Where a try at a window linearises the jerk.
  enum class Tangent : std::uint8_t {
    kBound,    ///< the bound without jerk
    kOldPlan,  ///< the old plan where it is fast, the bound behind it
    kSteady,   ///< as above, behind it at no more than the steady speed there
    kTail      ///< all of the old plan with its rest, and a motion from rest behind it
  };
  /// One try at a window.
  struct Attempt {
    Tangent tangent;
    double softness;  ///< share of the speed beside rests
    int shorter;      ///< cells that the window is shortened by
    RestRoom room = RestRoom::kLargest;
    bool is_to_jump = false;  ///< ends where what feed and velocity allow jumps, if it does
  };

  [[nodiscard]] bool plan_window() noexcept;
  /// The last cell behind `first` and before `end` whose bound by feed and velocity is far from
  /// that of the cell before; `end` where there is none.
  [[nodiscard]] std::int64_t find_jump(std::int64_t first, std::int64_t end) const noexcept;
  [[nodiscard]] bool attempt(const Attempt& how) noexcept;
  /// Into `backward_` and `bound_`, of the cells first .. end - 1.
  void pass_twice(std::int64_t first, std::int64_t end, double b_begin) noexcept;
  /// Largest u̇² at which the cell before `first`, where the machine rests, may end, and that before
  /// `end`, where the window rests, may begin.
  [[nodiscard]] double start_b(std::int64_t first, std::int64_t end) noexcept;
  [[nodiscard]] double stop_b(std::int64_t first, std::int64_t end) const noexcept;
  void choose_bar(Tangent tangent) noexcept;
  void take_old_plan(int knots) noexcept;
  void follow_old_plan() noexcept;
  void follow_tail() noexcept;
  void lower_beside_rests(double largest) noexcept;
  /// Solves the window, `wanted` times at most once a plan of it is good.
  [[nodiscard]] bool refine(int wanted) noexcept;
  /// What the plan uses of the limits, cell by cell. Whether it keeps them.
  [[nodiscard]] bool check() noexcept;
  void tighten() noexcept;
  void take_result() noexcept;
  [[nodiscard]] int cells_to_keep(const Plan& plan) const noexcept;
  [[nodiscard]] std::size_t find_tail(std::int64_t first, int& kept) const noexcept;
  void commit(bool is_new) noexcept;
  void commit_crawl() noexcept;
  [[nodiscard]] bool is_near_bar(int cells) const noexcept;
  void linearise_at_result() noexcept;
  [[nodiscard]] bool is_failing() const noexcept;
  [[nodiscard]] std::int64_t window_end() const noexcept;
  [[nodiscard]] std::int64_t cells_needed() const noexcept;

  FeedSettings settings_;
  FeedLimits limits_;   ///< what plans are checked against
  FeedLimits planned_;  ///< what they are made for
  CellGrid grid_;
  int branch_ = 0;
  JerkStep solver_;
  int history_ = 0;        ///< cells kept behind next_
  std::int64_t next_ = 0;  ///< first cell that is not committed
  bool is_at_rest_ = true;
  FeedState state_;  ///< at the boundary before next_, where not at rest
  RestCell start_;   ///< of the window being planned
  Plan old_, new_, best_;
  std::vector<double> backward_, bound_, bar_knots_, bar_middles_, bar_slopes_, accel_share_,
      jerk_share_;
  std::vector<FeedUse> uses_;        ///< of the plan that was checked last
  double jerk_without_tangent_ = 1;  ///< share of the jerk that rows have where b' is not known
  FeedPieces pieces_;                ///< of the window, the tail behind what is committed
  FeedWindow window_;
  FeedCount count_;
  std::int64_t window_rounds_ = 0;  ///< of the solver, spent on this window
};

}  // namespace meridian
