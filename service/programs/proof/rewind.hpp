// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "meridian/kinematics/machine_model.hpp"
#include "service/programs/proof/joint_program.hpp"

namespace meridian::proof {

/// Of `steps`, which begin behind `rest`: the last one of a rewind that begins with the first of
/// them. A rewind takes the tool off the part along its axis, turns the redundant joint by whole
/// turns with nothing else, and brings the tool back to the same place; its ways there and back are
/// checked by where their lines end. Nothing where none begins. `clear_mm` off the part the joint
/// may turn. Proof: tests/unit/proof/rewind_test.cpp.
[[nodiscard]] std::optional<std::size_t> find_rewind(const ProgramStep& rest,
                                                     std::span<const ProgramStep> steps,
                                                     const MachineModel& model, double clear_mm);

}  // namespace meridian::proof
