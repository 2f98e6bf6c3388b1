// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"
#include "service/core/planner/feed/cells/feed_limits.hpp"
#include "service/core/planner/feed/cells/feed_sample.hpp"
#include "service/core/planner/feed/cells/feed_span.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"

/// The grid of the feed planner: short cells of the path with the joints' derivatives by the path
/// parameter u. Cell boundaries lie on every end of a span, so that derivatives are smooth inside a
/// cell. Units: mm, rad, s. Source: docs/motion.md, section 8.
namespace meridian {

/// Bounds of the derivatives in a cell: that much above zero (`up`) and below (`down`), both >= 0.
struct CellBound {
  using Values = Eigen::Array<double, 8, 1>;  ///< as LimitedVector, whole registers of them
  struct Sides {
    Values up = Values::Zero(), down = Values::Zero();
  };
  Sides d1, d2, d3;
  Values rate = Values::Zero();  ///< the larger side of d1
};
static_assert(CellBound::Values::SizeAtCompileTime >= kMaxLimited);

struct FeedCell {
  static constexpr int kSteps = 8;  ///< samples lie kSteps + 1 to a cell, both ends included

  std::uint64_t span = 0;  ///< counts spans from 0 since begin()
  double x = 0;            ///< where it begins on the path of its span
  double h = 0;            ///< length
  double max_b = 0;        ///< least of the samples', lowered where a plan overshot the feed
  double tight = 1;        ///< share of A and J that plans may use, lowered where one overshot,
                           ///< but not below kMinTight
  double made_b = 0, made_tight = 1;  ///< both before any was lowered
  CellBound bound;
  std::array<CellSample, kSteps + 1> at;
};

/// How spans become cells.
struct CellSettings {
  double cell_s = 0.004;       ///< time that a cell takes at full speed, about
  double rest_s = 0.007;       ///< that the first and the last one take, about
  double feed_share = 0.9985;  ///< of the programmed feed that is planned
  int kept_cells = 512;        ///< at a time; a power of two
};

/// Makes cells of spans as they come, in a fixed store. What a cell is depends on the spans up to
/// kAhead behind its own and on nothing else. Cells are named by their number since begin().
class CellGrid {
 public:
  static constexpr int kAhead = 4;  ///< spans that bound the cells of the one before them
  static constexpr int kMin = 40;   ///< cells of a path, however short
  /// Beside a rest no cell is longer than that share of its distance to it, but for the first,
  /// which is no shorter than that: below, motion would creep.
  static constexpr double kRestGrowth = 0.15, kMinRest_mm = 2e-3;

  CellGrid(const MachineModel& model, const FeedLimits& limits, const CellSettings& settings);

  /// Starts a path from `joints`.
  void begin(const JointVector& joints, double tool_length_mm) noexcept;

  /// Whether another span may be pushed.
  [[nodiscard]] bool has_room() const noexcept {
    // However many cells the first span becomes, they wait for the kAhead behind it.
    const bool are_few = static_cast<int>(drafts_.size()) < kDrafts / 2 || waiting_count_ <= kAhead;
    return waiting_count_ < kWaiting && are_few;
  }

  /// Takes the next span; a fault ends the path, cells before it stay valid.
  [[nodiscard]] PathFault push(const FeedSpan& span) noexcept;
  [[nodiscard]] PathFault push(const JointSpan& span) noexcept {
    return push(make_feed_span(span, tool_length_mm_));
  }

  /// No more spans: makes the last cells, as far as there is room for them.
  [[nodiscard]] PathFault finish() noexcept;

  /// Behind a fault, or where it is not waited for more: the path ends at `x` of `span`, the
  /// `number`th, whose cell there is shortened. What was pushed and lies before it becomes cells
  /// yet; fault() says where it cannot. Cells before `smallest` stand.
  void end_at(const JointSpan& span, std::uint64_t number, double x,
              std::int64_t smallest) noexcept;

  /// Makes the cells for which there was no room before drop_before().
  [[nodiscard]] PathFault make_cells() noexcept;

  /// Whether last() is the end of the path.
  [[nodiscard]] bool is_complete() const noexcept { return is_finished_ && drafts_.empty(); }

  /// Cells exist from first() to last() - 1.
  [[nodiscard]] std::int64_t first() const noexcept { return first_; }
  [[nodiscard]] std::int64_t last() const noexcept { return last_; }
  /// What plans have lowered from `cell` on is forgotten with them.
  void restore_from(std::int64_t cell) noexcept {
    for (; cell < last_; ++cell) {
      FeedCell& here = (*this)[cell];
      here.max_b = here.made_b;
      here.tight = here.made_tight;
    }
  }
  /// Forgets the cells before `cell`.
  void drop_before(std::int64_t cell) noexcept {
    first_ = std::max(first_, cell < last_ ? cell : last_);
  }

