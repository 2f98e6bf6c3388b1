// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/look_ahead/smooth_workspace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/geometry/unit_vector.hpp"
#include "meridian/kinematics/solve_driven.hpp"
#include "meridian/path/build_piece.hpp"
#include "service/core/planner/singular/robot/robot_pass.hpp"

namespace meridian {
namespace {

constexpr double kLingerShare = 0.9;  // of the axis tolerance: the redundant joint may be anywhere
constexpr double kBesidePole_rad = 0.05;  // kSameAxis turns the redundant joint by 2e-12 rad there
/// Rounding of joints, in their pose. What is farther off would be a step of the setpoints.
constexpr double kSameTip_mm = 1e-10, kSameAxis = 1e-13;

}  // namespace

BandTolerance SmoothPlanner::Workspace::tolerance() const noexcept {
  BandTolerance out;
  out.tip_mm = settings.tip_tolerance_mm > 0 ? settings.tip_tolerance_mm : model.tolerances.tip_mm;
  out.axis_rad =
      settings.axis_tolerance_rad > 0 ? settings.axis_tolerance_rad : model.tolerances.axis_rad;
  out.tip_mm = std::max(out.tip_mm, kMinTipTolerance_mm);
  out.axis_rad = std::max(axis_left_rad(out.axis_rad), kMinAxisTolerance_rad);
  const bool relaxed_axes = redundant_joint(model) >= 0 && model.pole_policy == PolePolicy::kRelax;
  if (relaxed_axes) out.pole = to_array(pole_direction(model));
  return out;
}

std::optional<ClBlock> SmoothPlanner::Workspace::smoothable(ClBlock block) const noexcept {
  if (!is_smooth() && model.family != MachineFamily::kRobot) return {};
  if (block.kind != BlockKind::kCut || plain.junction().is_first) return {};
  if (is_retried(block)) return {};
  if (block.feed_meaning == FeedMeaning::kNone || !(block.feed > 0)) return {};
  const auto unit = UnitVector3::near_unit(to_vector(block.axis));
  if (!unit || !to_vector(block.tip_mm).allFinite()) return {};
  Vector3 axis = unit->vector();
  if (block.feed_meaning == FeedMeaning::kTip && model.max_feed_mm_per_s > 0) {
    block.feed = std::min(block.feed, model.max_feed_mm_per_s);
  }
  if (redundant_joint(model) >= 0 && pole_distance(model, axis) < kPoleDeviation_rad) {
    axis = find_nearest_pole(model, axis);
  }
  block.axis = to_array(axis);
  if (!is_smooth()) {
    const RestToRestPlanner::Junction at = plain.junction();
    const PassCourse course{model, at.tool_length_mm, find_branch(at), at.joints};
    if (!comes_near_singularity(course, pose, block)) return {};
  }
  // Runs go through the pole and linger on it, or stay on it all the way with the axis fixed. What
  // leads off it from rest, out of the tolerance, is done at rest, where the redundant joint can
  // turn.
  const bool starts_on_pole = is_on_pole(pose.axis);
  const bool may_linger = model.pole_policy == PolePolicy::kRelax;
  if (axis == pose.axis) {
    const bool may_go_on = !starts_on_pole || running != Running::kThrough || may_linger;
    return may_go_on ? std::optional(block) : std::nullopt;
  }
  if (!find_great_circle(pose.axis, axis).is_unique) return {};
  if (running == Running::kOnPole) return {};
  const bool stays_close = pole_distance(model, axis) < kLingerShare * tolerance().axis_rad;
  if (starts_on_pole && !is_running() && !(may_linger && stays_close)) return {};
  return block;
}

bool SmoothPlanner::Workspace::is_on_pole(const Vector3& axis) const noexcept {
  return redundant_joint(model) >= 0 &&
         pole_distance(model, axis) < kOnPoleTolerances * tolerance().axis_rad;
}

int SmoothPlanner::Workspace::find_branch(const RestToRestPlanner::Junction& at) const noexcept {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const auto off = [&](const Solution<double>& found) {
    if (found.status == SolveStatus::kUnreachable) return kInfinite;
    double farthest = 0;
    for (int i = 0; i < model.joint_count; ++i) {
      farthest = std::max(farthest, std::abs(found.q[i] - at.joints[i]));
    }
    return farthest;
  };
  // Over the base axis the yaw may stand anywhere: of the others first.
  const double from_axis_mm =
      singular_distance(model, at.tool_length_mm, Singularity::kShoulder, at.pose, 0, at.joints);
  const bool is_over_base = from_axis_mm < tolerance().tip_mm;
  std::pair nearest{kInfinite, kInfinite};
  int best = 0;
  for (int branch = 0; branch < branch_count(model); ++branch) {
    const double with_yaw =
        is_over_base ? off(solve_driven(model, at.tool_length_mm, at.pose, at.joints[robot::kYaw],
                                        branch | robot::kYawDriven, at.joints))
                     : 0;
    const std::pair here{with_yaw,
                         off(solve(model, at.tool_length_mm, at.pose, branch, at.joints))};
    if (here < nearest) {
      nearest = here;
      best = branch;
    }
  }
  return best;
}

void SmoothPlanner::Workspace::begin_run(const ClBlock& cut) noexcept {
  const RestToRestPlanner::Junction at = plain.junction();
  RunStart start;
  start.pose = at.pose;
  start.programmed = programmed;
  start.joints = at.joints;
  start.tool_length_mm = at.tool_length_mm;
  start.epoch = at.epoch;
  start.path_index = at.path_index;
  start.window = at.window;
  start.branch = find_branch(at);
  start.is_on_pole = is_on_pole(pose.axis) && to_vector(cut.axis) == pose.axis;
  BandTolerance path = tolerance();
  if (!is_smooth()) path.axis_rad = kMinAxisTolerance_rad;  // of long turns; the tip is exact
  run.begin(start, path, pole_tolerance_rad());
  running = start.is_on_pole ? Running::kOnPole : Running::kThrough;
}

void SmoothPlanner::Workspace::end_run() noexcept {
  RestToRestPlanner::Junction at = plain.junction();
  at.joints = joints = run.joints();
  // Relaxed beside the pole, or behind a block too short for a span, the tool is not quite where
  // the last block put it: what follows starts from where it is. Beside the pole rounding of the
  // axis alone turns the redundant joint.
  const ToolPose there = forward(model, at.tool_length_mm, joints);
  const double from_pole = redundant_joint(model) >= 0 ? pole_distance(model, pose.axis) : 1;
  const bool is_beside_pole = from_pole >= kPoleDeviation_rad && from_pole < kBesidePole_rad;
  const bool is_same =
      (there.tip - pose.tip).norm() <= kSameTip_mm && (there.axis - pose.axis).norm() <= kSameAxis;
  if (is_beside_pole || !is_same) pose = there;
  at.pose = pose;
  at.path_index = run.next_path_index();
  at.window = run.next_window();
  plain.continue_at(at);
  running = Running::kNone;
}

SmoothRun::Status SmoothPlanner::Workspace::publish(MotionWriter& writer,
                                                    const ClBlock* last) noexcept {
  for (;;) {
    const SmoothRun::Status status = run.publish(writer);
    if (status == SmoothRun::Status::kRewind) {
      if (!refusal && rewind(writer)) continue;
      return refusal ? SmoothRun::Status::kFailed : SmoothRun::Status::kNoRoom;
    }
    if (!run.has_fault() || refusal) return status;
    if (!may_retry(last)) {
      refuse({PlanStatus::kRefused, fault_of_run(), 0, {}});
    } else if (last == nullptr && status == SmoothRun::Status::kFailed) {
      go_back();
      return SmoothRun::Status::kNoRoom;
    }
    return status;
  }
}

bool SmoothPlanner::Workspace::rewind(MotionWriter& writer) noexcept {
  if (awaits_ahead()) return false;
  RestToRestPlanner::Junction at = plain.junction();
  at.joints = run.joints();
  at.pose = forward(model, at.tool_length_mm, at.joints);
  at.path_index = run.next_path_index();
  at.window = run.next_window();
  plain.continue_at(at);
  const BlockReject& where = run.rewind_at();
  ClBlock block;
  block.sequence = where.sequence;
  block.line = where.line;
  const PlanResult result = plain.rewind(block, {where.joint, where.value}, run, writer);
  if (result.status == PlanStatus::kRefused) refuse(result);
  if (result.status != PlanStatus::kOk) return false;
  note(result.rewind);
  const RestToRestPlanner::Junction after = plain.junction();
  const RewindTarget to{after.joints, result.rewind.turns, find_branch(after)};
  run.go_on(to, after.path_index, after.window);
  return true;
}

void SmoothPlanner::Workspace::note(const Rewind& rewind) noexcept {
  if (!rewind.is_made()) return;
  rewinds.push_over_oldest(rewind);
}

}  // namespace meridian
