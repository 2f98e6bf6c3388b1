// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/programs/nc/state.hpp"

namespace meridian::nc {

/// CC: the pole of arcs, in the plane across the tool.
[[nodiscard]] cl::Outcome set_pole(State& s, const Line& line);

/// LP: a line to a radius (PR, IPR) and an angle from X (PA, IPA) about the pole; what is left out
/// stays as the tip has it. `iso` has its end as X and Y then. Refused: no pole, X or Y
/// beside. Proof: tests/unit/nc/heidenhain_polar_test.cpp.
[[nodiscard]] cl::Outcome prepare_polar_line(const State& s, Line& iso);

/// C, CR and CP with DR+ or DR-: the sense of the arc is the motion in force, and `iso` has its
/// centre and its end as ISO says them. CP IPA+720 IZ-4 is a helix. Refused: an arc without sense
/// or pole, an angle against its sense. Proof: tests/unit/nc/heidenhain_test.cpp.
[[nodiscard]] cl::Outcome prepare_arc(State& s, const Line& line, Line& iso);

}  // namespace meridian::nc
