// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/nc/state.hpp"

namespace meridian::nc {

/// Runs the words of one block in the order in which a control does: modes, feed, spindle, tool,
/// motion, stops.
[[nodiscard]] cl::Outcome run_block(State& s, const Line& line);

}  // namespace meridian::nc
