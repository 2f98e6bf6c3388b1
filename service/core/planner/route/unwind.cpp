// SPDX-License-Identifier: Apache-2.0
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/build_piece.hpp"
#include "service/core/planner/route/router.hpp"

/// Whole turns of the redundant joint off the part. Part of Router.
///
///     rest ── off along the tool axis, by the whole declared way ──▶ over ── redundant joint alone
///     ──▶ over ── back along the tool axis, at approach feed ──▶ rest, the same place
namespace meridian {

PathFault Router::unwind(const ClBlock& block, int turns, PlanCursor& cursor,
                         Staging& out) noexcept {
  const int free = redundant_joint(model_);
  const double off = model_.unwind_retract_mm;
  const Job job{block, MotionKind::kUnwind, model_.approach_feed_mm_per_s, 0};
  Job rapid = job;
  rapid.feed_mm_per_s = 0;
  if (find_clearance(cursor.pose, cursor.joints, cursor.tool_length_mm, off) < off) {
    return {PathFault::Kind::kTravel, -1, 0};
  }
  const ToolPose rest = cursor.pose;
  const ToolPose over{rest.tip + off * rest.axis, rest.axis};
  PathFault fault = run_lift(make_line(rest, over), rapid, cursor, out);
  if (is_fault(fault)) return fault;
  JointVector turned = cursor.joints;
  turned[free] += turns * kTurn_rad;
  const std::uint32_t rotary = 1U << static_cast<unsigned>(free);
  fault = run(make_joint_move(cursor.joints, turned, rotary), rapid, 0, cursor, out);
  if (is_fault(fault)) return fault;
  fault = run_lift(make_line(over, rest), job, cursor, out);
  cursor.pose = rest;
  return fault;
}

}  // namespace meridian
