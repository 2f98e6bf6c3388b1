// SPDX-License-Identifier: Apache-2.0
// Klartext: every statement becomes the words of ISO that say the same.
#include <algorithm>
#include <array>
#include <optional>

#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/block.hpp"
#include "service/programs/nc/heidenhain/heidenhain_arcs.hpp"
#include "service/programs/nc/heidenhain/heidenhain_cycles.hpp"
#include "service/programs/nc/heidenhain/heidenhain_frames.hpp"
#include "service/programs/nc/heidenhain/heidenhain_function.hpp"
#include "service/programs/nc/heidenhain/heidenhain_parameters.hpp"
#include "service/programs/nc/heidenhain/heidenhain_words.hpp"
#include "service/programs/nc/remedy.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

bool has_name(const Line& line, std::string_view name) {
  return std::any_of(line.names.begin(), line.names.end(),
                     [name](const Line::Name& n) { return n.name == name; });
}

cl::Outcome begin_program(State& s, const Line& line) {
  const std::string_view text = line.names.front().arguments;
  if (text.find(" INCH") != std::string_view::npos) {
    (void)set_unit(s, cl::LengthUnit::kInch);  // no unit is missing besides
    return refuse("a program in inch, whose feeds count tenths of an inch", "output it in MM");
  }
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin != std::string_view::npos) {
    s.cl.summary.program = std::string(text.substr(begin, text.find(' ', begin) - begin));
  }
  return set_unit(s, cl::LengthUnit::kMillimetre);
}

/// CYCL DEF 9.1 DWELL 0.500, and what of the other cycles says nothing about where.
cl::Outcome run_cycle_definition(State& s, const Line& line) {
  std::string_view text = line.names.front().arguments;
  while (text.starts_with(' ')) text.remove_prefix(1);
  const std::string number(text.substr(0, text.find(' ')));
  if (number.size() == 3 && number.starts_with("7.") && number != "7.0") {
    return shift_datum(s, line, text.substr(number.size()));
  }
  if (number.starts_with("32.") || number == "9.0" || number == "7.0") {
    s.cl.summary.skip("CYCL DEF " + number, line.number);
    return {};
  }
  if (is_frame_cycle(number)) return reset_frame_cycle(s, line, number, text.substr(number.size()));
  if (number == "9.1") {
    const auto seconds = read_number(text.substr(text.rfind(' ') + 1), s.variables);
    if (seconds) return rest(s, line, *seconds);
  }
  return define_cycle(s, line, number, text.substr(number.size()));
}

/// Words that this line has no use for, and that would move the tool in another one.
cl::Outcome check_words_of_others(std::string_view statement, const Line& iso, bool retracts) {
  for (const std::string_view other : {"PR", "IPR", "PA", "IPA", "MB"}) {
    if (iso.find(other) == nullptr || (retracts && other == "MB")) continue;
    return refuse(std::string(other) + " in a line with " + std::string(statement),
                  other == "MB" ? "write it beside M140"
                                : "write LP for a line, CP for an arc with PA or IPA alone",
                  std::string(other));
  }
  return {};
}

cl::Outcome prepare_motion(State& s, const Line& line, Translated& translated) {
  Line& iso = translated.iso;
  const std::string_view statement = line.names.front().name;
  const bool is_rapid = has_name(line, "FMAX");
  if (has_name(line, "RL") || has_name(line, "RR")) {
    return refuse("radius compensation (RL, RR)", "output the path of the tool's centre (R0)");
  }
  s.modes.motion = is_rapid ? Motion::kRapid : Motion::kLine;
  const bool is_arc = statement == "C" || statement == "CR" || statement == "CP";
  auto done = statement == "LP" ? prepare_polar_line(s, iso)
              : is_arc          ? prepare_arc(s, line, iso)
                                : cl::Outcome();
  if (!done) return done;
  return check_words_of_others(statement, iso, translated.retracts);
}

bool is_of_motion(const Word& word) {
  return !word.is('F') && !word.is('S') && !word.is('T') && !word.is('M');
}

