// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/joint_masks.hpp"
#include "meridian/cycle/state_table.hpp"
#include "meridian/cycle/supervise.hpp"
#include "meridian/kinematics/limited.hpp"

/// Dry run: the machine runs as ever while its drives stay off. What they report is not asked for
/// but for the emergency input, and for a drive that is on; they would be where they were sent.
/// RT: cycle. Proof: tests/unit/cycle/dry_run_test.cpp.
namespace meridian {

/// Whether the emergency input is open, as far as somebody still says so. Who said it last and is
/// silent for kEmergencyHeard_s may be gone for good: no dry run waits for that, nor the way to
/// Off. Drives are enabled by what was reported last, however old.
[[nodiscard]] inline bool is_emergency_heard(const MachineModel& machine,
                                             const CycleInputs& in) noexcept {
  constexpr double kEmergencyHeard_s = 1.0;
  const Feedback& f = in.feedback;
  const double stalled = static_cast<double>(machine.cycle_ns) * 1e-9 * in.lost_periods;
  return f.emergency_stop && f.emergency_ns != 0 &&
         static_cast<double>(in.now_ns - f.emergency_ns) * 1e-9 <= kEmergencyHeard_s + stalled;
}

/// What drives would report that are where the last setpoint sent them.
[[nodiscard, gnu::noinline]] inline Feedback dry_feedback(const MachineModel& machine,
                                                          const CycleState& state,
                                                          const CycleInputs& in) noexcept {
  const std::uint32_t all = all_joints(machine);
  Feedback dry;
  dry.arrival_ns = in.now_ns;
  dry.cycle_seen = in.cycle - in.lost_periods - 1;
  dry.position =
      has_stage(machine) ? state.sent[dry.cycle_seen % kSentCycles].drive_position : state.joints;
  dry.joint_mask = dry.enabled_mask = dry.referenced_mask = all;
  dry.emergency_stop = is_emergency_heard(machine, in);
  return dry;
}

/// Whether a drive reports operation enabled, or did so last.
[[nodiscard]] inline bool is_drive_enabled(const Cycle& c) noexcept {
  return (c.in.feedback.enabled_mask & all_joints(c.machine)) != 0;
}

/// The joints are where the drives are, where all of them report and have their references, else at
/// home.
inline void stand_dry(Cycle& c) noexcept {
  const std::uint32_t all = all_joints(c.machine);
  if (is_feedback_there(c) && (c.drives.referenced_mask & all) == all) {
    return take_over_feedback(c);
  }
  JointVector home{};
  for (int i = 0; i < c.machine.joint_count; ++i) {
    home[static_cast<std::size_t>(i)] = drive_spec(c.machine, i).home;
  }
  c.state.joints = has_stage(c.machine) ? joints_of(c.machine, home) : home;
  c.state.latched_joints = c.state.joints;
  c.state.latched_drives = home;
}

}  // namespace meridian
