// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "meridian/units.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/cl/words/handlers.hpp"

namespace meridian::cl {
namespace {

constexpr double kMaxGears = 99;

/// LOADTL/n[,...], LOAD/TOOL,n[,...], TOOL/n: the number is argument `at`.
Outcome load_tool(Modal& m, const Statement& s, std::size_t at) {
  if (at >= s.argument_count || !s.arguments[at].is_number) {
    return refuse("tool change without a tool number");
  }
  const double number = s.arguments[at].number;
  if (!(number >= 0 && number <= 1e9 && number == std::floor(number))) {
    return refuse("tool number " + short_number(number) + " is not a whole number");
  }
  const auto tool = static_cast<std::uint32_t>(number);
  auto& tools = m.summary.tools;
  if (tools.size() < ClSummary::kMaxTools &&
      std::find(tools.begin(), tools.end(), tool) == tools.end()) {
    tools.push_back(tool);
  }
  m.tool = tool;
  m.path.act(BlockKind::kTool, ActionKind::kToolChange, number, s.line);
  return {};
}

/// What may stand behind RANGE: the number of a gear or its name.
bool is_gear(const Argument& a) {
  if (a.is_number) {
    return a.number >= 0 && a.number <= kMaxGears && a.number == std::floor(a.number);
  }
  return is_word(a.text, "LOW") || is_word(a.text, "MEDIUM") || is_word(a.text, "MED") ||
         is_word(a.text, "HIGH");
}

/// The words of a SPINDL statement, each alone.
struct SpindleWords {
  const Argument* speed = nullptr;
  std::optional<ActionKind> sense;
  bool turns = false;      ///< a word that only a turning spindle has
  std::string_view left;   ///< RANGE, MAXRPM: the machine's own business
  std::string_view other;  ///< the first word that is none of SPINDL's speed and sense
};

Expected<SpindleWords, Refusal> spindle_words(const Statement& s) {
  SpindleWords words;
  for (std::size_t i = 0; i < s.argument_count; ++i) {
    const Argument& a = s.arguments[i];
    const Argument* const next = i + 1 < s.argument_count ? &s.arguments[i + 1] : nullptr;
    if (a.is_number) {
      if (words.speed != nullptr) return refuse("SPINDL has several numbers");
      words.speed = &a;
    } else if (is_word(a.text, "RPM") || is_word(a.text, "ON")) {
      words.turns = true;
    } else if (is_word(a.text, "CLW") || is_word(a.text, "FWD")) {
      words.turns = true;
      words.sense = ActionKind::kSpindleClockwise;
    } else if (is_word(a.text, "CCLW") || is_word(a.text, "REV")) {
      words.turns = true;
      words.sense = ActionKind::kSpindleCounterClockwise;
    } else if (is_word(a.text, "SFM") || is_word(a.text, "SMM") || is_word(a.text, "SURF")) {
      return refuse("spindle by surface speed needs the radius being cut",
                    "output the speed in rev/min");
    } else if (is_word(a.text, "RANGE")) {
      words.left = "RANGE";
      i += next != nullptr && is_gear(*next) ? 1 : 0;
    } else if (is_word(a.text, "MAXRPM") && next != nullptr && next->is_number) {
      words.left = "MAXRPM";
      ++i;
    } else if (is_gear(a)) {
      words.left = "the gear";
    } else if (words.other.empty()) {
      words.other = a.text;
    }
  }
  return words;
}

}  // namespace

Outcome read_loadtl(Modal& m, const Statement& s) { return load_tool(m, s, 0); }

Outcome read_load(Modal& m, const Statement& s) {
  if (s.argument_count == 0 || !is_word(s.arguments[0].text, "TOOL")) {
    return refuse("LOAD/" + std::string(s.rest) + " is not understood", "LOAD/TOOL,n");
  }
  return load_tool(m, s, 1);
}

Outcome read_tool_data(Modal& m, const Statement& s) {
  for (std::size_t i = 0; i < s.argument_count; ++i) {
    if (!s.arguments[i].is_number) continue;
    m.units.cutter = s.arguments[i].number;
    break;
  }
  return skip(m, s);
}

Outcome read_spindle(Modal& m, const Statement& s) {
  m.feed.reset();
  if (s.has_word("OFF") || s.has_word("STOP")) {
    m.spindle.state = ActionKind::kSpindleOff;
    m.path.act(BlockKind::kAuxiliary, ActionKind::kSpindleOff, 0, s.line);
    return {};
  }
  const auto words = spindle_words(s);
  if (!words) return tl::make_unexpected(words.error());
  const bool takes_angle = is_word(words->other, "ORIENT") || is_word(words->other, "LOCK");
  const bool has_speed = words->turns || (words->speed != nullptr && !takes_angle);
  if (!words->other.empty() && has_speed) {
    return refuse("SPINDL word " + quoted(words->other) +
                  " beside a speed or a sense is not understood");
  }
  if (!has_speed && s.argument_count > 0) return pass_on(m, s);  // ORIENT, LOCK, a gear alone
  if (words->speed != nullptr) {
    const double speed = words->speed->number;
    if (!(speed >= 0 && speed <= 1e6)) {
      return refuse("spindle speed " + short_number(speed) + " makes no sense");
    }
    m.spindle.speed_rpm = speed;
  } else if (!(m.spindle.speed_rpm > 0)) {
    return refuse("SPINDL/" + std::string(s.rest) + " before any speed",
                  "write SPINDL with a speed before it");
  }
  if (!words->left.empty()) {
    m.remarks.warn(words->left, s.line, [&words] {
      return "SPINDL: " + std::string(words->left) + " is left to the machine";
    });
  }
  m.spindle.sense = words->sense.value_or(m.spindle.sense);
  m.spindle.state = m.spindle.sense;
  m.path.act(BlockKind::kAuxiliary, m.spindle.sense, m.spindle.speed_rpm, s.line);
  return {};
}

/// ON says nothing beside another word.
Outcome read_coolant(Modal& m, const Statement& s) {
  const bool is_on = s.has_word("ON");
  const bool is_on_alone = is_on && s.argument_count == 1;
  const bool has_one_word = s.argument_count == (is_on ? 2U : 1U);
  ActionKind what = ActionKind::kVendorWord;
  if (s.has_word("OFF")) {
    what = ActionKind::kCoolantOff;
  } else if (is_on_alone || (has_one_word && s.has_word("FLOOD"))) {
    what = ActionKind::kCoolantFlood;
  } else if (has_one_word && s.has_word("MIST")) {
    what = ActionKind::kCoolantMist;
  } else if (has_one_word && (s.has_word("THRU") || s.has_word("THROUGH"))) {
    what = ActionKind::kCoolantThrough;
  }
  if (what == ActionKind::kVendorWord) return pass_on(m, s);
  m.path.act(BlockKind::kAuxiliary, what, 0, s.line);
  return {};
}

/// DELAY/s, DELAY/DWELL,s and DELAY/n,REV.
Outcome read_delay(Modal& m, const Statement& s) {
  const Argument* const number = s.only_number();
  const bool revolutions = s.has_word("REV");
  const bool has_word = revolutions || s.has_word("DWELL");
  if (number == nullptr || s.argument_count > 2 || (s.argument_count == 2 && !has_word)) {
    return refuse(std::string(s.major) + " needs one number of seconds or n,REV");
  }
  double seconds = number->number;
  if (revolutions) {
    if (!m.spindle.turns()) {
      return refuse("dwell in revolutions, but no spindle speed is in force",
                    "write SPINDL before it");
    }
    seconds *= units::kMinute_s / m.spindle.speed_rpm;
  }
  if (!(seconds >= 0 && seconds <= 86400)) {
    return refuse("dwell of " + short_number(seconds) + " s makes no sense");
  }
  m.summary.dwell_time_s += seconds;
  m.path.act(BlockKind::kDwell, ActionKind::kNone, seconds, s.line);
  return {};
}

Outcome read_stop(Modal& m, const Statement& s) {
  m.path.act(BlockKind::kStop, ActionKind::kStop, 0, s.line);
  return {};
}

Outcome read_optional_stop(Modal& m, const Statement& s) {
  m.path.act(BlockKind::kOptionalStop, ActionKind::kStop, 0, s.line);
  return {};
}

Outcome pass_on(Modal& m, const Statement& s) {
  std::string text(s.major);
  if (!s.rest.empty()) text += "/";
  for (const char c : s.rest) {
    if (c != ' ' && c != '\t') text.push_back(c);
  }
  constexpr std::size_t kMax = sizeof(ClBlock::text) - 1;
  if (text.size() > kMax) {
    m.remarks.warn("vendor:" + std::string(s.major), s.line, [&text] {
      return "vendor word " + cl::quoted(text) + " is cut to " + std::to_string(kMax) +
             " characters";
    });
  }
  double value = 0;
  for (std::size_t i = s.argument_count; i-- > 0;) {
    if (s.arguments[i].is_number) value = s.arguments[i].number;
  }
  m.path.vendor_word(text, value, s.line);
  return {};
}

Outcome read_cutcom(Modal& m, const Statement& s) {
  if (s.has_word("OFF") || m.cutcom_path == CutcomPath::kOfTool) return {};
  if (m.cutcom_path == CutcomPath::kOfPart) {
    return refuse(
        "CUTCOM after CUTCOM_GEOMETRY_TYPE/OUTPUT_ON_PROFILE: the points are those of "
        "the part's edge, which the control would leave by the tool's radius",
        "let Creo output the path of the tool's centre (OUTPUT_ON_CENTER)", "CUTCOM");
  }
  m.remarks.warn("CUTCOM", s.line, [] {
    return "CUTCOM is not applied: the path is taken as the path of the tool tip, as written";
  });
  return {};
}

}  // namespace meridian::cl
