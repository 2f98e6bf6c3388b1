// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/travel.hpp"
#include "meridian/path/build_piece.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/look_ahead/fault_code.hpp"
#include "service/core/planner/look_ahead/smooth_workspace.hpp"

/// A block that a run cannot follow as it rounds it: the machine rests ahead of it, and it is done
/// exactly, from rest to rest. Part of SmoothPlanner.
namespace meridian {
namespace {

ToolPose pose_at_end(const ClBlock& block) noexcept {
  return {to_vector(block.tip_mm), to_vector(block.axis).normalized()};
}

/// Whether some solution for `pose` is inside travel.
bool is_inside_travel_on_a_branch(const MachineModel& model, double tool_length_mm,
                                  const ToolPose& pose, const JointVector& near) noexcept {
  for (int branch = 0; branch < branch_count(model); ++branch) {
    auto at = solve(model, tool_length_mm, pose, branch, near);
    if (at.status == SolveStatus::kUnreachable) continue;
    wind_into_travel(model, near, at.q);
    if (first_joint_outside_travel(model, at.q, kTravelMargin) < 0) return true;
  }
  return false;
}

}  // namespace

BlockReject SmoothPlanner::Workspace::fault_of_run() const noexcept {
  BlockReject reject = run.faulty_block();
  reject.code = code_of(run.fault().kind);
  return reject;
}

bool SmoothPlanner::Workspace::may_retry(const ClBlock* last) const noexcept {
  const std::uint64_t sequence = run.faulty_block().sequence;
  if (!is_smooth() || redundant_joint(model) < 0) return false;
  if (retried && sequence <= retried->sequence) return false;
  const bool is_last = last != nullptr && last->sequence == sequence;
  const ClBlock* block = is_last ? last : window.find(sequence);
  if (block == nullptr || block->kind != BlockKind::kCut || block->is_arc) return false;
  return is_inside_travel_on_a_branch(model, plain.junction().tool_length_mm, pose_at_end(*block),
                                      run.joints());
}

void SmoothPlanner::Workspace::go_back() noexcept {
  retried = fault_of_run();
  pose = programmed = forward(model, plain.tool_length_mm(), run.joints());
  end_run();
  window.go_back_to(retried->sequence);
  decided = Decided::kNothing;
}

ClBlock SmoothPlanner::Workspace::rest_of(ClBlock block) const noexcept {
  if (block.feed_meaning != FeedMeaning::kInverseTime) return block;
  const ClBlock* before = window.find_motion_ahead(block.sequence);
  if (before == nullptr) return block;
  const ToolPose end = pose_at_end(block);
  const double whole = make_line(pose_at_end(*before), end).length;
  const double left = make_line(pose, end).length;
  if (left > 0) block.feed *= std::max(1.0, whole / left);
  return block;
}

}  // namespace meridian
