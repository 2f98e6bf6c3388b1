// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/legs/rest_to_rest_workspace.hpp"

#include <algorithm>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/geometry/unit_vector.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/look_ahead/fault_code.hpp"

namespace meridian {
namespace {

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

bool RestToRestPlanner::Workspace::may_rewind(const PathFault& fault) const noexcept {
  return model.rewind_policy == RewindPolicy::kRetract && fault.kind == PathFault::Kind::kTravel &&
         fault.joint >= 0 && redundant_joint(model) >= 0;
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
      result.rewind = {block.sequence,
                       block.line,
                       static_cast<std::int16_t>(to.turns),
                       static_cast<std::int16_t>(fault.joint),
                       from,
                       to.joints[redundant_joint(model)] - from,
                       model.rewind_retract_mm};
      if (trial != nullptr) return {};
      const PathFault after = router.route(block, next, staging);
      if (awaits_blocks()) return {};
      if (!is_fault(after)) {
        ++next.window;
        return {};
      }
    }
    next = rest;
    staging.go_back(mark);
  }
  result.rewind = {};
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
  if (stage_state == Stage::kNeedsAhead || !may_rewind(fault)) return fault;
  const bool needs_branch = fault.joint != redundant_joint(model);
  if (needs_branch && !router.is_reachable(block, rest)) return fault;
  staging.go_back(before);
  next = rest;
  return rewind(block, fault, nullptr);
}

void RestToRestPlanner::Workspace::stage(const ClBlock& block) noexcept {
  clear_stage();
  if (!is_finite(block)) return refuse(block, RejectCode::kNotFinite, -1, 0);
  if (is_motion(block.kind)) {
    stage_motion(block);
    if (stage_state == Stage::kRefused && on_pole_rad > kPoleDeviation_rad)
      stage_as_programmed(block);
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
  router.set_pole_tolerance(kPoleDeviation_rad);
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
    staged_approach = router.last_approach();
    result.axis_deviation_rad = router.axis_deviation_rad();
    next.is_first = false;
    count_window(0);
  }
  if (fault.kind == PathFault::Kind::kNone) {
    if (!find_great_circle(next.pose.axis, to_vector(block.axis)).is_unique) {
      return refuse(block, RejectCode::kAxisReversal, -1, 0);
    }
    fault = model.rewind_policy == RewindPolicy::kRetract ? route_or_rewind(block) : route(block);
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

}  // namespace meridian
