// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>

#include "meridian/units.hpp"
#include "service/programs/cl/text/number.hpp"
#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/cl/words/handlers.hpp"
#include "service/programs/cl/words/motion.hpp"

namespace meridian::cl {
namespace {

constexpr double kMaxTurns = 1000;
constexpr double kSweepTolerance_rad = 1e-3;  // given sweep against that to the end point

/// The numbers inside the bracket that `keyword` opens, e.g. of "(CIRCLE/ 1, 2, 3, 4)": up to 7.
struct Numbers {
  std::array<double, 7> value{};
  std::size_t count = 0;
};

Numbers numbers_of(std::string_view text, std::size_t at) {
  Numbers numbers;
  while (at < text.size() && text[at] != ')' && numbers.count < numbers.value.size()) {
    if (!starts_number(text[at])) {
      ++at;
      continue;
    }
    std::size_t stop = at;
    while (stop < text.size() && text[stop] != ',' && text[stop] != ' ' && text[stop] != ')') {
      ++stop;
    }
    if (!parse_number(text.substr(at, stop - at), numbers.value[numbers.count++])) return {};
    at = stop;
  }
  return numbers;
}

Numbers numbers_after(std::string_view text, std::string_view keyword, bool last) {
  const std::size_t at = last ? text.rfind(keyword) : text.find(keyword);
  return at == std::string_view::npos ? Numbers{} : numbers_of(text, at + keyword.size());
}

Outcome refuse_second(const Modal& m) {
  if (const auto* const arc = std::get_if<PendingArc>(&m.curve)) {
    return refuse_at(arc->line, "CIRCLE without the GOTO that ends the arc");
  }
  return refuse("an arc inside a spline", "output all control points of the spline before it");
}

/// TIMES,n after the numbers of a CIRCLE; 0: it is not there.
Expected<int, Refusal> turns_of(const Statement& s, std::size_t numbers) {
  const bool has_times = numbers + 2 == s.argument_count &&
                         is_word(s.arguments[numbers].text, "TIMES") &&
                         s.arguments[numbers + 1].is_number;
  if (s.has_empty_argument() || (numbers != s.argument_count && !has_times)) {
    return refuse("CIRCLE holds something that is no number");
  }
  if (!has_times) return 0;
  const double turns = s.arguments[numbers + 1].number;
  if (!(turns >= 1 && turns <= kMaxTurns && turns == std::floor(turns))) {
    return refuse("CIRCLE/...,TIMES needs a whole number from 1 to 1000");
  }
  return static_cast<int>(turns);
}

/// Forms of CIRCLE by the count of their numbers.
Outcome set_form(PendingArc& arc, std::size_t n, bool has_forward) {
  switch (n) {
    case 4:
      if (!has_forward) {
        return refuse("CIRCLE with 4 numbers does not give its sense",
                      "write INDIRV before it, or output CIRCLE with its normal");
      }
      arc.form = PendingArc::Form::kForward;
      return {};
    case 6:
    case 7:
      arc.form = PendingArc::Form::kRight;
      return {};
    case 11:
      arc.form = PendingArc::Form::kClockwise;
      return {};
    default:
      return refuse("CIRCLE needs 4, 6, 7 or 11 numbers, here are " + std::to_string(n));
  }
}

/// The vector about which an arc turns right-handed, in W.
Expected<Vector3, Refusal> normal_of(Modal& m, const PendingArc& arc, const Vector3& centre) {
  if (arc.form == PendingArc::Form::kForward) {
    const Vector3 forward = m.frames.direction(to_vector(m.forward.value_or(Array3{})));
    m.forward.reset();
    const Vector3 normal = (m.path.tip() - centre).cross(forward);
    if (normal.norm() > 1e-6) return normal;
    return refuse_at(arc.line, "INDIRV does not give the sense of the arc",
                     "output the direction of motion where the arc begins");
  }
  const Vector3 normal =
      m.frames.direction(Vector3(arc.centre_normal[3], arc.centre_normal[4], arc.centre_normal[5]));
  const bool is_left =
      m.options.arc_sense == ArcSense::kLeft ||
      (m.options.arc_sense == ArcSense::kByForm && arc.form == PendingArc::Form::kClockwise);
  return is_left ? Vector3(-normal) : normal;
}

/// MOVARC gives its sweep, with its sign, beside the end: both must agree.
Outcome check_sweep(const Modal& m, const PendingArc& arc, const Vector3& centre,
                    const Vector3& normal, const Vector3& tip) {
  if (!arc.sweep_rad) return {};
  const Vector3 n = normal.normalized();
  const Vector3 a = (m.path.tip() - centre), b = tip - centre;
  const double angle = std::atan2(n.dot(a.cross(b)), a.dot(b) - n.dot(a) * n.dot(b));
  if (std::abs(std::remainder(angle - std::abs(*arc.sweep_rad), 2 * std::numbers::pi)) <=
      kSweepTolerance_rad) {
    return {};
  }
  return refuse_at(arc.line,
                   "MOVARC gives a sweep of " +
                       short_number(units::deg_from_rad(std::abs(*arc.sweep_rad))) +
                       " deg, but its end lies elsewhere",
                   "output an end that the sweep leads to, or points");
}

/// The sweep of a MOVARC in degrees: below zero it turns left-handed.
Outcome set_sweep(PendingArc& arc, double sweep_deg) {
  if (!(sweep_deg != 0 && std::abs(sweep_deg) <= 360)) {
    return refuse("MOVARC: a sweep of " + short_number(sweep_deg) + " deg makes no arc");
  }
  arc.sweep_rad = units::rad_from_deg(sweep_deg);
  if (sweep_deg < 0) {
    for (std::size_t i = 3; i < 6; ++i) arc.centre_normal[i] = -arc.centre_normal[i];
  }
  return {};
}

}  // namespace

Outcome read_circle(Modal& m, const Statement& s) {
  if (m.curve.index() != 0) return refuse_second(m);
  if (m.cycle) return refuse("an arc inside a cycle", "write CYCLE/OFF before it");
  std::size_t n = 0;
  while (n < s.argument_count && s.arguments[n].is_number) ++n;
  PendingArc arc;
  arc.line = s.line;
  const auto turns = turns_of(s, n);
  if (!turns) return tl::make_unexpected(turns.error());
  arc.turns = *turns;
  if (auto done = set_form(arc, n, m.forward.has_value()); !done) return done;
  const std::size_t vector = n == 4 ? 3 : 6;
  for (std::size_t i = 0; i < vector; ++i) arc.centre_normal[i] = s.arguments[i].number;
  if (n == 4) arc.radius = s.arguments[3].number;
  if (n >= 7) arc.radius = s.arguments[6].number;
  if (!(arc.radius >= 0)) return refuse("CIRCLE has a negative radius");
  m.curve = arc;
  return {};
}

Outcome read_forward(Modal& m, const Statement& s) {
  if (s.argument_count != 3 || !s.all_numbers()) {
    return refuse("INDIRV needs the three numbers of the forward direction");
  }
  m.forward = numbers_from(s, 0);
  return {};
}

/// MOVARC/x,y,z,i,j,k,r,ANGLE,a or MOVARC/CENTER,x,y,z,AXIS,i,j,k,RADIUS,r, and the GOTO behind it.
Outcome read_move_arc(Modal& m, const Statement& s) {
  if (m.curve.index() != 0) return refuse_second(m);
  if (m.cycle) return refuse("an arc inside a cycle", "write CYCLE/OFF before it");
  const auto has = [&s](std::size_t at, std::string_view word) {
    return at < s.argument_count && is_word(s.arguments[at].text, word);
  };
  const bool has_keys = s.argument_count == 10 && s.number_count == 7 && has(0, "CENTER") &&
                        has(4, "AXIS") && has(8, "RADIUS");
  const bool has_sweep = s.argument_count == 9 && s.number_count == 8 && has(7, "ANGLE");
  if (!has_keys && !has_sweep) {
    return refuse(
        "MOVARC needs 7 numbers, ANGLE and the sweep in degrees, or CENTER, AXIS, RADIUS");
  }
  PendingArc arc;
  arc.line = s.line;
  std::array<double, 7> v{};
  for (std::size_t i = 0, at = 0; at < s.argument_count && i < v.size(); ++at) {
    if (s.arguments[at].is_number) v[i++] = s.arguments[at].number;
  }
  std::copy_n(v.begin(), 6, arc.centre_normal.begin());
  arc.radius = v[6];
  if (!(arc.radius >= 0)) return refuse("MOVARC has a negative radius");
  if (has_sweep) {
    if (auto done = set_sweep(arc, s.arguments[8].number); !done) return done;
  }
  m.curve = arc;
  return {};
}

/// CATIA: TLON,GOFWD/ (CIRCLE/ centre, radius),ON,(LINE/ centre, end) after INDIRV; on an inclined
/// plane (CYLNDR/ centre, axis, radius),ON,(PLANE/PERPTO,...,(POINT/ end)).
Outcome read_tool_on(Modal& m, const Statement& s) {
  if (m.curve.index() != 0) return refuse_second(m);
  if (!m.forward) return refuse("TLON without the INDIRV that gives the sense of the arc");
  std::string text(s.rest);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const Numbers circle = numbers_after(text, "CIRCLE", false);
  const Numbers cylinder = numbers_after(text, "CYLNDR", false);
  const Numbers line = numbers_after(text, "LINE", false);
  const Numbers point = numbers_after(text, "POINT", true);
  PendingArc arc;
  arc.form = PendingArc::Form::kForward;
  arc.line = s.line;
  std::array<double, 3> end{};
  if (circle.count == 4 && line.count == 6) {
    arc.radius = circle.value[3];
    std::copy_n(circle.value.begin(), 3, arc.centre_normal.begin());
    std::copy_n(line.value.begin() + 3, 3, end.begin());
  } else if (cylinder.count == 7 && point.count == 3) {
    arc.radius = cylinder.value[6];
    std::copy_n(cylinder.value.begin(), 3, arc.centre_normal.begin());
    std::copy_n(point.value.begin(), 3, end.begin());
  } else {
    return refuse(
        "TLON in a form that is not understood: neither CIRCLE and LINE nor CYLNDR and POINT");
  }
  if (auto done = begin_motion(m, s.line); !done) return done;
  const auto tip = point_in_w(m, end.data());
  if (!tip) return tl::make_unexpected(tip.error());
  return run_arc(m, arc, *tip, s.line);
}

Outcome run_arc(Modal& m, const PendingArc& pending, const Vector3& tip, std::uint32_t line) {
  const auto centre = point_in_w(m, pending.centre_normal.data());
  if (!centre) return tl::make_unexpected(centre.error());
  if (m.path.position() == BlockPath::Position::kUnknown) {
    return refuse_at(pending.line, "an arc before any position", "begin with FROM or GOTO");
  }
  const auto normal = normal_of(m, pending, *centre);
  if (!normal) return tl::make_unexpected(normal.error());
  if (auto done = check_sweep(m, pending, *centre, *normal, tip); !done) return done;
  const auto feed = next_feed(m, line);
  if (!feed) return tl::make_unexpected(feed.error());
  const ArcPath arc{*centre, *normal, pending.radius * m.units.to_mm, pending.turns, pending.line};
  return m.path.arc_to(arc, tip, m.axis.in_w, *feed, line);
}

Outcome end_listed_arc(Modal& m) {
  const auto* const arc = std::get_if<PendingArc>(&m.curve);
  if (arc == nullptr || !arc->end) return {};
  const PendingArc pending = *arc;
  m.curve = {};
  return run_arc(m, pending, *pending.end, pending.end_line);
}

}  // namespace meridian::cl
