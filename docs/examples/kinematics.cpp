// SPDX-License-Identifier: Apache-2.0
#include "meridian/kinematics/kinematics.hpp"

#include <cstdio>

#include "meridian/machine_file.hpp"

/// kinematics MACHINE: a pose of joints, and the joints of that pose on every branch. mm, rad.
int main(int count, char** arguments) {
  const auto machine = meridian::load_machine(count > 1 ? arguments[1] : "lai.toml");
  if (!machine) return std::puts(machine.error().c_str());
  const meridian::JointVector joints{10, 20, 30, 0.4, 0.5};
  const double tool_mm = machine->tool_length_mm;
  const auto pose = meridian::forward(*machine, tool_mm, joints);
  std::printf("tip %.6f %.6f %.6f\n", pose.tip[0], pose.tip[1], pose.tip[2]);
  for (int branch = 0; branch < meridian::branch_count(*machine); ++branch) {
    const auto found = meridian::solve(*machine, tool_mm, pose, branch, joints);
    if (found.status == meridian::SolveStatus::kUnreachable) continue;
    std::printf("branch %d:", branch);
    for (int i = 0; i < machine->joint_count; ++i) std::printf(" %.6f", found.q[i]);
    std::puts("");
  }
}
