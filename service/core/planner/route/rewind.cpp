// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/path/build_piece.hpp"
#include "service/core/planner/route/route_look_ahead.hpp"
#include "service/core/planner/route/router.hpp"

/// Rewinds off the part: which solution they lead to, and the motion. Part of Router.
///
///     rest ── off along the tool axis, by the whole declared way ──▶ over ── to the winding or
///     branch ──▶ over ── back along the tool axis, at approach feed ──▶ rest, the same place
namespace meridian {
namespace {

constexpr double kMargin_rad = 1e-9;                     // of a winding at the end of travel
constexpr int kMaxWindings = RewindSolutions::kMax / 2;  // of a branch

}  // namespace

void Router::add_windings(const RewindTarget& on, int branch_in_force, const PlanCursor& cursor,
                          RewindSolutions& found) const noexcept {
  const int free = redundant_joint(model_);
  const bool is_other_branch = on.branch != branch_in_force;
  int added = 0;
  const auto add = [&](int turns) {
    RewindSolution one{on};
    JointVector& q = one.target.joints;
    q[free] += turns * kTurn_rad;
    if (added == kMaxWindings || first_joint_outside_travel(model_, q, kMargin_rad) >= 0) return;
    if (keep_out_at(model_.keep_out, q) >= 0) return;
    if (tip_axis_outside(model_, cursor.tool_length_mm, q) >= 0) return;
    if (!is_other_branch) one.target.turns = turns;
    for (int i = 0; i < model_.joint_count; ++i) {
      if (!model_.joints[i].is_rotary) continue;
      one.time_s += std::abs(q[i] - cursor.joints[i]) / model_.joints[i].limits.velocity;
    }
    found.add(one);
    ++added;
  };
  if (is_other_branch) add(0);
  if (model_.joints[free].is_endless) return;
  for (int count = 1; count <= kMaxWindings; ++count) {
    add(-count);
    add(count);
  }
}

RewindSolutions Router::find_rewinds(const ClBlock& block, const RewindCause& cause,
                                     const PlanCursor& cursor) noexcept {
  RewindSolutions found;
  needs_ahead_ = false;
  RewindTarget on{cursor.joints};
  const int in_force = branch_of(cursor.pose, cursor.joints, cursor.tool_length_mm);
  on.branch = in_force;
  add_windings(on, in_force, cursor, found);
  on.branch = in_force == 0 ? 1 : 0;
  const auto other = solve(model_, cursor.tool_length_mm, cursor.pose, on.branch, cursor.joints);
  if (other.status == SolveStatus::kOk) {
    on.joints = other.q;
    add_windings(on, in_force, cursor, found);
  }
  look_past_rewind(block, cause, cursor, found);
  return found;
}

void Router::look_past_rewind(const ClBlock& block, const RewindCause& cause,
                              const PlanCursor& cursor, RewindSolutions& found) noexcept {
  const int free = redundant_joint(model_);
  const std::span<RewindSolution> all = found.all();
  std::array<RouteAhead, RewindSolutions::kMax> routes;
  for (std::size_t n = 0; n < all.size(); ++n) {
    // Beside the pole the redundant joint may stand off the programmed axis: blocks start on it.
    const RewindTarget& to = all[n].target;
    const auto exact = solve(model_, cursor.tool_length_mm, cursor.pose, to.branch, to.joints);
    routes[n] = {to.branch, exact.q[free]};
  }
  const std::span<RouteAhead> asked(routes.data(), all.size());
  bool is_cut_short = false;
  if (look_ahead_ != nullptr) {
    // A line is followed from the tool to its end, an arc as a whole where the tool is at its
    // begin.
    const bool is_whole = block.is_arc && !cause.is_in_block && block.sequence > 0;
    look_ahead_->ask({is_whole ? block.sequence - 1 : block.sequence, !is_whole, cursor.pose,
                      cursor.tool_length_mm},
                     asked);
    needs_ahead_ = !look_ahead_->look();
    std::copy_n(look_ahead_->routes().begin(), asked.size(), asked.begin());
    is_cut_short = look_ahead_->is_cut_short();
  } else {
    RouteLookAhead look(model_);
    look.begin(cursor.tool_length_mm, cursor.pose, slack_, asked);
    for (const ClBlock& next : from(block)) look.follow(next);
    std::copy_n(look.routes().begin(), asked.size(), asked.begin());
    is_cut_short = !look.is_settled();
  }
  const JointLimits& limits = model_.joints[free].limits;
  const bool is_upwards = cause.fault.value > cursor.joints[free];
  for (std::size_t n = 0; n < all.size(); ++n) {
    all[n].carries = routes[n].carries;
    all[n].time_s += routes[n].time_s;
    if (is_cut_short && cause.fault.joint == free) {
      all[n].room = room_of(limits, all[n].target.joints[free], is_upwards);
    }
  }
  found.sort();
}

PathFault Router::rewind(const ClBlock& block, const RewindTarget& target, PlanCursor& cursor,
                         Staging& out) noexcept {
  const double off = model_.rewind_retract_mm;
  const Job job{block, MotionKind::kRewind, model_.approach_feed_mm_per_s, 0};
  Job rapid = job;
  rapid.feed_mm_per_s = 0;
  if (find_lift(cursor.pose, cursor.joints, cursor.tool_length_mm, off).mm < off) {
    return {PathFault::Kind::kTravel, -1, 0};
  }
  const ToolPose rest = cursor.pose;
  const ToolPose over{rest.tip + off * rest.axis, rest.axis};
  PathFault fault = run_lift(make_line(rest, over), rapid, cursor, out);
  if (is_fault(fault)) return fault;
  fault = target.is_other_branch() ? turn_through_pole(over, target, rapid, cursor, out)
                                   : turn_on_branch(target, rapid, cursor, out);
  if (is_fault(fault)) return fault;
  fault = run_lift(make_line(over, rest), job, cursor, out);
  cursor.pose = rest;
  return fault;
}

PathFault Router::turn_on_branch(const RewindTarget& target, const Job& rapid, PlanCursor& cursor,
                                 Staging& out) noexcept {
  const int free = redundant_joint(model_);
  JointVector turned = cursor.joints;
  turned[free] += target.turns * kTurn_rad;
  const std::uint32_t rotary = 1U << static_cast<unsigned>(free);
  return run(make_joint_move(cursor.joints, turned, rotary), rapid, kNoPart, cursor, out);
}

PathFault Router::turn_through_pole(const ToolPose& over, const RewindTarget& target,
                                    const Job& rapid, PlanCursor& cursor, Staging& out) noexcept {
  const auto end = solve(model_, cursor.tool_length_mm, over, target.branch, target.joints);
  if (end.status != SolveStatus::kOk) return {PathFault::Kind::kUnreachable, -1, 0};
  const PlanCursor begin = cursor;
  const Staging::Mark mark = out.mark();
  const double deviation_rad = deviation_rad_;  // of the axis on the part
  const Vector3 nearest = find_nearest_pole(model_, over.axis);
  PathFault fault;
  for (const Vector3& pole : {nearest, Vector3(-nearest)}) {
    cursor = begin;
    out.go_back(mark);
    fault = enter_pole(make_line(over, {over.tip, pole}), rapid, kWhole, cursor, out);
    if (is_fault(fault)) continue;
    fault = leave_pole_by(make_line({over.tip, pole}, over), end.q, rapid, cursor, out);
    if (!is_fault(fault)) break;
  }
  deviation_rad_ = deviation_rad;
  return fault;
}

}  // namespace meridian
