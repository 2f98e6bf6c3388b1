// SPDX-License-Identifier: Apache-2.0
// F, S, T, M and dwells: what a block says beside its motion.
#include <algorithm>
#include <cmath>

#include "meridian/units.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/state.hpp"
#include "service/programs/nc/words/codes.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr double kMaxTool = 1e9;
constexpr double kMaxSpeed = 1e6;
constexpr double kLongestDwell_s = 86400;

bool is_whole(double number, double max) {
  return number >= 0 && number <= max && number == std::floor(number);
}

cl::Outcome take_feed(State& s, const Line& line) {
  const Word* const f = line.find("F");
  if (f == nullptr) return {};
  if (!(f->number > 0)) return refuse("F" + std::string(f->digits) + " is no feed");
  s.cl.written_feed = {f->number, s.modes.feed_unit};
  s.cl.feed.reset();
  return {};
}

/// The action of a spindle that turns, with its speed.
void start_spindle(State& s, const Line& line) {
  s.cl.path.act(BlockKind::kAuxiliary, s.cl.spindle.state, s.cl.spindle.speed_rpm, line.number);
}

cl::Outcome take_speed(State& s, const Line& line, bool starts) {
  const Word* const speed = line.find("S");
  if (speed == nullptr) return {};
  if (!(speed->number >= 0 && speed->number <= kMaxSpeed)) {
    return refuse("spindle speed " + cl::short_number(speed->number) + " makes no sense");
  }
  s.cl.feed.reset();
  s.cl.spindle.speed_rpm = speed->number;
  if (!starts && s.cl.spindle.state != ActionKind::kSpindleOff) start_spindle(s, line);
  return {};
}

cl::Outcome turn_spindle(State& s, const Line& line, ActionKind sense) {
  if (!(s.cl.spindle.speed_rpm > 0))
    return refuse("the spindle starts, but no S gave its speed", "write S with it");
  s.cl.feed.reset();
  s.cl.spindle.sense = s.cl.spindle.state = sense;
  start_spindle(s, line);
  return {};
}

void stop_spindle(State& s, const Line& line) {
  s.cl.feed.reset();
  s.cl.spindle.state = ActionKind::kSpindleOff;
  s.cl.path.act(BlockKind::kAuxiliary, ActionKind::kSpindleOff, 0, line.number);
}

/// A tool by its name: as the tool table has it, or a number of its own.
cl::Outcome take_named_tool(State& s, const Line& line, std::string_view name) {
  const auto known = s.tools.find(name);
  if (known) {
    s.modes.next_tool = *known;
    return {};
  }
  const auto number = s.tools.number_of(name);
  if (!number) return tl::make_unexpected(number.error());
  s.cl.remarks.warn(name, line.number, [&] {
    return "tool " + cl::quoted(name) + " is called " + std::to_string(*number) +
           " here; give its row in the tool table name = " + cl::quoted(name);
  });
  s.modes.next_tool = *number;
  return {};
}

cl::Outcome take_tool(State& s, const Line& line) {
  const Word* const t = line.find("T");
  if (t == nullptr) return {};
  if (!t->text.empty()) return take_named_tool(s, line, t->text);
  if (!is_whole(t->number, kMaxTool)) {
    return refuse("tool number " + cl::short_number(t->number) + " is not a whole number");
  }
  s.modes.next_tool = static_cast<std::uint32_t>(t->number);
  return {};
}

cl::Outcome change_tool(State& s, const Line& line) {
  if (!s.modes.next_tool) return refuse("M6, but no T named the tool", "write T with it");
  const std::uint32_t tool = *s.modes.next_tool;
  if (tool == 0) {  // the spindle is emptied
    s.cl.summary.skip("T0", line.number);
    return {};
  }
  auto& tools = s.cl.summary.tools;
  if (tools.size() < cl::ClSummary::kMaxTools &&
      std::find(tools.begin(), tools.end(), tool) == tools.end()) {
    tools.push_back(tool);
  }
  s.cl.tool = tool;
  s.cl.path.act(BlockKind::kTool, ActionKind::kToolChange, tool, line.number);
  if (s.modes.control == Control::kNone) s.position.tip[2].reset();
  const bool is_siemens = s.modes.language == Language::kSiemens;  // a new tool comes with its D1
  if (is_siemens && s.modes.control == Control::kNone) s.modes.control = Control::kLength;
  return {};
}

/// A code of the machine's own.
cl::Outcome pass_on(State& s, const Line& line, const Word& word) {
  if (!is_whole(word.number, 99999)) {
    return refuse("M" + std::string(word.digits) + " is no M code");
  }
  s.cl.path.vendor_word("M" + std::string(word.digits), word.number, line.number);
  return {};
}

