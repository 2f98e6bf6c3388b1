// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/controls/robot_program.hpp"

#include <algorithm>
#include <cmath>

#include "service/programs/post/controls/nc_text.hpp"
#include "service/programs/post/controls/robot_name.hpp"

namespace meridian::post {
namespace {

/// From rest to rest the fastest moment is up to twice as fast as the mean.
constexpr double kRestToRest = 2;

}  // namespace

// Both were asked for before the program was begun: see refuse_robot().
RobotProgram::RobotProgram(const ProgramParts& parts)
    : parts_(parts),
      axes_(*RobotAxes::of(parts.model, parts.words, parts.options)),
      name_(*robot_name(parts.options, parts.name)) {}

void RobotProgram::begin(const std::vector<std::string>& notes) {
  std::vector<std::string> all;
  for (const std::string& note : notes) all.push_back(harmless(note));
  all.emplace_back("JOINT ANGLES HOLD TOOL AND WORKPIECE - NO TOOL OR BASE FRAME IS USED");
  all.emplace_back("EVERY MOVE ENDS AT REST - ITS TIME IS THE LEAST THAT IT MAY TAKE");
  open(all);
}

void RobotProgram::start_at(const Target& at) {
  halt("THE NEXT MOVE GOES STRAIGHT IN THE JOINTS TO WHERE THE PROGRAM BEGINS");
  at_.reset();
  go(at);
}

void RobotProgram::go(const Target& to) {
  RobotMove next;
  next.deg = axes_.shown_deg(to.axes);
  next.is_first = !at_.has_value();
  if (at_ && *at_ == next.deg) return;
  if (at_) {
    // By the drives: what is shown of a coupled axis is not its own turn.
    const auto turns = axes_.turned_rad(drives_, to.axes);
    for (int k = 0; k < axes_.count(); ++k) {
      next.full_speed_s = std::max(next.full_speed_s, std::abs(turns[k]) / axes_.velocity(k));
    }
    next.seconds = std::max(to.duration_s, kRestToRest * next.full_speed_s);
  }
  move(next);
  at_ = next.deg;
  drives_ = to.axes;
}

void RobotProgram::change_tool(int number) { halt("CHANGE TO TOOL " + std::to_string(number)); }

void RobotProgram::spindle_off() { halt("SPINDLE OFF"); }

void RobotProgram::spindle_on(bool is_clockwise, double rev_per_min) {
  halt("SPINDLE ON, " + fixed(rev_per_min, 0) +
       (is_clockwise ? " RPM CLOCKWISE" : " RPM COUNTER-CLOCKWISE"));
}

void RobotProgram::coolant(const std::string& word) {
  if (word == "M9") return halt("COOLANT OFF");
  halt(word == "M8" ? "COOLANT FLOOD" : word == "M7" ? "COOLANT MIST" : "COOLANT THROUGH THE TOOL");
}

void RobotProgram::stop(bool is_optional) {
  halt(is_optional ? "OPTIONAL STOP OF THE PROGRAM" : "STOP OF THE PROGRAM");
}

std::string RobotProgram::numbered(const RobotMove& to, const char* prefix) const {
  std::string out;
  for (int k = 0; k < axes_.count(); ++k) {
    if (k > 0) out += ",";
    out.append(prefix).append(std::to_string(k + 1)).append(" ");
    out += fixed(to.deg[k], kRotaryDecimals);
  }
  return out;
}

}  // namespace meridian::post
