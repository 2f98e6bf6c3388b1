// SPDX-License-Identifier: Apache-2.0
// The tool axis as the words of a block give it.
#include <algorithm>
#include <array>

#include "service/programs/nc/remedy.hpp"
#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr std::array<std::string_view, 3> kFanucVector = {"I", "J", "K"};
constexpr std::array<std::string_view, 3> kSiemensVector = {"A3", "B3", "C3"};
constexpr std::array<std::string_view, 3> kKlartextVector = {"TX", "TY", "TZ"};

const std::array<std::string_view, 3>& addresses_of(Language language) {
  if (language == Language::kFanuc) return kFanucVector;
  return language == Language::kSiemens ? kSiemensVector : kKlartextVector;
}

}  // namespace

cl::Outcome take_vector(const State& s, const Line& line, Target& to) {
  const auto& addresses = addresses_of(s.modes.language);
  Vector3 v = Vector3::Zero();
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Word* const word = line.find(addresses[k]);
    if (word == nullptr) continue;
    v[static_cast<Eigen::Index>(k)] = word->number;
    ++count;
  }
  if (count == 0) return {};
  if (count < 3 && s.modes.language == Language::kFanuc) {
    return refuse("under G43.5 the tool axis needs all three of I, J and K");
  }
  const double norm = v.norm();
  if (!(norm > 1e-6 && norm < 1e9))
    return refuse("the tool axis has no direction: it is zero", kNumbersByCam);
  to.position.vector = to_array(Vector3(v / norm));
  return {};
}

cl::Outcome choose_orientation(State& s, const Line& line) {
  if (s.modes.language == Language::kFanuc) return {};
  const auto& addresses = addresses_of(s.modes.language);
  bool has_rotary = false, has_vector = false;
  for (const Word& word : line.words) {
    has_rotary = has_rotary || word.may_be_rotary();
    has_vector = has_vector ||
                 std::find(addresses.begin(), addresses.end(), word.address) != addresses.end();
  }
  const bool is_in_space = s.modes.in_space_deg.has_value();
  const std::string names = is_in_space
                                ? "A, B, C in space"
                                : std::string(addresses[0]) + ", " + std::string(addresses[1]) +
                                      ", " + std::string(addresses[2]);
  if (!s.modes.is_oriented()) {
    if (has_vector)
      return refuse(names + " without tool-centre control",
                    "write TRAORI or FUNCTION TCPM before it");
    return {};
  }
  if (has_vector && has_rotary)
    return refuse("rotary words beside " + names + " in one block", "output one of them");
  if (has_vector && s.modes.orientation.axes == Orientation::Axes::kOfMachine) {
    return refuse("A3, B3, C3 in the axes of the machine (ORIMKS)", "output ORIWKS");
  }
  if (has_vector && s.modes.turns_evenly()) {
    const bool is_klartext = s.modes.language == Language::kHeidenhain;
    s.cl.remarks.warn("vectors", line.number, [&names, is_klartext] {
      return names + (is_klartext ? " without PATHCTRL VECTOR" : " under ORIAXES") +
             ": between two points the tool axis turns on a great circle here, and on the control "
             "as its joints go";
    });
  }
  if (has_vector) s.modes.control = Control::kVector;
  if (has_rotary) s.modes.control = Control::kRotary;
  return {};
}

}  // namespace meridian::nc
