// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "service/programs/cl/shapes/arc.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

/// Centre and sense as written, in the unit of the program.
struct WrittenArc {
  Vector3 begin, end, centre;
  Vector3 normal;  ///< the tip turns right-handed about it
};

/// R: the shorter of two arcs, or the longer where R is negative.
cl::Outcome centre_by_radius(const State& s, double radius, WrittenArc& arc) {
  Vector3 chord = arc.end - arc.begin;
  chord -= arc.normal * arc.normal.dot(chord);
  const double length = chord.norm();
  if (!(length * s.cl.units.to_mm > cl::kArcClosed_mm)) {
    return refuse("an arc with R that ends where it begins", "a full circle needs I, J or K");
  }
  const double square = radius * radius - length * length / 4;
  const double short_mm = (length / 2 - std::abs(radius)) * s.cl.units.to_mm;
  if (short_mm > cl::kArcMismatch_mm) {
    return refuse("R " + cl::short_number(radius) + " is too small for ends that are " +
                  cl::short_number(length) + " apart");
  }
  const double height = std::sqrt(std::max(square, 0.0)) * (radius < 0 ? -1 : 1);
  arc.centre = arc.begin + chord / 2 + arc.normal.cross(chord / length) * height;
  return {};
}

cl::Outcome centre_by_words(const State& s, const Line& line, WrittenArc& arc) {
  constexpr std::array<std::string_view, 3> kAddresses = {"I", "J", "K"};
  if (s.modes.control == Control::kVector && s.modes.language == Language::kFanuc) {
    return refuse("an arc under G43.5 without R: I J K are the tool axis there", "write it with R");
  }
  bool has_centre = false;
  arc.centre = arc.begin;
  for (std::size_t k = 0; k < 3; ++k) {
    const Word* const word = line.find(kAddresses[k]);
    if (word == nullptr) continue;
    if (k == s.modes.plane) {
      if (word->number == 0) continue;
      return refuse(std::string(kAddresses[k]) + " lies across the plane of the arc",
                    "G17: I J, G18: I K, G19: J K");
    }
    has_centre = true;
    const auto at = static_cast<Eigen::Index>(k);
    const bool is_absolute = word->distance_mode == Word::DistanceMode::kAbsolute ||
                             s.modes.centre == Distance::kAbsolute;
    arc.centre[at] = is_absolute ? word->number : arc.begin[at] + word->number;
  }
  if (!has_centre)
    return refuse("an arc without R and without a centre (I, J, K)", "output one of them");
  return {};
}

/// TURN=n: so many whole circles before the arc.
Expected<int, cl::Refusal> turns_of(const Line& line) {
  const Word* const turn = line.find("TURN");
  if (turn == nullptr) return 0;
  if (!(turn->number >= 0 && turn->number <= 999 && turn->number == std::floor(turn->number))) {
    return refuse("TURN=" + std::string(turn->digits) + " is no number of circles");
  }
  return static_cast<int>(turn->number) + 1;
}

}  // namespace

cl::Outcome arc_to(State& s, const Line& line, const Target& to) {
  const bool is_off_tip = !holds_tip(s.modes.control) &&
                          (to.position.is_turned() || s.frames.tilt == Tilt::kDefined) &&
                          !is_across_plane(s, to.position);
  if (to.turns || is_off_tip) {
    return refuse(
        "an arc in whose block rotary axes turn, or are turned without tool-centre "
        "control, is not run here",
        "let the CAM system write it as lines");
  }
  for (const char* const address : {"P", "L"}) {
    const Word* const word = line.find(address);
    if (word != nullptr && word->number != 1) {
      return refuse(std::string("word ") + address + " of an arc: several turns in one block",
                    "write every turn as a block");
    }
  }
  const auto feed = feed_of_motion(s, line);
  if (!feed) return tl::make_unexpected(feed.error());
  WrittenArc arc;
  for (std::size_t k = 0; k < 3; ++k) {
    arc.begin[static_cast<Eigen::Index>(k)] = *s.position.tip[k];
    arc.end[static_cast<Eigen::Index>(k)] = *to.position.tip[k];
  }
  arc.normal = Vector3::Unit(s.modes.plane) * (s.modes.motion == Motion::kClockwise ? -1 : 1);
  const Word* const radius = line.find(s.modes.language == Language::kSiemens ? "CR" : "R");
  if (auto done = radius != nullptr ? centre_by_radius(s, radius->number, arc)
                                    : centre_by_words(s, line, arc);
      !done) {
    return done;
  }
  const auto end = in_path(s, {arc.end, to.axis});
  if (!end) return tl::make_unexpected(end.error());
  const Vector3 normal = direction_in_w(s, s.frames.now.direction(arc.normal));
  const auto centre = in_path(s, {arc.centre, normal});
  if (!centre) return tl::make_unexpected(centre.error());
  const auto turns = turns_of(line);
  if (!turns) return tl::make_unexpected(turns.error());
  const cl::ArcPath path{centre->tip, centre->axis, 0, *turns, line.number};
  if (auto done = s.cl.path.arc_to(path, end->tip, end->axis, *feed, line.number); !done) {
    return done;
  }
  s.position = to.position;
  s.in_w = {in_w(s, arc.end), to.axis};
  return {};
}

}  // namespace meridian::nc
