// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/siemens/siemens_frames.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "service/programs/cl/text/number.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr const char* kByCam = "let the CAM system output points without it";

/// Words of the axes that a frame statement has, as x, y and z; nothing else may stand beside them.
Expected<std::array<std::optional<double>, 3>, cl::Refusal> axes_of(const Line& line,
                                                                    std::string_view name) {
  constexpr std::string_view kAxes = "XYZ";
  std::array<std::optional<double>, 3> out;
  for (const Word& word : line.words) {
    const std::size_t k = word.address.size() == 1 ? kAxes.find(word.address.front()) : 3;
    if (k >= out.size() || word.distance_mode != Word::DistanceMode::kModal) {
      return refuse(std::string(name) + " with the word " + std::string(word.address),
                    "write it in a block of its own, with X, Y and Z");
    }
    out[k] = word.number;
  }
  return out;
}

Vector3 as_vector(const std::array<std::optional<double>, 3>& v) {
  return {v[0].value_or(0), v[1].value_or(0), v[2].value_or(0)};
}

/// ROT X Y Z: about Z first, then about the new Y and the new X, or by RPL about the plane's axis.
Expected<cl::Frame, cl::Refusal> rotation_of(State& s, const Line& line, std::string_view name) {
  const Word* const in_plane = line.find("RPL");
  if (in_plane != nullptr) {
    if (line.words.size() > 1) return refuse(std::string(name) + " with RPL and other words");
    return turned_about(s.modes.plane, in_plane->number);
  }
  const auto angles = axes_of(line, name);
  if (!angles) return tl::make_unexpected(angles.error());
  const Vector3 deg = as_vector(*angles);
  if ((deg.array() != 0).count() > 1) {
    s.cl.remarks.warn("RPY", line.number, [name] {
      return std::string(name) +
             " about several axes: taken as about Z, the new Y and the new X (RPY, as the control "
             "is shipped); its machine data may say otherwise";
    });
  }
  return turned({{2, deg[2]}, {1, deg[1]}, {0, deg[0]}});
}

bool is_cleared_by(const Line& line, const Line::Name& name) {
  return name.arguments.find_first_not_of(" \t") == std::string_view::npos && line.words.empty();
}

/// MIRROR and SCALE clear as TRANS does where they stand alone.
cl::Outcome take_rigid(State& s, const Line& line, const Line::Name& name) {
  const bool is_additive = name.name.front() == 'A';
  const std::string_view kind = is_additive ? name.name.substr(1) : name.name;
  if (is_cleared_by(line, name) && !is_additive) {
    set_shift(s, line, {});
    return {};
  }
  cl::Frame frame;
  if (kind == "TRANS") {
    const auto offset = axes_of(line, name.name);
    if (!offset) return tl::make_unexpected(offset.error());
    frame.origin = as_vector(*offset);
  } else if (kind == "ROT") {
    const auto rotation = rotation_of(s, line, name.name);
    if (!rotation) return tl::make_unexpected(rotation.error());
    frame = *rotation;
  } else {
    return refuse(std::string(name.name) + (kind == "ROTS"    ? ": angles in space"
                                            : kind == "SCALE" ? ": scaling"
                                                              : ": mirroring"),
                  kByCam, std::string(name.name));
  }
  set_shift(s, line, is_additive ? cl::compose(s.frames.shift, frame) : frame);
  return {};
}

/// Arguments of CYCLE800 by their place; what is left out is zero.
Expected<std::array<double, 14>, cl::Refusal> numbers_of(std::string_view text) {
  constexpr std::size_t kNameOfData = 1;
  std::array<double, 14> out{};
  for (std::size_t k = 0; k < out.size() && !text.empty(); ++k) {
    const std::size_t stop = std::min(text.find(','), text.size());
    std::string_view one = text.substr(0, stop);
    text.remove_prefix(std::min(stop + 1, text.size()));
    while (one.starts_with(' ')) one.remove_prefix(1);
    while (one.ends_with(' ')) one.remove_suffix(1);
    if (k == kNameOfData || one.empty()) continue;
    if (!cl::parse_number(one, out[k])) {
      return refuse("CYCLE800: argument " + std::to_string(k + 1) + " is no number", kByCam,
                    "CYCLE800");
    }
  }
  return out;
}

