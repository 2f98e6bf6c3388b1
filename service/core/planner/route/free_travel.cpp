// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/free_travel.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/joint_cells.hpp"
#include "service/core/planner/singular/pole_bounds.hpp"

namespace meridian {
namespace {

constexpr int kTravelSteps = 8;
constexpr double kMargin_rad = 1e-4;
constexpr double kNoWay_rad = 1e-9;  // a joint at the end of travel that leaves it is inside
constexpr double kMinShare = 1e-6;

}  // namespace

JointVector FreeTravel::turned(double by) const noexcept {
  JointVector joints = at_;
  joints[redundant_joint(model_)] += by;
  return joints;
}

FreeTravel::Way FreeTravel::walk(const JointSpan& span, const JointVector& joints,
                                 double by) const noexcept {
  const int free = redundant_joint(model_);
  const double length = span.band.length;
  Way way;
  way.end = joints;
  way.begin = way.low = way.high = way.end[free];
  double step = length / kTravelSteps, last_step = 0, last_slope = 0, bend = 0;
  for (double x = 0; x < length;) {
    const double next = std::min(length, x + step);
    const ToolPose pose = pose_on(span.band.c, next);
    const auto there =
        span.is_free_driven
            ? solve_held(model_, tool_length_mm_, pose, quintic_at(span.free, next / length) + by)
            : solve(model_, tool_length_mm_, pose, span.branch, way.end);
    way.is_there = there.status != SolveStatus::kUnreachable;
    if (!way.is_there) return way;
    const double turn = there.q[free] - way.end[free];
    if (std::abs(turn) > kMaxFollowed_rad && step > kMinShare * length) {
      step *= 0.5;
      continue;
    }
    const double slope = turn / (next - x);
    if (x > 0) bend = std::max(bend, std::abs(slope - last_slope) * std::max(step, last_step));
    way.is_inside &= first_joint_outside_travel(model_, there.q, kTravelMargin) < 0;
    way.low = std::min(way.low, there.q[free]);
    way.high = std::max(way.high, there.q[free]);
    way.end = there.q;
    x = next;
    last_slope = slope;
    last_step = step;
    step = std::min(2 * step, length / kTravelSteps);
  }
  way.margin = kMargin_rad + 0.5 * bend;
  return way;
}

std::optional<double> FreeTravel::find_outside(const Way& way) const noexcept {
  const JointLimits& limits = model_.joints[redundant_joint(model_)].limits;
  const double high = way.high + way.margin, low = way.low - way.margin;
  if (way.high > way.begin + kNoWay_rad && high > limits.travel_max) return high;
  if (way.low < way.begin - kNoWay_rad && low < limits.travel_min) return low;
  return {};
}

std::optional<double> FreeTravel::follow(const JointSpan& span) noexcept {
  const Way way = walk(span, at_, 0);
  if (!way.is_there) return {};  // the feed finds it too
  const auto outside = find_outside(way);
  if (!outside) at_ = way.end;
  return outside;
}

bool FreeTravel::fits(const JointSpan& span, double by) const noexcept {
  const Way way = walk(span, turned(by), by);
  return way.is_there && way.is_inside && !find_outside(way);
}

bool FreeTravel::fits_from(const JointVector& joints, const JointSpan& span) const noexcept {
  const Way way = walk(span, joints, 0);
  return way.is_there && way.is_inside && !find_outside(way);
}

}  // namespace meridian
