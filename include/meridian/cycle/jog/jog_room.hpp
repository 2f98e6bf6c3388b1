// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "meridian/cycle/jog/jog_law.hpp"
#include "meridian/cycle/joint_masks.hpp"
#include "meridian/geometry/jet.hpp"
#include "meridian/kinematics/keep_out.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "meridian/kinematics/tip_over_base.hpp"

/// What one joint may do while the others stand still: as far as its travel and that of the drives
/// of a stage reach, as fast as both may go. Units: mm or rad, s. RT: cycle.
/// Proof: tests/unit/cycle/jogging_test.cpp.
namespace meridian {

/// Share of every limit that a jog uses; the rest is for rounding.
inline constexpr double kJogShare = 0.99;
/// A joint without a reference has no travel to stop at: it goes at most at this share of its
/// velocity.
inline constexpr double kUnreferencedShare = 0.1;

/// A joint at rest, ready to be jogged, and what a FaultStop may use.
struct JogRoom {
  JogAxis axis;
  JogRates fault;
};

namespace jog {

/// Largest amounts of a drive's derivatives by the joint.
struct Slopes {
  double first = 0, second = 0, third = 0;
};

/// Lessens `rates` so that a drive with `slopes` keeps the limits too. Its acceleration is
/// u' a + u'' v², its jerk u' j + 3 u'' v a + u''' v³: halves and quarters of them are given out.
inline void keep_drive(JogRates& rates, const Slopes& slopes, double velocity, double acceleration,
                       double jerk) noexcept {
  const auto cap = [](double& value, double limit, double slope) {
    if (slope > 0) value = std::min(value, limit / slope);
  };
  cap(rates.velocity, velocity, slopes.first);
  if (slopes.second > 0) {
    rates.velocity = std::min(rates.velocity, std::sqrt(0.5 * acceleration / slopes.second));
  }
  if (slopes.third > 0) {
    rates.velocity = std::min(rates.velocity, std::cbrt(0.25 * jerk / slopes.third));
  }
  const bool is_bent = slopes.second > 0 || slopes.third > 0;
  cap(rates.acceleration, is_bent ? 0.5 * acceleration : acceleration, slopes.first);
  cap(rates.acceleration, 0.25 * jerk, 3 * slopes.second * rates.velocity);
  cap(rates.jerk, is_bent ? 0.5 * jerk : jerk, slopes.first);
}

/// Whether the stage's drives are in their travel where `joint` is at `q`, or no farther out of it
/// than they are in `joints`.
[[nodiscard]] inline bool are_drives_inside(const MachineModel& machine, JointVector joints,
                                            int joint, double q) noexcept {
  const double phi = std::abs(stage::carriage_of(machine.stage, joints).phi);
  const LimitedVector now = limited_of(machine, joints);
  joints[static_cast<std::size_t>(joint)] = q;
  const LimitedVector then = limited_of(machine, joints);
  const double phi_then = std::abs(stage::carriage_of(machine.stage, joints).phi);
  if (!(phi_then <= std::max(phi, machine.stage.phi_max_rad))) return false;
  for (int i = machine.joint_count; i < limited_count(machine); ++i) {
    const auto n = static_cast<std::size_t>(i);
    const JointLimits& limits = limited_spec(machine, i).limits;
    const bool is_inside = then[n] >= std::min(limits.travel_min, now[n]) &&
                           then[n] <= std::max(limits.travel_max, now[n]);
    if (!is_inside) return false;
  }
  return true;
}

/// The farthest point between where the joint is and `end` where the drives are inside.
[[nodiscard]] inline double reach_of_drives(const MachineModel& machine, const JointVector& joints,
                                            int joint, double end) noexcept {
  if (are_drives_inside(machine, joints, joint, end)) return end;
  double inside = joints[static_cast<std::size_t>(joint)], outside = end;
  for (int n = 0; n < 52; ++n) {
    const double middle = 0.5 * (inside + outside);
    (are_drives_inside(machine, joints, joint, middle) ? inside : outside) = middle;
  }
  return inside;
}

/// Narrows the room of a joint whose motion moves the drives of the stage.
[[gnu::noinline]] inline void narrow_for_stage(const MachineModel& machine,
                                               const JointVector& joints, int joint,
                                               JogRoom& room) noexcept {
  constexpr int kSamples = 32;
  constexpr double kBetweenSamples = 1.1;
  const auto n = static_cast<std::size_t>(joint);
  JogAxis& axis = room.axis;
  axis.low = reach_of_drives(machine, joints, joint, axis.low);
  axis.high = reach_of_drives(machine, joints, joint, axis.high);
  const double low = std::min(axis.low, joints[n]), high = std::max(axis.high, joints[n]);
  std::array<Slopes, kStageDrives> slopes{};
  for (int sample = 0; sample <= kSamples; ++sample) {
    Joints<Jet<3>> moving;
    for (std::size_t i = 0; i < moving.size(); ++i) moving[i] = Jet<3>(joints[i]);
    moving[n] = Jet<3>::variable(low + (high - low) * sample / kSamples);
    const Limited<Jet<3>> all = limited_of(machine, moving);
    for (std::size_t k = 0; k < slopes.size(); ++k) {
      const Jet<3>& u = all[static_cast<std::size_t>(machine.joint_count) + k];
      const auto raise = [](double& max, double value) {
        max = std::max(max, kBetweenSamples * std::abs(value));
      };
      raise(slopes[k].first, u.derivative(1));
      raise(slopes[k].second, u.derivative(2));
      raise(slopes[k].third, u.derivative(3));
    }
  }
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    const JointLimits& limits = machine.stage_drives[k].limits;
    keep_drive(axis.rates, slopes[k], kJogShare * limits.velocity, kJogShare * limits.acceleration,
               kJogShare * limits.jerk);
    keep_drive(room.fault, slopes[k], kJogShare * limits.velocity,
               kJogShare * limits.fault_acceleration, kJogShare * limits.fault_jerk);
  }
}

/// Narrows the room of a joint to what the tip box leaves, where it is known where the tip is.
[[gnu::noinline]] inline void narrow_for_tip(const MachineModel& machine, double tool_length_mm,
                                             const JointVector& joints, int joint,
                                             std::uint32_t referenced_mask,
                                             JogAxis& axis) noexcept {
  const std::uint32_t all = tip_joints(machine);
  const bool moves_tip = (all >> static_cast<unsigned>(joint) & 1U) != 0;
  if (!moves_tip || (referenced_mask & all) != all) return;
  const std::array<TipCircle, 3> tip = tip_circles(machine, tool_length_mm, joints, joint);
  for (std::size_t i = 0; i < tip.size(); ++i) {
    narrow_inside(machine.tip_box, i, tip[i], axis.at.q, axis.low, axis.high);
  }
}

}  // namespace jog

