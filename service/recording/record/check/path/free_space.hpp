// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "meridian/geometry/vector3.hpp"
#include "service/recording/record/check/path/checked_path.hpp"

/// The free space of a recording and a path: which parameters of a path element are within
/// tolerance of a commanded pose, and which of the chord between two poses within that of a vertex.
/// Units: mm, rad. Source: Alt and Godau, the Frechet distance of two polygonal curves (1995).
/// Proof: tests/unit/record/free_space_test.cpp.
namespace meridian::record {

/// What the tool may be off, tip and axis together.
struct Tolerance {
  double tip_mm = 0, axis_rad = 0;
};

/// A commanded pose at the gauge line: where the tip is follows from the tool in force.
struct GaugePose {
  Vector3 gauge = Vector3::Zero();
  Vector3 axis = Vector3::UnitZ();

  [[nodiscard]] ToolPose with_tool(double tool_length_mm) const {
    return {gauge - tool_length_mm * axis, axis};
  }
};

/// Parameters [low, high] in [0, 1].
struct Interval {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double low = 0, high = 1;

  [[nodiscard]] static Interval none() noexcept { return {kNone, -kNone}; }
  [[nodiscard]] bool is_empty() const noexcept { return !(low <= high); }
  void cut(double from, double to) noexcept;
};

/// How far a commanded pose is from the pose at `t` of an element.
struct PoseMatch {
  double t = 0;
  double tip_mm = 0, axis_rad = 0;

  /// max(tip/tolerance, axis/tolerance).
  [[nodiscard]] double share(const Tolerance& tolerance) const noexcept;
};

/// Parameters of the element whose pose is within tolerance of `pose`, which has its tool.
[[nodiscard]] Interval free_on(const PathElement& element, const ToolPose& pose,
                               const Tolerance& tolerance);

/// Parameters of the chord from one pose to the next that are within tolerance of `vertex`.
[[nodiscard]] Interval free_on_chord(const ToolPose& vertex, const ToolPose& from,
                                     const ToolPose& to, const Tolerance& tolerance);

/// The parameter in `within` for which max(tip/tolerance, axis/tolerance) is least. The nearest tip
/// alone would be ill-posed where the axis turns fast.
[[nodiscard]] PoseMatch best_on(const PathElement& element, const Interval& within,
                                const ToolPose& pose, const Tolerance& tolerance);

/// The same of a vertex on a chord; `t` is on the chord.
[[nodiscard]] PoseMatch best_on_chord(const ToolPose& vertex, const ToolPose& from,
                                      const ToolPose& to, const Interval& within,
                                      const Tolerance& tolerance);

}  // namespace meridian::record
