// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "service/programs/cl/shapes/spline.hpp"
#include "service/programs/cl/words/handlers.hpp"
#include "service/programs/cl/words/motion.hpp"

namespace meridian::cl {
namespace {

constexpr std::size_t kMaxKnots = 100'000;

Outcome refuse_stray(const Statement& s) {
  return refuse(std::string(s.major) + " without the NURBS that it belongs to");
}

/// Cuts the whole spline into straight blocks.
Outcome run_spline(Modal& m, const PendingSpline& given, std::uint32_t line) {
  if (auto done = begin_motion(m, line); !done) return done;
  using Position = BlockPath::Position;
  const bool has_begin = m.path.position() == Position::kReached ||
                         m.path.position() == Position::kReported ||
                         m.path.position() == Position::kLost;
  if (!has_begin) return refuse_at(given.line, "a spline before any position", "begin with GOTO");
  ClampedCubic spline;
  spline.inner_knots.assign(given.knots.begin(), given.knots.end() - 1);
  spline.points.push_back({m.path.tip(), m.axis.in_w});
  for (const std::array<double, 6>& point : given.points) {
    const auto tip = point_in_w(m, point.data());
    if (!tip) return tl::make_unexpected(tip.error());
    if (given.has_axes) {
      if (auto done = set_axis(m, point.data() + 3, ToolAxis::Source::kPoint); !done) return done;
    }
    spline.points.push_back({*tip, m.axis.in_w});
  }
  const auto feed = next_feed(m, line);
  if (!feed) return tl::make_unexpected(feed.error());
  const std::vector<ToolPose> chords = chords_of(spline, {});
  if (chords.empty()) {
    return refuse_at(given.line, "the spline would take more than 200000 straight blocks",
                     "output points");
  }
  ++m.summary.splines;
  for (const ToolPose& end : chords) {
    if (auto done = m.path.line_to(end.tip, end.axis, *feed, line); !done) return done;
  }
  return {};
}

}  // namespace

/// NURBS: a clamped cubic from where the tool is. KNOT and CNTRL follow.
Outcome read_spline(Modal& m, const Statement& s) {
  if (s.argument_count > 0) {
    return refuse(std::string(s.major) + "/" + std::string(s.rest.substr(0, 40)) +
                      " is a spline in a form that is not understood",
                  "output points or arcs");
  }
  if (m.curve.index() != 0 || m.cycle)
    return refuse("NURBS inside an arc, a spline or a cycle", "write it before or after");
  m.curve = PendingSpline{.line = s.line, .knots = {}, .points = {}};
  return {};
}

Outcome read_knots(Modal& m, const Statement& s) {
  auto* const spline = std::get_if<PendingSpline>(&m.curve);
  if (spline == nullptr) return refuse_stray(s);
  if (!s.all_numbers() || s.argument_count == 0 || !spline->points.empty()) {
    return refuse("KNOT needs numbers, in front of the control points");
  }
  for (std::size_t i = 0; i < s.argument_count; ++i) {
    const double knot = s.arguments[i].number;
    const double last = spline->knots.empty() ? 0 : spline->knots.back();
    if (!(knot >= last && knot <= 1) || last == 1) {
      return refuse("KNOT: the knots do not rise from 0 to 1");
    }
    spline->knots.push_back(knot);
  }
  if (spline->knots.size() > kMaxKnots) return refuse("NURBS with more than 100000 knots");
  return {};
}

Outcome read_control_point(Modal& m, const Statement& s) {
  auto* const spline = std::get_if<PendingSpline>(&m.curve);
  if (spline == nullptr) return refuse_stray(s);
  const std::size_t n = s.argument_count;
  if (!s.all_numbers() || (n != 3 && n != 6)) return refuse("CNTRL needs 3 or 6 numbers");
  if (spline->knots.empty() || spline->knots.back() != 1) {
    return refuse("CNTRL before the knots have come to 1");
  }
  if (!spline->points.empty() && spline->has_axes != (n == 6)) {
    return refuse("CNTRL with a tool axis beside CNTRL without");
  }
  spline->has_axes = n == 6;
  std::array<double, 6> point{};
  for (std::size_t i = 0; i < n; ++i) point[i] = s.arguments[i].number;
  spline->points.push_back(point);
  if (spline->points.size() < spline->knots.size() + 2) return {};
  const PendingSpline whole = std::move(*spline);
  m.curve = {};
  return run_spline(m, whole, s.line);
}

}  // namespace meridian::cl
