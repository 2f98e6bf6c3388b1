// SPDX-License-Identifier: Apache-2.0
// Where a line leads: tip and tool axis by the words that it has.
#include <algorithm>
#include <array>
#include <cmath>

#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/cl/words/motion.hpp"
#include "service/programs/nc/remedy.hpp"
#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr std::array<std::string_view, 3> kTip = {"X", "Y", "Z"};
constexpr double kSameAxis = 1e-5;  // digits of the numbers that give a tool axis

cl::Outcome take_tip(State& s, const Line& line, Target& to) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Word* const word = line.find(kTip[k]);
    if (word == nullptr) continue;
    note_digits(s, line, *word);
    std::optional<double>& at = to.position.tip[k];
    const bool is_incremental = is_relative(s, *word);
    if (is_incremental && !at) {
      return refuse("G91, but where " + std::string(kTip[k]) + " stands is not known here",
                    "write a G0 with X, Y and Z under G90 first", "not known");
    }
    at = is_incremental ? *at + word->number : word->number;
  }
  return {};
}

cl::Outcome find_axis(const State& s, Target& to) {
  if (s.modes.control == Control::kRotary) {
    if (!s.axes) {
      return refuse(
          "rotary words with tool-centre control need the machine that they are written for: which "
          "axes turn "
          "what is in its machine file",
          "--machine FILE", "machine");
    }
    if (!s.axes->refusal().empty()) return refuse(s.axes->refusal(), kRightMachine, "machine");
    if (to.position.is_by_control) {
      return refuse(
          "the control turned the rotary axes (G53.1 and its kin, or vectors), and no word says to "
          "where",
          "write all rotary words into the first block with tool-centre control", "not given");
    }
    to.axis = s.axes->axis(to.position.rotary);
    return {};
  }
  Vector3 axis = Vector3::UnitZ();  // along the machine's Z
  const bool is_bare = !holds_tip(s.modes.control);
  if (is_bare && is_across_plane(s, to.position)) axis = tool_of_plane(s);
  if (s.modes.control == Control::kVector) {
    if (!to.position.vector && to.position.is_turned()) {
      return refuse("no I J K yet, and rotary axes are not at zero: the tool axis is not known",
                    "write the tool axis into the first block with tool-centre control");
    }
    const bool is_tilted = !s.frames.now.rotation.isIdentity();
    if (is_tilted && s.modes.language == Language::kFanuc) {
      return refuse("G43.5 in a tilted plane", "output G43.5 without G68.2, in one frame", "G43.5");
    }
    if (to.position.vector) axis = s.frames.now.direction(to_vector(*to.position.vector));
  }
  to.axis = direction_in_w(s, axis);
  return {};
}

/// A vector that leads elsewhere than the rotary words did: the control has turned the rotary axes,
/// and where they stand is not in the program.
void note_turn_by_vector(const State& s, Target& to) {
  if (s.modes.control != Control::kVector) return;
  const bool has_words = s.axes && s.axes->refusal().empty();
  const Vector3 by_words =
      has_words ? s.axes->axis(to.position.rotary) : direction_in_w(s, Vector3::UnitZ());
  if ((to.axis - by_words).norm() <= kSameAxis) return;
  to.position.is_by_control = true;
  to.position.rotary.clear();
}

/// Words that mean nothing where they stand.
cl::Outcome check_words(const State& s, const Line& line, bool is_arc) {
  for (const char* const address : {"I", "J", "K", "R"}) {
    const bool is_vector = s.modes.control == Control::kVector && address[0] != 'R' &&
                           s.modes.language == Language::kFanuc;
    if (line.find(address) != nullptr && !is_arc && !is_vector) {
      return refuse(std::string("word ") + address + " in a block that is no arc",
                    "write G2 or G3, or G43.5 for a tool axis");
    }
  }
  for (const char* const address : {"U", "V", "W"}) {
    if (line.find(address) != nullptr) {
      return refuse(std::string("word ") + address + " moves an axis beside X, Y and Z",
                    kMovesByCam);
    }
  }
  const Word* const lean = line.find("Q");
  if (lean != nullptr && lean->number != 0) {
    const bool leans = s.modes.control == Control::kVector;
    return refuse(leans ? "word Q beside a point: under G43.5 the control leans the tool by it"
                        : "word Q beside a point is not understood",
                  leans ? "output the tool axis itself, and Q0" : "leave it out");
  }
  // D is the number of a radius: without G41 and G42, which are refused, it says nothing.
  if (line.find("E") != nullptr) {
    return refuse("word E in a motion block is not understood", "write it in a block of its own");
  }
  return {};
}

/// A cut without G43, or under D0 of Siemens: its Z may be that of the spindle.
void warn_of_no_length(State& s, const Line& line) {
  if (s.modes.control != Control::kNone || s.modes.motion == Motion::kRapid) return;
  const bool is_siemens = s.modes.language == Language::kSiemens;
  s.cl.remarks.warn("no length", line.number, [is_siemens] {
    return std::string("a cut ") + (is_siemens ? "under D0" : "without G43 or G43.4") +
           ": Z is read as that of the tip; where it means the spindle, the tool cuts off by its "
           "length";
  });
}

/// Without tool-centre control X Y Z are those of the tip only where no rotary axis is turned, or
/// where the tool stands across a tilted plane.
bool is_of_tip(const State& s, const Target& to) {
  if (holds_tip(s.modes.control)) return true;
  return !to.turns && (!to.position.is_turned() || is_across_plane(s, to.position));
}

