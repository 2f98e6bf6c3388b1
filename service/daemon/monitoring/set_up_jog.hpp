// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/cycle/jog_path.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/monitoring/monitored.hpp"

/// How fast an operator may jog with an open guard, so that the monitoring finds nothing.
/// RT: cycle. Proof: tests/unit/daemon/set_up_jog_test.cpp.
namespace meridian::interpolator {

inline constexpr double kSetUpShare = 0.9;     ///< servo loops overshoot
inline constexpr double kTiltReach_mm = 1000;  ///< the tip rests, axes turn about it so far away

/// Greatest jog speed of joint `joint` at `q` that keeps joint and tip inside their limits.
[[nodiscard]] inline double set_up_jog_speed(const MachineModel& machine,
                                             const monitoring::Limits& limits, int joint,
                                             const JointVector& q, double tool_length_mm) noexcept {
  constexpr double kStep = 1e-4;
  const auto n = static_cast<std::size_t>(joint);
  JointVector next = q;
  next[n] += kStep;
  const Array3 a = tip_over_base(machine, tool_length_mm, q);
  const Array3 b = tip_over_base(machine, tool_length_mm, next);
  const double slope = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) / kStep;
  double speed = limits.axes[n].set_up_speed;
  if (slope > 0) speed = std::min(speed, limits.set_up_tip_speed / slope);
  return kSetUpShare * speed;
}

/// Slows `order` down to what is allowed with an open guard. `q`: the joints, as commanded last.
inline void slow_down(JogOrder& order, const MachineModel& machine,
                      const monitoring::Limits& limits, const JointVector& q) noexcept {
  double speed = 0;
  if (!order.is_tool) {
    if (order.joint >= machine.joint_count) return;
    speed = set_up_jog_speed(machine, limits, order.joint, q, order.tool_length_mm);
  } else if (order.joint >= static_cast<int>(ToolAxis::kTiltX)) {
    speed = kSetUpShare * limits.set_up_tip_speed / kTiltReach_mm;
  } else {
    speed = kSetUpShare * limits.set_up_tip_speed;
  }
  order.velocity = std::clamp(order.velocity, -speed, speed);
}

}  // namespace meridian::interpolator
