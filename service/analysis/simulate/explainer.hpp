// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/planner/motion_port.hpp"
#include "service/analysis/simulate/explanation.hpp"
#include "service/analysis/simulate/limit_view.hpp"

namespace meridian::simulate {

/// What the picture wants of every cycle. Units: s, mm.
struct ExplainedCycle {
  double time_s = 0;       ///< that it took
  double distance_mm = 0;  ///< of the tip
  double feed_mm_per_s = 0, programmed_mm_per_s = 0;
  LimitId limit = kNoLimit;
  double tool_length_mm = 0;
  std::optional<Cause> cause;  ///< nothing: it lies ahead, see TakeCause
};

/// Follows a run cycle by cycle and accounts its time to blocks, limits and causes. A stretch that
/// brakes gets the cause that stands at its end, one that speeds up that at its begin: so a corner
/// is charged with the way down to it and up again.
///
/// A cycle that passes several blocks is shared among them by the lengths passed; the sum over all
/// blocks is the number of cycles. Memory: the blocks that are planned and not yet run, and the
/// cycles of one braking stretch (at most kMaxUndecided); it does not grow with the program.
class Explainer {
 public:
  static constexpr std::size_t kMaxUndecided = 4096;

  using TakeBlock = std::function<void(const ExplainedBlock&)>;
  using TakeCycle = std::function<void(const ExplainedCycle&)>;
  /// The cause of all cycles so far that had none.
  using TakeCause = std::function<void(Cause)>;
  /// Each may be empty. `take_block` gets every block of the program, in order.
  Explainer(const MachineModel& model, TakeBlock take_block, TakeCycle take_cycle,
            TakeCause take_cause = {});

  /// A block that is going to be planned, in order. `programmed_feed`: before the machine limited
  /// it. Lengths of its way: of the tip, and as the path counts it (50 mm per rad of axis).
  void add_block(const ClBlock& block, double programmed_feed, double tip_length_mm,
                 double path_length_mm);
  /// The axis was moved beside the pole by that much in blocks `first` to `last`.
  void add_relaxed_axis(std::uint64_t first, std::uint64_t last, double deviation_rad);

  /// One cycle of the program, after the approach. `piece` and `path` are those in force, nullptr
  /// for none; `piece_time` as in the cycle's state.
  void add_cycle(const CycleRecord& record, const TimePiece* piece, const PathPiece* path,
                 double piece_time, double tool_length_mm);
  /// The program is over: all that is left is decided and reported.
  void finish();

  [[nodiscard]] const Explanation& explanation() const noexcept { return explanation_; }

 private:
  /// A block that has not run to its end.
  struct Open {
    ExplainedBlock block;
    double path_begin_mm = 0, path_end_mm = 0;  ///< lengths of the blocks' paths added up
    double share_per_s = 0;  ///< programmed in inverse time: share of its path per second; else 0
  };
  /// A part of a cycle whose cause lies ahead.
  struct Undecided {
    std::uint64_t sequence = 0;
    LimitId limit = kNoLimit;
    double time_s = 0, lost_s = 0;
  };

  [[nodiscard]] Open* find(std::uint64_t sequence);
  /// Feed in inverse time: the speed along the path over the one that is programmed; else 0.
  [[nodiscard]] static double find_feed_share(const Open& open, double speed);
  /// Where a cycle is on the paths of all blocks, added up. A span of the smooth path belongs to
  /// the block of its begin and may reach over many; its parameter counts as they do.
  [[nodiscard]] double find_path_position(const PathPiece& path, double s, double speed);
  /// The block that `place` is in, `from` or one behind it.
  [[nodiscard]] std::uint64_t find_block(double path_position, std::uint64_t from);
  /// Nothing: it lies ahead.
  [[nodiscard]] std::optional<Cause> cause_of(const LimitView& view, const CycleRecord& record);
  /// Shares a cycle among the blocks that it passed, up to `place` in block `last`. `cause`
  /// nothing: it lies ahead.
  void share_out(std::uint64_t last, double path_position, const LimitView& view, double speed,
                 double distance_mm, std::optional<Cause> cause);
  void give(Open& open, double time_s, const LimitView& view, double speed, double feed_mm_per_s,
            std::optional<Cause> cause);
  void account(Open& open, LimitId limit, std::optional<Cause> cause, double time_s,
               double feed_share);
  void decide(Cause cause);
  void book(Open& open, LimitId limit, Cause cause, double time_s, double lost_s);
  /// Reports the blocks that are over.
  void close_blocks(std::uint64_t running);
  void close_front();
  void add_to_stretch(const ExplainedBlock& block);
  void close_stretch();

  const MachineModel& model_;
  LimitMap limits_;
  TakeBlock take_block_;
  TakeCycle take_cycle_;
  TakeCause take_cause_;
  double period_s_;
  std::deque<Open> open_;  ///< by sequence, the first may be running
  std::deque<Undecided> undecided_;
  double planned_mm_ = 0;  ///< paths of the blocks so far
  Explanation explanation_;
  ExplainedStretch stretch_;
  std::uint64_t running_ = 0;  ///< block of the last cycle
  double path_position_ = 0;   ///< of the last cycle, see find_path_position()
  bool is_on_span_ = false;    ///< the last cycle was on a span of the smooth path: this one
  std::uint64_t span_index_ = 0;
  double span_begin_ = 0, span_length_ = 0;
  std::uint32_t window_ = 0;  ///< of the last cycle
  bool has_tip_ = false, is_braking_ = false;
  bool bends_ahead_ = false;             ///< the path has bent since the motion brakes
  Cause speeds_up_from_ = Cause::kRest;  ///< that the motion speeds up from
  Vector3 tip_ = Vector3::Zero();
};

}  // namespace meridian::simulate
