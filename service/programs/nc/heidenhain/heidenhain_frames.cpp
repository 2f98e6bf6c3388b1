// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/heidenhain/heidenhain_frames.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/heidenhain/heidenhain_parameters.hpp"
#include "service/programs/nc/remedy.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr const char* kBySpatialAngles = "output PLANE SPATIAL with SPA, SPB and SPC";

/// The next word of `text`, without the blanks around it.
std::string_view take_word(std::string_view& text) {
  while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1);
  const std::size_t size = std::min(text.find_first_of(" \t"), text.size());
  const std::string_view word = text.substr(0, size);
  text.remove_prefix(size);
  return word;
}

enum class Follow : std::uint8_t { kStay, kTurn };

/// A form of PLANE, and the words that it has numbers for.
struct PlaneForm {
  std::string_view name;
  std::array<std::string_view, 6> addresses;
};
constexpr std::array kPlaneForms = std::to_array<PlaneForm>({
    {"RESET", {}},
    {"SPATIAL", {"SPA", "SPB", "SPC"}},
    {"EULER", {"EULPR", "EULNU", "EULROT"}},
    {"VECTOR", {"BX", "BY", "BZ", "NX", "NY", "NZ"}},
});

/// What stands behind PLANE: its numbers, and whether the rotary axes follow.
struct PlaneWords {
  std::array<std::optional<double>, 6> numbers;
  Follow follow = Follow::kStay;

  [[nodiscard]] double number(std::size_t k) const { return numbers[k].value_or(0); }
  [[nodiscard]] Vector3 vector(std::size_t first) const {
    return {number(first), number(first + 1), number(first + 2)};
  }
};

Expected<PlaneWords, cl::Refusal> plane_words(const PlaneForm& form, std::string_view text,
                                              const Variables& variables) {
  PlaneWords out;
  const std::string title = "PLANE " + std::string(form.name);
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
    if (word == "TURN" || word == "MOVE") out.follow = Follow::kTurn;
    for (std::size_t k = 0; k < form.addresses.size(); ++k) {
      const std::string_view address = form.addresses[k];
      if (address.empty() || !word.starts_with(address)) continue;
      out.numbers[k] = read_number(word.substr(address.size()), variables);
      if (!out.numbers[k]) {
        return refuse(title + ": " + cl::quoted(word) + " has no number", kNumbersByCam, "PLANE");
      }
    }
  }
  for (std::size_t k = 0; k < form.addresses.size() && form.name != "SPATIAL"; ++k) {
    if (form.addresses[k].empty() || out.numbers[k]) continue;
    return refuse(title + " without " + std::string(form.addresses[k]),
                  "output all of its numbers, zeros too", "PLANE");
  }
  return out;
}

/// About the fixed X, Y and Z one after the other; about Z, the new X and the new Z; or of a vector
/// along x and the normal.
Expected<cl::Frame, cl::Refusal> plane_of(const PlaneForm& form, const PlaneWords& words) {
  if (form.name == "SPATIAL") {
    return turned({{2, words.number(2)}, {1, words.number(1)}, {0, words.number(0)}});
  }
  if (form.name == "EULER") {
    return turned({{2, words.number(0)}, {0, words.number(1)}, {2, words.number(2)}});
  }
  if (form.name == "RESET") return cl::Frame();
  const Vector3 base = words.vector(0), normal = words.vector(3);
  constexpr double kShortest = 1e-6;
  if (!(base.norm() > kShortest && normal.norm() > kShortest) || !are_square(base, normal)) {
    return refuse("PLANE VECTOR: BX BY BZ do not stand square on NX NY NZ",
                  "output a base vector that lies in the plane", "PLANE");
  }
  return frame_along(Vector3::Zero(), base, normal);
}

/// X+10: which axis, and its number, which may stand behind a blank.
struct DatumWord {
  std::size_t axis = 0;
  double number = 0;
  bool is_incremental = false;
};

Expected<DatumWord, cl::Refusal> datum_word(std::string_view& text, const Variables& variables,
                                            const std::string& title) {
  std::string_view word = take_word(text);
  DatumWord out;
  out.is_incremental = word.starts_with('I');
  if (out.is_incremental) word.remove_prefix(1);
  constexpr std::string_view kAxes = "XYZ";
  out.axis = word.empty() ? kAxes.npos : kAxes.find(word.front());
  if (out.axis == kAxes.npos) {
    return refuse(title + " by " + cl::quoted(word) + ", which only the control knows",
                  "output the shift as X, Y and Z", title);
  }
  const std::string_view rest = word.size() > 1 ? word.substr(1) : take_word(text);
  const auto number = read_number(rest, variables);
  if (!number) {
    return refuse(title + ": " + cl::quoted(rest) + " is no number", kNumbersByCam, title);
  }
  out.number = *number;
  return out;
}

/// Puts a datum there where nothing is tilted; where it lies already that says nothing.
cl::Outcome put_datum(State& s, const Line& line, const cl::Frame& shift,
                      const std::string& title) {
  if (s.frames.tilt != Tilt::kNone && shift.origin != s.frames.shift.origin) {
    return refuse(title + " in a tilted plane, along its axes",
                  "output the points of the plane without it", title);
  }
  set_shift(s, line, shift);
  return {};
}

}  // namespace

