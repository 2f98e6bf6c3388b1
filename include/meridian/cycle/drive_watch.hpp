// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/joint_masks.hpp"
#include "meridian/cycle/obey.hpp"
#include "meridian/cycle/supervise.hpp"
#include "meridian/kinematics/limited.hpp"

/// Watches drives that are to be off: in Off, Disabling and Fault nobody enables or moves them but
/// somebody else. RT: cycle. Proof: tests/unit/cycle/drive_watch_test.cpp.
namespace meridian {

/// Drives have so long to go off, brakes to close and axes to settle on them.
inline constexpr double kOffGrace_s = 0.5;
/// Two windows in a row must show the same: one report that is off, or drives that were started
/// anew somewhere else, is no motion.
inline constexpr double kWatchWindow_s = 0.05;
/// Motion is more than this in each of two windows, one way: 0.2 mm/s or 0.1 deg/s. Encoders at
/// rest change by micrometres, or counts of 5e-5 rad (17 bit), and back; brakes sag within the
/// grace.
inline constexpr double kWatchMoved_mm = 0.01, kWatchMoved_rad = 1e-4;

/// The first drive that moved in both windows, one way; -1: none.
[[nodiscard]] inline int first_drive_moving(const Cycle& c, const JointVector& moved,
                                            const JointVector& before) noexcept {
  for (int i = 0; i < c.machine.joint_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const double min = drive_spec(c.machine, i).is_rotary ? kWatchMoved_rad : kWatchMoved_mm;
    const bool is_far = std::abs(moved[n]) > min && std::abs(before[n]) > min;
    if (is_far && (moved[n] > 0) == (before[n] > 0)) return i;
  }
  return -1;
}

/// A window is over: what it says of the drives.
[[gnu::noinline]] inline void end_watch_window(Cycle& c) noexcept {
  DriveWatch& watch = c.state.watch;
  const Feedback& f = c.in.feedback;
  const std::uint32_t enabled = f.enabled_mask & watch.enabled_mask & all_joints(c.machine);
  JointVector moved{};
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = f.position[i] - watch.position[i];
  const int moving = watch.has_moved ? first_drive_moving(c, moved, watch.moved) : -1;
  watch.is_astray = moving >= 0 || enabled != 0;
  watch.moved = moved;
  watch.has_moved = true;
  watch.time = 0;
  if (!watch.is_astray) {
    c.state.alarms_reported &= ~(1U << static_cast<unsigned>(Alarm::kDrivesAstray));
    return;
  }
  const int joint = moving >= 0 ? moving : first_bit(enabled);
  report_alarm(c, Alarm::kDrivesAstray, joint, moved[static_cast<std::size_t>(joint)]);
  if (c.state.state == State::kFault) return;
  c.state.alarm = Alarm::kDrivesAstray;
  drop_program(c);
  enter(c, State::kFault);
}

/// In Off, Disabling and Fault: drives that report operation enabled, or move, are an alarm of
/// their own and lead to Fault, whose reset is refused while that lasts. Reports that are old say
/// nothing.
inline void watch_drives(Cycle& c) noexcept {
  DriveWatch& watch = c.state.watch;
  if (!is_feedback_there(c)) {
    watch = {};
    return;
  }
  if (c.state.state_time <= kOffGrace_s) {
    watch.time = 0;
    watch.has_moved = false;
    return;
  }
  if (watch.time == 0) {
    watch.position = c.in.feedback.position;
    watch.enabled_mask = c.in.feedback.enabled_mask;
  }
  watch.time += c.dt * c.periods;
  if (watch.time >= kWatchWindow_s) end_watch_window(c);
}

}  // namespace meridian