  /// Why the path ends before its time, the number of the span on which it does, and where on it.
  [[nodiscard]] const PathFault& fault() const noexcept { return fault_; }
  [[nodiscard]] std::uint64_t faulty_span() const noexcept { return faulty_span_; }
  [[nodiscard]] double faulty_x() const noexcept { return faulty_x_; }

  [[nodiscard]] const FeedCell& operator[](std::int64_t cell) const noexcept {
    return cells_[static_cast<std::size_t>(cell) & (cells_.size() - 1)];
  }
  [[nodiscard]] FeedCell& operator[](std::int64_t cell) noexcept {
    return cells_[static_cast<std::size_t>(cell) & (cells_.size() - 1)];
  }

  /// Largest u̇² at the boundary before `cell`: what the cells on both sides allow.
  [[nodiscard]] double max_b_at(std::int64_t cell) const noexcept;

  /// Cells that the begin of the path has more of because they are graded there.
  [[nodiscard]] std::int64_t added_at_begin() const noexcept { return added_at_begin_; }

  /// Joints at the end of the last cell.
  [[nodiscard]] const JointVector& joints() const noexcept { return joints_; }

 private:
  static constexpr int kMaxPerSpan = 400;
  static constexpr int kWaiting = kMin + kAhead + 4;
  static constexpr int kDrafts = 4096;
  /// Of a span that is graded, so that those behind it find room.
  static constexpr int kMaxGraded = (kDrafts - kWaiting) / (kAhead + 1);
  static constexpr double kRatio = 2.5;  ///< of the lengths of neighbouring cells

  /// A cell to be: a piece of a span that waits.
  struct Draft {
    int waiting = 0;  ///< index of its span among those that wait
    double x = 0, h = 0;
  };

  [[nodiscard]] PathFault sample(const FeedSpan& span, double x, JointVector& reference,
                                 CellSample& out) const noexcept {
    return take_sample(model_, limits_, settings_.feed_share, span, x, reference, out);
  }
  /// Time per u at `x`; 0: there is no such pose.
  [[nodiscard]] double time_at(const FeedSpan& span, double x) const noexcept;
  /// How many cells `span` is worth.
  [[nodiscard]] int cells_of(const FeedSpan& span) const noexcept;
  void draft_cells(const FeedSpan& span) noexcept;
  /// Beside an inner singularity the time per u changes manifold inside of a span: halves the cell
  /// at `x` as long as it takes too long where it is slowest; there are no more than `max` then.
  void draft_graded(const FeedSpan& span, double x, double h, std::size_t max) noexcept;
  /// Halves cells longer than `ratio` times a neighbour; `left` is the one before the first.
  void halve(double left, double ratio, int rounds) noexcept;
  [[nodiscard]] bool split(std::size_t draft) noexcept;
  /// Of a path without cells: drafts enough for a motion to be shaped.
  void halve_short_path() noexcept;
  /// Forgets what was to become cells behind `x` of the `number`th span.
  void cut_drafts(std::uint64_t number, double x) noexcept;
  /// Forgets the cells behind it, but for the first `kept`: the one there is to be made anew.
  void cut_cells(const JointSpan& span, std::uint64_t number, double x, std::int64_t kept) noexcept;
  /// On a sliver of a cell the path would end from all but a rest, and a plan swings back there.
  void join_sliver(std::int64_t kept) noexcept;
  /// Cells of the path beside the rests at both of its ends, graded by the distance to them.
  void grade_begin() noexcept;
  void grade_end() noexcept;
  /// How far the machine comes from a rest at `x` in CellSettings::rest_s.
  [[nodiscard]] double length_from_rest(const FeedSpan& span, double x) const noexcept;
  void draft_from_rest(Draft rest, double first, bool is_end, std::size_t to_come,
                       double& from_rest) noexcept;
  [[nodiscard]] PathFault make_cell(const Draft& draft) noexcept;
  [[nodiscard]] PathFault check_between(PathKind kind, const JointDerivatives& a,
                                        const JointDerivatives& b, double h) const noexcept;
  /// Finds faulty_x() in `draft` closer than between two of its samples.
  void narrow_fault(const Draft& draft) noexcept;
  /// Whether the span of `draft` ends out of reach: a joint that jumps on the way there is not why
  /// the block cannot be cut.
  [[nodiscard]] bool leaves_reach(const Draft& draft) const noexcept;

  const MachineModel& model_;
  FeedLimits limits_;
  CellSettings settings_;
  std::vector<FeedCell> cells_;
  std::array<FeedSpan, kWaiting> waiting_;
  int waiting_count_ = 0;
  std::vector<Draft> drafts_, finer_;
  std::uint64_t next_span_ = 0;  ///< number of waiting_[0]
  std::int64_t first_ = 0, last_ = 0, added_at_begin_ = 0;
  double last_h_ = 0;  ///< length of the last cell made
  JointVector joints_{};
  double tool_length_mm_ = 0;
  bool is_finished_ = false, is_begin_graded_ = false;
  PathFault fault_;
  std::uint64_t faulty_span_ = 0;
  double faulty_x_ = 0;
};

}  // namespace meridian
