// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "meridian/units.hpp"
#include "service/cl/interpreter.hpp"

namespace meridian::cl {
namespace {

constexpr double kAxisNormTolerance = 1e-3;  // a rounded or sloppy axis is normalised
constexpr double kFarthest_mm = 1e6;         // no machine is larger; catches lost decimal points

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

/// FROM tells where the tool is; it does not move it. The point becomes a block only where a cut or
/// an arc begins there (begin_at_from).
Interpreter::Result Interpreter::take_from(const Statement& s) {
  const std::size_t n = s.argument_count;
  if (!s.all_numbers() || (n != 3 && n != 6)) return refuse(s.line, "FROM needs 3 or 6 numbers");
  if (auto done = prepare_motion(s.line); !done) return done;
  Vector3 tip;
  if (auto done = take_pose(s, tip); !done) return done;
  if (position_told_ && is_at(tip)) return {};
  if (has_moved()) {
    warn_once("FROM", s.line, [&] {
      return std::string("FROM behind motion: taken as the new position, without motion to it");
    });
  }
  from_line_ = s.line;
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

bool Interpreter::is_at(const Vector3& tip) const {
  return (tip - tip_).norm() <= kLeastMove_mm && axis_ == axis_before_;
}

/// A cut from the FROM point: a rapid brings the tool there first. Behind motion that ended
/// elsewhere the file does not show how it comes there.
Interpreter::Result Interpreter::begin_at_from(std::uint32_t line, Blocks& out) {
  if (has_moved()) {
    return refuse(from_line_,
                  "FROM is not where the motion before it ended, and a cut begins there",
                  "write RAPID and a GOTO to that point");
  }
  const Vector3 axis_after = axis_;
  axis_ = axis_before_;
  const ClBlock begin = block(BlockKind::kRapid, line);
  account(begin, 0);
  emit(begin, out);
  position_told_ = true;
  axis_ = axis_after;
  return {};
}

Interpreter::Result Interpreter::move_to(const Vector3& tip, std::uint32_t line, Blocks& out) {
  const bool cuts_from_from = !position_told_ && has_position_ && !rapid_;
  if (cuts_from_from && (has_moved() || !is_at(tip))) {
    if (auto done = begin_at_from(line, out); !done) return done;
  }
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

}  // namespace meridian::cl
