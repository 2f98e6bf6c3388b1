// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "meridian/kinematics/machine_model.hpp"

/// Machines of the other families for tests and benchmarks of the core, which knows no files:
/// geometry alone, as in deploy/machines.
namespace meridian::test {

/// A trunnion table: C on A, X Y Z on the tool side; joints in the order X Y Z C A.
[[nodiscard]] inline MachineModel trunnion_machine() {
  MachineModel model;
  model.name = "trunnion-ac";
  model.family = MachineFamily::kChain;
  const Vector3 o = Vector3::Zero();
  const std::array<ChainJoint, 5> chain{
      ChainJoint{3, true, true, Vector3::UnitZ(), o},
      ChainJoint{4, true, true, Vector3::UnitX(), Vector3(0, 0, -40)},
      ChainJoint{0, false, false, Vector3::UnitX(), o},
      ChainJoint{1, false, false, Vector3::UnitY(), o},
      ChainJoint{2, false, false, Vector3::UnitZ(), o}};
  model.chain = *describe_chain(chain, Vector3::UnitZ(), Vector3(0, 0, 300));
  for (int i = 3; i < 5; ++i) model.joints[i].is_rotary = true;
  model.tool_length_mm = 110;
  return model;
}

/// An articulated robot, 6R with a spherical wrist or 5R; the workpiece lies in front of it.
[[nodiscard]] inline MachineModel robot_machine(bool has_spherical_wrist) {
  MachineModel model;
  model.name = has_spherical_wrist ? "robot-6r" : "robot-5r";
  model.family = MachineFamily::kRobot;
  model.joint_count = has_spherical_wrist ? 6 : 5;
  model.robot = {has_spherical_wrist, 250, 700, 700, 40};
  for (JointSpec& joint : model.joints) joint.is_rotary = true;
  model.X_MW.origin_mm = {850, 0, 250};
  model.tool_length_mm = 110;
  return model;
}

}  // namespace meridian::test
