// SPDX-License-Identifier: Apache-2.0
#include "meridian/path/build_piece.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "meridian/geometry/great_circle.hpp"

namespace meridian {
namespace {

double length_of(double tip_mm, double turn_rad) noexcept {
  return std::hypot(tip_mm, kAxisLength_mm_per_rad * turn_rad);
}

void set_axis(PathPiece& piece, const Vector3& begin, const Vector3& end) noexcept {
  const GreatCircle circle = find_great_circle(begin, end);
  piece.axis_begin = to_array(circle.begin);
  piece.axis_normal = to_array(circle.normal);
  piece.axis_turn = circle.turn;
}

Vector3 turned(const Vector3& radius, const Vector3& normal, double angle) noexcept {
  return std::cos(angle) * radius + std::sin(angle) * normal.cross(radius);
}

/// The great circle of `piece` from turn `from` on, over `by`.
void cut_axis(PathPiece& piece, double from, double by) noexcept {
  const Vector3 begin = to_vector(piece.axis_begin), normal = to_vector(piece.axis_normal);
  const double c = std::cos(from), s = std::sin(from);
  if (from != 0) {
    piece.axis_begin = to_array(c * begin + s * normal);
    piece.axis_normal = to_array(c * normal - s * begin);
  }
  piece.axis_turn = by;
}

/// Tip and axis between shares `from` and `to` of their way.
void cut_pose(PathPiece& piece, double from, double to) noexcept {
  const Vector3 delta = to_vector(piece.tip_delta);
  if (piece.kind == PathKind::kArc) {
    const Vector3 x = to_vector(piece.arc_x), y = to_vector(piece.arc_y);
    const double angle = piece.arc_sweep * from, c = std::cos(angle), s = std::sin(angle);
    piece.arc_x = to_array(c * x + s * y);
    piece.arc_y = to_array(c * y - s * x);
    piece.arc_centre = to_array(to_vector(piece.arc_centre) + from * delta);
    piece.arc_sweep *= to - from;
  } else {
    piece.tip_begin = to_array(to_vector(piece.tip_begin) + from * delta);
  }
  piece.tip_delta = to_array((to - from) * delta);
  cut_axis(piece, from * piece.axis_turn, (to - from) * piece.axis_turn);
}

}  // namespace

PathPiece make_line(const ToolPose& begin, const ToolPose& end) noexcept {
  PathPiece piece;
  piece.kind = PathKind::kLine;
  piece.tip_begin = to_array(begin.tip);
  piece.tip_delta = to_array(end.tip - begin.tip);
  set_axis(piece, begin.axis, end.axis);
  piece.length = length_of(tip_length(piece), piece.axis_turn);
  return piece;
}

PathPiece make_arc(const ToolPose& begin, const ToolPose& end, const ClBlock& block) noexcept {
  const Vector3 normal = to_vector(block.normal);
  Vector3 centre = to_vector(block.centre_mm);
  centre += normal * normal.dot(begin.tip - centre);  // in the plane of the begin
  const Vector3 radius = begin.tip - centre;
  PathPiece piece;
  piece.kind = PathKind::kArc;
  piece.tip_begin = to_array(begin.tip);
  piece.arc_centre = to_array(centre);
  piece.arc_x = to_array(radius);
  piece.arc_y = to_array(normal.cross(radius));
  piece.arc_sweep = block.sweep_rad;
  piece.tip_delta = to_array(end.tip - centre - turned(radius, normal, block.sweep_rad));
  set_axis(piece, begin.axis, end.axis);
  piece.length = length_of(tip_length(piece), piece.axis_turn);
  return piece;
}

Vector3 find_arc_begin(const ClBlock& block) noexcept {
  const Vector3 normal = to_vector(block.normal), centre = to_vector(block.centre_mm);
  const Vector3 from_centre = to_vector(block.tip_mm) - centre;
  const Vector3 radius = from_centre - normal * normal.dot(from_centre);
  return centre + turned(radius, normal, -block.sweep_rad);
}

PathPiece make_turn(const ToolPose& pose, double free_begin, double free_end) noexcept {
  PathPiece piece;
  piece.kind = PathKind::kTurn;
  piece.is_free_driven = true;
  piece.tip_begin = to_array(pose.tip);
  piece.axis_begin = to_array(pose.axis);
  piece.free_begin = free_begin;
  piece.free_end = free_end;
  piece.length = kAxisLength_mm_per_rad * std::abs(free_end - free_begin);
  return piece;
}

PathPiece make_joint_move(const JointVector& begin, const JointVector& end,
                          std::uint32_t rotary_mask) noexcept {
  PathPiece piece;
  piece.kind = PathKind::kJoint;
  piece.joints_begin = begin;
  piece.joints_end = end;
  double square = 0;
  for (int i = 0; i < kMaxJoints; ++i) {
    const double weight = (rotary_mask >> i & 1U) != 0 ? kAxisLength_mm_per_rad : 1.0;
    const double by = weight * (end[i] - begin[i]);
    square += by * by;
  }
  piece.length = std::sqrt(square);
  return piece;
}

PathPiece with_axes(const PathPiece& piece, const Vector3& begin, const Vector3& end) noexcept {
  PathPiece out = piece;
  set_axis(out, begin, end);
  out.length = length_of(tip_length(out), out.axis_turn);
  return out;
}

double tip_length(const PathPiece& piece) noexcept {
  const double straight = to_vector(piece.tip_delta).norm();
  if (piece.kind == PathKind::kLine) return straight;
  if (piece.kind != PathKind::kArc) return 0;
  return std::hypot(piece.arc_sweep * to_vector(piece.arc_x).norm(), straight);
}

PathPiece cut_piece(const PathPiece& piece, double from, double to) noexcept {
  PathPiece part = piece;
  part.length = (to - from) * piece.length;
  const double by = piece.free_end - piece.free_begin;
  part.free_end = to == 1 ? piece.free_end : piece.free_begin + to * by;
  part.free_begin = piece.free_begin + from * by;
  if (piece.kind == PathKind::kLine || piece.kind == PathKind::kArc) cut_pose(part, from, to);
  return part;
}

PolePassage find_passage(const PathPiece& piece, const Vector3& pole) noexcept {
  const Vector3 begin = to_vector(piece.axis_begin), normal = to_vector(piece.axis_normal);
  return {atan2(normal.dot(pole), begin.dot(pole)), std::abs(begin.cross(normal).dot(pole))};
}

PathPiece cut_by_azimuth(const PathPiece& piece, const PolePassage& passage, double from,
                         double to) noexcept {
  const auto turn_at = [&passage](double azimuth) {
    return atan2(passage.offset * std::sin(azimuth), std::cos(azimuth));
  };
  const double first = turn_at(from), last = turn_at(to);
  PathPiece part = piece;
  const double whole = piece.axis_turn;
  cut_pose(part, (passage.nearest_turn + first) / whole, (passage.nearest_turn + last) / whole);
  part.axis_turn = last - first;
  part.length = kAxisLength_mm_per_rad * (to - from);
  part.is_azimuthal = true;
  part.azimuth_begin = from;
  part.azimuth_end = to;
  part.azimuth_from = first;
  part.pole_offset = passage.offset;
  return part;
}

}  // namespace meridian
