// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/rt/cycle_data.hpp"

namespace meridian {

/// What is wrong with a setpoint; kNone: it may be sent.
struct GuardVerdict {
  Alarm alarm = Alarm::kNone;
  int joint = 0;
  double value = 0;  ///< the offending position or step
};

inline constexpr double kGuardTravel =
    1e-9;                                   ///< mm or rad; rounding of a pose on the travel's edge
inline constexpr double kGuardStep = 1e-9;  ///< mm or rad; rounding of one solve, 1000x margin

/// Judges the next joint setpoint, the last thing before it is sent: finite, inside travel, and no
/// farther from `previous` (sent `elapsed` seconds ago) than the joint's velocity limit reaches.
/// RT: cycle. Proof: tests/unit/rt/guard_test.cpp.
[[nodiscard]] inline GuardVerdict judge(const MachineModel& machine, const JointVector& next,
                                        const JointVector& velocity, const JointVector& previous,
                                        double elapsed) noexcept {
  for (int i = 0; i < machine.joint_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const JointSpec& joint = machine.joints[n];
    const double q = next[n], step = q - previous[n];
    if (!std::isfinite(q) || !std::isfinite(velocity[n])) return {Alarm::kNotFinite, i, q};
    if (!joint.is_endless && (q < joint.limits.travel_min - kGuardTravel ||
                              q > joint.limits.travel_max + kGuardTravel)) {
      return {Alarm::kTravel, i, q};
    }
    if (!(std::abs(step) <= joint.limits.velocity * elapsed + kGuardStep)) {
      return {Alarm::kStep, i, step};
    }
  }
  return {};
}

}  // namespace meridian
