// SPDX-License-Identifier: Apache-2.0
// Where rotary words turn their axes.
#include <algorithm>
#include <cmath>

#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/remedy.hpp"
#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr double kTurn_deg = 360;

void set_rotary(ToolPosition& position, const RotaryAt& end) {
  const auto at = std::find_if(position.rotary.begin(), position.rotary.end(),
                               [&](const RotaryAt& r) { return r.address == end.address; });
  (at != position.rotary.end() ? *at : position.rotary.emplace_back()) = end;
}

/// Where the axis stands; nothing: that is not known.
const RotaryAt* known(const ToolPosition& position, std::string_view address) {
  for (const RotaryAt& at : position.rotary) {
    if (at.address == address) return at.deg ? &at : nullptr;
  }
  return nullptr;
}

/// What the word asks for: in Klartext M126 asks for the shorter sense of every axis that turns
/// without end.
Word::DistanceMode sense_of(const State& s, const Word& word, bool is_incremental,
                            bool is_endless) {
  const bool is_plain = word.distance_mode == Word::DistanceMode::kModal && !is_incremental;
  return is_plain && is_endless && s.modes.rotary_sense == RotarySense::kShorter
             ? Word::DistanceMode::kShortest
             : word.distance_mode;
}

bool is_by_sense(Word::DistanceMode sense) {
  using enum Word::DistanceMode;
  return sense == kShortest || sense == kUpwards || sense == kDownwards;
}

/// Where a number leads from `before`, deg.
double end_of(double number, Word::DistanceMode sense, bool is_incremental,
              const RotaryAt& before) {
  using enum Word::DistanceMode;
  constexpr double kSameAngle_deg = 1e-9;  // rounding, which would make a whole turn of none
  const double at = before.deg.value_or(0);
  const double off = std::remainder(number - at, kTurn_deg);
  double turn = std::abs(off) > kSameAngle_deg ? off : 0;
  if (sense == kUpwards && turn < 0) turn += kTurn_deg;
  if (sense == kDownwards && turn > 0) turn -= kTurn_deg;
  if (is_by_sense(sense)) return at + turn;
  if (is_incremental) return at + number;
  return before.is_within_turn ? at + within_turn(number) - within_turn(at) : number;
}

/// A long turn that another set-up of the control makes the other way.
void warn_of_roll_over(State& s, const Line& line, const Word& word, double by_deg) {
  if (!(std::abs(by_deg) > kTurn_deg / 2) || s.modes.language == Language::kSiemens) return;
  s.cl.remarks.warn("roll-over", line.number, [&] {
    const bool is_klartext = s.modes.language == Language::kHeidenhain;
    return std::string(word.address) + " turns by " + cl::short_number(by_deg) +
           " deg in this block, as it is written; " +
           (is_klartext ? "under M126, or with the machine parameter for it,"
                        : "where it rolls over (parameter 1008),") +
           " the control goes the shorter way";
  });
}

}  // namespace

double within_turn(double deg) { return deg - kTurn_deg * std::floor(deg / kTurn_deg); }

cl::Outcome take_rotary(State& s, const Line& line, Target& to) {
  bool has_any = false;
  for (const Word& word : line.words) {
    if (!word.may_be_rotary()) continue;
    const std::string address(word.address);
    if (s.modes.control == Control::kVector) {
      return refuse("rotary word " + address + " under G43.5, where I J K give the tool axis",
                    "output G43.4, or I J K alone");
    }
    const bool has_axes = s.axes && s.axes->refusal().empty();
    if (has_axes && !s.axes->is_rotary(word.address)) {
      return refuse("the machine has no rotary axis with the NC word " + address,
                    "check nc_word in the machine file", "no axis " + address);
    }
    note_digits(s, line, word);
    const RotaryAt* const stands = known(to.position, address);
    const bool is_incremental = is_relative(s, word);
    if (is_incremental && stands == nullptr) {
      return refuse("G91, but where " + address + " stands is not known here",
                    "write G90 and where it goes before it");
    }
    const RotaryAt before = stands != nullptr ? *stands : RotaryAt{address, std::nullopt};
    const bool is_endless = has_axes && s.axes->is_endless(word.address);
    const auto sense = sense_of(s, word, is_incremental, is_endless);
    const double deg = end_of(word.number, sense, is_incremental, before);
    if (!(std::abs(deg) <= 1e6)) return refuse("an angle beyond 1e6 deg", kMovesByCam);
    const double by_deg = deg - before.deg.value_or(0);
    const bool is_plain = sense == Word::DistanceMode::kModal && !is_incremental;
    if (stands != nullptr && is_plain && is_endless) warn_of_roll_over(s, line, word, by_deg);
    to.turns = to.turns || by_deg != 0;
    set_rotary(to.position,
               {address, deg, before.is_within_turn || (is_endless && is_by_sense(sense))});
    has_any = true;
  }
  if (has_any) note_rotary_words(s, to.position);
  return {};
}

}  // namespace meridian::nc
