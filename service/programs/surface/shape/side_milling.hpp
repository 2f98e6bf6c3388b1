// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "meridian/path/cl_block.hpp"

namespace meridian::surface {

/// One straight line of a ruled wall, and how its ends go on with the parameter. Units: mm.
struct Ruling {
  Vector3 bottom, top;
  Vector3 bottom_rate, top_rate;  ///< derivatives by the parameter
};

/// A ruled wall, the cutter on the side of (derivative by the parameter) x (bottom to top). Its
/// parameter runs from 0 to 1 and may go beyond both.
using RuledWall = std::function<Ruling(double)>;

/// A cylinder of this radius along the ruling, touching it in its middle. Its end lies `below_mm`
/// under the wall. Source: docs/surface.md, eq. 7.1. Units: mm.
[[nodiscard]] ToolPose flank_pose(const RuledWall& wall, double part, double radius_mm,
                                  double below_mm);

/// What the flank leaves of a wall, and what it takes of it. Units: mm, rad.
struct FlankFit {
  double undercut_mm = 0;  ///< highest rest on the wall
  double overcut_mm = 0;   ///< deepest cut into it
  double twist_rad = 0;    ///< largest turn of the normal along one ruling
};

/// The wall against the swept flank: of every point its least distance from the axes at `poses`
/// less the radius. Source: docs/surface.md, eq. 7.2. Proof:
/// tests/unit/surface/side_milling_test.cpp.
[[nodiscard]] FlankFit measure_flank(const RuledWall& wall, const std::vector<ToolPose>& poses,
                                     double radius_mm);

/// The sample's wall: 80 mm long, 20 mm high, a wave that leans more or less along its way.
[[nodiscard]] Ruling sample_wall(double part);

/// `side-milling`: that wall cut by the flank of an end mill of 10 mm in one pass. Frame: W in the
/// corner at its bottom, z up.
[[nodiscard]] std::vector<ClBlock> side_milling();

/// Twist, undercut and overcut of the sample, as text.
[[nodiscard]] std::string side_milling_report();

}  // namespace meridian::surface
