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
