// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/programs/cl/interpreter/modal.hpp"
#include "service/programs/cl/refusal.hpp"
#include "service/programs/cl/text/statement.hpp"

/// What the words of a CL file do: each takes its statement, changes what holds for later ones, and
/// gives blocks to the path. The table of words names them.
namespace meridian::cl {

using Handler = Outcome (*)(Modal& m, const Statement& s);

// points.cpp
Outcome read_goto(Modal& m, const Statement& s);
Outcome read_listed_point(Modal& m, const Statement& s);  ///< a line of bare numbers
Outcome read_delta(Modal& m, const Statement& s);
Outcome read_from(Modal& m, const Statement& s);
Outcome read_rapid(Modal& m, const Statement& s);
Outcome read_tool_axis(Modal& m, const Statement& s);
Outcome read_multax(Modal& m, const Statement& s);
Outcome read_home(Modal& m, const Statement& s);

// arcs.cpp
Outcome read_circle(Modal& m, const Statement& s);
Outcome read_forward(Modal& m, const Statement& s);
Outcome read_tool_on(Modal& m, const Statement& s);
Outcome read_move_arc(Modal& m, const Statement& s);

// helices.cpp
Outcome read_helix(Modal& m, const Statement& s);

// splines.cpp
Outcome read_spline(Modal& m, const Statement& s);
Outcome read_knots(Modal& m, const Statement& s);
Outcome read_control_point(Modal& m, const Statement& s);

// copying.cpp
Outcome read_index(Modal& m, const Statement& s);
Outcome read_copy(Modal& m, const Statement& s);

// cycles.cpp
Outcome read_cycle_word(Modal& m, const Statement& s);

// feeds.cpp
Outcome read_units(Modal& m, const Statement& s);
Outcome read_feed(Modal& m, const Statement& s);
Outcome read_transition(Modal& m, const Statement& s);

// frames.cpp
Outcome read_msys(Modal& m, const Statement& s);
Outcome read_mcs(Modal& m, const Statement& s);
Outcome read_mcsys(Modal& m, const Statement& s);
Outcome read_csys(Modal& m, const Statement& s);
Outcome read_trntyp(Modal& m, const Statement& s);
Outcome read_origin(Modal& m, const Statement& s);
Outcome read_trans(Modal& m, const Statement& s);
Outcome read_tracut(Modal& m, const Statement& s);
Outcome read_rotary(Modal& m, const Statement& s);
Outcome read_mode(Modal& m, const Statement& s);

// machine.cpp
Outcome read_loadtl(Modal& m, const Statement& s);
Outcome read_load(Modal& m, const Statement& s);
Outcome read_tool_data(Modal& m, const Statement& s);
Outcome read_spindle(Modal& m, const Statement& s);
Outcome read_coolant(Modal& m, const Statement& s);
Outcome read_delay(Modal& m, const Statement& s);
Outcome read_stop(Modal& m, const Statement& s);
Outcome read_optional_stop(Modal& m, const Statement& s);
Outcome pass_on(Modal& m, const Statement& s);  ///< to the machine, as a vendor word
Outcome read_cutcom(Modal& m, const Statement& s);

// structure.cpp
Outcome read_tool_path(Modal& m, const Statement& s);
Outcome read_end_of_path(Modal& m, const Statement& s);
Outcome read_end(Modal& m, const Statement& s);
Outcome read_fini(Modal& m, const Statement& s);
Outcome read_program_name(Modal& m, const Statement& s);
Outcome read_note(Modal& m, const Statement& s);
Outcome skip(Modal& m, const Statement& s);          ///< counted
Outcome skip_flagged(Modal& m, const Statement& s);  ///< counted, with the row's note as a remark
Outcome refuse_word(Modal& m, const Statement& s);   ///< with the row's note as the reason
Outcome refuse_unless_off(Modal& m, const Statement& s);    ///< WORD/OFF is skipped
Outcome refuse_unless_first(Modal& m, const Statement& s);  ///< WORD/1 is skipped

}  // namespace meridian::cl
