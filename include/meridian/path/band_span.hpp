// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "meridian/path/path_piece.hpp"

namespace meridian {

/// One committed span of the band spline: the smooth path between two of its knots, or a part of
/// it. Spans follow one another without a gap and with three continuous derivatives by u; a
/// committed span never changes. The first begins and the last ends on a CL block, where the
/// machine is at rest.
///
/// u is the chord length of the CL polyline, du² = |dP|² + (50 mm/rad · |dK|)²: along the spline it
/// is nearly, not exactly, the path length, so |dP/du| is about 1 on a straight line, smaller where
/// the axis turns and down to 0 at an exact reversal. It counts from 0 at BandSpline::begin().
///
/// Frame: W. Units: mm, rad, s. Trivially copyable. Source: docs/motion.md, section 1.
struct BandSpan {
  double u0 = 0;      ///< u at the begin
  double length = 0;  ///< range of u, > 0; x = u - u0 runs in [0, length]
  PoseQuartic c{};    ///< tip and axis in powers of x, see pose_on()
  /// The block that the begin of the span belongs to. A span may straddle blocks: BlockEnd says
  /// where they end.
  std::uint64_t sequence = 0;
  std::uint32_t line = 0;
  /// Bound of the tip speed |dP/dt|: the least programmed feed of the blocks that the span touches;
  /// where one is in inverse time also the fastest that a block within 5 mm of u asks for.
  double feed_mm_per_s = std::numeric_limits<double>::infinity();
  /// Bound of du/dt: the least that an inverse-time feed on the span asks for; infinite where none
  /// is programmed.
  double u_speed_mm_per_s = std::numeric_limits<double>::infinity();
  /// Bound of the axis speed |dK/dt|: where a block of the span is in inverse time the fastest that
  /// one within 5 mm of u asks for; infinite else.
  double turn_rad_per_s = std::numeric_limits<double>::infinity();
};
static_assert(std::is_trivially_copyable_v<BandSpan>);

/// `span` from x = `from` on, `length` long.
[[nodiscard]] inline BandSpan part_of_span(const BandSpan& span, double from,
                                           double length) noexcept {
  BandSpan out = span;
  out.u0 = span.u0 + from;
  out.length = length;
  for (auto& c : out.c) {  // Taylor shift
    for (std::size_t round = 0; round < 4; ++round) {
      for (std::size_t k = 4; k-- > round;) c[k] += from * c[k + 1];
    }
  }
  return out;
}

/// Where a block ends on the spline: within tolerance of its programmed pose. Blocks without length
/// (du < 1e-6 mm) have none.
struct BlockEnd {
  double u = 0;
  std::uint64_t sequence = 0;
  std::uint32_t line = 0;
  double feed_mm_per_s = 0;  ///< programmed tip feed; of inverse time tip length over duration
};
static_assert(std::is_trivially_copyable_v<BlockEnd>);

/// The piece that the cycle runs on `span`. Branch, joints and names are filled in by the planner.
[[nodiscard]] inline PathPiece make_spline(const BandSpan& span) noexcept {
  PathPiece piece;
  piece.kind = PathKind::kSpline;
  piece.sequence = span.sequence;
  piece.line = span.line;
  piece.length = span.length;
  piece.spline = span.c;
  return piece;
}

}  // namespace meridian
