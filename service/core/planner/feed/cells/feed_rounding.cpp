// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/feed_rounding.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/kinematics/solve_driven.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/cells/feed_sample.hpp"
#include "service/core/planner/feed/legs/path_choice.hpp"

namespace meridian {
namespace {

double share_beside_pole(const MachineModel& model, const FeedLimits& limits, const PathPiece& path,
                         double x) noexcept {
  const bool is_solved = path.kind == PathKind::kLine || path.kind == PathKind::kArc;
  const bool shows = path.kind == PathKind::kSpline || (is_solved && !path.is_free_driven);
  if (!shows || redundant_joint(model) < 0) return 1;
  const auto pose = pose_at(path, x);
  const double distance = pole_distance(model, pose.axis);
  const double noise = distance > 0 ? kAxisNoise / distance : 0;
  const JointCaps caps = planned_caps(model, pose_in_machine(model, pose).tip.norm());
  double share = 1;
  for (int i = 0; i < limits.count; ++i) {
    share = std::min(share, 1 - caps.noise_gain[i] * noise / limits.jerk[i]);
  }
  return share;
}

/// Rounding of a joint that a `distance` from its singular place shows as; nearer than `held` it is
/// not solved for.
double noise_at(double rounding, double distance, double held) noexcept {
  return distance > held ? rounding / distance : 0;
}

/// Of what is added up to the tip's distances from the base axis, in mm.
double reach_of(const MachineModel& model, const ToolPose& pose) noexcept {
  const auto& [rotation, origin_mm] = model.X_MW;
  const Vector3 sums = rotation.cwiseAbs() * pose.tip.cwiseAbs() + origin_mm.cwiseAbs();
  return sums[0] + sums[1];
}

/// By the cycle of the machine. The yaw has what the wrist point has over its distance from the
/// base axis. The roll makes up for the yaw, so it has the yaw's and its own over the bend.
double robot_share(const MachineModel& model, const FeedLimits& limits, const PathPiece& path,
                   double x, const JointVector& joints) noexcept {
  if (path.kind == PathKind::kJoint) return 1;
  const ToolPose pose = pose_at(path, x);
  const double reach = reach_of(model, pose) + model.robot.wrist_mm + path.tool_length_mm;
  const double distance =
      robot::shoulder_distance(model.robot, path.tool_length_mm, pose_in_machine(model, pose));
  const int driven = path.is_free_driven ? driven_joint(model, path.branch) : -1;
  const bool drives_both = path.is_free_driven && (path.branch & robot::kYawAndRollDriven) != 0;
  const double yaw =
      driven == robot::kYaw ? 0 : noise_at(kAxisNoise * reach, distance, robot::kShoulderHold_mm);
  const double gain = noise_gain(static_cast<double>(model.cycle_ns) * 1e-9);
  double share = 1 - gain * yaw / limits.jerk[robot::kYaw];
  if (has_wrist_roll(model) && driven != robot::kRoll && !drives_both) {
    const double bend = std::abs(std::sin(joints[robot::kBend]));
    const double roll = noise_at(kAxisNoise + yaw, bend, robot::kWristHold_rad);
    share = std::min(share, 1 - gain * roll / limits.jerk[robot::kRoll]);
  }
  return share;
}

}  // namespace

double share_beside_singularity(const MachineModel& model, const FeedLimits& limits,
                                const PathPiece& path, double x,
                                const JointVector& joints) noexcept {
  const double share = model.family == MachineFamily::kRobot
                           ? robot_share(model, limits, path, x, joints)
                           : share_beside_pole(model, limits, path, x);
  return std::max(share, kMinTight);
}

}  // namespace meridian
