// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/programs/nc/state.hpp"

namespace meridian::nc {

/// Runs the words of one block in the order in which a control does: modes, feed, spindle, tool,
/// motion, stops.
[[nodiscard]] cl::Outcome run_block(State& s, const Line& line);

/// The same for a line of Klartext, which has one statement. Proof:
/// tests/unit/nc/heidenhain_test.cpp.
[[nodiscard]] cl::Outcome run_heidenhain(State& s, const Line& line);

}  // namespace meridian::nc