/// L B+Q121 C+Q122 after PLANE .. STAY: the rotary axes go to where the plane wants them.
cl::Outcome take_plane_angles(State& s, Line& iso) {
  const auto is_of_plane = [](const Word& word) {
    return word.distance_mode == Word::DistanceMode::kOfPlane;
  };
  if (std::none_of(iso.words.begin(), iso.words.end(), is_of_plane)) return {};
  if (s.frames.tilt == Tilt::kNone || s.modes.motion != Motion::kRapid) {
    return refuse("a Q parameter", kMovesByCam, "Q");
  }
  const bool has_others = std::any_of(iso.words.begin(), iso.words.end(), [&](const Word& word) {
    return is_of_motion(word) && !is_of_plane(word);
  });
  if (has_others) {
    return refuse("other coordinates beside Q120, Q121 or Q122",
                  "turn the tool in a block of its own");
  }
  std::erase_if(iso.words, is_of_plane);
  turn_to_plane(s, iso);
  return {};
}

/// FAUTO: the feed of the last TOOL CALL that gave one.
cl::Outcome take_auto_feed(State& s, const Line& line) {
  if (!has_name(line, "FAUTO")) return {};
  if (!(s.modes.auto_feed > 0))
    return refuse("FAUTO, but no TOOL CALL before it gives F", "write F with a number");
  s.cl.written_feed = {s.modes.auto_feed, s.modes.feed_unit};
  s.cl.feed.reset();
  return {};
}

/// M140 MB50, M140 MB MAX.
cl::Outcome run_retract(State& s, const Line& line, const Line& iso) {
  const Word* const by = iso.find("MB");
  const auto others = std::count_if(iso.words.begin(), iso.words.end(), is_of_motion);
  if (others != (by != nullptr ? 1 : 0)) {
    return refuse("M140 beside coordinates", "write it in a block of its own", "M140");
  }
  if (by == nullptr && !has_name(line, "MB MAX")) {
    return refuse("M140 needs MB with a length, or MB MAX", {}, "M140");
  }
  return retract(s, iso, by != nullptr ? std::optional(by->number) : std::nullopt);
}

/// L, LN, LP, C, CR, CP: what moves, with the actions of its line.
cl::Outcome run_words(State& s, const Line& line) {
  Translated translated;
  const std::string_view statement = line.names.front().name;
  if (auto done = translate(s, line, translated); !done) return done;
  Line& iso = translated.iso;
  if (auto done = prepare_motion(s, line, translated); !done) return done;
  if (auto done = take_auto_feed(s, line); !done) return done;
  if (auto done = act_before(s, iso); !done) return done;
  if (translated.retracts) {
    if (auto done = run_retract(s, line, iso); !done) return done;
    return act_after(s, iso);
  }
  if (!translated.is_machine_position) {
    if (auto done = take_angles_in_space(s, iso); !done) return done;
  }
  const bool moves = std::any_of(iso.words.begin(), iso.words.end(), is_of_motion);
  const bool is_motion = statement != "STOP" && statement != "M" && statement != "TOOL CALL";
  if (moves && !is_motion) return refuse(std::string(statement) + " with coordinates");
  if (moves) {
    if (auto taken = take_plane_angles(s, iso); !taken) return taken;
    const bool goes_on = std::any_of(iso.words.begin(), iso.words.end(), is_of_motion);
    if (!goes_on) return act_after(s, iso);
    auto done = translated.is_machine_position
                    ? move_to_machine_position(s, iso, MachinePosition::kAsWritten)
                    : move(s, iso);
    if (!done) return done;
  }
  const auto* const cycle = std::get_if<CycleDefinition>(&s.modes.definition);
  const bool is_modal = cycle != nullptr && cycle->runs_at_every_point;
  if (translated.calls_cycle || (is_modal && moves)) {
    if (auto done = call_cycle(s, iso); !done) return done;
  }
  return act_after(s, iso);
}

/// A new speed of a spindle that turns holds from the next line on, which often gives its sense.
void act_on_speed(State& s, const Line& line) {
  if (!s.modes.has_new_speed) return;
  s.modes.has_new_speed = false;
  const bool names_sense = std::any_of(line.words.begin(), line.words.end(), [](const Word& word) {
    constexpr std::array kSense = {3.0, 4.0, 5.0, 13.0, 14.0};
    return word.is('M') && std::find(kSense.begin(), kSense.end(), word.number) != kSense.end();
  });
  if (names_sense) return;
  s.cl.path.act(BlockKind::kAuxiliary, s.cl.spindle.state, s.cl.spindle.speed_rpm, line.number);
}

