// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/wrist_points.hpp"

#include "service/text/printed.hpp"

namespace meridian::surface {

using text::printed;

std::vector<WristPoint> wrist_points(const SurfacePath& path, double distance_mm) {
  std::vector<WristPoint> out;
  for (const Contact* const contact : in_order(path)) {
    const SurfaceShape& shape = contact->shape;
    out.push_back({shape.at + distance_mm * shape.normal, shape.normal});
  }
  return out;
}

std::string to_table(const std::vector<WristPoint>& points) {
  std::string out = "x_mm,y_mm,z_mm,i,j,k\n";
  for (const WristPoint& p : points) {
    out += printed("%.6f,%.6f,%.6f,%.9f,%.9f,%.9f\n", p.at[0], p.at[1], p.at[2], p.normal[0],
                   p.normal[1], p.normal[2]);
  }
  return out;
}

}  // namespace meridian::surface
