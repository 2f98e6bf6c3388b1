// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/path/checked_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/path/path_piece.hpp"

namespace meridian::record {
namespace {

constexpr double kLargestPart_rad = std::numbers::pi / 12;

}  // namespace

double PathElement::tip_length() const noexcept {
  return length - kAxisLength_mm_per_rad * axis_turn;
}

ToolPose PathElement::pose(double t) const noexcept {
  ToolPose out{tip_begin + t * tip_delta, axis_begin};
  if (arc_sweep != 0) {
    out.tip += std::cos(t * arc_sweep) * arc_x + std::sin(t * arc_sweep) * arc_y;
  }
  if (axis_turn != 0) {
    out.axis = std::cos(t * axis_turn) * axis_begin + std::sin(t * axis_turn) * axis_normal;
  }
  return out;
}

ToolPose PathElement::slope(double t) const noexcept {
  ToolPose out{tip_delta, Vector3::Zero()};
  if (arc_sweep != 0) {
    out.tip += arc_sweep * (std::cos(t * arc_sweep) * arc_y - std::sin(t * arc_sweep) * arc_x);
  }
  if (axis_turn != 0) {
    out.axis =
        axis_turn * (std::cos(t * axis_turn) * axis_normal - std::sin(t * axis_turn) * axis_begin);
  }
  return out;
}

CheckedPath::CheckedPath(double tool_length_mm, double max_feed_mm_per_s)
    : tool_length_mm_(tool_length_mm),
      begin_tool_length_mm_(tool_length_mm),
      max_feed_mm_per_s_(max_feed_mm_per_s > 0 ? max_feed_mm_per_s : PathElement::kNoFeed) {}

void CheckedPath::add(const ClBlock& block, double new_tool_length_mm) {
  if (block.kind == BlockKind::kTool) {
    // At rest with joints unmoved: the tip is somewhere else from now on, on the same tool axis.
    end_.tip -= (new_tool_length_mm - tool_length_mm_) * end_.axis;
    tool_length_mm_ = new_tool_length_mm;
    return;
  }
  if (!is_motion(block.kind)) return;
  ++motion_blocks_;
  const ToolPose goal{to_vector(block.tip_mm), to_vector(block.axis).normalized()};
  if (!has_begin_) {
    has_begin_ = true;
    begin_ = end_ = goal;
    begin_line_ = block.line;
    begin_tool_length_mm_ = tool_length_mm_;
    return;
  }
  const GreatCircle circle = find_great_circle(end_.axis, goal.axis);
  PathElement element;
  element.tip_begin = end_.tip;
  element.tip_delta = goal.tip - end_.tip;
  element.arc_x = element.arc_y = Vector3::Zero();
  element.axis_begin = circle.begin;
  element.axis_normal = circle.normal;
  element.axis_turn = circle.turn;
  element.tool_length_mm = tool_length_mm_;
  element.line = block.line;
  double tip_length = element.tip_delta.norm();
  const double turn_length = kAxisLength_mm_per_rad * circle.turn;
  int parts = 1;
  if (block.is_arc) {
    const Vector3 normal = to_vector(block.normal);
    element.tip_begin = to_vector(block.centre_mm);
    element.arc_x = end_.tip - element.tip_begin;
    element.tip_begin += normal.dot(element.arc_x) * normal;
    element.arc_x -= normal.dot(element.arc_x) * normal;
    element.arc_y = normal.cross(element.arc_x);
    element.tip_delta = normal.dot(goal.tip - end_.tip) * normal;
    tip_length = std::hypot(block.sweep_rad * element.arc_x.norm(), element.tip_delta.norm());
    parts = std::max(1, static_cast<int>(std::ceil(block.sweep_rad / kLargestPart_rad)));
  }
  const double path_length = std::hypot(tip_length, turn_length);
  if (block.feed_meaning != FeedMeaning::kNone) {
    element.is_timed = block.feed_meaning == FeedMeaning::kInverseTime;
    const double per_s = element.is_timed ? block.feed : block.feed / tip_length;
    element.feed_mm_per_s =
        std::min(element.is_timed ? per_s * tip_length : block.feed, max_feed_mm_per_s_);
    element.turn_rad_per_s = circle.turn > 0 ? per_s * circle.turn : 0;
    element.path_mm_per_s = path_length > 0 ? per_s * path_length : 0;
  }
  element.length = (tip_length + turn_length) / parts;
  element.path_length = path_length / parts;
  const PathElement whole = element;
  for (int i = 0; i < parts; ++i) {
    if (parts > 1) {
      const double begin = static_cast<double>(i) / parts;
      const double sweep = block.sweep_rad;
      const double turn = whole.axis_turn;
      element.tip_begin = whole.tip_begin + begin * whole.tip_delta;
      element.tip_delta = whole.tip_delta / parts;
      element.arc_x = std::cos(begin * sweep) * whole.arc_x + std::sin(begin * sweep) * whole.arc_y;
      element.arc_y = std::cos(begin * sweep) * whole.arc_y - std::sin(begin * sweep) * whole.arc_x;
      element.axis_begin =
          std::cos(begin * turn) * whole.axis_begin + std::sin(begin * turn) * whole.axis_normal;
      element.axis_normal =
          std::cos(begin * turn) * whole.axis_normal - std::sin(begin * turn) * whole.axis_begin;
      element.axis_turn = turn / parts;
      element.is_block_end = i + 1 == parts;
    }
    element.arc_sweep = block.is_arc ? block.sweep_rad / parts : 0;
    element.s = length_;
    element.path_begin = passed_;
    length_ += element.length;
    passed_ += element.path_length;
    elements_.push_back(element);
  }
  tip_length_mm_ += tip_length;
  end_ = goal;
}

}  // namespace meridian::record