/// What has its time before the motion of its block.
bool comes_before(const MRow* row) {
  if (row == nullptr || row->kind == MKind::kTool) return true;
  const auto action = static_cast<ActionKind>(row->value);
  return (row->kind == MKind::kSpindle && action != ActionKind::kSpindleOff) ||
         (row->kind == MKind::kCoolant && action != ActionKind::kCoolantOff);
}

cl::Outcome act(State& s, const Line& line, const Word& word, const MRow* row) {
  const bool ends_subprogram = s.modes.language == Language::kSiemens && word.number == 17;
  if (ends_subprogram)
    return refuse("M17: the end of a subprogram", "output a main program", "M17");
  if (row == nullptr) return pass_on(s, line, word);
  const auto action = static_cast<ActionKind>(row->value);
  switch (row->kind) {
    case MKind::kStop:
      s.cl.path.act(BlockKind::kStop, ActionKind::kStop, 0, line.number);
      return {};
    case MKind::kOptionalStop:
      s.cl.path.act(BlockKind::kOptionalStop, ActionKind::kStop, 0, line.number);
      return {};
    case MKind::kEnd:
      s.cl.structure.phase = cl::Structure::Phase::kEnded;
      return {};
    case MKind::kSpindle:
      if (action != ActionKind::kSpindleOff) return turn_spindle(s, line, action);
      stop_spindle(s, line);
      return {};
    case MKind::kCoolant:
      s.cl.path.act(BlockKind::kAuxiliary, action, 0, line.number);
      return {};
    case MKind::kTool:
      return change_tool(s, line);
    case MKind::kRefused:
      break;
  }
  return refuse("M" + std::string(word.digits) + ": " + std::string(row->note),
                std::string(row->remedy), "M" + std::string(word.digits));
}

/// D0 takes the length of the tool out of force, D1 and its kin put it in; a tool change too.
void note_tool_offset(State& s, const Line& line) {
  const Word* const d = line.find("D");
  if (d == nullptr || s.modes.is_oriented()) return;
  s.modes.control = d->number == 0 ? Control::kNone : Control::kLength;
}

bool starts_spindle(const Line& line) {
  return std::any_of(line.words.begin(), line.words.end(), [](const Word& word) {
    return word.is('M') && (word.number == 3 || word.number == 4);
  });
}

}  // namespace

cl::Outcome rest(State& s, const Line& line, double time_s) {
  if (!(time_s >= 0 && time_s <= kLongestDwell_s)) {
    return refuse("dwell of " + cl::short_number(time_s) + " s makes no sense");
  }
  s.cl.summary.dwell_time_s += time_s;
  s.cl.path.act(BlockKind::kDwell, ActionKind::kNone, time_s, line.number);
  return {};
}

cl::Outcome act_before(State& s, const Line& line) {
  if (s.modes.language == Language::kSiemens) note_tool_offset(s, line);
  if (auto done = take_feed(s, line); !done) return done;
  if (auto done = take_speed(s, line, starts_spindle(line)); !done) return done;
  if (auto done = take_tool(s, line); !done) return done;
  for (const Word& word : line.words) {
    const MRow* const row = word.is('M') ? find_m(word.number) : nullptr;
    if (!word.is('M') || !comes_before(row)) continue;
    if (auto done = act(s, line, word, row); !done) return done;
  }
  return {};
}

cl::Outcome act_after(State& s, const Line& line) {
  for (const Word& word : line.words) {
    const MRow* const row = word.is('M') ? find_m(word.number) : nullptr;
    if (!word.is('M') || comes_before(row)) continue;
    if (auto done = act(s, line, word, row); !done) return done;
  }
  return {};
}

cl::Outcome dwell(State& s, const Line& line) {
  const Word* seconds = nullptr;
  for (const char* const address : {"X", "U"}) {
    if (seconds == nullptr) seconds = line.find(address);
  }
  const Word* const p = line.find("P");
  if ((seconds == nullptr) == (p == nullptr)) {
    return refuse("G4 needs one time", "G4 X or U in seconds, G4 P in milliseconds");
  }
  double time_s = seconds != nullptr ? seconds->number : p->number;
  if (p != nullptr && !p->has_point) time_s /= 1000;
  if (p != nullptr && p->has_point) {
    s.cl.remarks.warn("dwell", line.number,
                      [] { return std::string("G4 P with a decimal point: taken as seconds"); });
  }
  return rest(s, line, time_s);
}

cl::Outcome siemens_dwell(State& s, const Line& line) {
  const Word* const seconds = line.find("F");
  const Word* const turns = line.find("S");
  if ((seconds == nullptr) == (turns == nullptr)) {
    return refuse("G4 needs one time", "G4 F in seconds, G4 S in revolutions");
  }
  if (seconds != nullptr) return rest(s, line, seconds->number);
  if (!s.cl.spindle.turns())
    return refuse("dwell in revolutions, but no spindle speed is in force",
                  "write S and M3 or M4 before it");
  return rest(s, line, turns->number * units::kMinute_s / s.cl.spindle.speed_rpm);
}

}  // namespace meridian::nc
