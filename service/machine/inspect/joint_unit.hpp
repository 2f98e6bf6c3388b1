// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/units.hpp"

namespace meridian::inspect {

/// `value` of a joint, mm or rad, in the unit that people read: mm or deg.
[[nodiscard]] inline double at_edge(const JointSpec& joint, double value) {
  return joint.is_rotary ? units::deg_from_rad(value) : value;
}

/// That unit.
[[nodiscard]] inline const char* unit_of(const JointSpec& joint) {
  return joint.is_rotary ? "deg" : "mm";
}

}  // namespace meridian::inspect
