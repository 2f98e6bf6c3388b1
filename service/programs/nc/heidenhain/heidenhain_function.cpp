// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/heidenhain/heidenhain_function.hpp"

#include <string>
#include <string_view>

#include "service/programs/nc/heidenhain/heidenhain_parameters.hpp"
#include "service/programs/nc/heidenhain/heidenhain_words.hpp"
#include "service/programs/nc/remedy.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

bool mentions(std::string_view text, std::string_view what) {
  return text.find(what) != std::string_view::npos;
}

/// FUNCTION DWELL TIME0.5.
cl::Outcome run_dwell(State& s, const Line& line, std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  const auto seconds = read_number(text, s.variables);
  if (!seconds) return refuse("FUNCTION DWELL TIME without a number of seconds", kNumbersByCam);
  return rest(s, line, *seconds);
}

}  // namespace

cl::Outcome run_function(State& s, const Line& line) {
  const std::string_view text = line.names.front().arguments;
  constexpr std::string_view kDwell = " DWELL TIME";
  if (text.starts_with(kDwell)) return run_dwell(s, line, text.substr(kDwell.size()));
  if (mentions(text, "RESET TCPM")) return switch_off(s, line);
  if (text == " MODE MILL") {
    s.cl.summary.skip("FUNCTION MODE MILL", line.number);
    return {};
  }
  if (!mentions(text, "TCPM")) {
    return refuse("FUNCTION" + std::string(text.substr(0, 24)) + " is not run here", kMovesByCam,
                  "FUNCTION");
  }
  if (mentions(text, "CENTER")) {
    return refuse("FUNCTION TCPM whose points are those of the ball's centre (REFPNT)",
                  "output the points of the tip");
  }
  if (mentions(text, "F CONT")) {
    s.cl.remarks.warn("F CONT", line.number, [] {
      return std::string("FUNCTION TCPM F CONT: F is taken as the feed of the tip");
    });
  }
  using Between = Orientation::Between;
  const bool is_circle = mentions(text, "PATHCTRL VECTOR");
  auto done = switch_on(s, line, is_circle ? Between::kGreatCircle : Between::kEvenJoints);
  if (mentions(text, "AXIS SPAT")) s.modes.in_space_deg.emplace();
  return done;
}

}  // namespace meridian::nc
