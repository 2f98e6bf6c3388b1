// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/state_table.hpp"

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

/// What a report of the probe means for the motion.
enum class ProbeNews : std::uint8_t {
  kNone,
  kFound,  ///< the contact that is sought
  kTouch,  ///< contact in a motion that seeks none
  kLost    ///< the probe that seeks contact is connected no more
};

/// Whether joints move by setpoints: those of drives that are homing are their feedback.
[[nodiscard]] inline bool is_in_motion(const Cycle& c) noexcept {
  if (!is_on_path(c.state.state) || c.state.homing.is_active) return false;
  return std::any_of(c.state.velocity.begin(), c.state.velocity.end(),
                     [](double velocity) { return velocity != 0; });
}

/// Periods between the newest report without contact and this one, by all that tells: the
/// setpoints that the drives took, this cycle's own count, and the arrivals.
[[nodiscard]] inline std::uint64_t periods_of_contact(const Cycle& c) noexcept {
  const Probing& probing = c.state.probing;
  const std::uint64_t own = c.in.cycle - probing.free_cycle;
  const std::uint64_t seen =
      c.drives.cycle_seen > probing.free_seen ? c.drives.cycle_seen - probing.free_seen : 0;
  const std::int64_t between_ns = c.drives.arrival_ns - probing.free_arrival_ns;
  const std::int64_t arrived = (between_ns + c.machine.cycle_ns / 2) / c.machine.cycle_ns;
  return std::max({own, seen, static_cast<std::uint64_t>(std::max<std::int64_t>(arrived, 1))});
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
    tell(c, EventCode::kContactJoint, joint, 1, c.state.probing.free_joints[joint]);
    tell(c, EventCode::kContactJoint, joint, 0, c.feedback[joint]);
  }
  tell(c, EventCode::kContactFound, periods_of_contact(c));
}

/// Begins to seek contact, or not: the program that starts is a probing move, or is none.
inline void begin_probing(const Cycle& c, bool is_probing) noexcept {
  c.state.probing.state = is_probing ? ProbeState::kSeeking : ProbeState::kOff;
  keep_free_report(c);
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
    if (is_sought) keep_free_report(c);
    return ProbeNews::kNone;
  }
  if (!is_in_motion(c)) return ProbeNews::kNone;
  if (is_sought) {
    report_contact(c);
    probing.state = ProbeState::kFound;
    return ProbeNews::kFound;
  }
  const bool is_edge = free_time >= kProbeFree_s && probing.state == ProbeState::kOff;
  return is_edge ? ProbeNews::kTouch : ProbeNews::kNone;
}

/// The program is at its end: one that still seeks contact says that there was none.
inline void end_probing(const Cycle& c) noexcept {
  const bool is_sought = c.state.probing.state == ProbeState::kSeeking;
  c.state.probing.state = ProbeState::kOff;
  if (is_sought) tell(c, EventCode::kAlarm, static_cast<std::uint64_t>(Alarm::kNoContact));
}

}  // namespace meridian
