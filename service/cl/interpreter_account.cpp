// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "meridian/units.hpp"
#include "service/cl/arc.hpp"
#include "service/cl/interpreter.hpp"

namespace meridian::cl {
namespace {

constexpr double kLargestInchPart_mm = 1000;  // inch files beyond it are suspected of being metric
constexpr double kFastInch_mm_per_s = 20000.0 / 60.0;

}  // namespace

/// Counts arcs that leave the straight motion before them along it or against it: an arc sense that
/// is mostly against it is not what the CAM system meant.
void Interpreter::check_arc_sense(const Vector3& tangent, std::uint32_t line) {
  const double along = direction_.dot(tangent);
  if (along > 0.9) ++arcs_along_;
  if (along < -0.9) ++arcs_against_;
  if (arcs_against_ >= 3 && arcs_against_ > 2 * arcs_along_) {
    warn_once("arc sense", line, [&] {
      return std::string(
          "most arcs start against the motion before them: is their sense of rotation right? "
          "(--arc-sense)");
    });
  }
}

/// Ends nearer to each other than files round, but not one point, may be a full circle that
/// rounding opened or what is left of an arc that was split. CAM systems write the latter (a radius
/// of 69 mm and a chord of its last decimal), so the sense decides, as for every arc, and it is
/// said.
void Interpreter::check_arc_gap(const Arc& arc, const Vector3& end, std::uint32_t line) {
  Vector3 chord = end - tip_;
  chord -= arc.normal * arc.normal.dot(chord);
  const double gap = chord.norm();
  if (gap >= kArcMismatch_mm || arc.radius < 10 * gap) return;
  warn_once("arc gap", line, [&] {
    return std::string("begin and end of this arc are " + short_number(gap) +
                       " mm apart; as its sense says it is " +
                       short_number(arc.radius * arc.sweep_rad) +
                       " mm long: a full circle ends in the very point where it begins");
  });
}

/// An inch file whose part would be beyond a metre, or whose feed beyond 20 m/min, is likely a
/// metric one with the wrong unit word.
void Interpreter::suspect_metric(const ClBlock& b) {
  double extent = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    extent = std::max(extent, summary_.box_max_mm[i] - summary_.box_min_mm[i]);
  }
  const bool fast = b.feed_meaning == FeedMeaning::kTip && b.feed > kFastInch_mm_per_s;
  if (extent <= kLargestInchPart_mm && !fast) return;
  metric_suspected_ = true;
  warn_once("metric", b.line, [&] {
    return std::string(fast ? "inch, but the feed comes to " +
                                  short_number(units::per_min_from_per_s(b.feed)) +
                                  " mm/min: plainly metric? (--units mm)"
                            : "inch, but the path is " + short_number(extent) +
                                  " mm wide: plainly metric? (--units mm)");
  });
}

/// Angles are worked out only where an axis goes beyond all before it.
void Interpreter::account_axis(double change_chord) {
  if (change_chord > change_chord_max_) {
    change_chord_max_ = change_chord;
    summary_.axis_change_max_rad =
        std::atan2(axis_before_.cross(axis_).norm(), axis_before_.dot(axis_));
  }
  if (axis_[2] < axis_z_min_ || axis_[2] > axis_z_max_) {
    axis_z_min_ = std::min(axis_z_min_, axis_[2]);
    axis_z_max_ = std::max(axis_z_max_, axis_[2]);
    const double tilt = std::atan2(std::hypot(axis_[0], axis_[1]), axis_[2]);
    summary_.tilt_min_rad = std::min(summary_.tilt_min_rad, tilt);
    summary_.tilt_max_rad = std::max(summary_.tilt_max_rad, tilt);
  }
}

void Interpreter::account(const ClBlock& b, double length) {
  for (std::size_t i = 0; i < 3; ++i) {
    summary_.box_min_mm[i] = std::min(summary_.box_min_mm[i], b.tip_mm[i]);
    summary_.box_max_mm[i] = std::max(summary_.box_max_mm[i], b.tip_mm[i]);
  }
  if (summary_.unit == LengthUnit::kInch && !metric_suspected_) suspect_metric(b);
  const Vector3 change = axis_ - axis_before_;
  const bool turns = change != Vector3::Zero();
  if (turns || !position_told_) account_axis(position_told_ ? change.norm() : 0);
  const bool moves = position_told_ && (length > kLeastMove_mm || turns);
  if (position_told_ && !moves) ++summary_.zero_length;
  if (b.kind == BlockKind::kRapid) {
    summary_.rapid_length_mm += length;
    return;
  }
  summary_.cut_length_mm += length;
  if (b.feed_meaning == FeedMeaning::kInverseTime) {
    if (moves) summary_.cut_time_s += 1 / b.feed;
    return;
  }
  summary_.cut_time_s += length / b.feed;
  if (options_.max_feed_mm_per_s > 0 && b.feed > options_.max_feed_mm_per_s) {
    ++summary_.feeds_limited;
  }
}

}  // namespace meridian::cl
