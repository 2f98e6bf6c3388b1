// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "meridian/planner/smooth_planner.hpp"
#include "service/core/path/index_ring.hpp"
#include "service/core/planner/feed/legs/leg_planner.hpp"
#include "service/core/planner/feed/rolling/feed_raise.hpp"
#include "service/core/planner/look_ahead/block_window.hpp"
#include "service/core/planner/look_ahead/smooth_run.hpp"
#include "service/core/planner/singular/pole/pole_bounds.hpp"

namespace meridian {

/// Whether there is a branch to choose.
[[nodiscard]] inline bool has_branches(const MachineModel& model) noexcept {
  return redundant_joint(model) >= 0 || model.family == MachineFamily::kRobot;
}

/// What a smooth planner is made of, and how runs through blocks and motion from rest to rest take
/// turns: which block may be run on through, where a run begins and ends, and what is done at rest
/// between. Memory: all of it at the start. Units: mm, rad, s.
struct SmoothPlanner::Workspace {
  static constexpr std::size_t kMaxRewinds = 256;      ///< that wait to be taken; the oldest go
  static constexpr std::size_t kMaxRelaxedAxes = 256;  ///< the same

  /// Which blocks come.
  enum class Intake : std::uint8_t {
    kLooking,  ///< more of the program's begin may come, before anything is planned
    kOpen,     ///< what comes is planned
    kEnding    ///< no block comes any more
  };
  /// The run through blocks that is going on.
  enum class Running : std::uint8_t {
    kNone,
    kThrough,
    kOnPole  ///< it stays on the pole all the way
  };
  /// What was decided for the block that waits for room.
  enum class Decided : std::uint8_t {
    kNothing,
    kAtRest,           ///< it goes from rest to rest
    kAtRestWithFactor  ///< and has been given the factor of its feed
  };

  Workspace(const MachineModel& m, ToolTable t)
      : model(m),
        plain(m, std::move(t)),
        raise(m),
        window(m, has_branches(m)),
        run(m, raise, has_branches(m) ? &window : nullptr),
        plain_relaxed_axes(kMaxRelaxedAxes),
        rewinds(kMaxRewinds) {
    if (has_branches(m)) plain.ask(&window);
  }

  /// What a pole that the tool axis misses leaves of an axis tolerance.
  [[nodiscard]] double axis_left_rad(double axis_rad) const noexcept {
    return std::max(axis_rad - std::abs(pole_offset_rad(model)), 0.0);
  }
  [[nodiscard]] BandTolerance tolerance() const noexcept;
  /// Of the axis beside the pole. What a program asks for holds there too.
  [[nodiscard]] double pole_tolerance_rad() const noexcept {
    const double axis_rad = tolerance().axis_rad;
    return settings.axis_tolerance_rad > 0
               ? axis_rad
               : std::max(axis_rad, axis_left_rad(model.tolerances.pole_axis_rad));
  }

  /// How far the blocks may be cut from where they are programmed.
  [[nodiscard]] LookAheadSlack slack() const noexcept {
    if (is_smooth()) return {tolerance().tip_mm, pole_tolerance_rad()};
    const bool relaxed_axes =
        redundant_joint(model) >= 0 && model.pole_policy == PolePolicy::kRelax;
    if (!relaxed_axes || settings.ends_exactly) return {};
    const double asked_rad = settings.axis_tolerance_rad;
    return {0, axis_left_rad(asked_rad > 0 ? asked_rad : model.tolerances.axis_beside_pole_rad())};
  }

