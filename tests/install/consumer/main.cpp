// SPDX-License-Identifier: Apache-2.0

/// Another project that uses the installed core: joints of a pose and back.

#include <cmath>
#include <cstdio>

#include "meridian/kinematics/kinematics.hpp"

int main() {
  meridian::MachineModel model;
  model.lai = {.pivot_mm = 140, .e_mm = 60, .h_mm = 400};
  const meridian::JointVector joints{10, 20, 30, 0.4, 0.5, 0};
  const auto pose = meridian::forward(model, 110.0, joints);
  const auto back = meridian::solve(model, 110.0, pose, 0, joints);
  double error = 0;
  for (int i = 0; i < model.joint_count; ++i) {
    error = std::fmax(error, std::fabs(back.q[i] - joints[i]));
  }
  std::printf("joints come back to %.1e\n", error);
  return error < 1e-9 ? 0 : 1;
}
