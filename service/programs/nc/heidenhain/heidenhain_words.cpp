// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/heidenhain/heidenhain_words.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "service/programs/nc/remedy.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

/// M codes of the control that say how it moves and nothing about where; M97 and M98 are of corners
/// under RL and RR, which are refused.
constexpr std::array kSilent = {90,  97,  98,  101, 102, 107, 108, 109, 110, 111, 112,
                                115, 116, 117, 120, 124, 137, 138, 141, 145, 148, 149};
/// Those that put points elsewhere, or whose words are neither coordinates nor a feed.
constexpr std::array kCodesNotRun = {92, 103, 114, 118, 130, 136, 143, 144};

bool is_code(const Word& word, int code) { return word.is('M') && word.number == code; }

/// M128 F5000 sets the feed of the linear axes that follow a turn: it is no feed of the path.
bool is_feed_of_m128(const Line& line, std::size_t at) {
  return at > 0 && line.words[at].is('F') && is_code(line.words[at - 1], 128);
}

/// What the words of a line may say; others would change the feed (FU, FZ, FT) or the path.
bool is_run_here(std::string_view address) {
  constexpr std::array<std::string_view, 8> kLong = {"TX",  "TY", "TZ",  "PA",
                                                     "IPA", "PR", "IPR", "MB"};
  constexpr std::string_view kShort = "XYZABCUVWFSTMR";
  return address.size() == 1 ? kShort.find(address) != std::string_view::npos
                             : std::find(kLong.begin(), kLong.end(), address) != kLong.end();
}

/// M94: rotary positions are shown, and count, within a turn from here on.
void reduce_rotary(State& s) {
  for (RotaryAt& at : s.position.rotary) {
    if (at.deg) at.deg = within_turn(*at.deg);
  }
}

void note_delta(State& s, const Line& line, const Word& word) {
  if (word.number == 0) return;
  s.cl.remarks.warn("delta", line.number,
                    [] { return std::string("DL, DR and DR2 of TOOL CALL are not applied"); });
}

}  // namespace

void move_word(Line& to, const Word& word, std::string_view address) {
  Word copy = word;
  copy.address = address;
  to.words.push_back(copy);
}

void move_start_with_coolant(Line& to, const Word& word) {
  Word action = word;
  action.number = word.number == 13 ? 3 : 4;
  move_word(to, action, "M");
  action.number = 8;
  move_word(to, action, "M");
}

cl::Outcome switch_on(State& s, const Line& line, Orientation::Between between) {
  s.modes.orientation.transformation = Orientation::Transformation::kOn;
  s.modes.orientation.between = between;
  s.modes.in_space_deg.reset();
  return set_control(s, line, s.axes ? Control::kRotary : Control::kVector);
}

cl::Outcome take_angles_in_space(State& s, Line& iso) {
  constexpr std::array<std::string_view, 3> kAngles = {"A", "B", "C"}, kAxis = {"TX", "TY", "TZ"};
  if (!s.modes.is_oriented() || !s.modes.in_space_deg) return {};
  auto& deg = *s.modes.in_space_deg;
  bool has_any = false;
  for (std::size_t k = 0; k < kAngles.size(); ++k) {
    const Word* const word = iso.find(kAngles[k]);
    if (word == nullptr) continue;
    if (word->distance_mode != Word::DistanceMode::kModal || iso.find(kAxis[k]) != nullptr) {
      return refuse("an angle in space (AXIS SPAT) that is incremental, or beside a vector",
                    "output A, B and C as they are");
    }
    deg[k] = word->number;
    has_any = true;
  }
  if (!has_any) return {};
  if (!deg[0] || !deg[1] || !deg[2]) {
    return refuse("the first block with angles in space (AXIS SPAT) needs all of A, B and C",
                  "output them, zeros too");
  }
  const Vector3 tool = turned({{2, *deg[2]}, {1, *deg[1]}, {0, *deg[0]}}).rotation.col(2);
  std::erase_if(iso.words, [&](const Word& word) {
    return std::find(kAngles.begin(), kAngles.end(), word.address) != kAngles.end();
  });
  for (std::size_t k = 0; k < kAxis.size(); ++k) {
    Word word;
    word.number = tool[static_cast<Eigen::Index>(k)];
    word.has_point = true;
    move_word(iso, word, kAxis[k]);
  }
  return {};
}

cl::Outcome switch_off(State& s, const Line& line) {
  s.modes.orientation.transformation = Orientation::Transformation::kOff;
  return set_control(s, line, Control::kLength);
}

cl::Outcome translate(State& s, const Line& line, Translated& out) {
  Line& iso = out.iso;
  iso.number = line.number;
  const bool is_radius_arc = line.names.front().name == "CR";
  for (std::size_t n = 0; n < line.words.size(); ++n) {
    const Word& word = line.words[n];
    if (is_feed_of_m128(line, n)) continue;
    const bool is_m = word.is('M');
    const int code =
        is_m && word.number >= 0 && word.number < 1e6 ? static_cast<int>(word.number) : -1;
    if (std::find(kSilent.begin(), kSilent.end(), code) != kSilent.end()) {
      s.cl.summary.skip("M" + std::string(word.digits), line.number);
    } else if (code == 126 || code == 127) {
      s.modes.rotary_sense = code == 126 ? RotarySense::kShorter : RotarySense::kAsWritten;
    } else if (code == 94) {
      reduce_rotary(s);
    } else if (code == 140) {
      out.retracts = true;
    } else if (code == 91) {
      out.is_machine_position = true;
    } else if (code == 128 || code == 129) {
      auto done =
          code == 128 ? switch_on(s, line, Orientation::Between::kEvenJoints) : switch_off(s, line);
      if (!done) return done;
    } else if (code == 89 || code == 99) {
      out.calls_cycle = true;
      if (auto* const cycle = std::get_if<CycleDefinition>(&s.modes.definition)) {
        cycle->runs_at_every_point = code == 89;
      }
    } else if (std::find(kCodesNotRun.begin(), kCodesNotRun.end(), code) != kCodesNotRun.end()) {
      return refuse("M" + std::string(word.digits) + " is not run here", kMovesByCam,
                    "M" + std::string(word.digits));
    } else if (code == 13 || code == 14) {
      move_start_with_coolant(iso, word);
    } else if (word.is('R') && !is_radius_arc) {
      if (word.number != 0) return refuse("R beside a straight line", kMovesByCam);
    } else if (word.address == "NX" || word.address == "NY" || word.address == "NZ" ||
               word.address == "LA") {
      s.cl.summary.skip(word.address, line.number);
    } else if (word.address == "DL" || word.address == "DR" || word.address == "DR2") {
      note_delta(s, line, word);
    } else if (!is_run_here(word.address)) {
      const std::string name(word.address.substr(0, 16));
      return refuse(name + ": this word of Klartext is not run here", kMovesByCam, name);
    } else {
      move_word(iso, word, word.address);
    }
  }
  return {};
}

}  // namespace meridian::nc
