// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "service/cl/arc.hpp"
#include "service/cl/interpreter.hpp"
#include "service/cl/number.hpp"

namespace meridian::cl {
namespace {

constexpr double kRadiusTolerance_mm = 0.01;  // told radius against begin of the arc

double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

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

Numbers numbers_behind(std::string_view text, std::string_view keyword, bool last) {
  const std::size_t at = last ? text.rfind(keyword) : text.find(keyword);
  return at == std::string_view::npos ? Numbers{} : numbers_of(text, at + keyword.size());
}

}  // namespace

Interpreter::Result Interpreter::take_circle(const Statement& s) {
  if (arc_.form != ArcForm::kNone) {
    return refuse(arc_.line, "CIRCLE without the GOTO that ends the arc");
  }
  std::size_t n = 0;
  while (n < s.argument_count && s.arguments[n].is_number) ++n;
  PendingArc arc;
  arc.line = s.line;
  const bool has_times = n + 2 == s.argument_count && is_word(s.arguments[n].text, "TIMES") &&
                         s.arguments[n + 1].is_number;
  if (s.has_empty_argument || (n != s.argument_count && !has_times)) {
    return refuse(s.line, "CIRCLE holds something that is no number");
  }
  if (has_times) {
    const double turns = s.arguments[n + 1].number;
    if (!(turns >= 1 && turns <= 1000 && turns == static_cast<int>(turns))) {
      return refuse(s.line, "CIRCLE/...,TIMES needs a whole number from 1 to 1000");
    }
    arc.turns = static_cast<int>(turns);
  }
  switch (n) {
    case 4:
      if (!forward_) {
        return refuse(s.line, "CIRCLE with 4 numbers does not tell which way it turns",
                      "write INDIRV before it, or output CIRCLE with its normal");
      }
      arc.form = ArcForm::kForward;
      arc.radius = s.arguments[3].number;
      break;
    case 6:
    case 7:
      arc.form = ArcForm::kRight;
      break;
    case 11:
      arc.form = ArcForm::kClockwise;
      break;
    default:
      return refuse(s.line, "CIRCLE needs 4, 6, 7 or 11 numbers, here are " + std::to_string(n));
  }
  const std::size_t vector = n == 4 ? 3 : 6;
  for (std::size_t i = 0; i < vector; ++i) arc.centre_normal[i] = s.arguments[i].number;
  if (n >= 7) arc.radius = s.arguments[6].number;
  if (!(arc.radius >= 0)) return refuse(s.line, "CIRCLE has a negative radius");
  arc_ = arc;
  return {};
}

Interpreter::Result Interpreter::take_forward(const Statement& s) {
  if (s.argument_count != 3 || !s.all_numbers()) {
    return refuse(s.line, "INDIRV needs the three numbers of the forward direction");
  }
  forward_ = {s.arguments[0].number, s.arguments[1].number, s.arguments[2].number};
  return {};
}

/// CATIA: TLON,GOFWD/ (CIRCLE/ centre, radius),ON,(LINE/ centre, end) after INDIRV; on an inclined
/// plane (CYLNDR/ centre, axis, radius),ON,(PLANE/PERPTO,...,(POINT/ end)).
Interpreter::Result Interpreter::take_tool_on(const Statement& s, Blocks& out) {
  if (!forward_) {
    return refuse(s.line, "TLON without the INDIRV that tells which way the arc turns");
  }
  std::string text(s.rest);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const Numbers circle = numbers_behind(text, "CIRCLE", false);
  const Numbers cylinder = numbers_behind(text, "CYLNDR", false);
  const Numbers line = numbers_behind(text, "LINE", false);
  const Numbers point = numbers_behind(text, "POINT", true);
  PendingArc arc;
  arc.form = ArcForm::kForward;
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
        s.line,
        "TLON in a form that is not understood: neither CIRCLE and LINE nor CYLNDR and POINT");
  }
  if (auto done = prepare_motion(s.line); !done) return done;
  Vector3 tip;
  if (auto done = point_of(end.data(), s.line, tip); !done) return done;
  arc_ = arc;
  return arc_to(tip, s.line, out);
}

