// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "service/core/planner/route/router.hpp"

/// Ways to, from and over the pole. Part of Router.
namespace meridian {
namespace {

constexpr double kSameFree_rad = 1e-9;  // azimuths that differ less need no turn on the pole
constexpr double kNearPole_rad = 2e-3;  // nearer the redundant joint is held on oblique routes

}  // namespace

PathFault Router::turn_free(const ToolPose& pose, double free_end, const Job& job,
                            PlanCursor& cursor, Staging& out) noexcept {
  const double free = cursor.joints[redundant_joint(model_)];
  if (std::abs(free_end - free) < kSameFree_rad) return {};
  return run(make_turn(pose, free, free_end), job, kNoPart, cursor, out);
}

double Router::follow_back(PathPiece path, const JointVector& end, double share,
                           double tool_length_mm) const noexcept {
  path.tool_length_mm = tool_length_mm;
  path.branch =
      static_cast<std::uint8_t>(branch_of(pose_at(path, path.length), end, tool_length_mm));
  constexpr int kSteps = 64;
  JointVector q = end;
  for (int n = 1; n <= kSteps; ++n) {
    q = joints_at(model_, path, path.length * (1 - (1 - share) * n / kSteps), q).q;
  }
  return q[redundant_joint(model_)];
}

// Orthogonal machines run straight to and from the pole with the redundant joint at rest. Where the
// other joint is oblique (nutating machines), the redundant joint turns on the way. It then follows
// the path but for the last kNearPole_rad, where holding it leaves the great circle by a quarter of
// that squared, 1e-6 rad, times the turn per tilt.
PathFault Router::enter_pole(const PathPiece& path, const Job& job, double share,
                             PlanCursor& cursor, Staging& out) noexcept {
  const int free = redundant_joint(model_);
  const bool is_near = path.axis_turn <= kNearPole_rad;
  if (is_near || is_straight_passage(path, cursor.joints[free], cursor, kPoleDeviation_rad)) {
    return run_held(path, cursor.joints[free], job, share, cursor, out);
  }
  const double far = 1 - kNearPole_rad / path.axis_turn;
  PathFault fault = run_solved(cut_piece(path, 0, far), job, share * far, cursor, out);
  if (is_fault(fault)) return fault;
  const PathPiece last = cut_piece(path, far, 1);
  // Keeps account of the axis deviation.
  (void)is_straight_passage(last, cursor.joints[free], cursor, kPoleDeviation_rad);
  return run_held(last, cursor.joints[free], job, share * (1 - far), cursor, out);
}

PathFault Router::leave_pole_by(const PathPiece& path, const JointVector& end, const Job& job,
                                PlanCursor& cursor, Staging& out) noexcept {
  const int free = redundant_joint(model_);
  const ToolPose pole = pose_at(path, 0.0);
  PlanCursor turned = cursor;
  turned.joints[free] = end[free];
  const bool is_near = path.axis_turn <= kNearPole_rad;
  if (is_near || is_straight_passage(path, end[free], turned, kPoleDeviation_rad)) {
    // What is too little for a turn is made on the route: it ends on the joints of its end, exactly.
    const PathFault fault = turn_free(pole, end[free], job, cursor, out);
    return is_fault(fault) ? fault : run_held(path, end[free], job, kWhole, cursor, out);
  }
  const double near = kNearPole_rad / path.axis_turn;
  const double limit = follow_back(path, end, near, cursor.tool_length_mm);
  PathFault fault = turn_free(pole, limit, job, cursor, out);
  if (is_fault(fault)) return fault;
  const PathPiece first = cut_piece(path, 0, near);
  (void)is_straight_passage(first, cursor.joints[free], cursor, kPoleDeviation_rad);
  fault = run_held(first, cursor.joints[free], job, near, cursor, out);
  if (is_fault(fault)) return fault;
  return run_solved(cut_piece(path, near, 1), job, 1 - near, cursor, out);
}

PathFault Router::leave_pole(const PathPiece& path, const ToolPose& end, const Job& job,
                             PlanCursor& cursor, Staging& out) noexcept {
  Candidates candidates = find_candidates(end, cursor);
  look_past(job.block, end, cursor.tool_length_mm, candidates);
  PathFault first{PathFault::Kind::kUnreachable, -1, 0};
  if (candidates.count == 0) {
    const auto at = solve(model_, cursor.tool_length_mm, end, 0, cursor.joints);
    const int joint = first_joint_outside_travel(model_, at.q, 1e-9);
    if (joint >= 0) first = {PathFault::Kind::kTravel, joint, limited_value(model_, at.q, joint)};
  }
  for (int n = 0; n < candidates.count; ++n) {
    PlanCursor trial = cursor;
    const Staging::Mark mark = out.mark();
    const PathFault fault = leave_pole_by(path, candidates.candidate[n].joints, job, trial, out);
    if (!is_fault(fault)) {
      cursor = trial;
      return {};
    }
    out.go_back(mark);
    if (n == 0) first = fault;
  }
  return first;
}

PathFault Router::leave_otherwise(const PathPiece& path, const ToolPose& end, const Job& job,
                                  const PathFault& fault, PlanCursor& cursor,
                                  Staging& out) noexcept {
  Candidates candidates = find_candidates(end, cursor);
  look_past(job.block, end, cursor.tool_length_mm, candidates);
  const ToolPose rest = pose_at(path, 0.0);
  for (int n = 0; n < candidates.count; ++n) {
    const JointVector& joints = candidates.candidate[n].joints;
    PlanCursor trial = cursor;
    const Staging::Mark mark = out.mark();
    const double free = follow_back(path, joints, 0.0, cursor.tool_length_mm);
    if (!is_fault(turn_free(rest, free, job, trial, out)) &&
        !is_fault(run_solved(path, job, 1.0, trial, out))) {
      deviation_rad_ = std::max(deviation_rad_, pole_distance(model_, rest.axis));
      cursor = trial;
      return {};
    }
    out.go_back(mark);
  }
  return fault;
}

bool Router::is_straight_passage(const PathPiece& path, double free_end, const PlanCursor& cursor,
                                 double tolerance_rad) noexcept {
  PathPiece held = path;
  held.is_free_driven = true;
  held.free_begin = cursor.joints[redundant_joint(model_)];
  held.free_end = free_end;
  held.tool_length_mm = cursor.tool_length_mm;
  constexpr int kSamples = 64;
  double largest = 0;
  for (int n = 0; n <= kSamples; ++n) {
    const double s = held.length * n / kSamples;
    const auto at = joints_at(model_, held, s, cursor.joints);
    const Vector3 axis = forward(model_, held.tool_length_mm, at.q).axis;
    largest = std::max(largest, angle_between(axis, pose_at(held, s).axis));
  }
  if (largest > tolerance_rad) return false;
  deviation_rad_ = std::max(deviation_rad_, largest);
  return true;
}

PathFault Router::pass_pole(const PathPiece& path, const ToolPose& end, double share,
                            const Job& job, PlanCursor& cursor, Staging& out) noexcept {
  Candidates candidates = find_candidates(end, cursor);
  look_past(job.block, end, cursor.tool_length_mm, candidates);
  const int free = redundant_joint(model_);
  for (int n = 0;
       n < candidates.count && candidates.candidate[n].carries == candidates.candidate[0].carries;
       ++n) {
    const double free_end = candidates.candidate[n].joints[free];
    if (!is_straight_passage(path, free_end, cursor, job.on_pole_rad)) continue;
    PlanCursor trial = cursor;
    const Staging::Mark mark = out.mark();
    const PathFault fault = run_held(path, free_end, job, 1.0, trial, out);
    if (!is_fault(fault)) {
      cursor = trial;
      return {};
    }
    out.go_back(mark);
  }
  // Over the pole itself, where the redundant joint may be turned at rest.
  const Vector3 begin_axis = to_vector(path.axis_begin);
  const Vector3 pole = find_nearest_pole(model_, begin_axis);
  deviation_rad_ = std::max(deviation_rad_, find_passage(path, pole).offset);
  const PathPiece there = with_axes(cut_piece(path, 0, share), begin_axis, pole);
  const PathPiece back = with_axes(cut_piece(path, share, 1), pole, end.axis);
  const Staging::Mark mark = out.mark();
  PlanCursor trial = cursor;
  PathFault fault = enter_pole(there, job, share, trial, out);
  if (!is_fault(fault)) {
    Job rest = job;
    rest.share_per_s = job.share_per_s / (1 - share);
    fault = leave_pole(back, end, rest, trial, out);
  }
  if (is_fault(fault)) {
    out.go_back(mark);
    return fault;
  }
  cursor = trial;
  return {};
}

}  // namespace meridian
