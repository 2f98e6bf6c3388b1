// SPDX-License-Identifier: Apache-2.0
// Where a line leads: tip and tool axis by the words that it has.
#include <algorithm>
#include <array>
#include <cmath>

#include "service/cl/words/motion.hpp"
#include "service/cl/written_text.hpp"
#include "service/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr std::array<std::string_view, 3> kTip = {"X", "Y", "Z"};

/// Numbers without a point are whole units here; older controls count least increments.
void note_digits(State& s, const Line& line, const Word& word) {
  s.cl.summary.decimals = std::max(s.cl.summary.decimals, word.decimals);
  if (word.has_point || word.number == 0) return;
  s.cl.remarks.warn("point", line.number, [&word] {
    return std::string(word.address) + std::string(word.digits) +
           " has no decimal point: taken as whole millimetres, inches or degrees; some controls "
           "count least increments there";
  });
}

void set_rotary(Place& place, std::string_view address, double deg) {
  const auto at = std::find_if(place.rotary.begin(), place.rotary.end(),
                               [&](const RotaryAt& r) { return r.address == address; });
  if (at != place.rotary.end()) {
    at->deg = deg;
  } else {
    place.rotary.push_back({std::string(address), deg});
  }
}

std::optional<double> rotary_of(const Place& place, std::string_view address) {
  for (const RotaryAt& at : place.rotary) {
    if (at.address == address) return at.deg;
  }
  return std::nullopt;
}

bool is_relative(const State& s, const Word& word) {
  return word.way == Word::Way::kModal ? s.modes.is_incremental
                                       : word.way == Word::Way::kIncremental;
}

cl::Outcome take_tip(State& s, const Line& line, Target& to) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Word* const word = line.find(kTip[k]);
    if (word == nullptr) continue;
    note_digits(s, line, *word);
    std::optional<double>& at = to.place.tip[k];
    const bool is_incremental = is_relative(s, *word);
    if (is_incremental && !at) {
      return refuse("G91, but where " + std::string(kTip[k]) + " stands is not known here",
                    "write a G0 with X, Y and Z under G90 first", "not known");
    }
    at = is_incremental ? *at + word->number : word->number;
  }
  return {};
}

cl::Outcome take_rotary(State& s, const Line& line, Target& to) {
  for (const Word& word : line.words) {
    if (!word.may_be_rotary()) continue;
    const std::string address(word.address);
    if (s.modes.control == Control::kVector) {
      return refuse("rotary word " + address + " under G43.5, where I J K give the tool axis");
    }
    if (s.axes && s.axes->refusal().empty() && !s.axes->is_rotary(word.address)) {
      return refuse("the machine has no rotary axis with the NC word " + address,
                    "check nc_word in the machine file", "no axis " + address);
    }
    note_digits(s, line, word);
    const std::optional<double> before = rotary_of(to.place, address);
    const bool is_incremental = is_relative(s, word);
    if (is_incremental && !before) {
      return refuse("G91, but where " + address + " stands is not known here");
    }
    const double deg = is_incremental ? *before + word.number : word.number;
    if (!(std::abs(deg) <= 1e6)) return refuse("an angle beyond 1e6 deg");
    to.turns = to.turns || before.value_or(0) != deg;
    set_rotary(to.place, address, deg);
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
    if (!s.axes->refusal().empty()) return refuse(s.axes->refusal(), {}, "machine");
    to.axis = s.axes->axis(to.place.rotary);
    return {};
  }
  Vector3 axis = Vector3::UnitZ();  // along the machine's Z
  if (s.modes.control == Control::kVector) {
    if (!to.place.has_vector && to.place.is_turned()) {
      return refuse("no I J K yet, and rotary axes are not at zero: the tool axis is not told",
                    "write the tool axis into the first block with tool-centre control");
    }
    if (to.place.has_vector) axis = to_vector(to.place.vector);
  }
  to.axis = s.axes ? Vector3(s.axes->to_program().transpose() * axis) : axis;
  return {};
}