/// Returns the room of `joint` from `joints`, everything at rest, those of `referenced_mask` with a
/// reference, a tool of that length in the spindle. Without a reference it has no ends; a joint
/// that a stage carries needs one (may_jog()).
[[nodiscard]] inline JogRoom jog_room(const MachineModel& machine, double tool_length_mm,
                                      const JointVector& joints, int joint,
                                      std::uint32_t referenced_mask) noexcept {
  const JointSpec& spec = machine.joints[static_cast<std::size_t>(joint)];
  const JointLimits& limits = spec.limits;
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  const bool is_referenced = (referenced_mask >> static_cast<unsigned>(joint) & 1U) != 0;
  const bool has_ends = is_referenced && !spec.is_endless;
  JogRoom room;
  room.axis.at.q = joints[static_cast<std::size_t>(joint)];
  room.axis.low = has_ends ? limits.travel_min : -kEndless;
  room.axis.high = has_ends ? limits.travel_max : kEndless;
  if (has_ends) {
    narrow_outside(machine.keep_out, joints, joint, referenced_mask, room.axis.low, room.axis.high);
  }
  if (machine.tip_box.is_set) {
    jog::narrow_for_tip(machine, tool_length_mm, joints, joint, referenced_mask, room.axis);
  }
  const double share = is_referenced ? kJogShare : kUnreferencedShare;
  room.axis.rates = {share * limits.velocity, kJogShare * limits.acceleration,
                     kJogShare * limits.jerk};
  room.fault = {room.axis.rates.velocity, kJogShare * limits.fault_acceleration,
                kJogShare * limits.fault_jerk};
  if (is_on_stage(machine, joint)) jog::narrow_for_stage(machine, joints, joint, room);
  return room;
}

/// Whether `joint` (from kMaxJoints on: a ToolAxis) is one that may be jogged: the tool with all
/// references, a stage's drives with both of theirs.
[[nodiscard]] inline bool may_jog(const MachineModel& machine, int joint,
                                  std::uint32_t referenced_mask) noexcept {
  const std::uint32_t all = all_joints(machine), pair = stage_pair(machine);
  if (joint >= kMaxJoints) return (referenced_mask & all) == all;
  if (joint < 0 || joint >= machine.joint_count) return false;
  return !is_on_stage(machine, joint) || (referenced_mask & pair) == pair;
}

}  // namespace meridian
