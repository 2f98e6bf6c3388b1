// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "service/programs/nc/state.hpp"

namespace meridian::nc {

/// PLANE SPATIAL, EULER, VECTOR and RESET, with MOVE, TURN or STAY. Refused by name: planes that
/// are given otherwise, and Q parameters. Proof: tests/unit/nc/heidenhain_frame_test.cpp.
[[nodiscard]] cl::Outcome set_klartext_plane(State& s, const Line& line, std::string_view text);

/// CYCL DEF 7.1 X+10: the datum of one axis; `text` is what stands behind the number of the line.
[[nodiscard]] cl::Outcome shift_datum(State& s, const Line& line, std::string_view text);
/// TRANS DATUM AXIS X+10 Y+5, TRANS DATUM RESET.
[[nodiscard]] cl::Outcome move_datum(State& s, const Line& line, std::string_view text);

/// CYCL DEF 247: row `row` of the preset table. The control ends datum shifts where it activates
/// one.
[[nodiscard]] cl::Outcome activate_preset(State& s, const Line& line, double row,
                                          const std::string& title);
/// PRESET SELECT #3, or NR3; with KEEP TRANS the datum shift stays. Refused by name: rows by name,
/// presets of pallets.
[[nodiscard]] cl::Outcome select_preset(State& s, const Line& line, std::string_view text);

/// Cycles 8, 10, 11 and 19: mirror, turn, scale and tilt. Only what ends them is run: CYCL DEF 10.1
/// ROT+0; 19.1 without angles, or with zeros, ends the tilted plane.
[[nodiscard]] bool is_frame_cycle(std::string_view number);
[[nodiscard]] cl::Outcome reset_frame_cycle(State& s, const Line& line, std::string_view number,
                                            std::string_view text);

}  // namespace meridian::nc