/// Words that mean nothing where they stand.
cl::Outcome check_words(const State& s, const Line& line, bool is_arc) {
  for (const char* const address : {"I", "J", "K", "R"}) {
    const bool is_vector = s.modes.control == Control::kVector && address[0] != 'R' &&
                           s.modes.language == Language::kFanuc;
    if (line.find(address) != nullptr && !is_arc && !is_vector) {
      return refuse(std::string("word ") + address + " in a block that is no arc");
    }
  }
  for (const char* const address : {"U", "V", "W"}) {
    if (line.find(address) != nullptr) {
      return refuse(std::string("word ") + address + " moves an axis beside X, Y and Z");
    }
  }
  const bool is_fanuc = s.modes.language == Language::kFanuc;  // else D is the tool's own offset
  if (line.find("E") != nullptr || (is_fanuc && line.find("D") != nullptr)) {
    return refuse("word E or D in a motion block is not understood");
  }
  return {};
}

/// A cut of words of Fanuc without G43: its Z may be that of the spindle.
void warn_of_no_length(State& s, const Line& line) {
  const bool is_bare = s.modes.control == Control::kNone && s.modes.language == Language::kFanuc;
  if (!is_bare || s.modes.motion == Motion::kRapid) return;
  s.cl.remarks.warn("no length", line.number, [] {
    return "a cut without G43 or G43.4: Z is read as that of the tip; where it means the spindle, "
           "the tool cuts off by its length";
  });
}

/// Without tool-centre control X Y Z are those of the tip only where no rotary axis is turned.
cl::Outcome move_plainly(State& s, const Line& line, const Target& to) {
  warn_of_no_length(s, line);
  if (holds_tip(s.modes.control) || (!to.turns && !to.place.is_turned())) {
    if (to.place.is_known()) return line_to(s, line, to);
  } else if (s.modes.motion != Motion::kRapid) {
    return refuse("a cut without tool-centre control while a rotary axis is not at zero",
                  "output G43.4 or G43.5, under which X Y Z are those of the tool tip", "no tip");
  }
  if (s.cl.path.has_moved())
    s.cl.remarks.warn("no tip", line.number, [] {
      return "rapids behind which the tip is not known (rotary axes turned without tool-centre "
             "control, or not all of X Y Z told) are no part of the path: the next motion goes "
             "straight from the point before them; see that nothing is in the way";
    });
  s.place = to.place;
  if (!holds_tip(s.modes.control) && (s.place.is_turned() || to.turns)) s.place.forget();
  return {};
}

}  // namespace

bool Place::is_turned() const noexcept {
  return std::any_of(rotary.begin(), rotary.end(),
                     [](const RotaryAt& at) { return !at.deg || std::fmod(*at.deg, 360.0) != 0; });
}

Vector3 in_w(const State& s, const Vector3& written) {
  const Vector3 mm = s.cl.units.to_mm * written;
  return s.axes ? Vector3(s.axes->to_program().transpose() * mm) : mm;
}

cl::Outcome move(State& s, const Line& line) {
  if (s.modes.motion == Motion::kNone) {
    return refuse("a point, but no G0, G1, G2 or G3 before it");
  }
  const bool is_arc =
      s.modes.motion == Motion::kClockwise || s.modes.motion == Motion::kCounterClockwise;
  if (auto done = check_words(s, line, is_arc); !done) return done;
  if (auto done = cl::begin_motion(s.cl, line.number); !done) return done;
  if (auto done = choose_orientation(s, line); !done) return done;
  Target to{s.place, Vector3::UnitZ(), false};
  if (auto done = take_tip(s, line, to); !done) return done;
  if (auto done = take_rotary(s, line, to); !done) return done;
  if (s.modes.control == Control::kVector && !is_arc) {
    if (auto done = take_vector(s, line, to); !done) return done;
  }
  if (auto done = find_axis(s, to); !done) return done;
  const bool is_cut = s.modes.motion != Motion::kRapid;
  const bool has_begun = s.cl.path.has_moved() || is_arc;
  if (is_cut && (!to.place.is_known() || (has_begun && !s.place.is_known()))) {
    return refuse("a cut, but where it begins is not known here",
                  "write a G0 with X, Y and Z before it, under the tool-centre control in force",
                  "not known");
  }
  ++(holds_tip(s.modes.control) ? s.cl.summary.goto_six : s.cl.summary.goto_three);
  return is_arc ? arc_to(s, line, to) : move_plainly(s, line, to);
}

}  // namespace meridian::nc
