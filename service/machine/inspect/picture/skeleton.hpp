// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "meridian/kinematics/machine_model.hpp"

namespace meridian::inspect {

/// What a joint moves when it runs in its positive direction.
enum class Side {
  kTable,    ///< the workpiece
  kTool,     ///< the tool
  kRelative  ///< the tool as seen from the workpiece; which of the two is the builder's affair
};

/// One joint as it stands in the machine. Units: mm. Frame: that of the kinematics.
struct SkeletonJoint {
  int joint = 0;  ///< its index in machine order
  bool is_rotary = false;
  Side side = Side::kTool;
  Vector3 direction = Vector3::UnitZ();  ///< unit, of positive motion; rotary: right-handed
  Vector3 point = Vector3::Zero();       ///< rotary: on the axis, where it is drawn
};

/// Where a machine's axes and pivots are: of chains and the Lai machine with every joint at zero,
/// of robots at home. Units: mm. Frame: that of the kinematics. Proof:
/// tests/unit/inspect/inspect_test.cpp (its axes give the forward kinematics).
struct Skeleton {
  std::vector<SkeletonJoint> joints;  ///< from the workpiece to the tool
  std::vector<Vector3> table;         ///< workpiece origin to the last pivot on the table's side
  std::vector<Vector3> arm;           ///< first pivot on the tool's side to the gauge point
  Vector3 gauge = Vector3::Zero();
  Vector3 tip = Vector3::Zero();
  Vector3 axis = Vector3::UnitZ();  ///< unit, tip to spindle
  JointVector joints_there{};       ///< where the joints are
};

[[nodiscard]] Skeleton skeleton_of(const MachineModel& model);

}  // namespace meridian::inspect