cl::Outcome set_klartext_plane(State& s, const Line& line, std::string_view text) {
  const std::string_view kind = take_word(text);
  const auto form = std::find_if(kPlaneForms.begin(), kPlaneForms.end(),
                                 [kind](const PlaneForm& row) { return row.name == kind; });
  if (form == kPlaneForms.end()) {
    return refuse("PLANE " + std::string(kind.substr(0, 16)) +
                      ": a plane that is not defined by angles in space, by Euler's or by vectors",
                  kBySpatialAngles, "PLANE");
  }
  if (holds_tip(s.modes.control)) {
    return refuse("PLANE while tool-centre control is on", "write FUNCTION RESET TCPM before it",
                  "PLANE");
  }
  const auto words = plane_words(*form, text, s.variables);
  if (!words) return tl::make_unexpected(words.error());
  const auto plane = plane_of(*form, *words);
  if (!plane) return tl::make_unexpected(plane.error());
  const bool follows = words->follow == Follow::kTurn, ends = form->name == "RESET";
  set_plane(s, line, *plane, follows ? Tilt::kTurned : ends ? Tilt::kNone : Tilt::kDefined);
  if (ends) s.frames.tilt = Tilt::kNone;
  return {};
}

cl::Outcome shift_datum(State& s, const Line& line, std::string_view text) {
  const auto word = datum_word(text, s.variables, "CYCL DEF 7");
  if (!word) return tl::make_unexpected(word.error());
  cl::Frame shift = s.frames.shift;
  double& at = shift.origin[static_cast<Eigen::Index>(word->axis)];
  at = word->is_incremental ? at + word->number : word->number;
  return put_datum(s, line, shift, "CYCL DEF 7");
}

cl::Outcome move_datum(State& s, const Line& line, std::string_view text) {
  const std::string title = "TRANS DATUM";
  const std::string_view kind = take_word(text);
  if (kind == "RESET") return put_datum(s, line, {}, title);
  if (kind != "AXIS") {
    return refuse(title + " " + std::string(kind.substr(0, 16)) + ", which only the control knows",
                  "output TRANS DATUM AXIS with X, Y and Z", title);
  }
  cl::Frame shift = s.frames.shift;
  while (text.find_first_not_of(" \t") != std::string_view::npos) {
    const auto word = datum_word(text, s.variables, title);
    if (!word) return tl::make_unexpected(word.error());
    if (word->is_incremental) return refuse(title + " with I", "output absolute values", title);
    shift.origin[static_cast<Eigen::Index>(word->axis)] = word->number;
  }
  return put_datum(s, line, shift, title);
}

cl::Outcome activate_preset(State& s, const Line& line, double row, const std::string& title) {
  constexpr double kRows = 1000;
  if (!(row >= 0 && row < kRows && row == std::floor(row))) {
    return refuse(title + " that is no row of a table", {}, title);
  }
  if (auto done = put_datum(s, line, {}, title); !done) return done;
  set_preset(s, line, static_cast<int>(row));
  return {};
}

cl::Outcome select_preset(State& s, const Line& line, std::string_view text) {
  const std::string title = "PRESET SELECT";
  std::string_view row = take_word(text);
  const std::size_t sign = row.starts_with('#') ? 1 : row.starts_with("NR") ? 2 : 0;
  const auto number =
      sign > 0 ? read_number(row.substr(sign), s.variables) : std::optional<double>();
  if (!number) {
    return refuse(title + " " + std::string(row.substr(0, 16)) + ", which only the control knows",
                  "output the number of the row, such as #3", title);
  }
  bool keeps_shift = false;
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
    keeps_shift |= word == "KEEP";
    if (word == "KEEP" || word == "TRANS" || word == "WP") continue;
    return refuse(title + " with " + std::string(word.substr(0, 16)) + " is not run here", {},
                  title);
  }
  const cl::Frame shift = s.frames.shift;
  if (auto done = activate_preset(s, line, *number, title); !done || !keeps_shift) return done;
  return put_datum(s, line, shift, title);
}

bool is_frame_cycle(std::string_view number) {
  constexpr std::array<std::string_view, 4> kCycles = {"8.", "10.", "11.", "19."};
  return std::any_of(kCycles.begin(), kCycles.end(), [number](std::string_view cycle) {
    return number.size() == cycle.size() + 1 && number.starts_with(cycle);
  });
}

cl::Outcome reset_frame_cycle(State& s, const Line& line, std::string_view number,
                              std::string_view text) {
  const std::string title = "CYCL DEF " + std::string(number);
  if (!number.ends_with(".0")) {
    const bool is_plane = number.starts_with("19.");
    for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
      const bool is_scale = word.starts_with("SCL");
      const std::size_t letters = is_scale || word.starts_with("ROT") ? 3 : 1;
      const std::string_view rest = word.size() > letters ? word.substr(letters) : take_word(text);
      if (read_number(rest, s.variables) != (is_scale ? 1.0 : 0.0)) {
        return refuse(title + " " + std::string(word.substr(0, 16)) +
                          (is_plane ? ": whether its angles are those of the axes depends on the "
                                      "machine"
                                    : ": mirroring, scaling or a rotation of the control's"),
                      is_plane ? kBySpatialAngles : kMovesByCam, title);
      }
    }
    if (is_plane) set_plane(s, line, {}, Tilt::kNone);
  }
  s.cl.summary.skip(title, line.number);
  return {};
}

}  // namespace meridian::nc
