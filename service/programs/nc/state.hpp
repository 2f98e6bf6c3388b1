// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "service/programs/cl/interpreter/modal.hpp"
#include "service/programs/nc/frames/frames.hpp"
#include "service/programs/nc/frames/machine_axes.hpp"
#include "service/programs/nc/modes.hpp"
#include "service/programs/nc/nc_line.hpp"
#include "service/programs/nc/tool_names.hpp"
#include "service/programs/nc/words/variables.hpp"

/// What the words of an NC program do. Each takes the line, changes what holds for later ones, and
/// gives blocks to the path, the same as the words of a CL file do.
namespace meridian::nc {

struct State {
  State(cl::ClReaderOptions options, std::shared_ptr<const MachineAxes> machine,
        NamedTools named_tools)
      : cl(std::move(options)), axes(std::move(machine)), tools(std::move(named_tools)) {}

  cl::Modal cl;
  std::shared_ptr<const MachineAxes> axes;  ///< null: the machine is not known
  Modes modes;
  ProgramFrames frames;
  Variables variables;
  ToolNames tools;
  ToolPosition position;
  ToolPose in_w{Vector3::Zero(), Vector3::UnitZ()};  ///< where the path ended, without --frame
};

// frames.cpp
/// Puts another frame between points and zero; the place of the tool is in it from here on.
void set_shift(State& s, const Line& line, const cl::Frame& shift);
/// Another work offset: its zero, from that of the station's frame.
void set_zero(State& s, const Line& line, const Vector3& zero_mm);
void set_plane(State& s, const Line& line, const cl::Frame& plane, Tilt tilt);
/// The control turns the tool across the plane in force: where the tip is then is not known.
void turn_to_plane(State& s, const Line& line);
/// Whether the tool stands across the tilted plane in force, with the rotary axes as at `place`.
[[nodiscard]] bool is_across_plane(const State& s, const ToolPosition& position);
/// z of the plane in force, along the axes of the program's zero.
[[nodiscard]] Vector3 tool_of_plane(const State& s);
/// A block with rotary words turns the tool off the plane that the control turned it to.
void note_rotary_words(State& s, ToolPosition& to);
/// A point as written, from the program's zero and in its unit; and back, from W without --frame.
[[nodiscard]] Vector3 in_program(const State& s, const Vector3& written);
[[nodiscard]] Vector3 as_written(const State& s, const Vector3& p_w);
/// A direction along the axes of the program's zero, in W without --frame.
[[nodiscard]] Vector3 direction_in_w(const State& s, const Vector3& program);
/// tilted_plane.cpp: G68.2, by angles, three points or two vectors.
[[nodiscard]] cl::Outcome define_plane(State& s, const Line& line);
/// A plane of several blocks has to be whole before anything else is done.
[[nodiscard]] cl::Outcome check_plane_is_whole(const State& s);
/// G53.1 and G52.
[[nodiscard]] cl::Outcome follow_plane(State& s, const Line& line);
[[nodiscard]] cl::Outcome set_local_zero(State& s, const Line& line);

// dynamic_offset.cpp
/// G254: from here on the zero of the program goes with the table; G255 ends it.
[[nodiscard]] cl::Outcome begin_dynamic_offset(State& s, const Line& line);
void end_dynamic_offset(State& s, const Line& line);
struct Target;
/// A block with rotary words under G254: its points count along the axes as it leaves the table.
[[nodiscard]] cl::Outcome turn_with_table(State& s, const Line& line, Target& to);

// points.cpp
/// The words of a line that move: its points by the motion in force.
[[nodiscard]] cl::Outcome move(State& s, const Line& line);
/// A rapid that is no part of the path, since where it ends is not known.
void warn_of_unseen_rapid(State& s, const Line& line);
/// A point of the program, in its unit, in W without --frame, in mm.
[[nodiscard]] Vector3 in_w(const State& s, const Vector3& written);

/// Where a line leads.
struct Target {
  ToolPosition position;
  Vector3 axis = Vector3::UnitZ();  ///< in W, without --frame
  bool turns = false;               ///< some rotary word says another angle than before
};
/// Numbers without a point are whole units here; older controls count least increments.
void note_digits(State& s, const Line& line, const Word& word);
/// Whether the word counts from where the tool or axis stands.
[[nodiscard]] bool is_relative(const State& s, const Word& word);

// rotary.cpp
/// The same place of an axis that turns without end, from 0 up to 360 deg.
[[nodiscard]] double within_turn(double deg);
/// The rotary words of a line.
[[nodiscard]] cl::Outcome take_rotary(State& s, const Line& line, Target& to);

// orientation.cpp
/// The tool axis of I J K under G43.5, of A3 B3 C3 under TRAORI: from the tip to the spindle, any
/// length.
[[nodiscard]] cl::Outcome take_vector(const State& s, const Line& line, Target& to);
/// Under TRAORI every block says by its words how it gives the tool axis.
[[nodiscard]] cl::Outcome choose_orientation(State& s, const Line& line);

// lines.cpp
[[nodiscard]] cl::Outcome line_to(State& s, const Line& line, const Target& to);
// arcs.cpp
[[nodiscard]] cl::Outcome arc_to(State& s, const Line& line, const Target& to);
/// One end of a motion in the path: `tip` in the unit of the program.
struct PathEnd {
  Vector3 tip, axis;
};
/// lines.cpp: the feed of the motion in force.
[[nodiscard]] Expected<cl::MotionFeed, cl::Refusal> feed_of_motion(State& s, const Line& line);
/// lines.cpp: to W with --frame.
[[nodiscard]] Expected<ToolPose, cl::Refusal> in_path(const State& s, const PathEnd& end);

// drill.cpp
/// Whether the tool may drill where it stands: along its axis, from a point that is known.
[[nodiscard]] cl::Outcome check_hole(const State& s);
/// One hole under the tool. It ends at the retract level.
[[nodiscard]] cl::Outcome drill(State& s, const Line& line, const Drilling& drilling);

// cycles.cpp
/// G81 and its kin; 0: G80, or a motion code.
void begin_cycle(State& s, int code);
/// A line under a canned cycle: one hole.
[[nodiscard]] cl::Outcome run_cycle(State& s, const Line& line);

// home.cpp
enum class MachinePosition : std::uint8_t {
  kHome,       ///< G28
  kReference,  ///< G30: the position G30 of the machine file, or G30 P3, G30 P4
  kAsWritten   ///< G53, SUPA, M91
};
[[nodiscard]] cl::Outcome move_to_machine_position(State& s, const Line& line,
                                                   MachinePosition position);

// retract.cpp
/// Along the tool axis off the part, `distance` in the unit of the program, or to the end of
/// travel.
[[nodiscard]] cl::Outcome retract(State& s, const Line& line, std::optional<double> distance);

// control.cpp
[[nodiscard]] cl::Outcome set_control(State& s, const Line& line, Control control);
/// G43, G43.4 and G43.5 with their H, G49. H0 is no length; another number than the tool's is an
/// offset that only the control knows.
[[nodiscard]] cl::Outcome take_length(State& s, const Line& line, Control control);
[[nodiscard]] cl::Outcome set_work_offset(State& s, const Line& line, int tenths);
/// CYCL DEF 247 of Klartext: a row of the preset table.
void set_preset(State& s, const Line& line, int row);
/// Before every motion: one under another offset than the last needs the positions of both.
[[nodiscard]] cl::Outcome check_work_offset(State& s, const Line& line);
[[nodiscard]] cl::Outcome set_unit(State& s, cl::LengthUnit unit);

// actions.cpp
/// F, S and T, and M codes that come before the motion of their block.
[[nodiscard]] cl::Outcome act_before(State& s, const Line& line);
/// M codes that come after it: stops, spindle and coolant off, the end.
[[nodiscard]] cl::Outcome act_after(State& s, const Line& line);
[[nodiscard]] cl::Outcome dwell(State& s, const Line& line);
[[nodiscard]] cl::Outcome rest(State& s, const Line& line, double time_s);
/// G4 F in seconds, G4 S in revolutions of the spindle.
[[nodiscard]] cl::Outcome siemens_dwell(State& s, const Line& line);

}  // namespace meridian::nc
