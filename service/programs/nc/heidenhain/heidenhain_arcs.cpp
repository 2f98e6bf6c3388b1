// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/heidenhain/heidenhain_arcs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "meridian/units.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr double kTurn_deg = 360;
constexpr double kAtPole_mm = 1e-9;  // nearer, an angle about it is none

void add_word(Line& iso, std::string_view address, double number) {
  Word word;
  word.address = address;
  word.number = number;
  word.distance_mode = Word::DistanceMode::kAbsolute;
  word.has_point = true;
  iso.words.push_back(word);
}

/// The end of an arc about the pole, and how many whole circles come before it.
struct PolarEnd {
  double x = 0, y = 0;
  int circles = 0;
};

/// IPA: as far as the arc goes, more than a turn for a helix.
Expected<PolarEnd, cl::Refusal> end_after(const State& s, double angle_deg) {
  constexpr double kLongest_deg = 1000 * kTurn_deg;
  if (!(angle_deg != 0 && std::abs(angle_deg) < kLongest_deg)) {
    return refuse("IPA of CP: an arc of no turn, or of more than a thousand");
  }
  const double x = *s.position.tip[0] - *s.modes.pole[0], y = *s.position.tip[1] - *s.modes.pole[1];
  const double turns = std::abs(angle_deg) / kTurn_deg;
  const int circles = static_cast<int>(std::ceil(turns)) - 1;
  if (turns == std::floor(turns)) return PolarEnd{*s.position.tip[0], *s.position.tip[1], circles};
  const double rad = units::rad_from_deg(std::remainder(angle_deg, kTurn_deg));
  const double c = std::cos(rad), sn = std::sin(rad);
  return PolarEnd{*s.modes.pole[0] + c * x - sn * y, *s.modes.pole[1] + sn * x + c * y, circles};
}

/// PR, PA: so far from the pole, at that angle from X.
PolarEnd end_at(const State& s, double radius, double angle_deg) {
  const double rad = units::rad_from_deg(angle_deg);
  return {*s.modes.pole[0] + radius * std::cos(rad), *s.modes.pole[1] + radius * std::sin(rad), 0};
}

/// Where the tip is, about the pole; the angle only where there is one.
struct PolarPosition {
  std::optional<double> radius, angle_deg;
};
PolarPosition polar_position(const State& s) {
  PolarPosition out;
  if (!s.position.tip[0] || !s.position.tip[1]) return out;
  const double x = *s.position.tip[0] - *s.modes.pole[0], y = *s.position.tip[1] - *s.modes.pole[1];
  out.radius = std::hypot(x, y);
  if (*out.radius > kAtPole_mm) out.angle_deg = units::deg_from_rad(std::atan2(y, x));
  return out;
}

/// CP: X and Y of its end by the angle.
cl::Outcome add_polar_end(const State& s, Line& iso) {
  const Word* const by = iso.find("IPA");
  const Word* const at = iso.find("PA");
  if ((by == nullptr) == (at == nullptr) || iso.find("X") != nullptr || iso.find("Y") != nullptr) {
    return refuse("CP needs one angle, PA or IPA, and neither X nor Y");
  }
  const auto radius = polar_position(s).radius;
  if (!radius) {
    return refuse("CP, but where it begins is not known here",
                  "write an L with X, Y and Z before it", "not known");
  }
  const bool is_left = s.modes.motion == Motion::kCounterClockwise;
  if (by != nullptr && (by->number > 0) != is_left) {
    return refuse("CP with IPA against its DR", "give both the same sign");
  }
  const auto end = by != nullptr ? end_after(s, by->number)
                                 : Expected<PolarEnd, cl::Refusal>(end_at(s, *radius, at->number));
  if (!end) return tl::make_unexpected(end.error());
  std::erase_if(iso.words, [](const Word& w) { return w.address == "IPA" || w.address == "PA"; });
  add_word(iso, "X", end->x);
  add_word(iso, "Y", end->y);
  if (end->circles > 0) add_word(iso, "TURN", end->circles);
  return {};
}

/// A word of a line about the pole: `absolute`, or `incremental` from `now`, or neither.
Expected<double, cl::Refusal> polar_value(const Line& iso, std::string_view absolute,
                                          std::string_view incremental, std::optional<double> now) {
  const Word* const at = iso.find(absolute);
  const Word* const by = iso.find(incremental);
  if (at != nullptr && by != nullptr) {
    return refuse("LP with " + std::string(absolute) + " and " + std::string(incremental),
                  "write one of them");
  }
  if (at != nullptr) return at->number;
  if (!now) {
    return refuse("LP without " + std::string(absolute) +
                      ": that of the tip is not known here, or the tip stands on the pole",
                  "write PR and PA", "not known");
  }
  return by != nullptr ? *now + by->number : *now;
}

bool has_sense(const Line& line, std::string_view sense) {
  return std::any_of(line.names.begin(), line.names.end(),
                     [sense](const Line::Name& n) { return n.name == sense; });
}

}  // namespace

cl::Outcome set_pole(State& s, const Line& line) {
  for (std::size_t k = 0; k < 2; ++k) {
    const Word* const word = line.find(k == 0 ? "X" : "Y");
    if (word == nullptr) continue;
    const bool is_relative = word->distance_mode == Word::DistanceMode::kIncremental;
    if (is_relative && !s.position.tip[k])
      return refuse("CC from a place that is not known here", "write X and Y of CC as absolute");
    s.modes.pole[k] = is_relative ? *s.position.tip[k] + word->number : word->number;
  }
  return {};
}

cl::Outcome prepare_polar_line(const State& s, Line& iso) {
  if (!s.modes.pole[0] || !s.modes.pole[1]) {
    return refuse("a line about the pole (LP) before any CC", "write CC with X and Y before it");
  }
  if (iso.find("X") != nullptr || iso.find("Y") != nullptr) {
    return refuse("LP beside X or Y", "write PR and PA");
  }
  const PolarPosition now = polar_position(s);
  const auto radius = polar_value(iso, "PR", "IPR", now.radius);
  if (!radius) return tl::make_unexpected(radius.error());
  const auto angle = polar_value(iso, "PA", "IPA", now.angle_deg);
  if (!angle) return tl::make_unexpected(angle.error());
  const PolarEnd end = end_at(s, *radius, *angle);
  std::erase_if(iso.words, [](const Word& w) {
    return w.address == "PR" || w.address == "IPR" || w.address == "PA" || w.address == "IPA";
  });
  add_word(iso, "X", end.x);
  add_word(iso, "Y", end.y);
  return {};
}

cl::Outcome prepare_arc(State& s, const Line& line, Line& iso) {
  const std::string_view statement = line.names.front().name;
  const bool is_left = has_sense(line, "DR+");
  if (!is_left && !has_sense(line, "DR-"))
    return refuse("an arc without DR+ or DR-", "write DR+ for left, DR- for right");
  s.modes.motion = is_left ? Motion::kCounterClockwise : Motion::kClockwise;
  if (statement == "CR") return {};
  if (!s.modes.pole[0] || !s.modes.pole[1]) {
    return refuse("an arc (" + std::string(statement) + ") before any CC",
                  "write CC with X and Y before it");
  }
  if (statement == "CP") {
    if (auto done = add_polar_end(s, iso); !done) return done;
  }
  add_word(iso, "I", *s.modes.pole[0]);
  add_word(iso, "J", *s.modes.pole[1]);
  return {};
}

}  // namespace meridian::nc
