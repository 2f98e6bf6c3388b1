// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "meridian/path/band_span.hpp"
#include "meridian/path/path_piece.hpp"
#include "meridian/planner/relaxed_axis.hpp"

namespace meridian {

/// A span of the path and how the joints follow it: on a branch, or beside the pole with the free
/// joint driven. Spans of a path follow one another with two continuous derivatives of every joint.
struct JointSpan {
  BandSpan band;
  int branch = 0;               ///< of the inverse kinematics, where not driven
  bool is_free_driven = false;  ///< the redundant joint is a quintic of x, the tilt follows
  FreeQuintic free{};           ///< Bernstein values over [0, length], rad
  FreeQuintic roll{};           ///< the roll, where that is driven besides the yaw
  double axis_deviation_rad =
      0;  ///< largest angle by which driving the redundant joint moves the axis
  RelaxedReason reason = RelaxedReason::kBeside;  ///< why, where driven
  double feed_factor = 1;                         ///< FeedFactors::label
  BlockMarks marks{};                             ///< blocks that end on the span
};

/// The piece that the cycle runs on `span`. Joints and names are filled in by the planner.
[[nodiscard]] inline PathPiece make_spline(const JointSpan& span) noexcept {
  PathPiece piece = make_spline(span.band);
  piece.branch = static_cast<std::uint8_t>(span.branch);
  piece.is_free_driven = span.is_free_driven;
  piece.free_quintic = span.free;
  piece.roll_quintic = span.roll;
  piece.marks = span.marks;
  return piece;
}

}  // namespace meridian