/// The turns of a swivel axis by axis. Which of the angles A, B, C belongs to which axis has two
/// readings, by its letter or by its turn: both have to say the same.
Expected<cl::Frame, cl::Refusal> swivel(int mode, const std::array<double, 3>& abc) {
  std::array<std::size_t, 3> order{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>((mode >> (2 * k)) & 3);
    if (axis == 0) return refuse("CYCLE800 in mode " + std::to_string(mode), kByCam, "CYCLE800");
    order[k] = axis - 1;
  }
  const cl::Frame by_letter =
      turned({{order[0], abc[order[0]]}, {order[1], abc[order[1]]}, {order[2], abc[order[2]]}});
  const cl::Frame by_turn = turned({{order[0], abc[0]}, {order[1], abc[1]}, {order[2], abc[2]}});
  if (!by_letter.rotation.isApprox(by_turn.rotation, 1e-9)) {
    return refuse("CYCLE800 in mode " + std::to_string(mode) +
                      ": which of its angles belongs to which axis has two readings",
                  "let the post-processor output mode 57 (X, Y, Z)", "CYCLE800 mode");
  }
  return by_letter;
}

/// CYCLE800(FR, TC, ST, MODE, X0, Y0, Z0, A, B, C, X1, Y1, Z1, DIR, ...).
cl::Outcome swivel_plane(State& s, const Line& line, const Line::Name& name) {
  if (is_cleared_by(line, name)) {
    set_plane(s, line, {}, Tilt::kNone);
    return {};
  }
  if (!line.words.empty()) {
    return refuse("CYCLE800 beside other words", "write it in a block of its own", "CYCLE800");
  }
  const auto v = numbers_of(name.arguments);
  if (!v) return tl::make_unexpected(v.error());
  constexpr int kModes = 192;  // of which two bits say how the angles are meant
  const double setting = (*v)[2], mode_number = (*v)[3];
  const bool are_whole = mode_number == std::floor(mode_number) && mode_number >= 0 &&
                         mode_number < 256 && setting == std::floor(setting) && setting >= 0 &&
                         setting < 1e9;
  const int mode = are_whole ? static_cast<int>(mode_number) : kModes;
  if ((mode & kModes) != 0) {
    return refuse("CYCLE800 with angles in space, projected angles or places of the rotary axes",
                  "let the post-processor output mode 57 (X, Y, Z)", "CYCLE800 mode");
  }
  if (!cl::is_identity(s.frames.shift)) {
    return refuse("CYCLE800 while TRANS or ROT is in force", "write TRANS alone before it",
                  "CYCLE800");
  }
  const auto rotation = swivel(mode, {(*v)[7], (*v)[8], (*v)[9]});
  if (!rotation) return tl::make_unexpected(rotation.error());
  cl::Frame plane = cl::compose(moved_by({(*v)[4], (*v)[5], (*v)[6]}), *rotation);
  plane = cl::compose(plane, moved_by({(*v)[10], (*v)[11], (*v)[12]}));
  const bool is_additive = std::fmod(setting, 10) == 1;
  if (is_additive) plane = cl::compose(s.frames.plane, plane);
  const bool turns = (*v)[13] != 0;
  set_plane(s, line, plane, turns ? Tilt::kTurned : Tilt::kDefined);
  return {};
}

}  // namespace

cl::Outcome take_siemens_frame(State& s, const Line& line, const Line::Name& name) {
  return name.name == "CYCLE800" ? swivel_plane(s, line, name) : take_rigid(s, line, name);
}

}  // namespace meridian::nc
