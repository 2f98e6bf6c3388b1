// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/jog/jog_path.hpp"
#include "meridian/geometry/jet.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/monitoring/monitored.hpp"

/// How fast an operator may jog with an open guard, so that the monitoring finds nothing.
/// RT: cycle. Proof: tests/unit/daemon/set_up_jog_test.cpp.
namespace meridian::interpolator {

inline constexpr double kSetUpShare = 0.9;  ///< servo loops overshoot

/// Greatest speed at which joints that move by their first derivatives keep the limits of set-up
/// mode: of each joint, and of the tip over the base.
[[nodiscard]] inline double set_up_speed(const MachineModel& machine,
                                         const monitoring::Limits& limits,
                                         const Joints<Jet<1>>& moving,
                                         double tool_length_mm) noexcept {
  double speed = std::numeric_limits<double>::infinity();
  const auto keep = [&speed](double limit, double slope) {
    if (slope > 0) speed = std::min(speed, kSetUpShare * limit / slope);
  };
  for (std::size_t i = 0; i < static_cast<std::size_t>(machine.joint_count); ++i) {
    keep(limits.axes[i].set_up_speed, std::abs(moving[i].derivative(1)));
  }
  const auto tip = tip_over_base(machine, tool_length_mm, moving);
  keep(limits.set_up_tip_speed,
       std::hypot(tip[0].derivative(1), tip[1].derivative(1), tip[2].derivative(1)));
  return speed;
}

/// The same along the path of a tool that is jogged, where it is and a little ahead of it in both
/// directions: beside the pole its slopes grow. 0 where there are no joints.
[[nodiscard]] inline double set_up_tool_speed(const MachineModel& machine,
                                              const monitoring::Limits& limits,
                                              const CycleState& state,
                                              double tool_length_mm) noexcept {
  constexpr double kAhead_mm = 0.5, kAhead_rad = 0.005;
  const Jogging& jogging = state.jogging;
  const double ahead = jogging.tool_path.is_tilt ? kAhead_rad : kAhead_mm;
  double speed = 0;
  for (const double offset : {0.0, ahead, -ahead}) {
    const double s = jogging.axis.at.q + offset;
    const bool is_inside = s >= jogging.axis.low && s <= jogging.axis.high;
    const auto at = joints_on(machine, jogging.tool_path, Jet<1>::variable(s), state.joints);
    if (at.status != SolveStatus::kOk || (offset != 0 && !is_inside)) continue;
    const double here = set_up_speed(machine, limits, at.q, tool_length_mm);
    speed = offset == 0 ? here : std::min(speed, here);
  }
  return speed;
}

/// Greatest jog speed with an open guard, of the joint or the tool that is jogged; no limit where
/// nothing is.
[[nodiscard]] inline double set_up_jog_speed(const MachineModel& machine,
                                             const monitoring::Limits& limits,
                                             const CycleState& state,
                                             double tool_length_mm) noexcept {
  const Jogging& jogging = state.jogging;
  if (!jogging.is_ready) return std::numeric_limits<double>::infinity();
  if (jogging.joint >= kMaxJoints) {
    return set_up_tool_speed(machine, limits, state, tool_length_mm);
  }
  Joints<Jet<1>> moving;
  for (std::size_t i = 0; i < moving.size(); ++i) moving[i] = Jet<1>(state.joints[i]);
  const auto n = static_cast<std::size_t>(jogging.joint);
  moving[n] = Jet<1>::variable(state.joints[n]);
  return set_up_speed(machine, limits, moving, tool_length_mm);
}

}  // namespace meridian::interpolator
