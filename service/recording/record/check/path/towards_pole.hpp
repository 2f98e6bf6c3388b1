// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"

namespace meridian::record {

/// Whether `axis` is between `from` and a pole of the machine, within `tolerance_rad` on the great
/// circle: where a rewind to another branch takes it. The machine has a pole.
[[nodiscard]] inline bool is_towards_pole(const MachineModel& model, const Vector3& from,
                                          const Vector3& axis, double tolerance_rad) {
  const Vector3 pole = pole_direction(model);
  const auto detour = [&](const Vector3& to) {
    return angle_between(from, axis) + angle_between(axis, to) - angle_between(from, to);
  };
  return std::min(detour(pole), detour(-pole)) <= tolerance_rad;
}

}  // namespace meridian::record
