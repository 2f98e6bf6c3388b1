// SPDX-License-Identifier: Apache-2.0
#include "service/machine/scene/link_tree.hpp"

#include <Eigen/Geometry>

#include "meridian/kinematics/kinematics.hpp"

namespace meridian::scene {
namespace {

[[nodiscard]] LinkTree tree_of(const ChainKinematics& chain) {
  LinkTree out;
  for (const ChainJoint& one : chain.chain) {
    const Screw screw{one.joint, one.is_rotary, one.direction, one.point_mm};
    if (one.is_table_side) {
      out.table.insert(out.table.begin(), screw);
    } else {
      out.head.push_back(screw);
    }
  }
  out.gauge_mm = chain.gauge_mm;
  out.axis = chain.home_axis;
  return out;
}

/// The table slides and turns against its joints, docs/kinematics.md, chapter 2.
[[nodiscard]] LinkTree tree_of(const LaiKinematics& lai) {
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  const Vector3 pivot(0, -lai.e_mm, lai.h_mm);
  LinkTree out;
  out.table = {{lai::kB2, false, -y}, {lai::kTheta1, true, -z}};
  out.head = {{lai::kB3, false, x}, {lai::kB4, false, -z}, {lai::kTheta2, true, y, pivot}};
  out.gauge_mm = pivot - lai.pivot_mm * z;
  return out;
}

/// The arm stretched along x; the shoulder lifts it, docs/kinematics.md, chapter 5.
[[nodiscard]] LinkTree tree_of(const RobotKinematics& robot) {
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  const Vector3 shoulder = robot.shoulder_height_mm * z;
  const Vector3 elbow = shoulder + robot.upper_arm_mm * x;
  const Vector3 wrist = elbow + robot.forearm_mm * x;
  LinkTree out;
  out.head = {{robot::kYaw, true, z},
              {robot::kShoulder, true, -y, shoulder},
              {robot::kElbow, true, -y, elbow}};
  if (robot.has_spherical_wrist) {
    out.head.push_back({robot::kRoll, true, x, wrist});
    out.head.push_back({robot::kBend, true, -y, wrist});
    out.head.push_back({robot::kSpin, true, x, wrist});
  } else {
    out.head.push_back({robot::kPitch, true, -y, wrist});
    out.head.push_back({robot::kTilt, true, z, wrist});
  }
  out.gauge_mm = wrist + robot.wrist_mm * x;
  out.axis = -x;
  return out;
}

}  // namespace

LinkTree link_tree(const MachineModel& model) {
  switch (model.family) {
    case MachineFamily::kChain:
      return tree_of(model.chain);
    case MachineFamily::kRobot:
      return tree_of(model.robot);
    case MachineFamily::kLai:
      break;
  }
  return tree_of(model.lai);
}

Eigen::Isometry3d motion_of(const Screw& screw, double value) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (!screw.is_rotary) {
    motion.translation() = value * screw.direction;
    return motion;
  }
  motion.linear() = Eigen::AngleAxisd(value, screw.direction).toRotationMatrix();
  motion.translation() = screw.point_mm - motion.linear() * screw.point_mm;
  return motion;
}

}  // namespace meridian::scene
