// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "service/programs/surface/shape/cutter.hpp"
#include "service/programs/surface/shape/nurbs_surface.hpp"
#include "service/programs/surface/shape/surface_shape.hpp"

namespace meridian::surface {

/// Which cutter touches which surface how. The lean counts from the direction of the lines, always
/// towards the growing parameter, so that the axis does not jump where a zigzag turns round. The
/// surface must live as long. Units: mm, rad.
struct ContactRule {
  const NurbsSurface* surface = nullptr;
  Cutter cutter;
  double lead_rad = 0;
  double tilt_rad = 0;
  bool is_flipped = false;   ///< the cutter is on the other side than du x dv
  bool runs_along_u = true;  ///< lines run along u, at one v each
};

/// One cutter contact: the surface there, the tool that touches it. Units: mm. Frame: W.
struct Contact {
  double u = 0, v = 0;
  SurfaceShape shape;
  Vector3 feed;  ///< unit, along the line towards its growing parameter
  ToolPose pose;
};

/// None where the surface has no normal.
[[nodiscard]] std::optional<Contact> find_contact(const ContactRule& rule, double u,
                                                  double v) noexcept;

/// Largest distance of the exact contact and tip between two contacts, parameters straight between
/// theirs, from the straight ways between the two: how far straight blocks leave the surface. None
/// where the surface has no normal on the way. The way must not cross a knot. Source:
/// docs/surface.md, eq. 3.1. Units: mm. Proof: tests/unit/surface/surface_path_test.cpp.
[[nodiscard]] std::optional<double> chord_error(const ContactRule& rule, const Contact& from,
                                                const Contact& to) noexcept;

/// Height of the cusp that two passes beside each other leave between these contacts; infinite
/// where the passes do not overlap. The cutter counts as a circle across the feed: exact for ball
/// ends. Source: docs/surface.md, eq. 3.2 to 3.4. Units: mm. Proof:
/// tests/unit/surface/surface_path_test.cpp.
[[nodiscard]] double scallop_between(const ContactRule& rule, const Contact& a,
                                     const Contact& b) noexcept;

}  // namespace meridian::surface
