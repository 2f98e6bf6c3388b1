// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>

#include "meridian/geometry/vector3.hpp"
#include "service/record/checked_path.hpp"

namespace meridian::record {

/// The programmed pose that a commanded one is held against, and how far apart they are.
struct PoseMatch {
  std::size_t element = 0;
  double t = 0;  ///< place on it, [0, 1]
  double s = 0;  ///< common length there
  double tip_mm = 0;
  double axis_rad = 0;
};

/// Finds for one commanded pose after the other the programmed pose near the place that is being
/// cut for which max(tip/tolerance, axis/tolerance) is least. The nearest tip alone would be
/// ill-posed where the axis turns fast.
///
/// Where several are as good (a path that runs back on itself), the one is taken that lies as far
/// along as the commanded pose has moved. It looks ahead by ten times that distance; where what it
/// finds there is half a tolerance off, as far as a tool may turn round before its path does.
///
/// The path goes forward alone: no match lies before the earliest place that the tool may have
/// come to, nowhere farther off than its tolerances.
///
///     path ──────────▶┐     The tool turns round earlier, inside the tolerance. Matches run back
///     tool ───────▶┐  │     along the way out as far as the earliest place; from there on they are
///          ◀───────┘  │     found on the way back.
///          ◀──────────┘
///
/// Proof: tests/unit/record/check_test.cpp.
class PathFollower {
 public:
  PathFollower(const CheckedPath& path, double tip_tolerance_mm, double axis_tolerance_rad);

  /// The axis tolerance of the matches from here on.
  void set_axis_tolerance(double rad) noexcept { axis_tolerance_ = rad; }

  /// The match of the next pose. Poses come in the order of time, tips of the tool in force.
  [[nodiscard]] PoseMatch follow(const ToolPose& pose);

  /// How far `pose` is from the begin of element `index`, where a new tool goes on.
  [[nodiscard]] PoseMatch match_begin(const ToolPose& pose, std::size_t index) const;
  /// Goes on from `match`, which the pose `pose` of a new tool has: joints have not moved.
  void jump(const ToolPose& pose, const PoseMatch& match) noexcept;

  /// A place on the path. Compares as they follow one another.
  struct Place {
    std::size_t element = 0;
    double t = 0;  ///< [0, 1]
    [[nodiscard]] friend auto operator<=>(const Place&, const Place&) = default;
  };
  /// The earliest that the tool may be at.
  [[nodiscard]] const Place& earliest() const noexcept { return earliest_; }
  /// Common length at a place.
  [[nodiscard]] double length_at(const Place& place) const noexcept;

  /// max(tip/tolerance, axis/tolerance) of a match.
  [[nodiscard]] double badness(const PoseMatch& match) const noexcept {
    return std::max(match.tip_mm / tip_tolerance_, match.axis_rad / axis_tolerance_);
  }

  /// max(tip/tolerance, axis/tolerance) of `pose` against element `index` at `t`.
  [[nodiscard]] double measure(const ToolPose& pose, std::size_t index, double t) const noexcept;

 private:
  [[nodiscard]] PoseMatch match_at(const ToolPose& pose, std::size_t index, double t) const;
  [[nodiscard]] double project(const ToolPose& pose, std::size_t index, double t) const noexcept;
  /// Where matches on element `index` begin.
  [[nodiscard]] double begin_of(std::size_t index) const noexcept {
    return index == earliest_.element ? earliest_.t : 0.0;
  }
  [[nodiscard]] PoseMatch search(const ToolPose& pose, double moved) const;
  [[nodiscard]] PoseMatch find_best(const ToolPose& pose, const PoseMatch& coarse) const;
  [[nodiscard]] PoseMatch scan(const ToolPose& pose, double reach, double place_weight,
                               double expected) const;
  [[nodiscard]] PoseMatch refine(const ToolPose& pose, std::size_t index) const;
  void raise_earliest(const ToolPose& pose, const PoseMatch& match) noexcept;
  void leave_behind(std::size_t index, double t, double off) noexcept;

  const CheckedPath& path_;
  double tip_tolerance_, axis_tolerance_;
  ToolPose last_{};
  PoseMatch here_;
  Place earliest_;
  bool is_first_ = true;
};

}  // namespace meridian::record