/// A cut in a tilted plane waits for the rotary axes.
cl::Outcome check_plane(const State& s, const Target& to) {
  const bool waits = s.modes.motion != Motion::kRapid && s.frames.tilt == Tilt::kDefined &&
                     !holds_tip(s.modes.control);
  if (!waits || is_across_plane(s, to.position)) return {};
  return refuse("a cut in a tilted plane that the tool does not stand across",
                s.axes ? "turn the tool first: G53.1, or PLANE .. TURN"
                       : "turn the tool first (G53.1, PLANE .. TURN); by rotary words: "
                         "--machine FILE",
                "no G53.1");
}

/// Without tool-centre control a cut is that of the tip only where no rotary axis is turned.
cl::Outcome check_tip(const State& s, const Target& to) {
  if (s.modes.motion != Motion::kLine || is_of_tip(s, to)) return {};
  if (to.position.is_by_control) {
    return refuse(
        "a cut without tool-centre control, but the control turned the rotary axes, and no word "
        "says where they stand",
        "write the words of all rotary axes before it", "no tip");
  }
  const auto lost = std::find_if(to.position.rotary.begin(), to.position.rotary.end(),
                                 [](const RotaryAt& at) { return !at.deg; });
  if (lost != to.position.rotary.end()) {
    return refuse("a cut without tool-centre control, and where rotary axis " + lost->address +
                      " stands is not known here",
                  "--machine FILE, which says where it was sent, or a word for it", "no tip");
  }
  const bool is_fanuc = s.modes.language == Language::kFanuc;
  return refuse("a cut without tool-centre control while a rotary axis is not at zero",
                is_fanuc ? "output G43.4 or G43.5, under which X Y Z are those of the tool tip"
                         : "switch it on (TRAORI, FUNCTION TCPM): X Y Z are those of the tip then",
                "no tip");
}

cl::Outcome move_plainly(State& s, const Line& line, const Target& to) {
  warn_of_no_length(s, line);
  if (is_of_tip(s, to) && to.position.is_known()) return line_to(s, line, to);
  if (s.cl.path.has_moved()) warn_of_unseen_rapid(s, line);
  s.position = to.position;
  if (!is_of_tip(s, to)) s.position.forget();
  return {};
}

}  // namespace

void note_digits(State& s, const Line& line, const Word& word) {
  s.cl.summary.decimals = std::max(s.cl.summary.decimals, word.decimals);
  if (word.has_point || word.number == 0) return;
  s.cl.remarks.warn("point", line.number, [&word] {
    return std::string(word.address) + std::string(word.digits) +
           " has no decimal point: taken as whole millimetres, inches or degrees; some controls "
           "count least increments there";
  });
}

bool is_relative(const State& s, const Word& word) {
  return word.distance_mode == Word::DistanceMode::kModal
             ? s.modes.is_incremental()
             : word.distance_mode == Word::DistanceMode::kIncremental;
}

bool ToolPosition::is_turned() const noexcept {
  return is_by_control || std::any_of(rotary.begin(), rotary.end(), [](const RotaryAt& at) {
           return !at.deg || std::fmod(*at.deg, 360.0) != 0;
         });
}

void warn_of_unseen_rapid(State& s, const Line& line) {
  s.cl.remarks.warn("no tip", line.number, [] {
    return "rapids after which the tip is not known (rotary axes turned without tool-centre "
           "control, or not all of X Y Z given) are no part of the path: the next motion goes "
           "straight from the point before them; see that nothing is in the way";
  });
}

Vector3 in_w(const State& s, const Vector3& written) {
  return direction_in_w(s, s.cl.units.to_mm * in_program(s, written));
}

cl::Outcome move(State& s, const Line& line) {
  if (s.modes.motion == Motion::kNone) {
    return refuse("a point, but no G0, G1, G2 or G3 before it", "write G0 or G1 with it", "no G0");
  }
  const bool is_arc =
      s.modes.motion == Motion::kClockwise || s.modes.motion == Motion::kCounterClockwise;
  if (auto done = check_words(s, line, is_arc); !done) return done;
  if (auto done = cl::begin_motion(s.cl, line.number); !done) return done;
  if (auto done = check_work_offset(s, line); !done) return done;
  if (auto done = choose_orientation(s, line); !done) return done;
  Target to{s.position, Vector3::UnitZ(), false};
  if (auto done = take_tip(s, line, to); !done) return done;
  if (auto done = take_rotary(s, line, to); !done) return done;
  if (s.modes.has_dynamic_offset && to.turns) {
    if (auto done = turn_with_table(s, line, to); !done) return done;
  }
  if (s.modes.control == Control::kVector && !is_arc) {
    if (auto done = take_vector(s, line, to); !done) return done;
  }
  if (auto done = find_axis(s, to); !done) return done;
  note_turn_by_vector(s, to);
  if (auto done = check_plane(s, to); !done) return done;
  if (auto done = check_tip(s, to); !done) return done;
  const bool is_cut = s.modes.motion != Motion::kRapid;
  const bool has_begun = s.cl.path.has_moved() || is_arc;
  if (is_cut && (!to.position.is_known() || (has_begun && !s.position.is_known()))) {
    return refuse("a cut, but where it begins is not known here",
                  "write a G0 with X, Y and Z before it, under the tool-centre control in force",
                  "not known");
  }
  ++(holds_tip(s.modes.control) ? s.cl.summary.goto_six : s.cl.summary.goto_three);
  return is_arc ? arc_to(s, line, to) : move_plainly(s, line, to);
}

}  // namespace meridian::nc
