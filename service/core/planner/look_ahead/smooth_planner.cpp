// SPDX-License-Identifier: Apache-2.0
#include "meridian/planner/smooth_planner.hpp"

#include <algorithm>
#include <utility>

#include "meridian/path/build_piece.hpp"
#include "service/core/planner/look_ahead/smooth_workspace.hpp"

namespace meridian {

SmoothPlanner::SmoothPlanner(const MachineModel& model, ToolTable tools)
    : workspace_(std::make_unique<Workspace>(model, std::move(tools))) {}

SmoothPlanner::~SmoothPlanner() = default;

void SmoothPlanner::swap_tools(ToolTable& tools) noexcept { workspace_->plain.swap_tools(tools); }

void SmoothPlanner::begin(const JointVector& at_rest, double tool_length_mm, std::uint16_t epoch,
                          const SmoothSettings& settings) noexcept {
  Workspace& w = *workspace_;
  if (w.is_running()) w.end_run();  // no index comes twice
  w.plain.begin(at_rest, tool_length_mm, epoch, settings.retracts_first, settings.first_joints);
  w.settings = settings;
  if (w.is_smooth() && w.model.pole_policy == PolePolicy::kRelax) {
    w.plain.set_free_cone(kOnPoleTolerances * w.tolerance().axis_rad);
  } else if (!w.is_smooth()) {
    w.plain.set_pole_tolerance(w.slack().axis_rad);
  }
  w.raise.begin(tool_length_mm);
  w.refusal.reset();
  w.retried.reset();
  w.decided = Workspace::Decided::kNothing;
  w.window.begin(w.slack());
  w.looked_at = 0;
  w.intake = has_branches(w.model) ? Workspace::Intake::kLooking : Workspace::Intake::kOpen;
  w.pose = w.programmed = w.plain.junction().pose;
  w.joints = at_rest;
}

PlanResult SmoothPlanner::plan(const ClBlock& block, MotionWriter& writer) noexcept {
  Workspace& w = *workspace_;
  if (w.refusal) return *w.refusal;
  if (block.kind == BlockKind::kEnd) w.window.end();
  bool is_taken = false;
  if (w.is_looking_at(block)) {
    // Without memory for the block: it is the last one, or the look is full.
    is_taken = block.kind != BlockKind::kEnd && w.window.waiting() < kLookAhead;
    if (is_taken) w.window.push(block);
    if (is_taken && w.wants_more()) return {};
    w.end_look(false);
  }
  const bool is_planned = plan_what_waits(writer);
  if (w.refusal) return *w.refusal;
  if (is_taken) return {};
  if (!is_planned) return {PlanStatus::kNoRoom, {}, 0, {}};
  const PlanResult result = plan_one(block, writer);
  if (result.status == PlanStatus::kOk && !w.is_looking()) w.window.keep(block);
  return result;
}

bool SmoothPlanner::plan_what_waits(MotionWriter& writer) noexcept {
  Workspace& w = *workspace_;
  if (w.window.waiting() == 0) return true;
  const auto begin = w.window.first(w.looked_at);
  const LookAheadSlack slack = w.slack();
  w.plain.look_at(begin, slack.tip_mm, slack.axis_rad);
  while (w.window.waiting() > 0) {
    if (plan_one(w.window.front(), writer).status != PlanStatus::kOk) return false;
    w.window.pop();
  }
  w.plain.look_at({});
  return true;
}

void SmoothPlanner::look_no_further() noexcept {
  Workspace& w = *workspace_;
  w.end_look(true);
  if (!w.awaits_ahead()) return;
  if (const auto mark = w.window.look_no_further()) w.raise.note_look(*mark);
}

std::uint64_t SmoothPlanner::look() const noexcept {
  Workspace& w = *workspace_;
  if (w.is_looking()) return w.window.waiting() > 0 ? 1 : 0;
  return w.awaits_ahead() ? 1 + w.window.questions() : 0;
}

void SmoothPlanner::finish() noexcept {
  Workspace& w = *workspace_;
  if (!w.is_looking()) look_no_further();
  w.window.end();
  w.end_look(false);
  w.intake = Workspace::Intake::kEnding;
}

PlanResult SmoothPlanner::plan_one(const ClBlock& block, MotionWriter& writer) noexcept {
  using Status = SmoothRun::Status;
  Workspace& w = *workspace_;
  if (w.refusal) return *w.refusal;
  // Decided once: what the answer depends on changes where the port was full meanwhile.
  const bool is_undecided = w.decided == Workspace::Decided::kNothing;
  auto cut = is_undecided ? w.smoothable(block) : std::nullopt;
  w.decide(!cut);
  if (w.is_running()) {
    const bool ends = !cut || !w.is_smooth();
    if (ends) w.run.finish();
    const Status status = w.publish(writer);
    if (w.refusal) return *w.refusal;
    if (!w.is_running() || w.run.has_fault() || status == Status::kNoRoom ||
        (ends && status != Status::kDone) || w.awaits_ahead())
      return {PlanStatus::kNoRoom, {}, 0, {}};
    if (ends) {
      w.end_run();
      cut = w.smoothable(block);  // it may start a run of its own
      w.decide(!cut);
    }
  }
  if (!cut) {
    if (w.awaits_ahead()) return {PlanStatus::kNoRoom, {}, 0, {}};
    if (w.decided != Workspace::Decided::kAtRestWithFactor && block.kind == BlockKind::kCut) {
      w.raise.rest();
      w.plain.set_feed_factor(w.raise.next(block.sequence, writer.feed_override(), 0).label);
    }
    PlanResult result = w.plain.plan(w.is_retried(block) ? w.rest_of(block) : block, writer);
    const bool waits = result.status == PlanStatus::kNoRoom;
    w.decided = waits ? Workspace::Decided::kAtRestWithFactor : Workspace::Decided::kNothing;
    if (result.status == PlanStatus::kRefused) {
      if (w.is_retried(block)) result.reject = *w.retried;
      w.refuse(result);
    } else if (result.status == PlanStatus::kOk) {
      w.note(result.rewind);
      w.follow_plain(block.kind);
      if (result.axis_deviation_rad > 0) {
        w.plain_relaxed_axes.push_over_oldest({block.sequence, block.sequence, block.line,
                                               block.line, result.axis_deviation_rad,
                                               RelaxedReason::kOnPole});
      }
    }
    return result;
  }
  if (!w.is_running()) w.begin_run(*cut);
  w.run.take(*cut);
  if (!w.is_smooth()) w.run.finish();
  w.pose = w.programmed = {to_vector(cut->tip_mm), to_vector(cut->axis)};
  (void)w.publish(writer, &block);
  return w.refusal.value_or(PlanResult{});
}

PlanResult SmoothPlanner::advance(MotionWriter& writer) noexcept {
  Workspace& w = *workspace_;
  if (w.is_looking()) return {};
  const bool is_planned = w.refusal || plan_what_waits(writer);
  if (is_planned && w.is_running()) {
    if (w.intake == Workspace::Intake::kEnding && !w.refusal) w.run.finish();
    (void)w.publish(writer);
  }
  return w.refusal.value_or(PlanResult{});
}

bool SmoothPlanner::take_approach(Approach& out) noexcept {
  return workspace_->plain.take_approach(out);
}

bool SmoothPlanner::take_rewind(Rewind& out) noexcept {
  return workspace_->rewinds.take_oldest(out);
}

bool SmoothPlanner::take_relaxed_axis(RelaxedAxis& out) noexcept {
  Workspace& w = *workspace_;
  return w.run.take_relaxed_axis(out) || w.plain_relaxed_axes.take_oldest(out);
}

bool SmoothPlanner::take_feed_mark(FeedMark& out) noexcept { return workspace_->raise.take(out); }

void SmoothPlanner::replay_feed(std::span<const FeedMark> marks) noexcept {
  Workspace& w = *workspace_;
  w.raise.replay(marks);
  w.window.replay(marks);
  w.replayed_look = 0;
  for (const FeedMark& mark : marks) {
    if (mark.looked_at > 0 && mark.sequence == 0)
      w.replayed_look = std::min<std::uint64_t>(mark.looked_at, kLookAhead);
  }
}

const JointVector& SmoothPlanner::joints() const noexcept { return workspace_->joints; }

double SmoothPlanner::tool_length_mm() const noexcept { return workspace_->plain.tool_length_mm(); }

}  // namespace meridian
