// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/router.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"
#include "service/core/planner/singular/robot/robot_pass.hpp"

namespace meridian {
namespace {

constexpr double kNoTip_mm = 1e-9;     // shorter routes are no motion
constexpr double kNoTurn_rad = 1e-12;  // smaller turns of the axis are none
constexpr int kMaxTurns = 4;           // windings tried either way
/// In inverse time blocks within this way bound the axis, and count for a tolerance of it on it.
constexpr double kSpeedReach_mm = 5;
constexpr double kInside = 0.98;  // of the reach, all of a block for certain

}  // namespace

Vector3 Router::relaxed(const Vector3& axis, double within_rad) noexcept {
  const double distance = pole_distance(model_, axis);
  if (!(distance < within_rad)) return axis;
  deviation_rad_ = std::max(deviation_rad_, distance);
  return find_nearest_pole(model_, axis);
}

bool Router::is_at_pole(const Vector3& axis) const noexcept {
  return redundant_joint(model_) >= 0 && pole_distance(model_, axis) < kPoleDeviation_rad;
}

Router::Job Router::job_of(const ClBlock& block) const noexcept {
  Job job{block, block.kind == BlockKind::kRapid ? MotionKind::kRapid : MotionKind::kCut};
  if (block.kind == BlockKind::kRapid) return job;
  const double max_feed = model_.max_feed_mm_per_s;
  job.feed_factor = feed_factor_;
  if (block.feed_meaning == FeedMeaning::kInverseTime) {
    job.share_per_s = block.feed;
    job.feed_mm_per_s = max_feed;
  } else {
    job.feed_mm_per_s = max_feed > 0 ? std::min(max_feed, block.feed) : block.feed;
    if (max_feed > 0) job.feed_factor = std::min(feed_factor_, max_feed / job.feed_mm_per_s);
  }
  return job;
}

double Router::bound_turn(const PathPiece& path, double programmed_rad, double before_mm_per_s,
                          double share_per_s) const noexcept {
  const double tolerance_rad = std::min(on_pole_rad_, model_.tolerances.axis_rad);
  const double tip_mm = tip_length(path);
  const double path_mm = std::hypot(tip_mm, kAxisLength_mm_per_rad * programmed_rad);
  const bool is_near = path_mm < kInside * kSpeedReach_mm;
  const double tip_mm_per_s = std::max(share_per_s * tip_mm, is_near ? before_mm_per_s : 0.0);
  const double rad_per_s =
      std::max(share_per_s * programmed_rad, tolerance_rad * tip_mm_per_s / kSpeedReach_mm);
  return path.axis_turn > 0 ? std::min(share_per_s, rad_per_s / path.axis_turn) : share_per_s;
}

void Router::Candidates::sort() noexcept {
  const auto is_before = [](const Candidate& a, const Candidate& b) {
    return a.carries != b.carries ? a.carries > b.carries : a.cost < b.cost;
  };
  for (int n = 1; n < count; ++n) {
    for (int k = n; k > 0 && is_before(candidate[k], candidate[k - 1]); --k)
      std::swap(candidate[k], candidate[k - 1]);
  }
}

Router::Candidates Router::find_candidates(const ToolPose& pose,
                                           const PlanCursor& cursor) const noexcept {
  Candidates candidates;
  const int free = redundant_joint(model_);
  const auto add = [&](const JointVector& q, int branch) {
    if (candidates.count == kMaxCandidates || first_joint_outside_travel(model_, q, 1e-9) >= 0)
      return;
    if (keep_out_at(model_.keep_out, q) >= 0) return;
    if (tip_axis_outside(model_, cursor.tool_length_mm, q) >= 0) return;
    double cost = 0;
    const LimitedVector from = limited_of(model_, cursor.joints), to = limited_of(model_, q);
    for (int i = 0; i < limited_count(model_); ++i) {
      cost = std::max(cost, std::abs(to[i] - from[i]) / limited_spec(model_, i).limits.velocity);
    }
    candidates.candidate[candidates.count++] = {q, cost, branch};
  };
  for (int branch = 0; branch < branch_count(model_); ++branch) {
    auto at = solve(model_, cursor.tool_length_mm, pose, branch, cursor.joints);
    if (at.status == SolveStatus::kUnreachable) continue;
    if (free < 0) wind_into_travel(model_, cursor.joints, at.q);
    add(at.q, branch);
    if (free < 0) continue;
    if (at.status == SolveStatus::kAtPole) break;
    if (model_.joints[free].is_endless) continue;
    for (int turns = 1; turns <= kMaxTurns; ++turns) {
      for (const int sign : {-1, 1}) {
        JointVector q = at.q;
        q[free] += sign * turns * 2 * std::numbers::pi;
        add(q, branch);
      }
    }
  }
  candidates.sort();
  return candidates;
}

bool Router::is_reachable(const ClBlock& block, const PlanCursor& cursor) const noexcept {
  return find_candidates({to_vector(block.tip_mm), to_vector(block.axis)}, cursor).count > 0;
}

PathFault Router::run(const PathPiece& path, const Job& job, double share, PlanCursor& cursor,
                      Staging& out) noexcept {
  Leg leg;
  leg.path = path;
  leg.path.sequence = job.block.sequence;
  leg.path.line = job.block.line;
  leg.path.epoch = cursor.epoch;
  const bool is_pole_turn = path.kind == PathKind::kTurn && job.motion != MotionKind::kRewind;
  leg.path.motion = is_pole_turn ? MotionKind::kPoleTurn : job.motion;
  leg.path.tool_length_mm = cursor.tool_length_mm;
  leg.feed_mm_per_s = job.feed_mm_per_s;
  leg.share_per_s = share > 0 ? job.share_per_s / share : 0;
  leg.feed_factor = job.feed_factor;
  leg.window = cursor.window;
  return legs_.plan(leg, out, cursor.joints);
}

PathFault Router::run_held(PathPiece path, double free_end, const Job& job, double share,
                           PlanCursor& cursor, Staging& out) noexcept {
  if (!(path.length > kNoTip_mm)) return {};
  path.is_free_driven = true;
  path.free_begin = cursor.joints[redundant_joint(model_)];
  path.free_end = free_end;
  return run(path, job, share, cursor, out);
}

PathFault Router::run_lift(const PathPiece& path, const Job& job, PlanCursor& cursor,
                           Staging& out) noexcept {
  const int free = redundant_joint(model_);
  if (free >= 0) return run_held(path, cursor.joints[free], job, kWhole, cursor, out);
  if (job.motion != MotionKind::kApproach || model_.family != MachineFamily::kRobot) {
    return run_solved(path, job, kWhole, cursor, out);
  }
  // A robot may lift off beside a singular place: slowly at first, and with rests faster and
  // faster.
  constexpr std::array kParts{0.0, 1.0 / 64, 1.0 / 16, 1.0 / 4, 1.0};
  const int branch = branch_of(pose_at(path, 0.0), cursor.joints, cursor.tool_length_mm);
  const auto is_near = [&](double s) {
    return is_near_singularity({model_, cursor.tool_length_mm, branch, cursor.joints},
                               pose_at(path, s));
  };
  const bool begins_near = is_near(0), ends_near = is_near(path.length);
  if (!begins_near && !ends_near) return run_solved(path, job, kWhole, cursor, out);
  for (std::size_t n = 1; n < kParts.size(); ++n) {
    const double from = begins_near ? kParts[n - 1] : 1 - kParts[kParts.size() - n];
    const double to = begins_near ? kParts[n] : 1 - kParts[kParts.size() - 1 - n];
    const PathFault fault = run_solved(cut_piece(path, from, to), job, to - from, cursor, out);
    if (is_fault(fault)) return fault;
  }
  return {};
}

/// The branch that gives `joints` back at `pose`.
int Router::branch_of(const ToolPose& pose, const JointVector& joints,
                      double tool_length_mm) const noexcept {
  int best = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (int branch = 0; branch < branch_count(model_); ++branch) {
    const auto at = solve(model_, tool_length_mm, pose, branch, joints);
    if (at.status == SolveStatus::kUnreachable) continue;
    double distance = 0;
    for (int i = 0; i < model_.joint_count; ++i) {
      distance = std::max(distance, std::abs(at.q[i] - joints[i]));
    }
    if (distance < nearest) {
      nearest = distance;
      best = branch;
    }
  }
  return best;
}

Solution<double> Router::solve_near(const ToolPose& pose, const JointVector& joints,
                                    double tool_length_mm) const noexcept {
  const int free = redundant_joint(model_);
  if (free >= 0) return solve_held(model_, tool_length_mm, pose, joints[free]);
  return solve(model_, tool_length_mm, pose, branch_of(pose, joints, tool_length_mm), joints);
}

PathFault Router::run_solved(PathPiece path, const Job& job, double share, PlanCursor& cursor,
                             Staging& out) noexcept {
  path.branch = static_cast<std::uint8_t>(
      branch_of(pose_at(path, 0.0), cursor.joints, cursor.tool_length_mm));
  return run(path, job, share, cursor, out);
}

PathFault Router::pass_in_cone(const PathPiece& path, const ToolPose& end, double share, Job job,
                               const Begin& begin, PlanCursor& cursor, Staging& out) noexcept {
  const double own_s = out.duration_since(begin.mark), own_rad = deviation_rad_;
  out.go_back(begin.mark);
  job.on_pole_rad = free_cone_rad_;
  PlanCursor trial = begin.cursor;
  const PathFault fault = pass_pole(path, end, share, job, trial, out);
  if (!is_fault(fault) && out.duration_since(begin.mark) < own_s) {
    cursor = trial;
    return {};
  }
  out.go_back(begin.mark);
  deviation_rad_ = own_rad;
  cursor = begin.cursor;
  return run_solved(path, job, kWhole, cursor, out);
}

PathFault Router::route_past_pole(const PathPiece& path, const ToolPose& end, const Job& job,
                                  PlanCursor& cursor, Staging& out) noexcept {
  const int free = redundant_joint(model_);
  const PolePassage passage = find_passage(path, find_nearest_pole(model_, cursor.pose.axis));
  const double share = passage.nearest_turn / path.axis_turn;
  const bool is_nearest_inside = share > 0 && share < 1;
  const bool passes = is_nearest_inside && passage.offset < job.on_pole_rad;
  const PlanCursor rest = cursor;
  const Staging::Mark mark = out.mark();
  PathFault fault = passes ? pass_pole(path, end, share, job, cursor, out)
                           : run_solved(path, job, kWhole, cursor, out);
  const bool is_out = fault.kind == PathFault::Kind::kTravel && fault.joint == free;
  const bool begins_in_cone = pole_distance(model_, rest.pose.axis) < free_cone_rad_;
  const bool may_pass =
      is_nearest_inside && !passes && !(job.share_per_s > 0) && passage.offset < free_cone_rad_;
  if (is_out && begins_in_cone) {
    out.go_back(mark);
    cursor = rest;
    fault = leave_otherwise(path, end, job, fault, cursor, out);
  } else if (begins_in_cone && may_pass && !is_fault(fault)) {
    fault = pass_in_cone(path, end, share, job, {rest, mark}, cursor, out);
  }
  return fault;
}

PathFault Router::route(const ClBlock& block, PlanCursor& cursor, Staging& out) noexcept {
  deviation_rad_ = 0;
  needs_ahead_ = false;
  Job job = job_of(block);
  const bool is_timed = job.share_per_s > 0;
  const Vector3 programmed = to_vector(block.axis);
  if (on_pole_rad_ > kPoleDeviation_rad && (!is_timed || is_at_pole(cursor.pose.axis))) {
    const bool is_fixed = angle_between(cursor.pose.axis, programmed) < kNoTurn_rad;
    if (!is_fixed) job.on_pole_rad = on_pole_rad_;
  }
  const ToolPose end{to_vector(block.tip_mm), relaxed(programmed, job.on_pole_rad)};
  PathPiece path = block.is_arc ? make_arc(cursor.pose, end, block) : make_line(cursor.pose, end);
  if (path.axis_turn < kNoTurn_rad) {
    path = with_axes(path, cursor.pose.axis, cursor.pose.axis);
    path.axis_turn = 0;
  }
  const double before_mm_per_s = cursor.cut_mm_per_s;
  cursor.cut_mm_per_s = is_timed                         ? job.share_per_s * tip_length(path)
                        : job.motion == MotionKind::kCut ? job.feed_mm_per_s
                                                         : 0;
  if (is_timed && cursor.relaxed_from) {
    job.share_per_s = bound_turn(path, angle_between(*cursor.relaxed_from, programmed),
                                 before_mm_per_s, job.share_per_s);
  }
  cursor.relaxed_from = deviation_rad_ > 0 ? std::optional(programmed) : std::nullopt;
  if (!(path.length > kNoTip_mm)) return {};
  const int free = redundant_joint(model_);
  PathFault fault;
  if (path.axis_turn == 0) {
    fault = run_lift(path, job, cursor, out);
    cursor.pose.tip = end.tip;
    return fault;
  }
  if (free < 0) {
    fault = run_solved(path, job, kWhole, cursor, out);
  } else if (is_at_pole(cursor.pose.axis)) {
    fault = leave_pole(path, end, job, cursor, out);
  } else if (is_at_pole(end.axis)) {
    fault = enter_pole(path, job, kWhole, cursor, out);
  } else {
    fault = route_past_pole(path, end, job, cursor, out);
  }
  cursor.pose = end;
  return fault;
}

}  // namespace meridian
