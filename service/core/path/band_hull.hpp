// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/path/path_piece.hpp"
#include "service/core/path/band_polyline.hpp"

namespace meridian {

/// Upper bound, in tolerances, of how far `quartic` (in powers of u - begin) is from `line` over u
/// in [begin, end]: at most 1 means that tip and axis keep their tolerances at every u. `segment`
/// lies at or before the one that holds `begin`. By places where that is enough: one evaluation per
/// vertex; else by the hull. Source: docs/motion.md, 1.4.
[[nodiscard]] double bound_deviation(const BandPolyline& line, const PoseQuartic& quartic,
                                     double begin, double end, std::int64_t segment) noexcept;

/// The same by the hull, hardly above the largest deviation: between two vertices the difference is
/// one quartic, which its Bernstein points enclose; they are halved up to three times where they do
/// not show it at once.
[[nodiscard]] double bound_by_hull(const BandPolyline& line, const PoseQuartic& quartic,
                                   double begin, double end, std::int64_t segment) noexcept;

}  // namespace meridian
