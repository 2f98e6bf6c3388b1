// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/programs/nc/state.hpp"

namespace meridian::nc {

/// A line of Klartext as ISO says it.
struct Translated {
  Line iso;
  bool is_machine_position = false;
  bool calls_cycle = false;  ///< M99, M89
  bool retracts = false;     ///< M140
};

/// The words of a line under their addresses in ISO. M13 and M14 start spindle and coolant; M128,
/// M129 and M94 act at once. Refused: M codes that put points elsewhere, and those whose words are
/// neither coordinates nor a feed. Proof: tests/unit/nc/heidenhain_test.cpp.
[[nodiscard]] cl::Outcome translate(State& s, const Line& line, Translated& out);

/// A word under another address.
void move_word(Line& to, const Word& word, std::string_view address);
/// M13 and M14: M3 or M4, and M8.
void move_start_with_coolant(Line& to, const Word& word);

/// Under AXIS SPAT: A, B and C of a line become the tool axis, as TX, TY and TZ give it.
[[nodiscard]] cl::Outcome take_angles_in_space(State& s, Line& iso);

/// TCPM and M128, by rotary words where the machine is known, until FUNCTION RESET TCPM and M129.
[[nodiscard]] cl::Outcome switch_on(State& s, const Line& line, Orientation::Between between);
[[nodiscard]] cl::Outcome switch_off(State& s, const Line& line);

}  // namespace meridian::nc
