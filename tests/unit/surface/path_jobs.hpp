// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/programs/surface/surface_path.hpp"
#include "support/surfaces.hpp"

/// Jobs for tests of paths over surfaces.
namespace meridian::surface {

using test::surface_of;

[[nodiscard]] inline ContactRule ball_on(const NurbsSurface& surface, double radius_mm,
                                         bool is_flipped = false) {
  ContactRule rule;
  rule.surface = &surface;
  rule.cutter = {2 * radius_mm, radius_mm};
  rule.is_flipped = is_flipped;
  return rule;
}

[[nodiscard]] inline CoverOptions whole(const NurbsSurface& surface) {
  CoverOptions options;
  options.range_u = surface.domain_u();
  options.range_v = surface.domain_v();
  return options;
}

[[nodiscard]] inline NurbsSurface wavy(unsigned seed) {
  std::mt19937_64 draw(seed);
  return surface_of(test::wavy(draw));
}

[[nodiscard]] inline CoverOptions with_scallop(const NurbsSurface& surface, double scallop_mm) {
  CoverOptions options = whole(surface);
  options.points = 2;
  options.scallop_mm = scallop_mm;
  return options;
}

}  // namespace meridian::surface