  [[nodiscard]] bool is_smooth() const noexcept {
    return settings.transition.value_or(model.transition) == Transition::kSmooth;
  }
  /// `block` as it can be run on through, or nothing where it is done at rest. In exact stop it is
  /// a run of its own where a robot comes near a singular place.
  [[nodiscard]] std::optional<ClBlock> smoothable(ClBlock block) const noexcept;
  /// The solution that the joints at the last rest are nearest to.
  [[nodiscard]] int find_branch(const RestToRestPlanner::Junction& at) const noexcept;
  [[nodiscard]] bool is_on_pole(const Vector3& axis) const noexcept;
  void begin_run(const ClBlock& cut) noexcept;
  void end_run() noexcept;
  /// What the run says of the block that it cannot follow.
  [[nodiscard]] BlockReject fault_of_run() const noexcept;
  /// Whether that block may be done from rest to rest: a line whose end has a solution inside
  /// travel, and that is not tried yet. `last`: the block that the run took last.
  [[nodiscard]] bool may_retry(const ClBlock* last) const noexcept;
  /// Whether that was `block`: it is done from rest to rest.
  [[nodiscard]] bool is_retried(const ClBlock& block) const noexcept {
    return retried && block.sequence == retried->sequence;
  }
  /// The run rests ahead of that block: it is to be done from rest to rest, and what is behind it
  /// planned anew.
  void go_back() noexcept;
  /// `block` from where the tool rests; of its time what is left.
  [[nodiscard]] ClBlock rest_of(ClBlock block) const noexcept;
  /// Publishes what is ready of the run, and goes back from a fault once it rests; not behind
  /// `last`, which the run has just taken.
  [[nodiscard]] SmoothRun::Status publish(MotionWriter& writer,
                                          const ClBlock* last = nullptr) noexcept;
  /// Turns the redundant joint back at the rest that the run came to; false: no room in the port,
  /// blocks ahead are missing, or refused.
  [[nodiscard]] bool rewind(MotionWriter& writer) noexcept;
  void note(const Rewind& rewind) noexcept;
  /// The program begins with what waits; `is_late`: because no more came for too long.
  void end_look(bool is_late) noexcept {
    if (!is_looking()) return;
    looked_at = window.waiting();
    if (looked_at > 0) raise.note_look({.looked_at = looked_at, .is_late = is_late});
    intake = Intake::kOpen;
  }
  /// What is planned waits for blocks behind it: they say which solution carries past the pole, or
  /// behind a rewind.
  [[nodiscard]] bool awaits_ahead() noexcept {
    const bool needs_ahead = plain.needs_ahead() || (is_running() && run.needs_ahead());
    return needs_ahead && window.is_missing();
  }
  /// Whether `block` is wanted for a look, and not planned at once.
  [[nodiscard]] bool is_looking_at(const ClBlock& block) noexcept {
    if (is_looking()) return window.waiting() > 0 || is_motion(block.kind);
    return awaits_ahead();
  }
  /// Whether the look goes on with what comes.
  [[nodiscard]] bool wants_more() noexcept {
    if (!is_looking()) return awaits_ahead();
    return window.waiting() != (replayed_look > 0 ? replayed_look : kLookAhead);
  }
  /// A block of `kind` was planned from rest to rest. What neither moves nor changes the tool
  /// leaves the programmed pose as it is.
  void follow_plain(BlockKind kind) noexcept {
    pose = plain.junction().pose;
    joints = plain.joints();
    if (is_motion(kind) || kind == BlockKind::kTool) programmed = pose;
  }
  void refuse(const PlanResult& why) noexcept { refusal = why; }
  void decide(bool is_at_rest) noexcept {
    if (!is_at_rest) decided = Decided::kNothing;
    if (is_at_rest && decided == Decided::kNothing) decided = Decided::kAtRest;
  }
  [[nodiscard]] bool is_looking() const noexcept { return intake == Intake::kLooking; }
  [[nodiscard]] bool is_running() const noexcept { return running != Running::kNone; }

  const MachineModel& model;
  RestToRestPlanner plain;
  FeedRaise raise;
  BlockWindow window;
  SmoothRun run;
  SmoothSettings settings;
  ToolPose pose{Vector3::Zero(), Vector3::UnitZ()};  ///< end of the last block taken
  /// That end as programmed: a run that ends beside a singularity leaves the tool inside the
  /// tolerance of it.
  ToolPose programmed{Vector3::Zero(), Vector3::UnitZ()};
  JointVector joints{};
  Intake intake = Intake::kOpen;
  Running running = Running::kNone;
  Decided decided = Decided::kNothing;
  std::optional<PlanResult> refusal;   ///< the program cannot go on
  std::optional<BlockReject> retried;  ///< the last block that is done at rest for a run's fault
  IndexRing<RelaxedAxis> plain_relaxed_axes;  ///< of blocks from rest to rest
  IndexRing<Rewind> rewinds;
  std::size_t looked_at = 0;        ///< blocks of the begin
  std::uint64_t replayed_look = 0;  ///< blocks that a run before was begun with; 0: none was
};

}  // namespace meridian
