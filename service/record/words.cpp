// SPDX-License-Identifier: Apache-2.0
#include "service/record/words.hpp"

#include <array>
#include <cstddef>

namespace meridian::record {
namespace {

constexpr std::array<std::string_view, 5> kKinds{"approach", "cut", "rapid", "pole_turn", "unwind"};
constexpr std::array<std::string_view, kStateCount> kStates{
    "off",      "enabling", "ready",    "loaded",    "approaching", "running", "holding", "held",
    "starving", "starved",  "aborting", "disabling", "fault_stop",  "fault",   "jogging", "homing"};

template <class Enum, std::size_t N>
[[nodiscard]] std::optional<Enum> find(const std::array<std::string_view, N>& words,
                                       std::string_view wanted) noexcept {
  for (std::size_t i = 0; i < N; ++i) {
    if (words[i] == wanted) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

template <class Enum, std::size_t N>
[[nodiscard]] std::string_view at(const std::array<std::string_view, N>& words,
                                  Enum value) noexcept {
  const auto i = static_cast<std::size_t>(value);
  return i < N ? words[i] : std::string_view("unknown");
}

}  // namespace

std::string_view word(MotionKind kind) noexcept { return at(kKinds, kind); }
std::string_view word(State state) noexcept { return at(kStates, state); }

std::optional<MotionKind> find_motion_kind(std::string_view wanted) noexcept {
  return find<MotionKind>(kKinds, wanted);
}
std::optional<State> find_state(std::string_view wanted) noexcept {
  return find<State>(kStates, wanted);
}

std::string position_column(const JointSpec& joint) {
  return joint.name + (joint.is_rotary ? "_rad" : "_mm");
}
std::string velocity_column(const JointSpec& joint) { return position_column(joint) + "_per_s"; }

}  // namespace meridian::record
