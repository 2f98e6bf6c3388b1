// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "meridian/planner/rest_to_rest.hpp"
#include "service/core/planner/route/router.hpp"
#include "service/core/planner/route/staging.hpp"

namespace meridian {

/// What a block becomes, staged behind what is published: a rewind, the way in, the way of the
/// block, a barrier; or why it is refused. Context: planner thread. Proof:
/// tests/unit/planner/rest_to_rest_test.cpp.
struct RestToRestPlanner::Workspace {
  Workspace(const MachineModel& m, ToolTable t) : model(m), tools(std::move(t)), router(m) {}

  const MachineModel& model;
  ToolTable tools;
  Router router;
  Staging staging;
  PlanCursor cursor;                                  ///< end of what is published
  PlanCursor next;                                    ///< end of what is staged
  PlanResult result;                                  ///< of what is staged
  std::optional<Approach> staged_approach, approach;  ///< that is published and was not taken
  bool retracts_first = false;
  std::optional<JointVector> first_joints;
  double on_pole_rad = kPoleDeviation_rad;  ///< what begin() or set_pole_tolerance() said
  enum class Stage : std::uint8_t {
    kNothing,
    kWhole,      ///< all of a block is staged
    kRefused,    ///< the program cannot go on
    kNeedsAhead  ///< nothing is staged: the look-ahead waits for blocks
  };
  Stage stage_state = Stage::kNothing;

  void refuse(const BlockReject& reject) noexcept {
    stage_state = Stage::kRefused;
    result = {PlanStatus::kRefused, reject, 0, {}};
  }
  void refuse(const ClBlock& block, RejectCode code, int joint, double value) noexcept {
    refuse({block.sequence, block.line, code, joint, value});
  }

  /// Nothing is staged behind `cursor`.
  void clear_stage() noexcept {
    staging.clear(cursor.path_index);
    next = cursor;
    result = {};
    if (stage_state == Stage::kNeedsAhead) stage_state = Stage::kNothing;
  }
  /// Stages the whole of `block` behind `cursor`, or refuses it.
  void stage(const ClBlock& block) noexcept;
  void stage_motion(ClBlock block) noexcept;
  /// The same without the axis tolerance about the pole, instead of what stage_motion() refused.
  void stage_as_programmed(const ClBlock& block) noexcept;
  void stage_barrier(const ClBlock& block) noexcept;
  void stage_retraction(const ClBlock& block) noexcept;
  /// Whether `fault` is one that another winding or branch may help.
  [[nodiscard]] bool may_rewind(const PathFault& fault) const noexcept;
  /// Stages a rewind from `next`, to a solution that `trial` lets pass, or without one with `block`
  /// behind it. Without one it returns `fault`, that of the block. Where blocks are
  /// missing for the answer nothing is meant.
  [[nodiscard]] PathFault rewind(const ClBlock& block, const PathFault& fault,
                                 const RewindTrial* trial) noexcept;
  /// The look-ahead waits for blocks: nothing is staged.
  [[nodiscard]] bool awaits_blocks() noexcept {
    if (router.needs_ahead()) stage_state = Stage::kNeedsAhead;
    return router.needs_ahead();
  }
  /// Stages the way of `block`; nothing is meant where blocks ahead are missing after it.
  [[nodiscard]] PathFault route(const ClBlock& block) noexcept;
  /// The same, off its travel with a rewind ahead of it.
  [[nodiscard]] PathFault route_or_rewind(const ClBlock& block) noexcept;
  /// What is staged behind the first `pieces_before` pieces is a window.
  void count_window(int pieces_before) noexcept {
    if (staging.time_count > pieces_before) ++next.window;
  }
  /// The last motion staged ends `block`.
  void mark_end(const ClBlock& block) noexcept {
    if (staging.path_count == 0) return;
    PathPiece& last = staging.paths[staging.path_count - 1];
    last.marks.add({last.length, 0, block.line});
  }
  /// All of what is staged is there.
  void finish_staging() noexcept {
    next.path_index = cursor.path_index + static_cast<std::uint64_t>(staging.path_count);
    stage_state = Stage::kWhole;
  }
  /// What was staged is published, or void.
  void leave_stage() noexcept {
    if (stage_state == Stage::kWhole) stage_state = Stage::kNothing;
  }
};

}  // namespace meridian
