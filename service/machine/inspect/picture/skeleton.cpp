// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/picture/skeleton.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "meridian/kinematics/lai_chain.hpp"

namespace meridian::inspect {
namespace {

/// Point of the axis next to `p`.
Vector3 foot(const SkeletonJoint& axis, const Vector3& p) {
  return axis.point + axis.direction * axis.direction.dot(p - axis.point);
}

/// Pivots from the workpiece outwards and from the gauge point inwards.
void lay_bodies(Skeleton& s, const Vector3& workpiece) {
  s.table = {workpiece};
  s.arm = {s.gauge};
  for (SkeletonJoint& joint : s.joints) {
    if (!joint.is_rotary || joint.side != Side::kTable) continue;
    joint.point = foot(joint, s.table.back());
    s.table.push_back(joint.point);
  }
  for (auto joint = s.joints.rbegin(); joint != s.joints.rend(); ++joint) {
    if (!joint->is_rotary || joint->side == Side::kTable) continue;
    joint->point = foot(*joint, s.arm.back());
    s.arm.push_back(joint->point);
  }
  std::reverse(s.arm.begin(), s.arm.end());
}

Skeleton chain_skeleton(const MachineModel& model) {
  const ChainKinematics& k = model.chain;
  Skeleton s;
  s.gauge = k.gauge_mm;
  s.axis = k.home_axis;
  s.tip = s.gauge - model.tool_length_mm * s.axis;
  for (const ChainJoint& joint : k.chain) {
    s.joints.push_back({joint.joint, joint.is_rotary,
                        joint.is_table_side ? Side::kTable : Side::kTool, joint.direction,
                        joint.point_mm});
  }
  lay_bodies(s, model.X_MW.origin_mm);
  return s;
}

/// The Lai machine as the chain that it is (docs/kinematics.md, chapter 4).
Skeleton lai_skeleton(const MachineModel& model) {
  const double length = model.lai.pivot_mm + model.tool_length_mm;
  const Vector3 pivot{0, -model.lai.e_mm, model.lai.h_mm};
  Skeleton s;
  s.tip = pivot - length * Vector3::UnitZ();
  s.gauge = pivot - model.lai.pivot_mm * Vector3::UnitZ();
  const Vector3 none = Vector3::Zero();
  s.joints = {{lai::kTheta1, true, Side::kRelative, Vector3::UnitZ(), none},
              {lai::kB2, false, Side::kRelative, Vector3::UnitY(), none},
              {lai::kB3, false, Side::kRelative, Vector3::UnitX(), none},
              {lai::kB4, false, Side::kRelative, -Vector3::UnitZ(), none},
              {lai::kTheta2, true, Side::kRelative, Vector3::UnitY(), pivot}};
  s.table = {model.X_MW.origin_mm, {0, 0, model.X_MW.origin_mm[2]}};
  s.joints[0].point = s.table.back();
  s.arm = {pivot, s.gauge};
  return s;
}

Skeleton robot_skeleton(const MachineModel& model) {
  const RobotKinematics& k = model.robot;
  Skeleton s;
  JointVector& q = s.joints_there;
  for (std::size_t i = 0; i < static_cast<std::size_t>(model.joint_count); ++i) {
    q[i] = model.joints[i].home;
  }
  const double yaw = q[robot::kYaw], rise = q[robot::kShoulder], bent = rise + q[robot::kElbow];
  const Vector3 er{std::cos(yaw), std::sin(yaw), 0}, en{-std::sin(yaw), std::cos(yaw), 0};
  const auto along = [&er](double angle) -> Vector3 {
    return std::cos(angle) * er + std::sin(angle) * Vector3::UnitZ();
  };
  const Vector3 base = Vector3::Zero(), shoulder = k.shoulder_height_mm * Vector3::UnitZ();
  const Vector3 elbow = shoulder + k.upper_arm_mm * along(rise);
  const Vector3 wrist = elbow + k.forearm_mm * along(bent);
  const ToolPose tool = robot::forward(k, 0.0, q);
  s.axis = tool.axis;
  s.gauge = tool.tip;
  s.tip = tool.tip - model.tool_length_mm * tool.axis;
  s.joints = {{robot::kYaw, true, Side::kTool, Vector3::UnitZ(), base},
              {robot::kShoulder, true, Side::kTool, -en, shoulder},
              {robot::kElbow, true, Side::kTool, -en, elbow}};
  if (k.has_spherical_wrist) {
    const double roll = q[robot::kRoll];
    const Vector3 up = along(bent + std::numbers::pi / 2);
    s.joints.push_back({robot::kRoll, true, Side::kTool, along(bent), elbow});
    s.joints.push_back(
        {robot::kBend, true, Side::kTool, -(std::cos(roll) * en + std::sin(roll) * up), wrist});
    s.joints.push_back({robot::kSpin, true, Side::kTool, -s.axis, s.gauge});
  } else {
    const double psi = bent + q[robot::kPitch];
    s.joints.push_back({robot::kPitch, true, Side::kTool, -en, wrist});
    s.joints.push_back({robot::kTilt, true, Side::kTool, along(psi + std::numbers::pi / 2), wrist});
  }
  s.table = {model.X_MW.origin_mm};
  s.arm = {base, shoulder, elbow, wrist, s.gauge};
  return s;
}

}  // namespace

Skeleton skeleton_of(const MachineModel& model) {
  switch (model.family) {
    case MachineFamily::kChain:
      return chain_skeleton(model);
    case MachineFamily::kRobot:
      return robot_skeleton(model);
    case MachineFamily::kLai:
      break;
  }
  return lai_skeleton(model);
}

}  // namespace meridian::inspect
