// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/state_table.hpp"
#include "meridian/path/path_piece.hpp"

/// Probing: a program that is started with kStartProbing moves until the drives report contact of
/// the probe, latches where they were, and comes to rest on its path. Contact in any other motion
/// is an alarm. A machine whose drives report no probe knows nothing of it.
/// RT: cycle. Proof: tests/unit/cycle/probing_test.cpp.
namespace meridian {

/// The argument of `start` that makes the program a probing move.
inline constexpr double kStartProbing = 2;

/// The probe must have been free for so long, s, before its contact is an alarm: a stylus that
/// leaves the surface may bounce.
inline constexpr double kProbeFree_s = 0.02;

/// A motion that begins in contact leaves it within so much of its largest joint, a rotary one at
/// kAxisLength_mm_per_rad; beyond, it leads into what it touches.
inline constexpr double kLeaveContact_mm = 5;

/// At the end of a probing move the drives may lag behind its last setpoint: they are waited for
/// until they are so near to it, or for so long.
inline constexpr double kProbeSettled_mm = 1e-3, kProbeSettle_s = 0.25;

/// What a report of the probe means for the motion.
enum class ProbeNews : std::uint8_t {
  kNone,
  kFound,  ///< the contact that is sought
  kTouch,  ///< contact in a motion that seeks none
  kLost    ///< the probe that seeks contact is connected no more
};

/// Whether joints move by setpoints. Drives that are homing move by themselves, at velocity 0.
[[nodiscard]] inline bool is_in_motion(const Cycle& c) noexcept {
  if (!is_on_path(c.state.state)) return false;
  return std::any_of(c.state.velocity.begin(), c.state.velocity.end(),
                     [](double velocity) { return velocity != 0; });
}

/// Periods between the newest report without contact and this one, by the setpoints that the
/// drives took, this cycle's own count, and the arrivals: the largest.
[[nodiscard]] inline std::uint64_t periods_of_contact(const Cycle& c) noexcept {
  const Probing& probing = c.state.probing;
  const auto own = static_cast<std::int64_t>(c.in.cycle - probing.free_cycle);
  const auto seen = static_cast<std::int64_t>(c.drives.cycle_seen - probing.free_seen);
  const std::int64_t between_ns = c.drives.arrival_ns - probing.free_arrival_ns;
  const std::int64_t arrived = (between_ns + c.machine.cycle_ns / 2) / c.machine.cycle_ns;
  return static_cast<std::uint64_t>(std::max({own, seen, arrived}));
}

/// Keeps a report without contact while one is sought: the other end of the interval that holds it.
inline void keep_free_report(const Cycle& c) noexcept {
  Probing& probing = c.state.probing;
  probing.free_joints = c.feedback;
  probing.free_cycle = c.in.cycle;
  probing.free_seen = c.drives.cycle_seen;
  probing.free_arrival_ns = c.drives.arrival_ns;
}

/// Reports the contact: where the joints were in the report before it and in its own.
inline void report_contact(const Cycle& c) noexcept {
  for (int i = 0; i < c.machine.joint_count; ++i) {
    const auto joint = static_cast<std::size_t>(i);
    emit(c, EventCode::kContactJoint, joint, 1, c.state.probing.free_joints[joint]);
    emit(c, EventCode::kContactJoint, joint, 0, c.feedback[joint]);
  }
  emit(c, EventCode::kContactFound, periods_of_contact(c), 0, c.state.stop.is_active() ? 1 : 0);
}

/// Begins to seek contact, or not: the program that starts is a probing move, or is none.
inline void begin_probing(const Cycle& c, bool is_probing) noexcept {
  c.state.probing.state = is_probing ? ProbeState::kSeeking : ProbeState::kOff;
  keep_free_report(c);
}

/// The largest of the amounts of `value`, by joint, in mm.
[[nodiscard]] inline double largest_joint_mm(const Cycle& c, const JointVector& value) noexcept {
  double largest = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.machine.joint_count); ++i) {
    const double mm = c.machine.joints[i].is_rotary ? kAxisLength_mm_per_rad : 1.0;
    largest = std::max(largest, mm * std::abs(value[i]));
  }
  return largest;
}

/// Whether contact in a motion that seeks none is new, or the motion leads farther into it.
[[nodiscard]] inline ProbeNews see_contact(Cycle& c, double free_time) noexcept {
  Probing& probing = c.state.probing;
  if (probing.state == ProbeState::kFound || !is_in_motion(c)) return ProbeNews::kNone;
  probing.contact_travel_mm += largest_joint_mm(c, c.state.velocity) * c.dt * c.periods;
  const bool is_new = free_time >= kProbeFree_s;
  if (!is_new && probing.contact_travel_mm <= kLeaveContact_mm) return ProbeNews::kNone;
  probing.contact_travel_mm = 0;
  return ProbeNews::kTouch;
}

/// Whether drives that reported `feedback` still come up to the last setpoint.
[[nodiscard]] inline bool is_lagging(const Cycle& c, const JointVector& feedback) noexcept {
  JointVector left{};
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = c.state.joints[i] - feedback[i];
  return largest_joint_mm(c, left) > kProbeSettled_mm;
}

/// Whether a probing move that is at its end may have contact yet: drives that lag are not there.
[[nodiscard]] inline bool may_touch_yet(const Cycle& c) noexcept {
  return c.state.probing.state == ProbeState::kSeeking && c.state.barrier_time <= kProbeSettle_s &&
         is_lagging(c, c.feedback);
}

/// Takes the newest report of the probe. It is called where a probe is connected or sought.
[[nodiscard]] inline ProbeNews see_probe(Cycle& c) noexcept {
  Probing& probing = c.state.probing;
  const bool is_sought = probing.state == ProbeState::kSeeking;
  const bool is_in_contact = c.drives.probe == ProbeInput::kContact;
  const double free_time = probing.free_time;
  probing.free_time = is_in_contact ? 0 : free_time + c.dt * c.periods;
  const bool is_lost = is_sought && c.drives.probe == ProbeInput::kNone;
  if (is_lost) return is_in_motion(c) ? ProbeNews::kLost : ProbeNews::kNone;
  if (!is_in_contact) {
    probing.contact_travel_mm = 0;
    if (is_sought) keep_free_report(c);
    return ProbeNews::kNone;
  }
  if (!is_sought) return see_contact(c, free_time);
  // At rest it is a hand that touches the stylus.
  if (!is_in_motion(c) && !is_lagging(c, probing.free_joints)) return ProbeNews::kNone;
  report_contact(c);
  probing.state = ProbeState::kFound;
  return ProbeNews::kFound;
}

/// The program is at its end: one that still seeks contact says that there was none.
inline void end_probing(const Cycle& c) noexcept {
  const bool is_sought = c.state.probing.state == ProbeState::kSeeking;
  c.state.probing.state = ProbeState::kOff;
  if (is_sought) emit(c, EventCode::kAlarm, static_cast<std::uint64_t>(Alarm::kNoContact));
}

}  // namespace meridian
