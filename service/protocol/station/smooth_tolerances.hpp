// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "meridian/kinematics/machine_model.hpp"

namespace meridian::stream {

/// Why a run on `model` with this transition cannot be planned for the tolerances that it asks for,
/// mm and rad, 0: the machine's; empty: it can. More than the largest is refused of every run, less
/// than the least of a smooth one, where it is the machine's too.
/// Proof: tests/unit/protocol/intake_program_test.cpp.
[[nodiscard]] std::string refusal_of_tolerances(const MachineModel& model, Transition transition,
                                                double tip_mm, double axis_rad);

}  // namespace meridian::stream
