// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/heidenhain/heidenhain_frames.hpp"

#include <array>
#include <string>

#include "service/programs/cl/text/number.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/remedy.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr const char* kByAngles = "output PLANE SPATIAL with SPA, SPB and SPC";

/// The next word of `text`, without the blanks around it.
std::string_view take_word(std::string_view& text) {
  while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1);
  const std::size_t size = std::min(text.find_first_of(" \t"), text.size());
  const std::string_view word = text.substr(0, size);
  text.remove_prefix(size);
  return word;
}

/// A number whose point may be a comma.
bool is_number(std::string_view text, double& number) {
  std::string plain(text);
  for (char& c : plain) c = c == ',' ? '.' : c;
  return cl::parse_number(plain, number);
}

enum class Follow : std::uint8_t { kStay, kTurn };

/// What stands behind PLANE: the angles, and whether the rotary axes follow.
struct PlaneWords {
  std::array<double, 3> deg{};
  Follow follow = Follow::kStay;
};

Expected<PlaneWords, cl::Refusal> plane_words(std::string_view text) {
  PlaneWords out;
  constexpr std::array<std::string_view, 3> kAngles = {"SPA", "SPB", "SPC"};
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
    if (word == "TURN" || word == "MOVE") out.follow = Follow::kTurn;
    for (std::size_t k = 0; k < kAngles.size(); ++k) {
      if (!word.starts_with(kAngles[k])) continue;
      if (!is_number(word.substr(kAngles[k].size()), out.deg[k])) {
        return refuse("PLANE SPATIAL: " + cl::quoted(word) + " is no angle", kNumbersByCam,
                      "PLANE");
      }
    }
  }
  return out;
}

}  // namespace

cl::Outcome set_klartext_plane(State& s, const Line& line, std::string_view text) {
  const std::string_view kind = take_word(text);
  if (kind != "SPATIAL" && kind != "RESET") {
    return refuse("PLANE " + std::string(kind.substr(0, 16)) +
                      ": a plane that is not told by SPA, "
                      "SPB and SPC",
                  kByAngles, "PLANE");
  }
  if (holds_tip(s.modes.control)) {
    return refuse("PLANE while tool-centre control is on", "write FUNCTION RESET TCPM before it",
                  "PLANE");
  }
  const auto words = plane_words(text);
  if (!words) return tl::make_unexpected(words.error());
  const bool follows = words->follow == Follow::kTurn;
  if (kind == "RESET") {
    set_plane(s, line, {}, follows ? Tilt::kTurned : Tilt::kNone);
    if (follows) s.frames.tilt = Tilt::kNone;
    return {};
  }
  // About the fixed axes X, Y and Z one after the other.
  const auto& deg = words->deg;
  const cl::Frame plane = turned({{2, deg[2]}, {1, deg[1]}, {0, deg[0]}});
  set_plane(s, line, plane, follows ? Tilt::kTurned : Tilt::kDefined);
  return {};
}

cl::Outcome shift_datum(State& s, const Line& line, std::string_view text) {
  std::string_view word = take_word(text);
  const bool is_incremental = word.starts_with('I');
  if (is_incremental) word.remove_prefix(1);
  constexpr std::string_view kAxes = "XYZ";
  const std::size_t k = word.empty() ? kAxes.npos : kAxes.find(word.front());
  if (k == kAxes.npos) {
    return refuse("CYCL DEF 7 by " + cl::quoted(word) + ", which only the control knows",
                  "output the shift as X, Y and Z", "CYCL DEF 7");
  }
  double number = 0;
  const std::string_view behind = word.size() > 1 ? word.substr(1) : take_word(text);
  if (!is_number(behind, number)) {
    return refuse("CYCL DEF 7: " + cl::quoted(behind) + " is no number", kNumbersByCam,
                  "CYCL DEF 7");
  }
  cl::Frame shift = s.frames.shift;
  double& at = shift.origin[static_cast<Eigen::Index>(k)];
  const double to = is_incremental ? at + number : number;
  if (s.frames.tilt != Tilt::kNone && to != at) {
    return refuse("CYCL DEF 7 in a tilted plane", "write it before PLANE", "CYCL DEF 7");
  }
  at = to;
  set_shift(s, line, shift);
  return {};
}

}  // namespace meridian::nc
