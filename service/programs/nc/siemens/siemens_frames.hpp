// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/programs/nc/state.hpp"

namespace meridian::nc {

/// TRANS, ROT, CYCLE800 and their kin put another frame between points and zero:
/// docs/nc-programs.md has their order. Refused by name: scaling, mirroring, angles in space, and
/// swivels whose angles have more than one reading. Proof: tests/unit/nc/siemens_frame_test.cpp.
[[nodiscard]] cl::Outcome take_siemens_frame(State& s, const Line& line, const Line::Name& name);

}  // namespace meridian::nc