Interpreter::Result Interpreter::arc_to(const Vector3& tip, std::uint32_t line, Blocks& out) {
  const PendingArc pending = arc_;
  arc_ = {};
  if (!has_position_) {
    return refuse(pending.line, "an arc before any position", "begin with FROM or GOTO");
  }
  if (!position_told_) {
    if (auto done = begin_at_from(pending.line, out); !done) return done;
  }
  Vector3 centre;
  if (auto done = point_of(pending.centre_normal.data(), pending.line, centre); !done) return done;
  Vector3 normal{pending.centre_normal[3], pending.centre_normal[4], pending.centre_normal[5]};
  if (!frame_is_identity_) normal = frame_.direction(normal);
  if (pending.form == ArcForm::kForward) {
    normal = (tip_ - centre)
                 .cross(frame_.direction(Vector3{(*forward_)[0], (*forward_)[1], (*forward_)[2]}));
    forward_.reset();
    if (!(normal.norm() > 1e-6)) {
      return refuse(pending.line, "INDIRV does not tell which way the arc turns");
    }
  } else if (options_.arc_sense == ArcSense::kLeft ||
             (options_.arc_sense == ArcSense::kByForm && pending.form == ArcForm::kClockwise)) {
    normal = -normal;
  }
  const Arc arc = solve_arc(tip_, tip, centre, normal);
  if (arc.status == Arc::Status::kNoRadius) {
    return refuse(pending.line, "the arc has no radius or no plane");
  }
  if (arc.status == Arc::Status::kNotOneCircle) {
    return refuse(
        pending.line,
        "begin and end of the arc do not lie on one circle about its centre: radii differ by " +
            short_number(arc.mismatch_mm) + " mm, allowed 0.01 mm");
  }
  const double told = pending.radius * to_mm_;
  if (told > 0 && std::abs(told - arc.radius) > kRadiusTolerance_mm) {
    return refuse(pending.line, "radius " + short_number(told) +
                                    " mm is told, but the arc begins " + short_number(arc.radius) +
                                    " mm from its centre");
  }
  const bool closed = arc.sweep_rad == 2 * std::numbers::pi;
  if (pending.turns > 1 && !closed) {
    return refuse(pending.line, "a helix of several turns that does not end above its begin",
                  "output it as arcs of one turn at most, or as points");
  }
  if (!closed) check_arc_gap(arc, tip, pending.line);
  check_arc_sense(arc.normal.cross(tip_ - arc.centre).normalized(), pending.line);

  ClBlock b = block(BlockKind::kCut, line);
  if (auto done = feed_into(b, line); !done) return done;
  b.is_arc = true;
  b.normal = to_array(arc.normal);
  b.sweep_rad = arc.sweep_rad;
  const int turns = std::max(pending.turns, 1);
  const bool is_inverse = b.feed_meaning == FeedMeaning::kInverseTime;
  if (is_inverse) b.feed *= turns;
  const Vector3 begin = tip_;
  const Vector3 axis_begin = axis_before_;
  const Vector3 axis_end = axis_;
  const Vector3 rise = arc.normal * arc.normal.dot(arc.end - begin);
  if (turns > 1 && angle_between(axis_begin, axis_end) > 0) {
    return refuse(pending.line, "a helix of several turns while the tool axis turns");
  }
  const double length = std::hypot(arc.radius * arc.sweep_rad, rise.norm() / turns);
  const double gap = (arc.end - tip).norm();
  const double rest = !closed && gap > kLeastMove_mm ? gap : 0;  // cut as a line behind the arc
  if (is_inverse) b.feed *= (length + rest) / length;            // both take the block's time
  for (int turn = 1; turn <= turns; ++turn) {
    const double done_part = static_cast<double>(turn - 1) / turns;
    b.centre_mm = to_array(Vector3(arc.centre + rise * done_part));
    const Vector3 end = turn == turns ? arc.end : Vector3(begin + rise * turn / turns);
    b.tip_mm = to_array(end);
    ++summary_.arcs;
    summary_.full_circles += closed ? 1 : 0;
    account(b, length);
    emit(b, out);
  }
  summary_.arc_mismatch_max_mm = std::max(summary_.arc_mismatch_max_mm, std::abs(arc.mismatch_mm));
  direction_.setZero();
  tip_ = arc.end;
  axis_before_ = axis_;
  if (rest == 0) return {};
  rapid_ = b.kind == BlockKind::kRapid;
  const double feed = feed_;
  if (is_inverse) feed_ *= (length + rest) / rest;
  auto done = move_to(tip, line, out);
  feed_ = feed;
  return done;
}

}  // namespace meridian::cl
