// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"

/// Sets of a machine's joints: bit i is joint i. RT: cycle.
namespace meridian {

[[nodiscard]] inline std::uint32_t all_joints(const MachineModel& machine) noexcept {
  return (1U << static_cast<unsigned>(machine.joint_count)) - 1U;
}

/// The two joints that a stage carries; 0: the machine has none.
[[nodiscard]] inline std::uint32_t stage_pair(const MachineModel& machine) noexcept {
  if (!has_stage(machine)) return 0;
  return 1U << static_cast<unsigned>(machine.stage.linear_joint) |
         1U << static_cast<unsigned>(machine.stage.rotary_joint);
}

[[nodiscard]] inline bool is_on_stage(const MachineModel& machine, int joint) noexcept {
  return (stage_pair(machine) >> static_cast<unsigned>(joint) & 1U) != 0;
}

/// The first joint of `mask`; 0 of none.
[[nodiscard]] inline int first_bit(std::uint32_t mask) noexcept {
  return mask == 0 ? 0 : std::countr_zero(mask);
}

}  // namespace meridian
