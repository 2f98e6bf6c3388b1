// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "meridian/kinematics/kinematics.hpp"
#include "support/family_machines.hpp"
#include "support/machines.hpp"

/// One workload for the benchmark that measures time and for the gate that counts instructions.
namespace meridian::bench {

/// The pose number `i` of a smooth path that circles the pole at 3 to 25 degrees: a tip on a
/// helix of 60 mm radius, so that every solve meets another winding and quadrant.
[[nodiscard]] inline ToolPose pose_on_path(int i) noexcept {
  const double turn = 2.0 * std::numbers::pi * i / 256.0;
  const double tilt = 0.25 + 0.19 * std::sin(0.31 * turn);
  return {{60.0 * std::cos(turn), 60.0 * std::sin(turn), 0.01 * i},
          {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)}};
}

inline constexpr int kPoses = 1024;

/// The poses of the workload, computed once.
[[nodiscard]] inline const ToolPose* path_poses() noexcept {
  static const auto poses = [] {
    std::array<ToolPose, kPoses> out;
    for (int i = 0; i < kPoses; ++i) out[i] = pose_on_path(i);
    return out;
  }();
  return poses.data();
}

/// Solves the inverse kinematics of `model` `n` times along the path, branch and winding followed
/// from the solve before. Returns a checksum of the joints, so that nothing is optimised away and
/// two builds can be compared.
[[nodiscard]] inline std::uint64_t solve_path(const MachineModel& model, int n) noexcept {
  const ToolPose* poses = path_poses();
  JointVector q{};
  std::uint64_t sum = 0;
  for (int i = 0; i < n; ++i) {
    q = solve(model, 110.0, poses[i % kPoses], 0, q).q;
    std::uint64_t bits = 0;
    std::memcpy(&bits, &q[3], sizeof bits);
    sum += bits;
  }
  return sum;
}

/// The machine of Lai et al.
[[nodiscard]] inline std::uint64_t run_inverse_kinematics(int n) noexcept {
  static const MachineModel model = test::lai_machine();
  return solve_path(model, n);
}
/// A trunnion by the closed form of any chain.
[[nodiscard]] inline std::uint64_t run_chain(int n) noexcept {
  static const MachineModel model = test::trunnion_machine();
  return solve_path(model, n);
}
[[nodiscard]] inline std::uint64_t run_robot_5r(int n) noexcept {
  static const MachineModel model = test::robot_machine(false);
  return solve_path(model, n);
}
[[nodiscard]] inline std::uint64_t run_robot_6r(int n) noexcept {
  static const MachineModel model = test::robot_machine(true);
  return solve_path(model, n);
}

}  // namespace meridian::bench
