// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/span_travel.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/travel.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/route/rewind_solutions.hpp"
#include "service/core/planner/singular/pole/pole_bounds.hpp"

namespace meridian {
namespace {

constexpr int kTravelSteps = 8;
constexpr double kMargin_rad = 1e-4;
constexpr double kNoMotion_rad = 1e-9;  // a joint at the end of travel that leaves it is inside
constexpr double kMinShare = 1e-6;

}  // namespace

JointVector SpanTravel::turned(double by) const noexcept {
  JointVector joints = at_;
  joints[redundant_joint(model_)] += by;
  return joints;
}

SpanTravel::Walk SpanTravel::walk(const JointSpan& span, const JointVector& joints,
                                  double by) const noexcept {
  const int free = redundant_joint(model_);
  const double length = span.band.length;
  Walk walked;
  walked.end = joints;
  walked.begin = walked.low = walked.high = walked.end[free];
  double step = length / kTravelSteps, last_step = 0, last_slope = 0, bend = 0;
  for (double x = 0; x < length;) {
    const double next = std::min(length, x + step);
    const ToolPose pose = pose_on(span.band.c, next);
    const auto there =
        span.is_free_driven
            ? solve_held(model_, tool_length_mm_, pose, quintic_at(span.free, next / length) + by)
            : solve(model_, tool_length_mm_, pose, span.branch, walked.end);
    walked.is_there = there.status != SolveStatus::kUnreachable;
    if (!walked.is_there) return walked;
    const double turn = there.q[free] - walked.end[free];
    if (std::abs(turn) > kMaxFollowed_rad && step > kMinShare * length) {
      step *= 0.5;
      continue;
    }
    const double slope = turn / (next - x);
    if (x > 0) bend = std::max(bend, std::abs(slope - last_slope) * std::max(step, last_step));
    note_outside(next, there.q, walked);
    walked.low = std::min(walked.low, there.q[free]);
    walked.high = std::max(walked.high, there.q[free]);
    walked.end = there.q;
    x = next;
    last_slope = slope;
    last_step = step;
    step = std::min(2 * step, length / kTravelSteps);
  }
  walked.margin = kMargin_rad + 0.5 * bend;
  return walked;
}

void SpanTravel::note_outside(double x, const JointVector& joints, Walk& walked) const noexcept {
  if (!walked.is_inside()) return;
  const int joint = first_joint_outside_travel(model_, joints, kTravelMargin);
  if (joint < 0) return;
  walked.outside = {joint, limited_value(model_, joints, joint)};
  walked.outside_x = x;
  walked.outside_at = joints;
}

std::optional<TravelEnd> SpanTravel::find_outside(const Walk& walked) const noexcept {
  const int free = redundant_joint(model_);
  if (model_.joints[free].is_endless) return {};
  const JointLimits& limits = model_.joints[free].limits;
  const double high = walked.high + walked.margin, low = walked.low - walked.margin;
  if (walked.high > walked.begin + kNoMotion_rad && high > limits.travel_max) {
    return TravelEnd{free, high};
  }
  if (walked.low < walked.begin - kNoMotion_rad && low < limits.travel_min) {
    return TravelEnd{free, low};
  }
  return {};
}

bool SpanTravel::is_other_branch_inside(const JointSpan& span, const Walk& walked) const noexcept {
  const bool is_kept_by_branch = !walked.is_inside() && !span.is_free_driven &&
                                 walked.outside.joint != redundant_joint(model_);
  if (!is_kept_by_branch) return false;
  const ToolPose pose = pose_on(span.band.c, walked.outside_x);
  const auto other =
      solve_other_branch(model_, tool_length_mm_, pose, span.branch, walked.outside_at);
  return other && first_joint_outside_travel(model_, *other, kTravelMargin) < 0;
}

std::optional<TravelEnd> SpanTravel::follow(const JointSpan& span) noexcept {
  const Walk walked = walk(span, at_, 0);
  if (!walked.is_there) return {};  // the feed finds it too
  if (const auto outside = find_outside(walked)) return outside;
  if (is_other_branch_inside(span, walked)) return walked.outside;
  at_ = walked.end;
  return {};
}

bool SpanTravel::fits(const JointSpan& span, double by) const noexcept {
  const Walk walked = walk(span, turned(by), by);
  return walked.is_there && walked.is_inside() && !find_outside(walked);
}

bool SpanTravel::fits_from(const JointVector& joints, const JointSpan& span) const noexcept {
  const Walk walked = walk(span, joints, 0);
  return walked.is_there && walked.is_inside() && !find_outside(walked);
}

}  // namespace meridian