/// TOOL CALL 5 Z S6000 F500: the tool, a speed for it, and the feed, which FAUTO means later too.
cl::Outcome call_tool(State& s, const Line& line) {
  Translated translated;
  if (auto done = translate(s, line, translated); !done) return done;
  Line& iso = translated.iso;
  if (const Word* const feed = iso.find("F")) {
    s.modes.auto_feed = feed->number;
    s.cl.written_feed = {feed->number, s.modes.feed_unit};
    s.cl.feed.reset();
  }
  std::erase_if(iso.words, [](const Word& word) { return word.is('F'); });
  const Word* const speed = iso.find("S");
  if (speed != nullptr && s.cl.spindle.state != ActionKind::kSpindleOff && speed->number > 0 &&
      speed->number < 1e6) {
    s.cl.spindle.speed_rpm = speed->number;
    s.modes.has_new_speed = true;
    std::erase_if(iso.words, [](const Word& word) { return word.is('S'); });
  }
  Word change;
  change.number = 6;
  if (iso.find("T") != nullptr) move_word(iso, change, "M");
  return act_before(s, iso);
}

/// Q5 = 3 of the program's own parameters; others belong to the cycle above.
bool is_assignment(const Line& line) {
  const std::string_view text = line.names.front().arguments;
  return is_free_parameter(text.substr(0, length_of_parameter(text)));
}

/// Q5 = 3, FN 0: Q5 = 3.
cl::Outcome run_assignment(State& s, const Line& line) {
  std::string_view text = line.names.front().arguments;
  if (line.names.front().name == "FN") {
    const std::size_t colon = text.find(':');
    const std::size_t function = text.find_first_not_of(' ');
    if (colon == std::string_view::npos || text.substr(function, colon - function) != "0") {
      return refuse(
          "FN" + std::string(text.substr(0, 16)) + ": jumps and formulas are not run here",
          kMovesByCam, "FN");
    }
    text.remove_prefix(colon + 1);
  }
  return assign_parameter(text, s.variables);
}

}  // namespace

cl::Outcome run_heidenhain(State& s, const Line& line) {
  const std::string_view statement = line.names.front().name;
  act_on_speed(s, line);
  if (statement == "Q" && !is_assignment(line)) {
    return take_cycle_parameters(s, line, line.names.front().arguments);
  }
  s.modes.open = OpenDefinition::kNone;
  if (statement == "Q" || statement == "FN") return run_assignment(s, line);
  if (statement == "BEGIN PGM") return begin_program(s, line);
  if (statement == "END PGM") {
    s.cl.structure.phase = cl::Structure::Phase::kEnded;
    return {};
  }
  if (statement == "FUNCTION") return run_function(s, line);
  if (statement == "TOOL CALL") return call_tool(s, line);
  if (statement == "CYCL DEF") return run_cycle_definition(s, line);
  if (statement == "CYCL CALL") return run_cycle_call(s, line);
  if (statement == "CC") return set_pole(s, line);
  if (statement == "TRANS DATUM") return move_datum(s, line, line.names.front().arguments);
  if (statement == "PRESET SELECT") return select_preset(s, line, line.names.front().arguments);
  if (statement == "PLANE") return set_klartext_plane(s, line, line.names.front().arguments);
  // A label alone moves nothing: what calls it is refused.
  const bool is_nothing = statement == "BLK FORM" || statement == "TOOL DEF" || statement == "LBL";
  if (is_nothing) {
    s.cl.summary.skip(statement, line.number);
    return {};
  }
  const bool has_words = statement == "L" || statement == "LN" || statement == "LP" ||
                         statement == "C" || statement == "CR" || statement == "CP" ||
                         statement == "M" || statement == "STOP";
  if (!has_words) {
    return refuse(std::string(statement) + ": this word of Klartext is not run here", kMovesByCam,
                  std::string(statement));
  }
  if (auto done = run_words(s, line); !done) return done;
  if (statement == "STOP") s.cl.path.act(BlockKind::kStop, ActionKind::kStop, 0, line.number);
  return {};
}

}  // namespace meridian::nc
