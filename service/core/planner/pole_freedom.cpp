// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/pole_freedom.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "meridian/path/pose_at.hpp"
#include "service/core/planner/leg_planner.hpp"

namespace meridian {

double PoleFreedom::most_off_at(double u) const noexcept {
  const auto programmed = programmed_.at(u);
  if (!programmed) return std::numeric_limits<double>::infinity();
  const BandSpan& span = probes_.span_at(u);
  const Vector3 axis = pose_on(span.c, std::clamp(u - span.u0, 0.0, span.length)).axis;
  const Vector3 pole = find_nearest_pole(model_, axis);
  const Vector3 middle = 0.5 * (axis + pole);
  return (programmed->axis - middle).norm() + 0.5 * (axis - pole).norm() + programmed->hidden_rad;
}

bool PoleFreedom::is_below(double limit_rad, PoleProbes::Place place) const noexcept {
  const double here = probes_.u_of(place);
  if (!(most_off_at(here) < limit_rad)) return false;
  const double from = place > probes_.begin_place() ? probes_.u_of(place - 1) : here;
  for (double u = programmed_.next_end(from); u < here; u = programmed_.next_end(u)) {
    if (!(most_off_at(u) < limit_rad)) return false;
  }
  return true;
}

}  // namespace meridian
