// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/nc/state.hpp"

namespace meridian::nc {

/// Puts the names of a Siemens line in force: TRAORI, ORIVECT and their kin. `has_machine_place`
/// becomes true for SUPA. Frames, jumps, variables and cycles are refused by name.
/// Proof: tests/unit/nc/siemens_test.cpp.
[[nodiscard]] cl::Outcome take_names(State& s, const Line& line, bool& has_machine_place);

/// Refuses what only a control can run by its name, however the rest of the line reads.
[[nodiscard]] cl::Outcome check_names(const Line& line);

/// Refuses what only a control can run by its name, however the rest of the line reads.
[[nodiscard]] cl::Outcome check_names(const Line& line);

/// Addresses that the language has beside single letters.
[[nodiscard]] cl::Outcome check_siemens_addresses(const State& s, const Line& line);

}  // namespace meridian::nc
