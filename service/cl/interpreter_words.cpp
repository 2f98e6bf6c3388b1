// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "meridian/units.hpp"
#include "service/cl/interpreter.hpp"

namespace meridian::cl {

Interpreter::Result Interpreter::take_rapid(const Statement& s) {
  if (s.argument_count > 0) {
    return refuse(s.line, "RAPID/" + std::string(s.rest) + " is not understood",
                  "RAPID alone holds for the next motion");
  }
  rapid_ = true;
  return {};
}

Interpreter::Result Interpreter::take_spindle(const Statement& s, Blocks& out) {
  const Argument* number = s.only_number();
  if (s.has_word("OFF")) {
    spindle_on_ = false;
    feed_dirty_ = true;
    action(BlockKind::kAuxiliary, ActionKind::kSpindleOff, 0, s.line, out);
    return {};
  }
  for (std::size_t i = 0; i < s.argument_count; ++i) {
    const Argument& a = s.arguments[i];
    if (a.is_number || is_word(a.text, "RPM") || is_word(a.text, "ON")) continue;
    if (is_word(a.text, "CLW") || is_word(a.text, "FWD")) {
      spindle_sense_ = ActionKind::kSpindleClockwise;
    } else if (is_word(a.text, "CCLW") || is_word(a.text, "REV")) {
      spindle_sense_ = ActionKind::kSpindleCounterClockwise;
    } else if (is_word(a.text, "SFM") || is_word(a.text, "SMM") || is_word(a.text, "SURF")) {
      return refuse(s.line, "spindle by surface speed needs the radius being cut",
                    "output the speed in rev/min");
    } else {
      vendor_word(s, out);  // ORIENT, LOCK, ranges: the machine's own business
      return {};
    }
  }
  if (number == nullptr && s.number_count > 0) return refuse(s.line, "SPINDL has several numbers");
  if (number != nullptr) {
    if (!(number->number >= 0 && number->number <= 1e6)) {
      return refuse(s.line, "spindle speed " + short_number(number->number) + " makes no sense");
    }
    spindle_rpm_ = number->number;
  } else if (!(spindle_rpm_ > 0)) {
    return refuse(s.line, "SPINDL/" + std::string(s.rest) + " before any speed was told");
  }
  spindle_on_ = true;
  feed_dirty_ = true;
  action(BlockKind::kAuxiliary, spindle_sense_, spindle_rpm_, s.line, out);
  return {};
}

Interpreter::Result Interpreter::take_coolant(const Statement& s, Blocks& out) {
  ActionKind what = ActionKind::kVendorWord;
  if (s.has_word("OFF")) {
    what = ActionKind::kCoolantOff;
  } else if (s.argument_count == 1 && (s.has_word("ON") || s.has_word("FLOOD"))) {
    what = ActionKind::kCoolantFlood;
  } else if (s.argument_count == 1 && s.has_word("MIST")) {
    what = ActionKind::kCoolantMist;
  } else if (s.argument_count == 1 && (s.has_word("THRU") || s.has_word("THROUGH"))) {
    what = ActionKind::kCoolantThrough;
  }
  if (what == ActionKind::kVendorWord) {
    vendor_word(s, out);
  } else {
    action(BlockKind::kAuxiliary, what, 0, s.line, out);
  }
  return {};
}

/// LOADTL/n[,...] and LOAD/TOOL,n[,...].
Interpreter::Result Interpreter::take_tool(const Statement& s, bool needs_tool_word, Blocks& out) {
  std::size_t at = 0;
  if (needs_tool_word) {
    if (s.argument_count == 0 || !is_word(s.arguments[0].text, "TOOL")) {
      return refuse(s.line, "LOAD/" + std::string(s.rest) + " is not understood", "LOAD/TOOL,n");
    }
    at = 1;
  }
  if (at >= s.argument_count || !s.arguments[at].is_number) {
    return refuse(s.line, "tool change without a tool number");
  }
  const double number = s.arguments[at].number;
  if (!(number >= 0 && number <= 1e9 && number == std::floor(number))) {
    return refuse(s.line, "tool number " + short_number(number) + " is not a whole number");
  }
  const auto tool = static_cast<std::uint32_t>(number);
  auto& tools = summary_.tools;
  if (tools.size() < ClSummary::kMostTools &&
      std::find(tools.begin(), tools.end(), tool) == tools.end()) {
    tools.push_back(tool);
  }
  action(BlockKind::kTool, ActionKind::kToolChange, number, s.line, out);
  return {};
}

Interpreter::Result Interpreter::take_delay(const Statement& s, Blocks& out) {
  const Argument* number = s.only_number();
  const bool revolutions = s.has_word("REV");
  if (number == nullptr || s.argument_count > 2 || (s.argument_count == 2 && !revolutions)) {
    return refuse(s.line, std::string(s.major) + " needs one number of seconds or n,REV");
  }
  double seconds = number->number;
  if (revolutions) {
    if (!spindle_on_ || !(spindle_rpm_ > 0)) {
      return refuse(s.line, "dwell in revolutions, but no spindle speed is in force");
    }
    seconds *= units::kMinute_s / spindle_rpm_;
  }
  if (!(seconds >= 0 && seconds <= 86400)) {
    return refuse(s.line, "dwell of " + short_number(seconds) + " s makes no sense");
  }
  summary_.dwell_time_s += seconds;
  action(BlockKind::kDwell, ActionKind::kNone, seconds, s.line, out);
  return {};
}

void Interpreter::take_tool_data(const Statement& s) {
  for (std::size_t i = 0; i < s.argument_count; ++i) {
    if (s.arguments[i].is_number) {
      cutter_written_ = s.arguments[i].number;
      return;
    }
  }
}

}  // namespace meridian::cl
