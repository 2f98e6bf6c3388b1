// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "meridian/path/cl_block.hpp"

namespace meridian::record {

/// A stretch of programmed path: a straight block, or a part of an arc of at most 15°. The tool
/// axis is on the great circle between the block axes. Units: mm, rad, s. Frame: W.
struct PathElement {
  Vector3 tip_begin;     ///< begin; arc: centre, at the height of the begin
  Vector3 tip_delta;     ///< end - begin; arc: rise along the normal
  Vector3 arc_x, arc_y;  ///< arc: begin - centre, and normal × that
  double arc_sweep = 0;  ///< 0: straight
  Vector3 axis_begin;
  Vector3 axis_normal;
  double axis_turn = 0;   ///< rad, [0, π]
  double s = 0;           ///< common length at its begin: tip length + 50 mm per rad of axis turn
  double length = 0;      ///< of it
  bool is_timed = false;  ///< its block is in inverse time
  double feed_mm_per_s = kNoFeed;   ///< tip speed that its block asks for, at most the machine's
  double turn_rad_per_s = kNoFeed;  ///< the same of the axis; infinite in rapids
  double path_begin = 0;   ///< at its begin: root of the squares of tip length and 50 mm per rad
  double path_length = 0;  ///< of it
  double path_mm_per_s = kNoFeed;  ///< that its block asks for
  double tool_length_mm = 0;       ///< gauge line to tip while it is cut
  std::uint32_t line = 0;          ///< source line of its block
  bool is_block_end = true;        ///< false between the parts of an arc

  static constexpr double kNoFeed = std::numeric_limits<double>::infinity();

  /// Of `length`, what the tip goes.
  [[nodiscard]] double tip_length() const noexcept;
  /// The way at `t` in [0, 1].
  [[nodiscard]] double path_to(double t) const noexcept { return path_begin + t * path_length; }
  /// Pose at `t` in [0, 1].
  [[nodiscard]] ToolPose pose(double t) const noexcept;
  /// Derivative of pose by t.
  [[nodiscard]] ToolPose slope(double t) const noexcept;
};

/// The path that a CL file programs, from the end of its first motion block on, as an outside check
/// sees it: written from the CL blocks alone, without code of the planner.
class CheckedPath {
 public:
  /// `tool_length_mm`: in the spindle at the start. `max_feed_mm_per_s`: of the machine, 0: none.
  CheckedPath(double tool_length_mm, double max_feed_mm_per_s);

  /// Adds the next block. `new_tool_length_mm` counts for a tool block alone.
  void add(const ClBlock& block, double new_tool_length_mm);

  [[nodiscard]] const std::vector<PathElement>& elements() const noexcept { return elements_; }
  [[nodiscard]] bool has_begin() const noexcept { return has_begin_; }
  [[nodiscard]] const ToolPose& begin() const noexcept { return begin_; }
  [[nodiscard]] const ToolPose& end() const noexcept { return end_; }
  [[nodiscard]] double begin_tool_length_mm() const noexcept { return begin_tool_length_mm_; }
  [[nodiscard]] double end_tool_length_mm() const noexcept { return tool_length_mm_; }
  [[nodiscard]] std::uint32_t begin_line() const noexcept { return begin_line_; }
  [[nodiscard]] std::uint64_t motion_block_count() const noexcept { return motion_blocks_; }
  [[nodiscard]] double tip_length_mm() const noexcept { return tip_length_mm_; }
  /// Common length of all elements.
  [[nodiscard]] double length() const noexcept { return length_; }

 private:
  std::vector<PathElement> elements_;
  ToolPose begin_{}, end_{};
  double tool_length_mm_, begin_tool_length_mm_;
  double max_feed_mm_per_s_;
  double length_ = 0, passed_ = 0, tip_length_mm_ = 0;
  std::uint64_t motion_blocks_ = 0;
  std::uint32_t begin_line_ = 0;
  bool has_begin_ = false;
};

}  // namespace meridian::record
