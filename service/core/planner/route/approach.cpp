// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/path/build_piece.hpp"
#include "service/core/planner/look_ahead/robot_look_ahead.hpp"
#include "service/core/planner/route/route_look_ahead.hpp"
#include "service/core/planner/route/router.hpp"

/// The approach: retract along the tool axis, joint move, down. Part of Router.
namespace meridian {
namespace {

constexpr double kThere = 1e-12;  // joints that differ less are where they should be
constexpr double kNearby = 1e-3;  // mm, rad: so near that a joint move alone is made
constexpr double kNoClearance_mm = 1e-3;

double largest_difference(const JointVector& a, const JointVector& b) noexcept {
  double largest = 0;
  for (int i = 0; i < kMaxJoints; ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

std::uint32_t rotary_mask(const MachineModel& model) noexcept {
  std::uint32_t mask = 0;
  for (int i = 0; i < model.joint_count; ++i) {
    if (model.joints[i].is_rotary) mask |= 1U << static_cast<unsigned>(i);
  }
  return mask;
}

ToolPose lifted(const ToolPose& pose, double by_mm) noexcept {
  return {pose.tip + by_mm * pose.axis, pose.axis};
}

/// The share of the straight line from `from` to `to` on which the tip stays in its box.
double share_in_tip_box(const TipBox& box, const Array3& from, const Array3& to) noexcept {
  double share = 1;
  for (std::size_t i = 0; box.is_set && i < from.size(); ++i) {
    const double by = to[i] - from[i];
    const double end = by > 0 ? box.max[i] : box.min[i];
    if (std::abs(by) > kTipBoxRounding) share = std::min(share, (end - from[i]) / by);
  }
  return share;
}

/// Adds length and time of what is staged from `begin` on.
void add_to_approach(const Staging::Mark& begin, const Staging& staged,
                     Approach& approach) noexcept {
  for (int n = begin.paths; n < staged.path_count; ++n) approach.length += staged.paths[n].length;
  for (int n = begin.times; n < staged.time_count; ++n) approach.time += staged.times[n].duration;
}

}  // namespace

Router::Lift Router::find_lift(const ToolPose& pose, const JointVector& joints,
                               double tool_length_mm, double whole_mm) const noexcept {
  if (!(whole_mm > 0)) return {0, joints};
  if (redundant_joint(model_) < 0) return find_lift_of_arm(pose, joints, tool_length_mm, whole_mm);
  // With the axis fixed joints and drives of a machine with linear joints are linear in the lift.
  double share = 1;
  const auto at = solve_near(lifted(pose, whole_mm), joints, tool_length_mm);
  const LimitedVector from = limited_of(model_, joints), to = limited_of(model_, at.q);
  for (int i = 0; i < limited_count(model_); ++i) {
    const JointSpec& spec = limited_spec(model_, i);
    if (spec.is_endless) continue;
    const double by = to[i] - from[i];
    const double end = by > 0 ? spec.limits.travel_max : spec.limits.travel_min;
    if (std::abs(by) > 1e-9) share = std::min(share, (end - from[i]) / by);
  }
  share = std::min(share, keep_out_between(model_.keep_out, joints, at.q).share);
  if (model_.tip_box.is_set) {
    share = std::min(share,
                     share_in_tip_box(model_.tip_box, tip_over_base(model_, tool_length_mm, joints),
                                      tip_over_base(model_, tool_length_mm, at.q)));
  }
  const double clearance = std::max(0.0, share) * whole_mm;
  if (!(clearance > kNoClearance_mm)) return {0, joints};
  return {clearance, solve_near(lifted(pose, clearance), joints, tool_length_mm).q};
}

/// The joints of an arm bend on the way up: as far as the whole path stays in reach and travel.
Router::Lift Router::find_lift_of_arm(const ToolPose& pose, const JointVector& joints,
                                      double tool_length_mm, double whole_mm) const noexcept {
  constexpr int kSteps = 16;
  const int branch = branch_of(pose, joints, tool_length_mm);
  Lift lift{0, joints};
  for (int n = 1; n <= kSteps; ++n) {
    const double above = whole_mm * n / kSteps;
    const auto at = solve(model_, tool_length_mm, lifted(pose, above), branch, lift.joints);
    const bool is_free = at.status == SolveStatus::kOk &&
                         first_joint_outside_travel(model_, at.q, 0) < 0 &&
                         keep_out_between(model_.keep_out, lift.joints, at.q).box < 0 &&
                         tip_axis_outside(model_, tool_length_mm, at.q) < 0;
    if (!is_free) break;
    lift = {above, at.q};
  }
  return lift.mm > kNoClearance_mm ? lift : Lift{0, joints};
}

PathFault Router::find_tip_fault(double tool_length_mm, const JointVector& joints) const noexcept {
  const int axis = tip_axis_outside(model_, tool_length_mm, joints);
  if (axis < 0) return {};
  const Array3 tip = tip_over_base(model_, tool_length_mm, joints);
  return {PathFault::Kind::kTipBox, axis, tip[static_cast<std::size_t>(axis)]};
}

PathFault Router::retract(const ClBlock& block, PlanCursor& cursor, Staging& out) noexcept {
  const Staging::Mark begin = out.mark();
  const ToolPose rest = cursor.pose;
  retracted_ = {};
  retracted_.from = cursor.joints;
  left_ = rest;
  cursor.has_retracted = true;
  const double up = find_lift(rest, cursor.joints, cursor.tool_length_mm, model_.clearance_mm).mm;
  if (!(up > 0)) return {};
  const Job rapid{block, MotionKind::kApproach, 0, 0};
  const PathFault fault = run_lift(make_line(rest, lifted(rest, up)), rapid, cursor, out);
  if (is_fault(fault)) return fault;
  cursor.pose = lifted(rest, up);
  retracted_.retract = up;
  add_to_approach(begin, out, retracted_);
  return {};
}

PathFault Router::lift_longer_tool(const Job& rapid, PlanCursor& cursor, Staging& out) noexcept {
  const double above = (cursor.pose.tip - left_.tip).dot(left_.axis);
  const double min_above = retracted_.retract - kNoClearance_mm;
  if (above >= min_above) return {};
  const double missing = model_.clearance_mm - above;
  const double up = find_lift(cursor.pose, cursor.joints, cursor.tool_length_mm, missing).mm;
  if (above + up < min_above) {
    const auto at = solve_near(lifted(cursor.pose, missing), cursor.joints, cursor.tool_length_mm);
    if (const int box = keep_out_between(model_.keep_out, cursor.joints, at.q).box; box >= 0) {
      return {PathFault::Kind::kKeepOut, -1, 1.0 * box};
    }
    const PathFault tip = find_tip_fault(cursor.tool_length_mm, at.q);
    if (is_fault(tip)) return tip;
    const int joint = first_joint_outside_travel(model_, at.q, 0);
    return {PathFault::Kind::kTravel, joint, joint >= 0 ? limited_value(model_, at.q, joint) : 0.0};
  }
  last_approach_.lift = up;
  return run_lift(make_line(cursor.pose, lifted(cursor.pose, up)), rapid, cursor, out);
}

PathFault Router::approach_by(const ToolPose& target, const Candidate& candidate, const Job& job,
                              PlanCursor& cursor, Staging& out) noexcept {
  const std::uint32_t rotary = rotary_mask(model_);
  Job rapid = job;
  rapid.feed_mm_per_s = 0;
  PathFault fault;
  const double apart = largest_difference(candidate.joints, cursor.joints);
  const double clearance = model_.clearance_mm;
  double up = 0;
  Lift down{0, candidate.joints};
  if (apart > kNearby) {
    if (cursor.has_retracted) {
      fault = lift_longer_tool(rapid, cursor, out);
      if (is_fault(fault)) return fault;
    } else {
      up = find_lift(cursor.pose, cursor.joints, cursor.tool_length_mm, clearance).mm;
    }
    if (up > 0) {
      fault = run_lift(make_line(cursor.pose, lifted(cursor.pose, up)), rapid, cursor, out);
      if (is_fault(fault)) return fault;
    }
    down = find_lift(target, candidate.joints, cursor.tool_length_mm, clearance);
  }
  last_approach_.retract = up;
  last_approach_.descent = down.mm;
  if (largest_difference(down.joints, cursor.joints) > kThere) {
    fault = run(make_joint_move(cursor.joints, down.joints, rotary), rapid, kNoPart, cursor, out);
    if (is_fault(fault)) return fault;
  }
  if (down.mm > 0) {
    fault = run_lift(make_line(lifted(target, down.mm), target), job, cursor, out);
  }
  return fault;
}

void Router::describe_approach(const Candidate& candidate, const Job& job, const PlanCursor& from,
                               const Staging::Mark& begin, const Staging& staged) noexcept {
  last_approach_.is_planned = true;
  last_approach_.epoch = from.epoch;
  last_approach_.sequence = job.block.sequence;
  last_approach_.line = job.block.line;
  if (from.has_retracted) {
    last_approach_.from = retracted_.from;
    last_approach_.retract = retracted_.retract;
    last_approach_.has_rest = true;
    last_approach_.length = retracted_.length;
    last_approach_.time = retracted_.time;
  } else {
    last_approach_.from = from.joints;
  }
  last_approach_.to = candidate.joints;
  last_approach_.branch = static_cast<std::uint8_t>(candidate.branch);
  add_to_approach(begin, staged, last_approach_);
}

void Router::take_looked(std::span<const RouteAhead> found, Candidates& candidates) noexcept {
  for (std::size_t n = 0; n < found.size(); ++n) {
    candidates.candidate[n].carries = found[n].carries;
    candidates.candidate[n].cost += found[n].time_s;
    if (found[n].end == RouteEnd::kLost) candidates.candidate[n].lost = found[n].lost;
  }
  candidates.sort();
}

void Router::look_along(const ClBlock& block, const ToolPose& start, double tool_length_mm,
                        Candidates& candidates) const noexcept {
  const std::span<const ClBlock> blocks = after(block);
  if (blocks.empty()) return;
  const RoutesAhead found = ahead_of(candidates);
  RouteLookAhead look(model_);
  look.begin(tool_length_mm, start, slack_,
             {found.data(), static_cast<std::size_t>(candidates.count)});
  for (const ClBlock& next : blocks) look.follow(next);
  take_looked(look.routes(), candidates);
}

void Router::look_along_arm(const ClBlock& block, const ToolPose& start, double tool_length_mm,
                            Candidates& candidates) const noexcept {
  const LookAheadSlack slack{std::max(slack_.tip_mm, model_.tolerances.tip_mm),
                             std::max(slack_.axis_rad, model_.tolerances.axis_rad)};
  for (int n = 0; n < candidates.count; ++n) {
    Candidate& candidate = candidates.candidate[n];
    candidate.carries = follow_ahead(
        model_, slack, {tool_length_mm, start, candidate.branch, candidate.joints}, after(block));
  }
  candidates.sort();
}

std::span<const ClBlock> Router::from(const ClBlock& block) const noexcept {
  const auto first = std::find_if(ahead_.begin(), ahead_.end(), [&block](const ClBlock& one) {
    return one.sequence == block.sequence;
  });
  return {first, ahead_.end()};
}

/// The blocks behind where `block` begins to be cut, of those that are known.
std::span<const ClBlock> Router::after(const ClBlock& block) const noexcept {
  const std::span<const ClBlock> all = from(block);
  return all.empty() || block.is_arc ? all : all.subspan(1);
}

void Router::look_past(const ClBlock& block, const ToolPose& start, double tool_length_mm,
                       Candidates& candidates) noexcept {
  if (look_ahead_ == nullptr) return look_along(block, start, tool_length_mm, candidates);
  const RoutesAhead found = ahead_of(candidates);
  look_ahead_->ask({block.sequence, false, start, tool_length_mm},
                   {found.data(), static_cast<std::size_t>(candidates.count)});
  needs_ahead_ = !look_ahead_->look();
  take_looked(look_ahead_->routes(), candidates);
}

Router::RoutesAhead Router::ahead_of(const Candidates& candidates) const noexcept {
  RoutesAhead found;
  for (int n = 0; n < candidates.count; ++n) {
    found[static_cast<std::size_t>(n)] = {candidates.candidate[n].branch,
                                          candidates.candidate[n].joints[redundant_joint(model_)]};
  }
  return found;
}

PathFault Router::approach_joints(const ClBlock& block, const JointVector& to, PlanCursor& cursor,
                                  Staging& out) noexcept {
  deviation_rad_ = 0;
  lost_.reset();
  last_approach_ = {};
  const int outside = first_joint_outside_travel(model_, to, 1e-9);
  if (outside >= 0) {
    return {PathFault::Kind::kTravel, outside, limited_value(model_, to, outside)};
  }
  const PlanCursor from = cursor;
  const Staging::Mark mark = out.mark();
  const PathPiece path = make_joint_move(cursor.joints, to, rotary_mask(model_));
  const Job job{block, MotionKind::kApproach, 0,
                path.length > 0 ? job_of(block).feed_mm_per_s / path.length : 0};
  if (largest_difference(to, cursor.joints) > kThere) {
    const PathFault fault = run(path, job, kWhole, cursor, out);
    if (is_fault(fault)) return fault;
  }
  cursor.pose = forward(model_, cursor.tool_length_mm, cursor.joints);
  Candidate candidate;
  candidate.joints = cursor.joints;
  candidate.branch = branch_of(cursor.pose, cursor.joints, cursor.tool_length_mm);
  describe_approach(candidate, job, from, mark, out);
  return {};
}

PathFault Router::find_target_fault(const ToolPose& target,
                                    const PlanCursor& cursor) const noexcept {
  const auto at = solve(model_, cursor.tool_length_mm, target, 0, cursor.joints);
  const int joint = first_joint_outside_travel(model_, at.q, 1e-9);
  if (joint >= 0) return {PathFault::Kind::kTravel, joint, limited_value(model_, at.q, joint)};
  const int box = keep_out_at(model_.keep_out, at.q);
  if (box >= 0) return {PathFault::Kind::kKeepOut, -1, 1.0 * box};
  const PathFault tip = find_tip_fault(cursor.tool_length_mm, at.q);
  return is_fault(tip) ? tip : PathFault{PathFault::Kind::kUnreachable, -1, 0};
}

PathFault Router::approach(const ClBlock& block, PlanCursor& cursor, Staging& out) noexcept {
  deviation_rad_ = 0;
  const ToolPose target{block.is_arc ? find_arc_begin(block) : to_vector(block.tip_mm),
                        relaxed(to_vector(block.axis), kPoleDeviation_rad)};
  Candidates candidates = find_candidates(target, cursor);
  const int free = redundant_joint(model_);
  // Room to turn counts as well: a winding at the end of travel is taken only where no other is.
  if (free >= 0 && !model_.joints[free].is_endless) {
    const JointLimits& limits = model_.joints[free].limits;
    for (int n = 0; n < candidates.count; ++n) {
      const double at = candidates.candidate[n].joints[free];
      const double room = std::min(at - limits.travel_min, limits.travel_max - at);
      candidates.candidate[n].cost += std::max(0.0, std::numbers::pi - room) / limits.velocity;
    }
    candidates.sort();
  }
  if (free >= 0) {
    // Inside the tolerance about the pole the joint is free: nothing follows from where it begins.
    const bool is_free = pole_distance(model_, target.axis) < on_pole_rad_;
    if (!is_free) look_along(block, target, cursor.tool_length_mm, candidates);
  } else if (model_.family == MachineFamily::kRobot) {
    look_along_arm(block, target, cursor.tool_length_mm, candidates);
  }
  const Job job{block, MotionKind::kApproach, model_.approach_feed_mm_per_s, 0};
  PathFault first{PathFault::Kind::kUnreachable, -1, 0};
  if (candidates.count == 0) first = find_target_fault(target, cursor);
  lost_.reset();
  bool is_tried = false;
  for (int n = 0; n < candidates.count; ++n) {
    const Candidate& candidate = candidates.candidate[n];
    if (candidate.lost) {
      if (!lost_) lost_ = candidate.lost;
      continue;
    }
    PlanCursor trial = cursor;
    const Staging::Mark mark = out.mark();
    last_approach_ = {};
    const PathFault fault = approach_by(target, candidate, job, trial, out);
    if (!is_fault(fault)) {
      describe_approach(candidate, job, cursor, mark, out);
      cursor = trial;
      cursor.pose = target;
      lost_.reset();
      return {};
    }
    out.go_back(mark);
    if (!is_tried) first = fault;
    is_tried = true;
  }
  if (is_tried) lost_.reset();
  return lost_ ? PathFault{PathFault::Kind::kTravel, lost_->joint, lost_->value} : first;
}

}  // namespace meridian
