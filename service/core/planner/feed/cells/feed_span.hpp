// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "meridian/path/path_piece.hpp"
#include "service/core/planner/feed/cells/joint_span.hpp"

namespace meridian {

/// A stretch of path as the feed planner sees it: from `begin` on `path`, `length` long, and how
/// fast it may be run. Branch and tool length are those of the path. Units: mm, rad, s.
struct FeedSpan {
  PathPiece path;
  double begin = 0, length = 0;
  double feed_mm_per_s = std::numeric_limits<double>::infinity();     ///< of the tip
  double u_speed_mm_per_s = std::numeric_limits<double>::infinity();  ///< of the path parameter
  double turn_rad_per_s = std::numeric_limits<double>::infinity();    ///< of the tool axis
  int cells = 0;  ///< that it becomes; 0: as many as CellSettings::cell_s asks for
};

/// All of `span`.
[[nodiscard]] inline FeedSpan make_feed_span(const JointSpan& span,
                                             double tool_length_mm) noexcept {
  FeedSpan out;
  out.path = make_spline(span);
  out.path.tool_length_mm = tool_length_mm;
  out.length = span.band.length;
  out.feed_mm_per_s = span.band.feed_mm_per_s;
  out.u_speed_mm_per_s = span.band.u_speed_mm_per_s;
  out.turn_rad_per_s = span.band.turn_rad_per_s;
  return out;
}

}  // namespace meridian
