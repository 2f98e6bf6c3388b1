// SPDX-License-Identifier: Apache-2.0
#include "meridian/planner/rest_to_rest.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/geometry/unit_vector.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/look_ahead/fault_code.hpp"
#include "service/core/planner/route/router.hpp"
#include "service/core/planner/route/staging.hpp"

namespace meridian {
namespace {

constexpr double kLegToleranceShare = 0.95;  // of the axis tolerance about the pole

TimeKind barrier_of(BlockKind kind) noexcept {
  switch (kind) {
    case BlockKind::kDwell:
      return TimeKind::kDwell;
    case BlockKind::kStop:
      return TimeKind::kStop;
    case BlockKind::kOptionalStop:
      return TimeKind::kOptionalStop;
    case BlockKind::kEnd:
      return TimeKind::kEnd;
    case BlockKind::kAuxiliary:
    case BlockKind::kTool:
    case BlockKind::kCut:
    case BlockKind::kRapid:
      break;
  }
  return TimeKind::kAction;
}

bool is_finite(const ClBlock& block) noexcept {
  double zero = 0;
  for (int i = 0; i < 3; ++i) {
    zero += 0 * block.tip_mm[i] + 0 * block.axis[i];
    if (block.is_arc) zero += 0 * block.centre_mm[i] + 0 * block.normal[i];
  }
  zero += 0 * block.feed + 0 * block.value + 0 * block.sweep_rad;
  return zero == 0;
}

}  // namespace

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
  double on_pole_rad = kPoleEase_rad;  ///< what begin() or set_pole_tolerance() said
  enum class Stage : std::uint8_t {
    kNothing,
    kWhole,      ///< all of a block is staged
    kRefused,    ///< the program cannot go on
    kNeedsAhead  ///< nothing is staged: the foresight waits for blocks
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
  /// Whether `fault` is one that turning the redundant joint back may help.
  [[nodiscard]] bool may_unwind(const PathFault& fault) const noexcept;
  /// Stages a rewind from `next`, to a solution that `trial` lets pass, or without one with `block`
  /// behind it. Without one it returns `fault`, that of the block. Where blocks are
  /// missing for the answer nothing is meant.
  [[nodiscard]] PathFault rewind(const ClBlock& block, const PathFault& fault,
                                 const RewindTrial* trial) noexcept;
  /// The foresight waits for blocks: nothing is staged.
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

bool RestToRestPlanner::Workspace::may_unwind(const PathFault& fault) const noexcept {
  return model.unwind_policy == UnwindPolicy::kRetract && fault.kind == PathFault::Kind::kTravel &&
         fault.joint >= 0 && fault.joint == redundant_joint(model);
}

PathFault RestToRestPlanner::Workspace::rewind(const ClBlock& block, const PathFault& fault,
                                               const RewindTrial* trial) noexcept {
  const PlanCursor rest = next;
  const Staging::Mark mark = staging.mark();
  const double from = rest.joints[redundant_joint(model)];
  RewindSolutions found = router.find_rewinds(block, {fault, trial != nullptr}, rest);
  if (awaits_blocks()) return {};
  for (const RewindSolution& one : found.all()) {
    if (trial != nullptr && !trial->fits(one.target)) continue;
    if (!is_fault(router.rewind(block, one.target, next, staging))) {
      ++next.window;
      const RewindTarget& to = one.target;
      result.unwinding = {block.sequence,
                          block.line,
                          static_cast<std::int16_t>(to.turns),
                          static_cast<std::int8_t>(fault.joint),
                          to.is_other_branch,
                          from,
                          to.joints[redundant_joint(model)] - from,
                          model.unwind_retract_mm};
      if (trial != nullptr) return {};
      const PathFault behind = router.route(block, next, staging);
      if (awaits_blocks()) return {};
      if (!is_fault(behind)) {
        ++next.window;
        return {};
      }
    }
    next = rest;
    staging.go_back(mark);
  }
  result.unwinding = {};
  return fault;
}

PathFault RestToRestPlanner::Workspace::route(const ClBlock& block) noexcept {
  const int before = staging.time_count;
  const PathFault fault = router.route(block, next, staging);
  if (!awaits_blocks()) count_window(before);
  return fault;
}

PathFault RestToRestPlanner::Workspace::route_or_rewind(const ClBlock& block) noexcept {
  const PlanCursor rest = next;
  const Staging::Mark before = staging.mark();
  const PathFault fault = route(block);
  if (stage_state == Stage::kNeedsAhead || !may_unwind(fault)) return fault;
  staging.go_back(before);
  next = rest;
  return rewind(block, fault, nullptr);
}

void RestToRestPlanner::Workspace::stage(const ClBlock& block) noexcept {
  clear_stage();
  if (!is_finite(block)) return refuse(block, RejectCode::kNotFinite, -1, 0);
  if (is_motion(block.kind)) {
    stage_motion(block);
    if (stage_state == Stage::kRefused && on_pole_rad > kPoleEase_rad) stage_as_programmed(block);
  } else {
    stage_barrier(block);
  }
  if (stage_state == Stage::kNothing) finish_staging();
}

void RestToRestPlanner::Workspace::stage_as_programmed(const ClBlock& block) noexcept {
  const PlanResult refusal = result;
  clear_stage();
  stage_state = Stage::kNothing;
  staged_approach = std::nullopt;
  router.set_pole_tolerance(kPoleEase_rad);
  stage_motion(block);
  router.set_pole_tolerance(on_pole_rad);
  if (stage_state == Stage::kRefused) result = refusal;
}

void RestToRestPlanner::Workspace::stage_motion(ClBlock block) noexcept {
  const auto axis = UnitVector3::near_unit(to_vector(block.axis));
  if (!axis) return refuse(block, RejectCode::kNotFinite, -1, 0);
  block.axis = to_array(axis->vector());
  const bool is_cut = block.kind == BlockKind::kCut;
  if (is_cut && (block.feed_meaning == FeedMeaning::kNone || !(block.feed > 0))) {
    return refuse(block, RejectCode::kFeed, -1, block.feed);
  }
  PathFault fault;
  if (next.is_first) {
    fault = first_joints ? router.approach_joints(block, *first_joints, next, staging)
                         : router.approach(block, next, staging);
    if (router.lost_block()) return refuse(*router.lost_block());
    staged_approach = router.way_in();
    result.axis_deviation_rad = router.axis_deviation_rad();
    next.is_first = false;
    count_window(0);
  }
  if (fault.kind == PathFault::Kind::kNone) {
    if (!find_great_circle(next.pose.axis, to_vector(block.axis)).is_unique) {
      return refuse(block, RejectCode::kAxisReversal, -1, 0);
    }
    fault = model.unwind_policy == UnwindPolicy::kRetract ? route_or_rewind(block) : route(block);
    if (stage_state == Stage::kNeedsAhead) return;
    result.axis_deviation_rad = std::max(result.axis_deviation_rad, router.axis_deviation_rad());
  }
  if (fault.kind == PathFault::Kind::kNone) return mark_end(block);
  RejectCode code = code_of(fault.kind);
  if (code == RejectCode::kTravelBetween) {
    if (!router.is_reachable(block, next)) {
      code = RejectCode::kTravel;
    } else if (cursor.is_first && staging.time_count == 0) {
      code = RejectCode::kApproach;
    }
  }
  refuse(block, code, fault.joint, fault.value);
}

/// Leaves where the machine rests ahead of the first action of a program that may begin in the
/// part.
void RestToRestPlanner::Workspace::stage_retraction(const ClBlock& block) noexcept {
  const bool is_action = block.kind == BlockKind::kAuxiliary || block.kind == BlockKind::kTool;
  if (!is_action || !retracts_first || !next.is_first || next.has_retracted) return;
  const PathFault fault = router.retract(block, next, staging);
  if (fault.kind != PathFault::Kind::kNone) {
    return refuse(block, code_of(fault.kind), fault.joint, fault.value);
  }
  if (staging.time_count > 0) ++next.window;
}

void RestToRestPlanner::Workspace::stage_barrier(const ClBlock& block) noexcept {
  stage_retraction(block);
  if (stage_state == Stage::kRefused) return;
  TimePiece piece;
  piece.kind = barrier_of(block.kind);
  piece.is_from_rest = true;
  piece.epoch = next.epoch;
  piece.window = next.window++;
  piece.sequence = block.sequence;
  piece.line = block.line;
  piece.duration = block.kind == BlockKind::kDwell ? std::max(0.0, block.value) : 0.0;
  if (block.kind == BlockKind::kTool) {
    const Tool* tool = tools.find(static_cast<int>(std::lround(block.value)));
    if (tool == nullptr) return refuse(block, RejectCode::kUnknownTool, -1, block.value);
    next.tool_length_mm = tool->tip_length_mm();
    next.pose.tip = forward(model, next.tool_length_mm, next.joints).tip;
  }
  (void)staging.add(piece);
}

RestToRestPlanner::RestToRestPlanner(const MachineModel& model, ToolTable tools)
    : workspace_(std::make_unique<Workspace>(model, std::move(tools))) {
  begin(JointVector{}, model.tool_length_mm, 0);
}

RestToRestPlanner::~RestToRestPlanner() = default;

void RestToRestPlanner::swap_tools(ToolTable& tools) noexcept {
  std::swap(workspace_->tools, tools);
}

void RestToRestPlanner::begin(const JointVector& at_rest, double tool_length_mm,
                              std::uint16_t epoch, bool retracts_first,
                              const std::optional<JointVector>& first_joints) noexcept {
  Workspace& w = *workspace_;
  w.retracts_first = retracts_first;
  w.first_joints = first_joints;
  PlanCursor cursor;
  if (epoch == w.cursor.epoch) {
    // What the epoch published before may still lie in the port: no index comes twice.
    cursor.path_index = w.cursor.path_index;
    cursor.window = w.cursor.window;
  }
  w.cursor = cursor;
  w.router.look_at({}, {});
  w.cursor.joints = at_rest;
  w.cursor.tool_length_mm = tool_length_mm;
  w.cursor.epoch = epoch;
  w.cursor.pose = forward(w.model, tool_length_mm, at_rest);
  w.staged_approach = w.approach = std::nullopt;
  w.stage_state = Workspace::Stage::kNothing;
  w.router.set_feed_factor(1);
  w.router.set_free_cone(0);
  set_pole_tolerance(0);
}

void RestToRestPlanner::ask(PoleLookAhead* foresight) noexcept {
  workspace_->router.ask(foresight);
}

bool RestToRestPlanner::needs_ahead() const noexcept {
  return workspace_->stage_state == Workspace::Stage::kNeedsAhead;
}

void RestToRestPlanner::set_free_cone(double rad) noexcept {
  workspace_->router.set_free_cone(rad);
}

void RestToRestPlanner::set_pole_tolerance(double rad) noexcept {
  Workspace& w = *workspace_;
  w.on_pole_rad = std::max(kPoleEase_rad, kLegToleranceShare * rad);
  w.router.set_pole_tolerance(w.on_pole_rad);
}

void RestToRestPlanner::set_feed_factor(double factor) noexcept {
  workspace_->router.set_feed_factor(factor);
}

PlanResult RestToRestPlanner::plan(const ClBlock& block, MotionWriter& writer) noexcept {
  Workspace& w = *workspace_;
  if (w.stage_state == Workspace::Stage::kRefused) return w.result;
  if (w.stage_state != Workspace::Stage::kWhole) w.stage(block);
  if (needs_ahead()) return {PlanStatus::kNoRoom, {}, 0, {}};
  return w.stage_state == Workspace::Stage::kRefused ? w.result : publish(writer);
}

bool RestToRestPlanner::take_approach(Approach& out) noexcept {
  Workspace& w = *workspace_;
  if (!w.approach) return false;
  out = *std::exchange(w.approach, std::nullopt);
  return true;
}

void RestToRestPlanner::look_at(std::span<const ClBlock> ahead, double tip_slack_mm,
                                double axis_slack_rad) noexcept {
  workspace_->router.look_at(ahead, {tip_slack_mm, axis_slack_rad});
}

PlanResult RestToRestPlanner::unwind(const ClBlock& block, double beyond, const RewindTrial& trial,
                                     MotionWriter& writer) noexcept {
  Workspace& w = *workspace_;
  if (w.stage_state == Workspace::Stage::kRefused) return w.result;
  if (w.stage_state != Workspace::Stage::kWhole) {
    w.clear_stage();
    PathFault fault{PathFault::Kind::kTravel, redundant_joint(w.model), beyond};
    if (w.may_unwind(fault)) fault = w.rewind(block, fault, &trial);
    if (w.stage_state == Workspace::Stage::kNeedsAhead) return {PlanStatus::kNoRoom, {}, 0, {}};
    if (fault.kind != PathFault::Kind::kNone) {
      w.refuse(block, code_of(fault.kind), fault.joint, fault.value);
      return w.result;
    }
    w.finish_staging();
  }
  return publish(writer);
}

PlanResult RestToRestPlanner::publish(MotionWriter& writer) noexcept {
  Workspace& w = *workspace_;
  const Staging& staged = w.staging;
  if (!writer.has_room(static_cast<std::size_t>(staged.path_count),
                       static_cast<std::size_t>(staged.time_count))) {
    return {PlanStatus::kNoRoom, {}, 0, {}};
  }
  bool is_written = true;
  for (int n = 0; n < staged.path_count; ++n) is_written &= writer.stage(staged.paths[n]);
  for (int n = 0; n < staged.time_count; ++n) is_written &= writer.stage(staged.times[n]);
  if (!is_written) {
    writer.discard();
    return {PlanStatus::kNoRoom, {}, 0, {}};
  }
  writer.publish();
  if (w.staged_approach) w.approach = std::exchange(w.staged_approach, std::nullopt);
  w.cursor = w.next;
  w.leave_stage();
  return w.result;
}

RestToRestPlanner::Junction RestToRestPlanner::junction() const noexcept {
  const PlanCursor& at = workspace_->cursor;
  return {at.pose, at.joints, at.tool_length_mm, at.epoch, at.path_index, at.window, at.is_first};
}

void RestToRestPlanner::continue_at(const Junction& junction) noexcept {
  Workspace& w = *workspace_;
  w.cursor = {junction.pose,       junction.joints, junction.tool_length_mm, junction.is_first,
              junction.path_index, junction.window, junction.epoch};
  w.leave_stage();
}

const JointVector& RestToRestPlanner::joints() const noexcept { return workspace_->cursor.joints; }

double RestToRestPlanner::tool_length_mm() const noexcept {
  return workspace_->cursor.tool_length_mm;
}

}  // namespace meridian
