// SPDX-License-Identifier: Apache-2.0
// HELICAL of CATIA: a whole helix, with its end.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "meridian/units.hpp"
#include "service/programs/cl/shapes/arc.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/cl/words/handlers.hpp"
#include "service/programs/cl/words/motion.hpp"

namespace meridian::cl {
namespace {

constexpr double kMaxTurnsOfHelix = 1000;
constexpr double kAngleTolerance_rad = 1e-3;  // given angle against that to the end point
constexpr double kHeightTolerance_mm = 0.01;  // given height against that of the end point
constexpr double kMinTangent = 1e-3;          // share of INDIRV that goes round the axis
constexpr double kCircle_rad = 2 * std::numbers::pi;

/// The numbers of a HELICAL, as written. The pitch and the number of turns follow from them.
struct WrittenArc {
  std::array<double, 3> centre{}, forward{}, axis{}, end{};
  double radius = 0, angle_deg = 0, height = 0;
};

/// The keywords of the long form; between them stand the numbers of the short one.
struct NamedNumbers {
  std::string_view word;
  std::size_t numbers;
};
constexpr std::array<NamedNumbers, 9> kHelixKeywords = {{{"CENTER", 3},
                                                         {"INDIRV", 3},
                                                         {"AXIS", 3},
                                                         {"PITCH", 1},
                                                         {"RADIUS", 1},
                                                         {"ANGLE", 1},
                                                         {"HEIGHT", 1},
                                                         {"ROUND", 1},
                                                         {"END", 3}}};
constexpr std::size_t kHelixNumbers = 17;

bool has_keywords(const Statement& s) {
  if (s.argument_count != kHelixNumbers + kHelixKeywords.size() || s.number_count != kHelixNumbers)
    return false;
  std::size_t at = 0;
  return std::all_of(kHelixKeywords.begin(), kHelixKeywords.end(),
                     [&](const NamedNumbers& keyword) {
                       const bool is_here = is_word(s.arguments[at].text, keyword.word);
                       at += keyword.numbers + 1;
                       return is_here;
                     });
}

Expected<WrittenArc, Refusal> helix_of(const Statement& s) {
  const bool is_short = s.argument_count == kHelixNumbers && s.all_numbers();
  if (!is_short && !has_keywords(s)) {
    return refuse("HELICAL needs CENTER, INDIRV, AXIS, PITCH, RADIUS, ANGLE, HEIGHT, ROUND and END",
                  "let the CAM system write arcs or points");
  }
  std::array<double, kHelixNumbers> v{};
  for (std::size_t at = 0, i = 0; at < s.argument_count; ++at) {
    if (s.arguments[at].is_number) v[i++] = s.arguments[at].number;
  }
  WrittenArc helix;
  std::copy_n(v.begin(), 3, helix.centre.begin());
  std::copy_n(v.begin() + 3, 3, helix.forward.begin());
  std::copy_n(v.begin() + 6, 3, helix.axis.begin());
  helix.radius = v[10];
  helix.angle_deg = std::abs(v[11]);
  helix.height = std::abs(v[12]);
  std::copy_n(v.begin() + 14, 3, helix.end.begin());
  if (!(helix.radius > 0 && helix.angle_deg > 0 && helix.angle_deg <= 360 * kMaxTurnsOfHelix)) {
    return refuse("HELICAL without a radius, or with an angle that makes no helix");
  }
  return helix;
}

/// The axis in the sense in which the helix turns right-handed about it, by its direction of
/// motion.
Expected<Vector3, Refusal> sense_of(const Modal& m, const WrittenArc& helix,
                                    const Vector3& radius) {
  const Vector3 axis = m.frames.direction(to_vector(helix.axis));
  const Vector3 forward = m.frames.direction(to_vector(helix.forward));
  const double sense = axis.dot(radius.cross(forward));
  const double whole = axis.norm() * radius.norm() * forward.norm();
  if (!(whole > 0) || std::abs(sense) < kMinTangent * whole) {
    return refuse("HELICAL: INDIRV does not give the sense of the helix",
                  "output the direction of motion where the helix begins");
  }
  return sense > 0 ? axis.normalized() : Vector3(-axis.normalized());
}

/// How often the helix goes all the way round before the arc to its end; angle, height and end must
/// agree.
Expected<int, Refusal> whole_turns(const WrittenArc& helix, const Arc& arc, const Vector3& to_end,
                                   double to_mm) {
  if (arc.status != Arc::Status::kOk) return 0;  // the arc is refused with its own reason
  const double rest = units::rad_from_deg(helix.angle_deg) - arc.sweep_rad;
  if (rest < -kAngleTolerance_rad ||
      std::abs(std::remainder(rest, kCircle_rad)) > kAngleTolerance_rad) {
    return refuse("HELICAL gives an angle of " + short_number(helix.angle_deg) +
                      " deg, but its end lies elsewhere",
                  "output an end that the angle leads to, or points");
  }
  const double rise = std::abs(arc.normal.dot(to_end));
  if (std::abs(rise - helix.height * to_mm) > kHeightTolerance_mm) {
    return refuse("HELICAL gives a height of " + short_number(helix.height * to_mm) +
                      " mm, but its end lies " + short_number(rise) + " mm from its begin",
                  "output an end at that height, or points");
  }
  return static_cast<int>(std::lround(rest / kCircle_rad));
}

}  // namespace

/// HELICAL/CENTER,x,y,z,INDIRV,i,j,k,AXIS,i,j,k,PITCH,p,RADIUS,r,ANGLE,a,HEIGHT,h,ROUND,n,END,x,y,z.
Outcome read_helix(Modal& m, const Statement& s) {
  if (m.curve.index() != 0) return refuse("HELICAL inside an arc or a spline");
  if (m.cycle) return refuse("an arc inside a cycle", "write CYCLE/OFF before it");
  const auto helix = helix_of(s);
  if (!helix) return tl::make_unexpected(helix.error());
  if (auto done = begin_motion(m, s.line); !done) return done;
  const auto centre = point_in_w(m, helix->centre.data());
  if (!centre) return tl::make_unexpected(centre.error());
  const auto end = point_in_w(m, helix->end.data());
  if (!end) return tl::make_unexpected(end.error());
  const auto feed = next_feed(m, s.line);
  if (!feed) return tl::make_unexpected(feed.error());
  const auto position = m.path.position();
  if (position == BlockPath::Position::kUnknown) {
    return refuse("an arc before any position", "begin with FROM or GOTO");
  }
  if (position == BlockPath::Position::kLost) {
    return m.path.line_to(*end, m.axis.in_w, *feed, s.line);
  }
  const Vector3 radius = m.path.tip() - *centre;
  const auto normal = sense_of(m, *helix, radius);
  if (!normal) return tl::make_unexpected(normal.error());
  const Arc last = solve_arc(m.path.tip(), *end, *centre, *normal);
  const auto turns = whole_turns(*helix, last, *end - m.path.tip(), m.units.to_mm);
  if (!turns) return tl::make_unexpected(turns.error());
  const ArcPath arc{*centre, *normal, helix->radius * m.units.to_mm, *turns + 1, s.line};
  return m.path.arc_to(arc, *end, m.axis.in_w, *feed, s.line);
}

}  // namespace meridian::cl
