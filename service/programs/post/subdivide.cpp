// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/subdivide.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/jacobian.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/joints_at.hpp"
#include "service/programs/post/drive_line.hpp"

namespace meridian::post {
namespace {

constexpr double kMaxTurn_rad = 0.5;  // of all rotary joints in one block: the bound needs < 2
constexpr double kMinShare = 1e-9;    // of a piece: nothing is gained by shorter blocks
constexpr double kLandsOn = 1e-6;     // mm, rad: end of the piece, planned and walked to

[[nodiscard]] ToolPose between(const ToolPose& a, const ToolPose& b, double share) {
  const GreatCircle circle = find_great_circle(a.axis, b.axis);
  const Vec3<double> axis = axis_on_circle(circle.begin, circle.normal, share * circle.turn);
  return {a.tip + share * (b.tip - a.tip), Vector3(axis[0], axis[1], axis[2])};
}

}  // namespace

Subdivider::Sample Subdivider::sample_at(const PathPiece& piece, double share,
                                         const JointVector& reference) const {
  Sample sample;
  const auto at = joints_at(model_, piece, share * piece.length, reference);
  sample.is_reachable = at.status != SolveStatus::kUnreachable;
  sample.exact = at.q;
  sample.end = {share, words_.as_written(drives_of(model_, at.q))};
  if (motion_ == BlockMotion::kDrives) {
    const Jacobian j = jacobian(model_, piece.tool_length_mm, at.q);
    for (int i = 0; i < model_.joint_count; ++i) {
      if (model_.joints[i].is_rotary)
        sample.reach = std::max(sample.reach, j.col(i).head<3>().norm());
    }
  }
  return sample;
}

bool Subdivider::keeps(const PathPiece& piece, const Sample& from, const Sample& to) const {
  const DriveLine line = bound_drive_line(model_, from.end.axes, to.end.axes);
  if (!line.is_known) return false;
  double turn = 0, slide = 0, turn_bend = 0, slide_bend = 0;
  for (int i = 0; i < model_.joint_count; ++i) {
    const bool is_rotary = model_.joints[i].is_rotary;
    (is_rotary ? turn : slide) += line.rate[i];
    (is_rotary ? turn_bend : slide_bend) += line.bend[i];
  }
  if (motion_ != BlockMotion::kTipAndAxis && turn > kMaxTurn_rad) return false;
  const double share = to.end.share - from.end.share;
  const double sweep = piece.arc_sweep * share, axis_turn = piece.axis_turn * share;
  const double path_bend = to_vector(piece.arc_x).norm() * sweep * sweep;
  double tip_bend = path_bend, axis_bend = axis_turn * axis_turn;
  if (motion_ == BlockMotion::kDrives) {
    // Between the ends the tip comes no farther from an axis than reach + (turn reach + slide)/2.
    const double reach =
        (std::max(from.reach, to.reach) + slide / 2) / (1 - std::min(turn, kMaxTurn_rad) / 2);
    tip_bend += (turn * turn + turn_bend) * reach + 2 * turn * slide + slide_bend;
  }
  axis_bend +=
      motion_ == BlockMotion::kTipAndAxis ? axis_turn * axis_turn : turn * turn + turn_bend;

  const auto pose_of = [this, &piece](const JointVector& axes) {
    return forward(model_, piece.tool_length_mm, joints_of(model_, axes));
  };
  const ToolPose begin = pose_of(from.end.axes), end = pose_of(to.end.axes);
  double tip_off = 0, axis_off = 0;
  for (int n = 0; n <= kSamples; ++n) {
    const double u = static_cast<double>(n) / kSamples;
    const ToolPose path = pose_at(piece, (from.end.share + u * share) * piece.length);
    ToolPose pose = between(begin, end, u);
    if (motion_ != BlockMotion::kTipAndAxis) {
      JointVector axes = from.end.axes;
      for (int i = 0; i < model_.joint_count; ++i) {
        axes[i] += u * (to.end.axes[i] - from.end.axes[i]);
      }
      const ToolPose moved = pose_of(axes);
      pose.axis = moved.axis;
      if (motion_ == BlockMotion::kDrives) pose.tip = moved.tip;
    }
    tip_off = std::max(tip_off, (pose.tip - path.tip).norm());
    axis_off = std::max(axis_off, (pose.axis - path.axis).norm());
  }
  constexpr double kRest = 1.0 / (8.0 * kSamples * kSamples);
  const double chord = axis_off + kRest * axis_bend;  // of the axes' tips on the unit sphere
  return tip_off + kRest * tip_bend <= tolerance_.chord_mm &&
         2 * std::asin(std::min(1.0, chord / 2)) <= tolerance_.axis_rad;
}

bool Subdivider::cut(const PathPiece& piece, const JointVector& begin, const Check& is_short_enough,
                     const Take& take) const {
  Sample from = sample_at(piece, 0, piece.joints_begin);
  from.end.axes = begin;
  double step = 1;
  while (from.end.share < 1) {
    const double rest = 1 - from.end.share;
    step = std::min(step, rest);
    const double share = step < rest ? from.end.share + step : 1;
    const Sample to = sample_at(piece, share, from.exact);
    if (to.is_reachable && keeps(piece, from, to) && is_short_enough(from.end, to.end)) {
      take(to.end);
      from = to;
      step *= 2;
      continue;
    }
    step /= 2;
    if (!(step > kMinShare)) return false;
  }
  for (int i = 0; i < model_.joint_count; ++i) {
    if (!(std::abs(from.exact[i] - piece.joints_end[i]) < kLandsOn)) return false;
  }
  return true;
}

}  // namespace meridian::post
