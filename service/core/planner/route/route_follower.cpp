// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/route_follower.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/geometry/unit_vector.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/kinematics/travel.hpp"
#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/route/rewind_solutions.hpp"
#include "service/core/planner/singular/pole/pole_bounds.hpp"

namespace meridian {
namespace {

constexpr double kStepShare = 0.3;     // of the distance to the pole, that the axis turns at once
constexpr double kMaxStep_rad = 0.05;  // more would miss where slides turn round
constexpr double kArcStep_rad = 0.1;   // of an arc
constexpr double kMinPole_rad = 1e-3;
constexpr int kMaxSteps = 256;  // per block
constexpr double kBend = 1.5;   // of the joints over the slack: it ends well outside of the pole

/// Whether a route that came to `end` may still turn out otherwise.
bool is_open(RouteEnd end) noexcept { return end == RouteEnd::kNone || end == RouteEnd::kDoubt; }

}  // namespace

RouteFollower::RouteFollower(const MachineModel& model, double tool_length_mm,
                             const LookAheadSlack& slack, int branch, const ToolPose& start,
                             std::span<RouteAhead> routes) noexcept
    : model_(model),
      tool_length_mm_(tool_length_mm),
      slack_(slack),
      branch_(branch),
      free_(redundant_joint(model)),
      pole_rad_(
          std::max(kZoneTolerances * std::max(axis_tolerance_beside_pole(model), slack.axis_rad),
                   kMinPole_rad)),
      pose_(start),
      routes_(routes) {
  const auto at = solve(model_, tool_length_mm_, start, branch_, JointVector{});
  const double distance = pole_distance(model_, start.axis);
  is_over_ = at.status != SolveStatus::kOk || distance < kPoleDeviation_rad;
  has_left_pole_ = distance >= pole_rad_;
  is_branch_certain_ = has_left_pole_ || !(slack.axis_rad > 0);
  joints_ = at.q;
  begin_ = joints_[free_];
}

void RouteFollower::follow(const ClBlock& block) noexcept {
  block_ = &block;
  is_tool_known_ &= block.kind != BlockKind::kTool;
  if (is_motion(block.kind)) run(block);
  if (is_over_) return;
  for (RouteAhead& route : routes_) {
    if (route.branch != branch_ || route.end != RouteEnd::kNone) continue;
    ++route.carries;
    route.time_s = time_s_;
  }
}

void RouteFollower::run(const ClBlock& block) noexcept {
  const auto unit = UnitVector3::near_unit(to_vector(block.axis));
  const ToolPose end{to_vector(block.tip_mm), unit ? unit->vector() : Vector3::UnitZ()};
  if (!unit || !end.tip.allFinite()) {
    is_over_ = true;
    return;
  }
  const PathPiece path = block.is_arc ? make_arc(pose_, end, block) : make_line(pose_, end);
  pose_ = end;
  if (!(path.length > 0)) return;
  const double feed_s = feed_time_s(path, block);
  const double arc_steps = block.is_arc ? std::abs(block.sweep_rad) / kArcStep_rad : 1;
  double share = 0;
  for (int n = 0; share < 1 && !is_over_; ++n) {
    const double turn = std::min(
        kMaxStep_rad, kStepShare * pole_distance(model_, pose_at(path, share * path.length).axis));
    const double by =
        std::min(1 / std::max(1.0, arc_steps), path.axis_turn > turn ? turn / path.axis_turn : 1.0);
    const double next = std::min(1.0, share + by);
    is_over_ =
        n == kMaxSteps || !put_at(pose_at(path, next * path.length), (next - share) * feed_s);
    share = next;
  }
}

double RouteFollower::feed_time_s(const PathPiece& path, const ClBlock& block) const noexcept {
  if (block.kind != BlockKind::kCut || !(block.feed > 0)) return 0;
  return block.feed_meaning == FeedMeaning::kTip ? tip_length(path) / block.feed : 1 / block.feed;
}

bool RouteFollower::put_at(const ToolPose& pose, double feed_s) noexcept {
  const auto at = solve(model_, tool_length_mm_, pose, branch_, joints_);
  const double distance = pole_distance(model_, pose.axis);
  has_left_pole_ |= distance >= pole_rad_;
  const double nearest = has_left_pole_ ? pole_rad_ : kPoleDeviation_rad;
  if (at.status != SolveStatus::kOk || distance < nearest) return false;
  double time_s = feed_s;
  for (int i = 0; i < model_.joint_count; ++i) {
    time_s = std::max(time_s, std::abs(at.q[i] - joints_[i]) / model_.joints[i].limits.velocity);
  }
  time_s_ += time_s;
  joints_ = at.q;
  bool is_any_left = false;
  for (RouteAhead& route : routes_) {
    if (route.branch != branch_) continue;
    if (is_open(route.end)) check(pose, route);
    is_any_left |= is_open(route.end);
  }
  return is_any_left;
}

void RouteFollower::check(const ToolPose& pose, RouteAhead& route) const noexcept {
  JointVector all = joints_;
  all[free_] += route.free - begin_;
  const int joint = first_outside(all);
  if (joint < 0) {
    if (has_boxes(model_) && is_tool_known_ && is_at_box(all)) route.end = RouteEnd::kDoubt;
    return;
  }
  route.end = may_rewind(joint, pose) ? RouteEnd::kRewinds : RouteEnd::kDoubt;
  if (route.end == RouteEnd::kRewinds) return;
  const double value = limited_value(model_, all, joint);
  const JointLimits& limits = limited_spec(model_, joint).limits;
  const double beyond = std::max(value - limits.travel_max, limits.travel_min - value);
  if (!is_branch_certain_ || !(beyond > spread_of(joint, pose))) return;
  route.end = RouteEnd::kLost;
  route.lost = {block_->sequence, block_->line, RejectCode::kTravelBetween, joint, value};
}

bool RouteFollower::may_rewind(int joint, const ToolPose& pose) const noexcept {
  if (model_.rewind_policy != RewindPolicy::kRetract) return false;
  const JointLimits& limits = model_.joints[free_].limits;
  if (joint == free_ && limits.travel_max - limits.travel_min >= kTurn_rad) return true;
  const auto other = solve_other_branch(model_, tool_length_mm_, pose, branch_, joints_);
  return other && first_outside(*other) < 0;
}

bool RouteFollower::is_at_box(const JointVector& all) const noexcept {
  return keep_out_at(model_.keep_out, all) >= 0 ||
         tip_axis_outside(model_, tool_length_mm_, all) >= 0;
}

int RouteFollower::first_outside(const JointVector& all) const noexcept {
  if (is_tool_known_) return first_joint_outside_travel(model_, all, kTravelMargin);
  for (int i = 0; i < model_.joint_count; ++i) {
    if (model_.joints[i].is_rotary && !is_inside_travel(model_.joints[i], all[i], kTravelMargin))
      return i;
  }
  return -1;
}

double RouteFollower::spread_of(int joint, const ToolPose& pose) const noexcept {
  const double here = limited_value(model_, joints_, joint);
  double sum = 0;
  const auto add = [&](const ToolPose& beside) {
    const auto at = solve(model_, tool_length_mm_, beside, branch_, joints_);
    sum += at.status == SolveStatus::kOk ? std::abs(limited_value(model_, at.q, joint) - here)
                                         : std::numeric_limits<double>::infinity();
  };
  const Vector3 across = pose.axis.unitOrthogonal();
  for (const Vector3& route : {across, Vector3(pose.axis.cross(across))}) {
    add({pose.tip, (pose.axis + std::tan(slack_.axis_rad) * route).normalized()});
  }
  for (int i = 0; i < 3; ++i) add({pose.tip + slack_.tip_mm * Vector3::Unit(i), pose.axis});
  return kBend * sum;
}

}  // namespace meridian
