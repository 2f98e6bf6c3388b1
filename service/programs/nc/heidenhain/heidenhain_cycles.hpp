// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/programs/nc/state.hpp"

namespace meridian::nc {

/// CYCL DEF 200 DRILLING and its kin: which cycle the next call runs. Its Q parameters stand behind
/// it or in the lines that follow. CYCL DEF 247 names the work offset. Refused by name: cycles that
/// only the control knows.
[[nodiscard]] cl::Outcome define_cycle(State& s, const Line& line, std::string_view number,
                                       std::string_view text);

/// Q201=-20 in a line of its own: a parameter of the cycle that is being defined.
[[nodiscard]] cl::Outcome take_cycle_parameters(State& s, const Line& line, std::string_view text);

/// CYCL CALL, M99 and M89: the hole of the cycle in force, where the tool stands. Proof:
/// tests/unit/nc/heidenhain_cycle_test.cpp.
[[nodiscard]] cl::Outcome call_cycle(State& s, const Line& line);

/// A line with CYCL CALL: FMAX and the actions M3, M8 and their kin may stand in it.
[[nodiscard]] cl::Outcome run_cycle_call(State& s, const Line& line);

}  // namespace meridian::nc
