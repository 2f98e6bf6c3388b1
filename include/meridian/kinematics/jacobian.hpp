// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "meridian/geometry/jet.hpp"
#include "meridian/kinematics/kinematics.hpp"

/// How the tool moves with the joints, and how far a machine is from being singular.
namespace meridian {

/// Rows Px, Py, Pz, Kx, Ky, Kz in W; one column per joint of the machine. Fixed storage.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMaxJoints>;

/// Returns the derivative of forward() by the joints. Units: mm and rad per mm and rad.
[[nodiscard]] inline Jacobian jacobian(const MachineModel& model, double tool_length_mm,
                                       const JointVector& q) noexcept {
  Jacobian out(6, model.joint_count);
  for (int i = 0; i < model.joint_count; ++i) {
    Joints<Jet<1>> moved;
    for (int n = 0; n < kMaxJoints; ++n) moved[n] = Jet<1>(q[n]);
    moved[i] = Jet<1>::variable(q[i]);
    const Pose<Jet<1>> pose = forward(model, tool_length_mm, moved);
    for (int row = 0; row < 3; ++row) {
      out(row, i) = pose.tip[row].derivative(1);
      out(row + 3, i) = pose.axis[row].derivative(1);
    }
  }
  return out;
}

/// Returns sqrt(det JᵀJ), the distance from singularity: 0 on the pole, at a limit of reach, where
/// an arm is stretched or a wrist aligned. It depends on neither frame nor tool.
[[nodiscard]] inline double measure(const MachineModel& model, const JointVector& q) noexcept {
  switch (model.family) {
    case MachineFamily::kChain:
      return chain::measure(model.chain, q);
    case MachineFamily::kRobot:
      return robot::measure(model.robot, q);
    case MachineFamily::kLai:
      break;
  }
  return lai::measure(q);
}

}  // namespace meridian
