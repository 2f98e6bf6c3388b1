// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>

#include "meridian/kinematics/joints.hpp"
#include "service/machine/file/section.hpp"

namespace meridian::config {

/// What the machine file says about homing, which the service alone needs.
struct HomingConfig {
  double timeout_s = 60;                ///< a drive must find its reference within it
  std::array<int, kMaxJoints> turns{};  ///< of each joint, from 1 on; 0: its place among the joints
};

/// Reads `[homing]` of a machine with so many joints. Throws ConfigError.
/// Proof: tests/unit/machine_file/machine_file_test.cpp.
[[nodiscard]] HomingConfig read_homing(Section section, int joint_count);

/// The same from the machine file `path`, which load_machine() has taken.
[[nodiscard]] HomingConfig load_homing(const std::filesystem::path& path, int joint_count);

}  // namespace meridian::config
