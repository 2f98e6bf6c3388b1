// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/picture/machine_posture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/kinematics/limited.hpp"
#include "service/machine/inspect/pose_solutions.hpp"
#include "service/machine/scene/link_tree.hpp"

namespace meridian::inspect {
namespace {

using scene::Screw;

/// An axis as the joints ahead of it carry it.
struct Axis {
  Vector3 point, direction;
};

[[nodiscard]] Axis axis_of(const std::vector<Screw>& screws, const JointVector& q, int joint) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  for (const Screw& screw : screws) {
    if (screw.joint == joint) return {motion * screw.point_mm, motion.linear() * screw.direction};
    motion = motion * scene::motion_of(screw, q[static_cast<std::size_t>(screw.joint)]);
  }
  return {Vector3::Zero(), Vector3::UnitZ()};
}

/// The pivots of a branch as its joints posture, and what it ends in.
[[nodiscard]] std::vector<Vector3> chain_of(const std::vector<Screw>& screws, const JointVector& q,
                                            const Vector3& end) {
  std::vector<Vector3> out;
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  for (const Screw& screw : screws) {
    if (screw.is_rotary) out.push_back(motion * screw.point_mm);
    motion = motion * scene::motion_of(screw, q[static_cast<std::size_t>(screw.joint)]);
  }
  out.push_back(motion * end);
  return out;
}

[[nodiscard]] StagePosture stage_at(const MachineModel& model, const scene::LinkTree& tree,
                                    const JointVector& q) {
  const ActuatorStage& stage = model.stage;
  const Axis linear = axis_of(tree.table, q, stage.linear_joint);
  const Axis rotary = axis_of(tree.table, q, stage.rotary_joint);
  const auto [s, phi] = stage::carriage_of(stage, q);
  const JointVector u = stage::drives_of(stage, q);
  const Vector3 along = stage.sign_s * linear.direction;
  const Vector3 across = (stage.sign_phi * rotary.direction).cross(along);
  StagePosture out;
  out.centre = rotary.point;
  for (std::size_t n = 0; n < kStageDrives; ++n) {
    const double side = n == 0 ? 1 : -1;
    const int drive = n == 0 ? stage.linear_joint : stage.rotary_joint;
    out.slider[n] = out.centre + (u[static_cast<std::size_t>(drive)] - s) * along +
                    side * stage.rail_mm * across;
    out.pin[n] = stage.kind == StageKind::kPinSlot
                     ? out.slider[n]
                     : Vector3(out.centre + side * stage.radius_mm *
                                                (std::cos(phi) * across - std::sin(phi) * along));
  }
  return out;
}

/// The solution inside travel, and at no box, that asks least of the joint that it asks most of.
[[nodiscard]] std::optional<JointVector> nearest_solution(const MachineModel& model,
                                                          const ToolPose& pose,
                                                          const JointVector& from) {
  std::optional<JointVector> nearest;
  double min = std::numeric_limits<double>::infinity();
  for (const PoseSolution& solution : solve_all(model, pose)) {
    if (!solution.is_possible()) continue;
    double farthest = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(model.joint_count); ++i) {
      const double by = std::abs(solution.q[i] - from[i]) / model.joints[i].limits.velocity;
      farthest = std::max(farthest, by);
    }
    if (farthest < min) {
      min = farthest;
      nearest = solution.q;
    }
  }
  return nearest;
}

[[nodiscard]] Vector3 gauge_of(const ProgramPose& at) {
  return at.pose.tip + at.tool_length_mm * at.pose.axis;
}

/// The path length of the gauge point up to each pose.
[[nodiscard]] std::vector<double> lengths_to(const std::vector<ProgramPose>& poses) {
  std::vector<double> lengths(poses.size(), 0.0);
  for (std::size_t n = 1; n < poses.size(); ++n) {
    lengths[n] = lengths[n - 1] + (gauge_of(poses[n]) - gauge_of(poses[n - 1])).norm();
  }
  return lengths;
}

}  // namespace

MachinePosture posture_at(const MachineModel& model, const JointVector& q, double tool_length_mm) {
  const scene::LinkTree tree = scene::link_tree(model);
  MachinePosture posture;
  posture.joints = q;
  posture.head = chain_of(tree.head, q, tree.gauge_mm);
  posture.tip = chain_of(tree.head, q, tree.gauge_mm - tool_length_mm * tree.axis).back();
  posture.table = chain_of(tree.table, q, model.X_MW.origin_mm);
  if (has_stage(model)) posture.stage = stage_at(model, tree, q);
  return posture;
}

Expected<std::vector<MachinePosture>, std::string> postures_along(
    const MachineModel& model, const std::vector<ProgramPose>& poses, int count) {
  const std::vector<double> lengths = lengths_to(poses);
  const double step = poses.empty() ? 0 : lengths.back() / (count - 1);
  double due = 0;
  std::vector<MachinePosture> postures;
  MachineModel with_tool = model;
  JointVector joints{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(model.joint_count); ++i) {
    joints[i] = model.joints[i].home;
  }
  for (std::size_t n = 0; n < poses.size(); ++n) {
    with_tool.tool_length_mm = poses[n].tool_length_mm;
    const auto next = nearest_solution(with_tool, poses[n].pose, joints);
    if (!next) {
      return tl::make_unexpected("line " + std::to_string(poses[n].line) +
                                 ": no joints inside travel put the tool there; `meridian "
                                 "simulate` says why, --place finds another frame");
    }
    joints = *next;
    const bool is_last = n + 1 == poses.size();
    if (lengths[n] < due && !is_last) continue;
    due = step > 0 ? step * (std::floor(lengths[n] / step) + 1) : lengths.back() + 1;
    postures.push_back(posture_at(with_tool, joints, with_tool.tool_length_mm));
    postures.back().line = poses[n].line;
  }
  return postures;
}

}  // namespace meridian::inspect
