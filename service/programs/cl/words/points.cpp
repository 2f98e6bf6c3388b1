// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "service/programs/cl/text/written_text.hpp"
#include "service/programs/cl/words/handlers.hpp"
#include "service/programs/cl/words/motion.hpp"

namespace meridian::cl {
namespace {

/// Digits after the point, of what the file's last digit is worth.
void count_decimals(ClSummary& summary, const Statement& s) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (s.arguments[i].decimals > summary.decimals) summary.decimals = s.arguments[i].decimals;
  }
}

/// Axis of a point: by numbers 4 to 6, else as the dialect leaves it out.
Outcome take_axis(Modal& m, const Statement& s) {
  if (s.argument_count < 6) return axis_left_out(m, s.line);
  const auto ijk = numbers_from(s, 3);
  m.rotary.line = 0;  // the point carries its axis, whatever rotary positions came before
  return set_axis(m, ijk.data(), ToolAxis::Source::kPoint);
}

/// Points without axis behind a rotary position that no axis vector carried yet.
Outcome check_rotary(const Modal& m) {
  if (m.rotary.line == 0) return {};
  return refuse_at(m.rotary.line,
                   m.rotary.text +
                       " turns a rotary axis, and the points after it carry no tool "
                       "axis: where they lie depends on the machine",
                   "output the tool axis with every GOTO (MULTAX)");
}

/// To where a point leads: the end of an arc, a hole, or a line.
Outcome go_to(Modal& m, const Vector3& tip, std::uint32_t line) {
  if (m.curve.index() == 0 && !m.cycle) [[likely]] {
    const auto feed = next_feed(m, line);
    if (!feed) return tl::make_unexpected(feed.error());
    return m.path.line_to(tip, m.axis.in_w, *feed, line);
  }
  if (auto* const arc = std::get_if<PendingArc>(&m.curve)) {
    if (m.dialect.traits().has_point_lists) {  // the list may go on
      arc->end = tip;
      arc->end_line = line;
      return {};
    }
    const PendingArc pending = *arc;
    m.curve = {};
    return run_arc(m, pending, tip, line);
  }
  if (std::holds_alternative<PendingSpline>(m.curve)) {
    return refuse_at(std::get<PendingSpline>(m.curve).line,
                     "NURBS has fewer control points than its knots ask for (knots + 2)");
  }
  if (m.next == NextMotion::kRapid) {
    m.remarks.warn("rapid in cycle", line, [] {
      return "RAPID in front of a point inside a cycle: the tool goes there and drills no hole";
    });
    const auto feed = next_feed(m, line);
    return m.path.line_to(tip, m.axis.in_w, *feed, line);
  }
  return run_hole(m, tip, line);
}

Outcome read_point(Modal& m, const Statement& s) {
  if (auto done = begin_motion(m, s.line); !done) return done;
  if (auto done = take_axis(m, s); !done) return done;
  if (auto done = check_rotary(m); !done) return done;
  const auto xyz = numbers_from(s, 0);
  const auto tip = point_in_w(m, xyz.data());
  if (!tip) return tl::make_unexpected(tip.error());
  count_decimals(m.summary, s);
  return go_to(m, *tip, s.line);
}

}  // namespace

Outcome read_goto(Modal& m, const Statement& s) {
  const std::size_t n = s.argument_count;
  if (n == 0 && m.dialect.traits().has_point_lists) return {};
  if (!s.all_numbers() || (n != 3 && n != 6 && n != 9)) {
    return refuse("GOTO needs 3 or 6 numbers, here are " + std::to_string(s.number_count) +
                  (s.all_numbers() ? "" : " and something that is no number"));
  }
  if (n == 9) {
    m.remarks.warn("nine", s.line, [] {
      return "GOTO has nine numbers: the last three (a surface normal) shape nothing here";
    });
  }
  ++(n >= 6 ? m.summary.goto_six : m.summary.goto_three);
  return read_point(m, s);
}

Outcome read_listed_point(Modal& m, const Statement& s) {
  const std::size_t n = s.argument_count;
  if (!m.dialect.traits().has_point_lists) {
    return refuse("statement without a word: " + quoted(s.rest),
                  "a continuation line whose '$' is missing? (--dialect creo reads such lines as "
                  "further points)");
  }
  if (!s.all_numbers() || (n != 3 && n != 6)) {
    return refuse("a point of a list needs 3 or 6 numbers, here are " +
                  std::to_string(s.number_count));
  }
  const auto xyz = numbers_from(s, 0);
  if (n == 3 && std::abs(to_vector(xyz).norm() - 1) <= kAxisNormTolerance) {
    return refuse("a line of three numbers that is a point or a tool axis",
                  "a continuation line whose '$' is missing?");
  }
  ++m.summary.listed_points;
  return read_point(m, s);
}

