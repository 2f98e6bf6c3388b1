// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "meridian/units.hpp"
#include "service/cl/arc.hpp"
#include "service/cl/interpreter.hpp"

namespace meridian::cl {
namespace {

constexpr double kAxisNormTolerance = 1e-3;   // a rounded or sloppy axis is normalised
constexpr double kFarthest_mm = 1e6;          // no machine is larger; catches lost decimal points
constexpr double kRadiusTolerance_mm = 0.01;  // told radius against begin of the arc

double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

Interpreter::Result Interpreter::prepare_motion(std::uint32_t line) {
  if (unit_ && !frame_dirty_ && motion_begun_) [[likely]]
    return {};
  if (auto done = resolve_unit(line); !done) return done;
  if (auto done = resolve_frame(line); !done) return done;
  motion_begun_ = true;
  return {};
}

Interpreter::Result Interpreter::set_axis(const double* ijk, const Statement& s) {
  // A file whose axis does not change is the rule: the modal vector then needs no square root.
  if (ijk[0] == axis_written_[0] && ijk[1] == axis_written_[1] && ijk[2] == axis_written_[2]) {
    return {};
  }
  const Vector3 k{ijk[0], ijk[1], ijk[2]};
  const double norm = k.norm();
  if (!(std::abs(norm - 1) <= kAxisNormTolerance)) {
    return refuse(s.line, "tool axis (" + short_number(k[0]) + ", " + short_number(k[1]) + ", " +
                              short_number(k[2]) + ") is not a unit vector: its length is " +
                              short_number(norm) + ", allowed 1 +- 0.001");
  }
  axis_written_ = {ijk[0], ijk[1], ijk[2]};
  const Vector3 unit = k / norm;
  axis_ = frame_is_identity_ ? unit : frame_.direction(unit);
  return {};
}

Interpreter::Result Interpreter::point_of(const double* xyz, std::uint32_t line,
                                          Vector3& tip) const {
  const Vector3 p{xyz[0] * to_mm_, xyz[1] * to_mm_, xyz[2] * to_mm_};
  if (!(p.cwiseAbs().maxCoeff() <= kFarthest_mm)) {
    return refuse(line, "a coordinate lies beyond 1e6 mm");
  }
  tip = frame_is_identity_ ? p : frame_.point(p);
  return {};
}

Interpreter::Result Interpreter::take_pose(const Statement& s, Vector3& tip) {
  const std::array<double, 3> xyz = {s.arguments[0].number, s.arguments[1].number,
                                     s.arguments[2].number};
  if (auto done = point_of(xyz.data(), s.line, tip); !done) return done;
  if (s.argument_count != 6) return {};
  const std::array<double, 3> ijk = {s.arguments[3].number, s.arguments[4].number,
                                     s.arguments[5].number};
  return set_axis(ijk.data(), s);
}

Interpreter::Result Interpreter::take_goto(const Statement& s, Blocks& out) {
  const std::size_t n = s.argument_count;
  if (!s.all_numbers() || (n != 3 && n != 6)) {
    return refuse(s.line, "GOTO needs 3 or 6 numbers, here are " + std::to_string(s.number_count) +
                              (s.all_numbers() ? "" : " and something that is no number"));
  }
  if (auto done = prepare_motion(s.line); !done) return done;
  Vector3 tip;
  if (auto done = take_pose(s, tip); !done) return done;
  ++(n == 6 ? summary_.goto_six : summary_.goto_three);
  return arc_.form == ArcForm::kNone ? move_to(tip, s.line, out) : arc_to(tip, s.line, out);
}

Interpreter::Result Interpreter::take_delta(const Statement& s, Blocks& out) {
  const std::size_t n = s.argument_count;
  if (!s.all_numbers() || (n != 1 && n != 3 && n != 6)) {
    return refuse(s.line, "GODLTA needs 1, 3 or 6 numbers");
  }
  if (auto done = prepare_motion(s.line); !done) return done;
  if (!has_position_) {
    return refuse(s.line, "GODLTA before any position", "begin with FROM or GOTO");
  }
  if (arc_.form != ArcForm::kNone) {
    return refuse(s.line, "CIRCLE must be followed by the GOTO that ends the arc");
  }
  Vector3 move;
  if (n == 1) {
    move = axis_ * (s.arguments[0].number * to_mm_);
  } else {
    move = {s.arguments[0].number * to_mm_, s.arguments[1].number * to_mm_,
            s.arguments[2].number * to_mm_};
    if (!frame_is_identity_) move = frame_.direction(move);
  }
  if (n == 6) {
    const std::array<double, 3> ijk = {s.arguments[3].number, s.arguments[4].number,
                                       s.arguments[5].number};
    if (auto done = set_axis(ijk.data(), s); !done) return done;
  }
  const Vector3 tip = tip_ + move;
  if (!(tip.cwiseAbs().maxCoeff() <= kFarthest_mm)) {
    return refuse(s.line, "a coordinate lies beyond 1e6 mm");
  }
  return move_to(tip, s.line, out);
}

/// FROM tells where the tool is; it does not move it. The point becomes a block only where an arc
/// begins there (arc_to).
Interpreter::Result Interpreter::take_from(const Statement& s) {
  const std::size_t n = s.argument_count;
  if (!s.all_numbers() || (n != 3 && n != 6)) return refuse(s.line, "FROM needs 3 or 6 numbers");
  if (position_told_) {
    warn_once("FROM", s.line, [&] {
      return std::string("FROM behind motion: taken as the new position, without motion to it");
    });
  }
  if (auto done = prepare_motion(s.line); !done) return done;
  Vector3 tip;
  if (auto done = take_pose(s, tip); !done) return done;
  tip_ = tip;
  axis_before_ = axis_;
  has_position_ = true;
  position_told_ = false;
  direction_.setZero();
  return {};
}

Interpreter::Result Interpreter::take_tool_axis(const Statement& s) {
  if (s.argument_count != 3 || !s.all_numbers()) {
    return refuse(s.line, "TLAXIS needs the three numbers of the tool axis");
  }
  const std::array<double, 3> ijk = {s.arguments[0].number, s.arguments[1].number,
                                     s.arguments[2].number};
  return set_axis(ijk.data(), s);
}

Interpreter::Result Interpreter::feed_into(ClBlock& b, std::uint32_t line) {
  if (rapid_) {
    b.kind = BlockKind::kRapid;
    b.feed_meaning = FeedMeaning::kNone;
    rapid_ = false;
    return {};
  }
  if (feed_dirty_) {
    if (auto done = resolve_feed(line); !done) return done;
  }
  b.feed = feed_;
  b.feed_meaning = feed_meaning_;
  return {};
}

Interpreter::Result Interpreter::move_to(const Vector3& tip, std::uint32_t line, Blocks& out) {
  ClBlock b;
  b.line = line;
  b.kind = BlockKind::kCut;
  if (auto done = feed_into(b, line); !done) return done;
  const Vector3 step = tip - tip_;
  const double length = position_told_ ? step.norm() : 0;
  direction_ = length > kLeastMove_mm ? Vector3(step / length) : Vector3::Zero();
  tip_ = tip;
  b.tip_mm = to_array(tip_);
  b.axis = to_array(axis_);
  account(b, length);
  emit(b, out);
  has_position_ = position_told_ = true;
  axis_before_ = axis_;
  return {};
}

Interpreter::Result Interpreter::arc_to(const Vector3& tip, std::uint32_t line, Blocks& out) {
  const PendingArc pending = arc_;
  arc_ = {};
  if (!has_position_) {
    return refuse(pending.line, "an arc before any position", "begin with FROM or GOTO");
  }
  if (!position_told_) {  // the FROM point: the machine has to be there before the arc
    const Vector3 axis_after = axis_;
    axis_ = axis_before_;
    ClBlock begin = block(BlockKind::kRapid, pending.line);
    account(begin, 0);
    emit(begin, out);
    position_told_ = true;
    axis_ = axis_after;
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
  check_arc_sense(arc.normal.cross(tip_ - arc.centre).normalized(), pending.line);

  ClBlock b = block(BlockKind::kCut, line);
  if (auto done = feed_into(b, line); !done) return done;
  b.is_arc = true;
  b.normal = to_array(arc.normal);
  b.sweep_rad = arc.sweep_rad;
  const int turns = std::max(pending.turns, 1);
  if (b.feed_meaning == FeedMeaning::kInverseTime) b.feed *= turns;
  const Vector3 begin = tip_;
  const Vector3 axis_begin = axis_before_;
  const Vector3 axis_end = axis_;
  const Vector3 rise = arc.normal * arc.normal.dot(arc.end - begin);
  if (turns > 1 && angle_between(axis_begin, axis_end) > 0) {
    return refuse(pending.line, "a helix of several turns while the tool axis turns");
  }
  for (int turn = 1; turn <= turns; ++turn) {
    const double done_part = static_cast<double>(turn - 1) / turns;
    b.centre_mm = to_array(Vector3(arc.centre + rise * done_part));
    const Vector3 end = turn == turns ? arc.end : Vector3(begin + rise * turn / turns);
    b.tip_mm = to_array(end);
    const double length = std::hypot(arc.radius * arc.sweep_rad, rise.norm() / turns);
    ++summary_.arcs;
    summary_.full_circles += closed ? 1 : 0;
    account(b, length);
    emit(b, out);
  }
  summary_.arc_mismatch_max_mm = std::max(summary_.arc_mismatch_max_mm, std::abs(arc.mismatch_mm));
  direction_.setZero();
  tip_ = arc.end;
  axis_before_ = axis_;
  if (!closed && (arc.end - tip).norm() > kLeastMove_mm) {
    const bool was_rapid = b.kind == BlockKind::kRapid;
    rapid_ = was_rapid;
    return move_to(tip, line, out);
  }
  return {};
}

}  // namespace meridian::cl
