// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/programs/nc/state.hpp"

namespace meridian::nc {

/// PLANE SPATIAL and PLANE RESET, with MOVE, TURN or STAY. Refused by name: planes that are told
/// otherwise, and Q parameters. Proof: tests/unit/nc/heidenhain_frame_test.cpp.
[[nodiscard]] cl::Outcome set_klartext_plane(State& s, const Line& line, std::string_view text);

/// CYCL DEF 7.1 X+10: the datum of one axis; `text` is what stands behind the number of the line.
[[nodiscard]] cl::Outcome shift_datum(State& s, const Line& line, std::string_view text);

}  // namespace meridian::nc
