// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "meridian/geometry/vector3.hpp"

namespace meridian::cl {

/// A clamped cubic B-spline, not rational, over the parameter 0 to 1, of tip and tool axis at once.
struct ClampedCubic {
  std::vector<double> inner_knots;  ///< inside (0, 1), not falling
  std::vector<ToolPose> points;     ///< control points, inner knots + 4; the axes of any length

  [[nodiscard]] ToolPose at(double u) const;
};

/// How far straight blocks may lie from the spline.
struct ChordTolerance {
  double tip_mm = 1e-3;
  double axis_rad = 1e-5;
};

/// Largest number of chords that one spline is cut into.
inline constexpr std::size_t kMaxChords = 200'000;

/// Points after the first of chords that lie within the tolerance of the spline; the last is its
/// end. Axes are unit vectors. Empty where it would take more than kMaxChords. The number in each
/// span of knots follows from its largest second derivative, which lies at a control point of the
/// second derivative: chord error <= h^2 / 8 max |f''|. Proof: tests/unit/cl/spline_test.cpp.
[[nodiscard]] std::vector<ToolPose> chords_of(const ClampedCubic& spline,
                                              const ChordTolerance& tolerance);

}  // namespace meridian::cl
