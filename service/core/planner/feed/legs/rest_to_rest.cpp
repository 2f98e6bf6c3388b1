// SPDX-License-Identifier: Apache-2.0
#include "meridian/planner/rest_to_rest.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "meridian/kinematics/kinematics.hpp"
#include "service/core/planner/feed/legs/rest_to_rest_workspace.hpp"
#include "service/core/planner/look_ahead/fault_code.hpp"

namespace meridian {
namespace {

constexpr double kLegToleranceShare = 0.95;  // of the axis tolerance about the pole

}  // namespace

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

void RestToRestPlanner::ask(PoleLookAhead* look_ahead) noexcept {
  workspace_->router.ask(look_ahead);
}

bool RestToRestPlanner::needs_ahead() const noexcept {
  return workspace_->stage_state == Workspace::Stage::kNeedsAhead;
}

void RestToRestPlanner::set_free_cone(double rad) noexcept {
  workspace_->router.set_free_cone(rad);
}

void RestToRestPlanner::set_pole_tolerance(double rad) noexcept {
  Workspace& w = *workspace_;
  w.on_pole_rad = std::max(kPoleDeviation_rad, kLegToleranceShare * rad);
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

PlanResult RestToRestPlanner::rewind(const ClBlock& block, const TravelEnd& end,
                                     const RewindTrial& trial, MotionWriter& writer) noexcept {
  Workspace& w = *workspace_;
  if (w.stage_state == Workspace::Stage::kRefused) return w.result;
  if (w.stage_state != Workspace::Stage::kWhole) {
    w.clear_stage();
    PathFault fault{PathFault::Kind::kTravel, end.joint, end.value};
    if (w.may_rewind(fault)) fault = w.rewind(block, fault, &trial);
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
