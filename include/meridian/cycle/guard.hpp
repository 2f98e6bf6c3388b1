// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/kinematics/keep_out.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tip_over_base.hpp"

namespace meridian {

/// What is wrong with a setpoint; kNone: it may be sent.
struct GuardVerdict {
  Alarm alarm = Alarm::kNone;
  int joint = 0;     ///< place in limited.hpp; kTipBox: axis of the base, 0 X, 1 Y, 2 Z
  double value = 0;  ///< the offending position or step; kKeepOut: the number of the box from 0
};

inline constexpr double kGuardTravel =
    1e-9;  ///< mm or rad; rounding of a pose on the travel's edge
inline constexpr double kGuardOutside =
    1e-11;  ///< mm or rad; rounding of a joint that comes to rest, 100 ulp of a metre
inline constexpr double kGuardKeepOut = 2 * kKeepOutRounding;  ///< what planners leave, and a solve
inline constexpr double kGuardTip = 1e-8;   ///< mm; what planners leave, and a solve
inline constexpr double kGuardStep = 1e-9;  ///< mm or rad; rounding of one solve, 1000x margin

/// Whether `q` is in travel, or no farther out of it than `previous`: whoever stands outside may
/// come back, and stand.
[[nodiscard]] inline bool is_in_travel(const JointLimits& limits, double q,
                                       double previous) noexcept {
  return q >= std::min(limits.travel_min - kGuardTravel, previous - kGuardOutside) &&
         q <= std::max(limits.travel_max + kGuardTravel, previous + kGuardOutside);
}

/// Whether joints enter a keep-out box at `next` or on the straight way there from `previous`, each
/// box less what a motion within its limits bends off that way. Whoever stands inside may come out,
/// and stand, but goes no deeper. Boxes of joints without travel (`has_travel`) say nothing.
[[nodiscard]] inline GuardVerdict check_keep_out(const MachineModel& machine,
                                                 const JointVector& next,
                                                 const JointVector& previous, double elapsed,
                                                 std::uint32_t has_travel) noexcept {
  JointVector off{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(machine.joint_count); ++i) {
    off[i] = -(machine.joints[i].limits.fault_acceleration * elapsed * elapsed / 8 + kGuardKeepOut);
  }
  const auto boxes = machine.keep_out.boxes();
  for (std::size_t n = 0; n < boxes.size(); ++n) {
    const KeepOutBox& box = boxes[n];
    if ((box.joints & has_travel) != box.joints) continue;
    const double before = depth_inside(box, previous), depth = depth_inside(box, next);
    const bool is_inside = before > kGuardKeepOut;
    const bool enters = is_inside
                            ? depth > before + kGuardOutside
                            : depth > kGuardKeepOut || entry_share(box, previous, next, off) <= 1;
    if (enters) return {Alarm::kKeepOut, std::countr_zero(box.joints), static_cast<double>(n)};
  }
  return {};
}

/// Whether the tip of a tool of that length leaves its box at `next`. Whoever is outside may come
/// in, and stand, but goes no farther out. Says nothing where a joint that moves the tip has no
/// travel (`has_travel`). Proof: tests/unit/cycle/guard_test.cpp.
[[nodiscard]] inline GuardVerdict check_tip_box(const MachineModel& machine, double tool_length_mm,
                                                const JointVector& next,
                                                const JointVector& previous,
                                                std::uint32_t has_travel = ~0U) noexcept {
  const std::uint32_t joints = tip_joints(machine);
  if ((joints & has_travel) != joints) return {};
  const Array3 tip = tip_over_base(machine, tool_length_mm, next);
  const int axis = axis_leaving(machine.tip_box, tip,
                                tip_over_base(machine, tool_length_mm, previous), kGuardTip);
  if (axis < 0) return {};
  return {Alarm::kTipBox, axis, tip[static_cast<std::size_t>(axis)]};
}

/// The drives of a stage, checked like joints; without `has_travel` not for their travel.
[[nodiscard]] inline GuardVerdict check_stage(const MachineModel& machine, const JointVector& next,
                                              const JointVector& previous, double elapsed,
                                              bool has_travel) noexcept {
  const LimitedVector now = limited_of(machine, next), before = limited_of(machine, previous);
  for (int i = machine.joint_count; i < limited_count(machine); ++i) {
    const auto n = static_cast<std::size_t>(i);
    const JointLimits& limits = limited_spec(machine, i).limits;
    const double u = now[n], step = u - before[n];
    if (!std::isfinite(u)) return {Alarm::kNotFinite, i, u};
    if (has_travel && !is_in_travel(limits, u, before[n])) return {Alarm::kTravel, i, u};
    if (!(std::abs(step) <= limits.velocity * elapsed + kGuardStep)) return {Alarm::kStep, i, step};
  }
  return {};
}

/// What few machines have: a stage, and keep-out boxes.
[[nodiscard, gnu::noinline]] inline GuardVerdict check_beyond_joints(
    const MachineModel& machine, const JointVector& next, const JointVector& previous,
    double elapsed, std::uint32_t has_travel) noexcept {
  const GuardVerdict verdict = machine.keep_out.empty()
                                   ? GuardVerdict{}
                                   : check_keep_out(machine, next, previous, elapsed, has_travel);
  if (verdict.alarm != Alarm::kNone || !has_stage(machine)) return verdict;
  return check_stage(machine, next, previous, elapsed, has_travel != 0);
}

/// Checks the next joint setpoint, the last thing before it is sent: finite, inside travel (for the
/// joints of `has_travel`; where there are none, the drives of a stage have none either), outside
/// of every keep-out box, and no farther from `previous` (sent `elapsed` seconds ago) than the
/// velocity limits of joints and drives reach. RT: cycle. Proof: tests/unit/cycle/guard_test.cpp,
/// stage_cycle_test.cpp.
[[nodiscard]] inline GuardVerdict check(const MachineModel& machine, const JointVector& next,
                                        const JointVector& velocity, const JointVector& previous,
                                        double elapsed, std::uint32_t has_travel = ~0U) noexcept {
  for (int i = 0; i < machine.joint_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const JointSpec& joint = machine.joints[n];
    const double q = next[n], step = q - previous[n];
    if (!std::isfinite(q) || !std::isfinite(velocity[n])) return {Alarm::kNotFinite, i, q};
    const bool is_checked = !joint.is_endless && (has_travel >> n & 1U) != 0;
    if (is_checked && !is_in_travel(joint.limits, q, previous[n])) return {Alarm::kTravel, i, q};
    if (!(std::abs(step) <= joint.limits.velocity * elapsed + kGuardStep)) {
      return {Alarm::kStep, i, step};
    }
  }
  const bool has_more = has_stage(machine) || !machine.keep_out.empty();
  return has_more ? check_beyond_joints(machine, next, previous, elapsed, has_travel)
                  : GuardVerdict{};
}

}  // namespace meridian
