// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/winding.hpp"

/// Joints and their travel.
namespace meridian {

/// Moves every rotary joint that has travel to the winding inside it that is nearest to
/// `reference`; where none is inside, to the winding nearest to `reference`. Endless joints go to
/// the nearest winding. For the first pose of a path: nothing that follows a path may call it.
/// Unit: rad. Proof: tests/property/kinematics.
inline void wind_into_travel(const MachineModel& model, const JointVector& reference,
                             JointVector& q) noexcept {
  constexpr double kMargin_rad = 1e-9;
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& joint = model.joints[i];
    if (!joint.is_rotary) continue;
    q[i] = joint.is_endless ? nearest_winding(q[i], reference[i])
                            : nearest_winding_inside(q[i], reference[i], joint.limits.travel_min,
                                                     joint.limits.travel_max, kMargin_rad);
  }
}

/// Whether `at` is a number no farther than `margin` outside the travel of `joint`. Endless joints
/// have no travel. Units: mm and rad alike. RT: cycle.
[[nodiscard]] inline bool is_inside_travel(const JointSpec& joint, double at,
                                           double margin) noexcept {
  return joint.is_endless
             ? std::isfinite(at)
             : at >= joint.limits.travel_min - margin && at <= joint.limits.travel_max + margin;
}

/// Returns the first joint, or drive of the stage, that is farther than `margin` outside its travel
/// (or not a number), by its index in limited.hpp; -1 where all are inside. RT: cycle.
[[nodiscard]] inline int first_joint_outside_travel(const MachineModel& model, const JointVector& q,
                                                    double margin) noexcept {
  for (int i = 0; i < model.joint_count; ++i) {
    if (!is_inside_travel(model.joints[i], q[i], margin)) return i;
  }
  if (!has_stage(model)) return -1;
  const LimitedVector all = limited_of(model, q);
  for (int i = model.joint_count; i < limited_count(model); ++i) {
    if (!is_inside_travel(limited_spec(model, i), all[i], margin)) return i;
  }
  return -1;
}

}  // namespace meridian
