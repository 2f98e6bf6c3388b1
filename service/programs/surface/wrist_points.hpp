// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "service/programs/surface/surface_path.hpp"

namespace meridian::surface {

/// S + dN of a contact, and its normal. Units: mm. Frame: W.
struct WristPoint {
  Vector3 at, normal;
};

/// Where the wrist of a robot stands at every contact, in the order of the cuts, whose tool points
/// along the normal and reaches `distance_mm` from the wrist to the contact. Source:
/// docs/surface.md, eq. 2.5. Proof: tests/unit/surface/wrist_points_test.cpp.
[[nodiscard]] std::vector<WristPoint> wrist_points(const SurfacePath& path, double distance_mm);

/// As a table: x_mm,y_mm,z_mm,i,j,k.
[[nodiscard]] std::string to_table(const std::vector<WristPoint>& points);

}  // namespace meridian::surface
