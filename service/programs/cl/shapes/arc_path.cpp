// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "service/programs/cl/shapes/arc.hpp"
#include "service/programs/cl/shapes/block_path.hpp"
#include "service/programs/cl/text/written_text.hpp"

namespace meridian::cl {
namespace {

constexpr double kRadiusTolerance_mm = 0.01;  // given radius against begin of the arc
constexpr double kTurn_rad = 2 * std::numbers::pi;

}  // namespace

/// Counts arcs that leave the straight motion before them along it or against it: an arc sense that
/// is mostly against it is not what the CAM system meant.
void BlockPath::check_arc_sense(const Vector3& tangent, std::uint32_t line) {
  const double along = direction_.dot(tangent);
  if (along > 0.9) ++arcs_along_;
  if (along < -0.9) ++arcs_against_;
  if (arcs_against_ >= 3 && arcs_against_ > 2 * arcs_along_) {
    remarks_.warn("arc sense", line, [] {
      return "most arcs start against the motion before them: is their sense of rotation right? "
             "(--arc-sense)";
    });
  }
}

/// Ends nearer to each other than files round, but not one point, may be a full circle that
/// rounding opened or what is left of an arc that was split. CAM systems write the latter (a radius
/// of 69 mm and a chord of its last decimal), so the sense decides, as for every arc, and it is
/// said.
void BlockPath::check_arc_gap(const Arc& arc, const Vector3& end, std::uint32_t line) {
  Vector3 chord = end - tip_;
  chord -= arc.normal * arc.normal.dot(chord);
  const double gap = chord.norm();
  if (gap >= kArcMismatch_mm || arc.radius < 10 * gap) return;
  remarks_.warn("arc gap", line, [&] {
    return "begin and end of this arc are " + short_number(gap) +
           " mm apart; as its sense says it is " + short_number(arc.radius * arc.sweep_rad) +
           " mm long: a full circle ends in the very point where it begins";
  });
}

/// `whole_turns` full circles and then what is left of the arc, all rising evenly.
void BlockPath::emit_turns(const Arc& arc, int whole_turns, const Vector3& axis, ClBlock b,
                           double rest_mm) {
  const Vector3 begin = tip_;
  const Vector3 rise = arc.normal * arc.normal.dot(arc.end - begin);
  const double total_rad = arc.sweep_rad + whole_turns * kTurn_rad;
  const double length = std::hypot(arc.radius * total_rad, rise.norm());
  const bool is_inverse = b.feed_meaning == FeedMeaning::kInverseTime;
  const double programmed = is_inverse ? b.feed * (length + rest_mm) / length : b.feed;
  double done_rad = 0;
  for (int turn = 0; turn <= whole_turns; ++turn) {
    const bool is_last = turn == whole_turns;
    b.sweep_rad = is_last ? arc.sweep_rad : kTurn_rad;
    const double part = b.sweep_rad / total_rad;
    b.feed = is_inverse ? programmed / part : programmed;
    b.centre_mm = to_array(Vector3(arc.centre + rise * (done_rad / total_rad)));
    done_rad += b.sweep_rad;
    b.tip_mm = to_array(is_last ? arc.end : Vector3(begin + rise * (done_rad / total_rad)));
    b.axis = to_array(is_last ? axis : axis_);
    ++summary_.arcs;
    summary_.full_circles += b.sweep_rad == kTurn_rad ? 1 : 0;
    emit_motion(b, length * part);
  }
}

Outcome BlockPath::arc_to(const ArcPath& given, const Vector3& tip, const Vector3& axis,
                          const MotionFeed& feed, std::uint32_t line) {
  if (position_ == Position::kLost) return line_to(tip, axis, feed, line);
  if (position_ == Position::kUnknown) {
    return refuse_at(given.line, "an arc before any position", "begin with FROM or GOTO");
  }
  if (position_ == Position::kReported) {
    if (auto done = begin_at_from(given.line); !done) return done;
  }
  const Arc arc = solve_arc(tip_, tip, given.centre, given.normal);
  if (arc.status == Arc::Status::kNoRadius) {
    return refuse_at(given.line, "the arc has no radius or no plane");
  }
  if (arc.status == Arc::Status::kNotOneCircle) {
    return refuse_at(
        given.line,
        "begin and end of the arc do not lie on one circle about its centre: radii differ by " +
            short_number(arc.mismatch_mm) + " mm, allowed 0.01 mm");
  }
  if (given.radius > 0 && std::abs(given.radius - arc.radius) > kRadiusTolerance_mm) {
    return refuse_at(given.line, "radius " + short_number(given.radius) +
                                     " mm is given, but the arc begins " +
                                     short_number(arc.radius) + " mm from its centre");
  }
  const int whole_turns = std::max(given.turns, 1) - 1;
  if (whole_turns > 0 && axis != axis_) {
    return refuse_at(given.line, "a helix of several turns while the tool axis turns",
                     "output points");
  }
  const bool closed = arc.sweep_rad == kTurn_rad;
  if (!closed) check_arc_gap(arc, tip, given.line);
  check_arc_sense(arc.normal.cross(tip_ - arc.centre).normalized(), given.line);

  const double gap = (arc.end - tip).norm();
  const double rest = !closed && gap > kMinMove_mm ? gap : 0;  // cut as a line after the arc
  ClBlock b;
  b.line = line;
  b.kind = feed.kind;
  b.feed_meaning = feed.meaning;
  b.feed = feed.feed;
  b.is_arc = true;
  b.normal = to_array(arc.normal);
  const Vector3 rise = arc.normal * arc.normal.dot(arc.end - tip_);
  const double length =
      std::hypot(arc.radius * (arc.sweep_rad + whole_turns * kTurn_rad), rise.norm());
  emit_turns(arc, whole_turns, axis, b, rest);
  summary_.arc_mismatch_max_mm = std::max(summary_.arc_mismatch_max_mm, std::abs(arc.mismatch_mm));
  direction_.setZero();
  if (rest == 0) return {};
  MotionFeed rest_feed = feed;  // both take the block's time in inverse time
  if (feed.meaning == FeedMeaning::kInverseTime) rest_feed.feed *= (length + rest) / rest;
  return line_to(tip, axis, rest_feed, line);
}

}  // namespace meridian::cl
