// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/band_spline.hpp"
#include "meridian/path/block_reject.hpp"
#include "meridian/planner/motion_port.hpp"
#include "meridian/planner/relaxed_axis.hpp"
#include "meridian/planner/rewind.hpp"
#include "service/core/path/index_ring.hpp"
#include "service/core/planner/feed/rolling/feed_raise.hpp"
#include "service/core/planner/feed/rolling/rolling_feed.hpp"
#include "service/core/planner/feed/stop/feed_stop_margin.hpp"
#include "service/core/planner/route/span_travel.hpp"
#include "service/core/planner/singular/pole/pole_corridor.hpp"
#include "service/core/planner/singular/robot/robot_passes.hpp"

namespace meridian {

/// Where a run starts, and the names that its pieces get.
struct RunStart {
  ToolPose pose{Vector3::Zero(), Vector3::UnitZ()};        ///< of the tool, at rest
  ToolPose programmed{Vector3::Zero(), Vector3::UnitZ()};  ///< that pose as programmed
  JointVector joints{};
  int branch = 0;
  /// The axis stays on the pole all the way: the redundant joint is held, nothing is sought about
  /// it.
  bool is_on_pole = false;
  double tool_length_mm = 0;
  std::uint16_t epoch = 0;
  std::uint64_t path_index = 0;  ///< of the next path piece
  std::uint32_t window = 0;      ///< the next one
};

/// A stretch of program without a rest: from blocks through spline and feed to windows in the port.
/// It starts and ends at rest.
class SmoothRun : public RewindTrial {
 public:
  enum class Status : std::uint8_t {
    kPublished,    ///< publish_window() alone: a window was published, call again
    kNeedsBlocks,  ///< all that is ready was published
    kNoRoom,       ///< the port is full, or the cycle may yet run a tail instead of the end: call
                   ///< again
    kDone,         ///< finish() was called and everything is published
    kRewind,       ///< published to a rest at which a rewind is needed: see rewind_at(), then
                   ///< go_on()
    kFailed        ///< fault() says why; what lies ahead of it is published to its end
  };

  /// `raise` says what the feed is planned with, `look_ahead` how far routes behind the pole carry.
  SmoothRun(const MachineModel& model, FeedRaise& raise, PoleLookAhead* look_ahead = nullptr);

  /// `pole_tolerance_rad`: of the axis beside the pole, smoothing and axis deviation together.
  void begin(const RunStart& start, const BandTolerance& tolerance,
             double pole_tolerance_rad) noexcept;

  /// Takes a cut. Only where publish() has said kNeedsBlocks.
  void take(const ClBlock& block) noexcept;
  /// No more blocks: the run ends on the last one.
  void finish() noexcept { band_.finish(); }

  /// Plans and publishes what is ready.
  [[nodiscard]] Status publish(MotionWriter& writer) noexcept;
  /// The same one window at a time.
  [[nodiscard]] Status publish_window(MotionWriter& writer) noexcept;

  /// Behind kNeedsBlocks: the blocks are needed by the look-ahead, take() is not to be called.
  [[nodiscard]] bool needs_ahead() const noexcept { return corridor_.needs_ahead(); }

  /// Known before kFailed says so: what lies ahead of it has to be published first.
  [[nodiscard]] const PathFault& fault() const noexcept { return fault_; }
  [[nodiscard]] bool has_fault() const noexcept { return fault_.kind != PathFault::Kind::kNone; }
  /// The block that the fault is on; its code is left to the caller.
  [[nodiscard]] const BlockReject& faulty_block() const noexcept { return faulty_block_; }

  /// Where a joint runs out of travel: the block, the joint, and `value` outside travel.
  [[nodiscard]] const BlockReject& rewind_at() const noexcept { return rewind_at_; }
  /// Behind kRewind: whether the span that would have left travel fits after a rewind to `target`,
  /// with the rest of a zone that it lies in.
  [[nodiscard]] bool fits(const RewindTarget& target) const noexcept override;
  /// Behind kRewind: the machine was taken to `target`, where it rests now; the names are those of
  /// what follows.
  void go_on(const RewindTarget& target, std::uint64_t path_index, std::uint32_t window) noexcept;

  /// Takes the oldest stretch beside the pole on which the axis was moved; false if there is none.
  [[nodiscard]] bool take_relaxed_axis(RelaxedAxis& out) noexcept {
    return relaxed_axes_.take_oldest(out);
  }

  /// Names for what follows the run, and the joints at its end.
  [[nodiscard]] std::uint64_t next_path_index() const noexcept {
    return start_.path_index + staged_spans_;
  }
  [[nodiscard]] std::uint32_t next_window() const noexcept { return window_; }
  [[nodiscard]] const JointVector& joints() const noexcept { return span_joints_; }

