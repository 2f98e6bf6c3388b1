// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/cycle/state.hpp"
#include "meridian/kinematics/machine_model.hpp"

/// What an operator is answered. Proof: tests/unit/telemetry/reply_words_test.cpp.
namespace meridian::telemetry {

/// Answer to an operator whose verb was accepted, with the value that is set; `state` is the one it
/// led to.
[[nodiscard]] std::string describe(Verb verb, State state, double argument);
/// Answer to an operator whose verb was refused in `state`, with the value, its range and the
/// remedy.
[[nodiscard]] std::string describe(Verb verb, Refusal refusal, State state, double argument,
                                   const MachineModel& model);

}  // namespace meridian::telemetry