Outcome read_delta(Modal& m, const Statement& s) {
  const std::size_t n = s.argument_count;
  if (!s.all_numbers() || (n != 1 && n != 3 && n != 6)) {
    return refuse("GODLTA needs 1, 3 or 6 numbers");
  }
  if (auto done = begin_motion(m, s.line); !done) return done;
  if (m.path.position() == BlockPath::Position::kUnknown) {
    return refuse("GODLTA before any position", "begin with FROM or GOTO");
  }
  if (m.curve.index() != 0 || m.cycle) {
    return refuse("GODLTA inside an arc, a spline or a cycle", "output GOTO");
  }
  Vector3 move;
  if (n == 1) {
    if (auto done = axis_left_out(m, s.line); !done) return done;
    move = m.axis.in_w * (s.arguments[0].number * m.units.to_mm);
  } else {
    const auto xyz = numbers_from(s, 0);
    move = m.frames.direction(m.units.to_mm * to_vector(xyz));
    if (auto done = take_axis(m, s); !done) return done;
  }
  const Vector3 tip = m.path.tip() + move;
  if (!(tip.cwiseAbs().maxCoeff() <= 1e6)) return refuse("a coordinate lies beyond 1e6 mm");
  return go_to(m, tip, s.line);
}

Outcome read_from(Modal& m, const Statement& s) {
  const std::size_t n = s.argument_count;
  if (!s.all_numbers() || (n != 3 && n != 6)) return refuse("FROM needs 3 or 6 numbers");
  if (auto done = begin_motion(m, s.line); !done) return done;
  if (auto done = take_axis(m, s); !done) return done;
  const auto xyz = numbers_from(s, 0);
  const auto tip = point_in_w(m, xyz.data());
  if (!tip) return tl::make_unexpected(tip.error());
  m.path.set_from(*tip, m.axis.in_w, s.line);
  return {};
}

Outcome read_rapid(Modal& m, const Statement& s) {
  if (s.argument_count > 0 && s.has_word("MODIFY")) return skip(m, s);
  if (s.argument_count > 0) {
    return refuse("RAPID/" + std::string(s.rest) + " is not understood",
                  "RAPID alone holds for the next motion");
  }
  m.next = NextMotion::kRapid;
  return {};
}

Outcome read_tool_axis(Modal& m, const Statement& s) {
  if (s.argument_count != 3 || !s.all_numbers()) {
    return refuse("TLAXIS needs the three numbers of the tool axis");
  }
  const auto ijk = numbers_from(s, 0);
  return set_axis(m, ijk.data(), ToolAxis::Source::kWord);
}

/// ON, or nothing: vectors follow. OFF: motion of three axes, along +z.
Outcome read_multax(Modal& m, const Statement& s) {
  if (!s.has_word("OFF")) return skip(m, s);
  constexpr std::array<double, 3> kPlusZ{0, 0, 1};
  return set_axis(m, kPlusZ.data(), ToolAxis::Source::kWord);
}

Outcome read_home(Modal& m, const Statement& s) {
  if (m.curve.index() != 0 || m.cycle)
    return refuse("GOHOME inside an arc, a spline or a cycle", "write it before or after");
  if (s.argument_count > 0) {  // NX says where home is
    const std::size_t n = s.argument_count;
    if (!s.all_numbers() || (n != 3 && n != 6)) {
      return refuse(
          "GOHOME/" + std::string(s.rest.substr(0, 40)) + " is a reference move of the control",
          "write RAPID and a GOTO");
    }
    m.next = NextMotion::kRapid;
    return read_point(m, s);
  }
  if (auto done = begin_motion(m, s.line); !done) return done;
  const auto home = m.options.home ? m.options.home(m.tool) : std::nullopt;
  if (!home) {
    return refuse("GOHOME moves to the home of the machine, which is not known here",
                  "simulate, post, check and stream know it by their machine file");
  }
  m.remarks.warn("home", s.line, [] {
    return "GOHOME: a straight rapid to the home of the machine file; see that nothing is in the "
           "way";
  });
  m.next = NextMotion::kFeed;
  return m.path.line_to(home->tip, home->axis, {BlockKind::kRapid, FeedMeaning::kNone, 0}, s.line);
}

}  // namespace meridian::cl