 private:
  /// Where the spans of the feed come from.
  enum class Supply : std::uint8_t {
    kFlowing,  ///< from the band, one after the other
    kHeld,     ///< held_ waits for a rewind: the feed ends ahead of it
    kRewound,  ///< held_ is next, and nothing was taken since the rewind
    kEnded     ///< no more come: the path ends, or a fault lies ahead
  };

  /// A published window that may still end in its tail.
  struct OpenWindow {
    std::uint32_t window = 0;
    std::int64_t rest_cell = -1;  ///< -1: it has no tail
  };

  [[nodiscard]] Status prepare(double feed_override) noexcept;
  /// Takes the next span that joints follow, or holds it for a rewind. False: it leaves travel
  /// behind one too, and fault() says so.
  [[nodiscard]] bool take_span(const JointSpan& span, double feed_override) noexcept;
  /// Gives the next span to the feed, with the factors that hold for it.
  void push(const JointSpan& span, double feed_override) noexcept;
  /// The next span that joints follow, nullptr where there is none yet.
  [[nodiscard]] const JointSpan* next_span() noexcept;
  /// No faster than the machine's highest feed.
  void limit_feed(BandSpan& span) const noexcept;
  /// Remembers where blocks end on the span that the band gave last.
  void note_block_ends() noexcept;
  /// Marks the ends of blocks on `span`, the next one.
  void mark_block_ends(JointSpan& span) noexcept;
  /// Follows the joints over `span`, the next one. False: one would leave its travel, and
  /// rewind_at() names where; nothing is followed then.
  [[nodiscard]] bool follow(const JointSpan& span) noexcept;
  /// Whether the feed knows its end.
  [[nodiscard]] bool is_feed_finished() const noexcept {
    return supply_ == Supply::kHeld || supply_ == Supply::kEnded;
  }
  /// Starts the feed where the machine rests.
  void begin_feed(int branch) noexcept;
  /// Keeps account of stretches beside the pole; `span` nullptr: the path ends.
  void note_relaxed_axis(const JointSpan* span) noexcept;
  void fail(const PathFault& fault, std::uint64_t sequence, std::uint32_t line) noexcept;
  void fail_on_span() noexcept;
  void fail_ahead() noexcept;
  /// The faulty block is the first that ends behind `x` of the `number`th span, where one is known.
  void name_block_at(std::int64_t number, double x) noexcept;
  /// The path ends where the last block ahead of the faulty one does.
  void end_ahead_of_fault() noexcept;
  [[nodiscard]] bool is_end_certain(const MotionWriter& writer) const noexcept;
  void follow_tail(MotionWriter& writer) noexcept;
  [[nodiscard]] bool write(MotionWriter& writer) noexcept;
  /// On `piece` at `end`, followed from its begin.
  [[nodiscard]] JointVector joints_on(const PathPiece& piece, double end) const noexcept;
  /// Where a run that failed rests.
  [[nodiscard]] JointVector joints_at_rest() const noexcept;
  [[nodiscard]] bool stage_spans(MotionWriter& writer, std::uint64_t until) noexcept;
  [[nodiscard]] TimePiece make_piece(const FeedPiece& piece, bool is_tail) const noexcept;
  [[nodiscard]] bool stage_pieces(MotionWriter& writer, std::span<const FeedPiece> pieces,
                                  bool is_tail) noexcept;

  const MachineModel& model_;
  FeedRaise& raise_;
  BandSpline band_;
  PoleCorridor corridor_;
  RobotPasses passes_;
  RollingFeed feed_;
  FeedStopMargin stop_margin_;
  SpanTravel travel_;
  IndexRing<JointSpan> spans_;  ///< by number, as far back as a window may go
  IndexRing<BlockEnd> ends_;    ///< of blocks, that no span is marked with yet
  RunStart start_;
  std::uint64_t staged_spans_ = 0;  ///< path pieces of spans before this one are in the port
  IndexRing<JointVector> begins_;   ///< at the begin of each of them, by number
  JointVector span_joints_{};       ///< at the end of the last, or where a run that failed rests
  std::uint32_t window_ = 0;
  std::uint32_t rested_window_ = 0;  ///< the next one when the machine last rested
  std::array<OpenWindow, MotionReader::kRemembered + 2> open_;
  bool has_window_ = false;  ///< feed_.window() waits for room
  bool is_band_finished_ = false;
  bool may_rewind_ = false;  ///< to another winding or branch
  Supply supply_ = Supply::kFlowing;
  JointSpan held_;
  BlockReject rewind_at_;
  std::optional<RelaxedAxis> relaxed_axis_;  ///< going on
  IndexRing<RelaxedAxis> relaxed_axes_;
  PathFault fault_;
  BlockReject faulty_block_;
};

}  // namespace meridian
