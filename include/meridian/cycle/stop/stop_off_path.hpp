// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/stop/stop_margin.hpp"
#include "meridian/geometry/jet.hpp"
#include "meridian/kinematics/limited.hpp"

/// Stops beside the path: of every joint on its own line where the path gives no setpoint, and what
/// is left of a deviation from the path. RT: cycle.
namespace meridian {

/// Lessens `authority` so that the drives of a stage stop inside their FaultStop limits too, the
/// joints running along `direction` from `joints`: where the curvature of the stage alone takes
/// most of a limit, a quarter of it.
[[nodiscard, gnu::noinline]] inline StopMargin authority_beside_stage(
    const MachineModel& machine, const JointVector& joints, const JointVector& direction,
    StopMargin authority) noexcept {
  Joints<Jet<3>> moving;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    moving[i] = Jet<3>::with_derivative(joints[i], direction[i]);
  }
  const Limited<Jet<3>> all = limited_of(machine, moving);
  for (int i = machine.joint_count; i < limited_count(machine); ++i) {
    const auto n = static_cast<std::size_t>(i);
    const JointLimits& limits = limited_spec(machine, i).limits;
    const double d1 = std::abs(all[n].derivative(1)), d2 = std::abs(all[n].derivative(2)),
                 d3 = std::abs(all[n].derivative(3));
    const double accel = std::max(limits.fault_acceleration - d2, 0.25 * limits.fault_acceleration);
    if (accel < authority.accel * d1) authority.accel = accel / d1;
    const double jerk =
        std::max(limits.fault_jerk - d3 - 3 * d2 * authority.accel, 0.25 * limits.fault_jerk);
    if (jerk < authority.jerk * d1) authority.jerk = jerk / d1;
  }
  return authority;
}

/// A stop of every joint along its last velocity, all in the same time: the last resort where the
/// path gives no setpoint that may be sent.
[[nodiscard]] inline StopInProgress stop_off_path(const MachineModel& machine,
                                                  const JointVector& joints,
                                                  const JointVector& velocity,
                                                  StopEvent event = StopEvent::kPathLost) noexcept {
  StopInProgress stop;
  stop.change(event);
  stop.begin = joints;
  StopMargin authority{1e9, 1e12};
  bool is_moving = false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(machine.joint_count); ++i) {
    const double speed = std::abs(velocity[i]);
    if (!(speed > 0) || !std::isfinite(speed)) continue;
    const JointLimits& limits = machine.joints[i].limits;
    stop.direction[i] = velocity[i];
    authority.accel = std::min(authority.accel, limits.fault_acceleration / speed);
    authority.jerk = std::min(authority.jerk, limits.fault_jerk / speed);
    is_moving = true;
  }
  if (is_moving && has_stage(machine)) {
    authority = authority_beside_stage(machine, joints, stop.direction, authority);
  }
  stop.law = StopLaw({0, is_moving ? 1.0 : 0.0, 0, 0}, authority);
  return stop;
}

/// Adds what is left of the deviation from the path: 1 - 10x³ + 15x⁴ - 6x⁵ of it.
inline void add_deviation(CycleState& state, int joint_count) noexcept {
  const StopInProgress& stop = state.stop;
  if (stop.time >= stop.deviation_time) return;
  const double x = stop.time / stop.deviation_time;
  const double left = 1 - x * x * x * (10 - x * (15 - 6 * x));
  const double slope = -30 * x * x * (1 - x) * (1 - x) / stop.deviation_time;
  for (std::size_t i = 0; i < static_cast<std::size_t>(joint_count); ++i) {
    state.joints[i] += stop.deviation[i] * left;
    state.velocity[i] += stop.deviation[i] * slope;
  }
}

/// Puts the joints where the stop off the path is at its time.
inline void put_off_path(CycleState& state, int joint_count) noexcept {
  const StopInProgress& stop = state.stop;
  const PathState p = stop.law.at(stop.time);
  for (std::size_t i = 0; i < static_cast<std::size_t>(joint_count); ++i) {
    state.joints[i] = stop.begin[i] + stop.direction[i] * p.s;
    state.velocity[i] = stop.direction[i] * p.ds;
  }
}

}  // namespace meridian
