// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "meridian/kinematics/machine_model.hpp"
#include "service/programs/proof/joint_program.hpp"

namespace meridian::proof {

struct RewindLimits {
  double clear_mm = 0;  ///< off the part: nearer nothing may turn
  double tool_length_mm = 0;
};

/// Of `steps`, which begin behind `rest`: the last one of a rewind that begins with the first of
/// them. A rewind takes the tool off the part along its axis and brings it back to the same
/// position. Off the part the redundant joint turns by whole turns with nothing else; or the axis
/// goes to the pole and back on another branch, with the tip at rest. Its ways are checked by where
/// their lines end. Nothing where none begins. Proof: tests/unit/proof/rewind_test.cpp.
[[nodiscard]] std::optional<std::size_t> find_rewind(const ProgramStep& rest,
                                                     std::span<const ProgramStep> steps,
                                                     const MachineModel& model,
                                                     const RewindLimits& limits);

}  // namespace meridian::proof
