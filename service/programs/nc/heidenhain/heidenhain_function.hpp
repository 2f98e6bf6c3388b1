// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/programs/nc/state.hpp"

namespace meridian::nc {

/// FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR and FUNCTION RESET TCPM: tool-centre control on and
/// off; FUNCTION DWELL TIME0.5; FUNCTION MODE MILL. Others are refused. Proof:
/// tests/unit/nc/heidenhain_test.cpp.
[[nodiscard]] cl::Outcome run_function(State& s, const Line& line);

}  // namespace meridian::nc
