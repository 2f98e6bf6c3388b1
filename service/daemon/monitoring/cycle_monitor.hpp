// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/joint_masks.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "meridian/monitoring/monitor.hpp"

/// Where the monitoring meets the cycle: plain values go in, an alarm comes out.
namespace meridian::interpolator {

/// What a state means for the monitoring. In a dry run drives are off.
[[nodiscard]] constexpr monitoring::Motion motion_of(State state, bool is_dry_run) noexcept {
  using monitoring::Motion;
  if (is_dry_run) return Motion::kOff;
  switch (state) {
    case State::kOff:
    case State::kEnabling:
    case State::kDisabling:
    case State::kFault:
      return Motion::kOff;
    case State::kReady:
    case State::kLoaded:
    case State::kHeld:
    case State::kStepping:
    case State::kStarved:
      return Motion::kRest;
    case State::kHoming:
      return Motion::kHoming;
    case State::kJogging:
      return Motion::kHand;
    case State::kApproaching:
    case State::kRunning:
    case State::kHolding:
    case State::kStarving:
    case State::kAborting:
    case State::kFaultStop:
      return Motion::kProgram;
  }
  return Motion::kOff;
}

/// The alarm of a finding; each has its own.
[[nodiscard]] constexpr Alarm alarm_of(monitoring::Finding finding) noexcept {
  using monitoring::Finding;
  switch (finding) {
    case Finding::kNone:
      return Alarm::kNone;
    case Finding::kStandstill:
      return Alarm::kStandstill;
    case Finding::kAxisSpeed:
      return Alarm::kJointSpeed;
    case Finding::kTipSpeed:
      return Alarm::kTipSpeed;
    case Finding::kPositionWindow:
      return Alarm::kPositionWindow;
    case Finding::kDriveModel:
      return Alarm::kDriveModel;
    case Finding::kJump:
      return Alarm::kFeedbackJump;
    case Finding::kFrozen:
      return Alarm::kFeedbackFrozen;
    case Finding::kTooFast:
      return Alarm::kFeedbackTooFast;
  }
  return Alarm::kNone;
}

/// Feeds the monitoring beside step(), once a cycle and ahead of it.
/// RT: cycle. Proof: tests/unit/daemon/monitoring_phases_test.cpp.
class CycleMonitor {
 public:
  explicit CycleMonitor(const monitoring::Limits& limits) noexcept : monitor_(limits) {}

  /// `next`: what step() is about to get; `last`: what it gave last.
  [[nodiscard]] MonitoringAlarm check(const MachineModel& machine, const CycleInputs& next,
                                      const CycleRecord& last, bool is_dry_run) noexcept {
    fill(machine, next, last, is_dry_run);
    const monitoring::Result result = monitor_.check(in_);
    return {alarm_of(result.finding), result.axis, result.value};
  }
  [[nodiscard]] const monitoring::Monitor& monitor() const noexcept { return monitor_; }

 private:
  /// Reports older than this say nothing; that they are lost is the cycle's to find.
  static constexpr std::int64_t kOld_ns = 200'000'000;

  void fill(const MachineModel& machine, const CycleInputs& next, const CycleRecord& last,
            bool is_dry_run) noexcept {
    const Feedback& f = next.feedback;
    const std::uint32_t all = all_joints(machine);
    in_.motion = motion_of(last.state, is_dry_run);
    in_.is_guard_open = f.is_guard_open;
    in_.periods = 1 + static_cast<int>(next.lost_periods);
    in_.cycle = last.setpoint.cycle;
    in_.commanded = last.joints;
    in_.cycle_seen = f.cycle_seen;
    in_.arrival_ns = f.arrival_ns;
    in_.known_mask = f.referenced_mask;
    in_.measured = has_stage(machine) ? joints_of(machine, f.position) : f.position;
    in_.has_report = f.arrival_ns != 0 && (f.joint_mask & all) == all &&
                     next.now_ns - f.arrival_ns <= kOld_ns && are_finite(machine, in_.measured);
    if (f.is_guard_open) in_.tip = tip_over_base(machine, next.tool_length_mm, in_.measured);
  }
  [[nodiscard]] static bool are_finite(const MachineModel& machine, const JointVector& q) noexcept {
    for (std::size_t i = 0; i < static_cast<std::size_t>(machine.joint_count); ++i) {
      if (!std::isfinite(q[i])) return false;
    }
    return true;
  }

  monitoring::Monitor monitor_;
  monitoring::Inputs in_;
};

}  // namespace meridian::interpolator
