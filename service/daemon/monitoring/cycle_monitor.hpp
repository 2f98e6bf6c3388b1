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

/// What a state means for the monitoring; `is_homing`: a drive is in homing mode, which may also be
/// brought to its end by an abort or a FaultStop. In a dry run drives are off.
[[nodiscard]] constexpr monitoring::Motion motion_of(State state, bool is_dry_run,
                                                     bool is_homing) noexcept {
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
      return Motion::kJog;
    case State::kApproaching:
    case State::kRunning:
    case State::kHolding:
    case State::kStarving:
      return Motion::kProgram;
    case State::kAborting:
    case State::kFaultStop:
      return is_homing ? Motion::kHoming : Motion::kProgram;
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
    case Finding::kDriveTooFast:
    case Finding::kAxisTooFast:
      return Alarm::kFeedbackTooFast;
  }
  return Alarm::kNone;
}

/// Feeds the monitoring beside step(), once a cycle and ahead of it.
/// RT: cycle. Proof: tests/unit/daemon/monitoring_phases_test.cpp.
class CycleMonitor {
 public:
  /// `timeout_s`: reports older than it say nothing; that they are lost is the cycle's to find.
  CycleMonitor(const monitoring::Limits& limits, double timeout_s) noexcept
      : timeout_ns_(std::llround(timeout_s * 1e9)), monitor_(limits) {}

  /// `next`: what step() is about to get; `last`: what it gave last; `homing_mask`: drives that it
  /// asks to home.
  [[nodiscard]] MonitoringAlarm check(const MachineModel& machine, const CycleInputs& next,
                                      const CycleRecord& last, bool is_dry_run,
                                      std::uint32_t homing_mask) noexcept {
    const std::uint32_t homing = homing_mask | next.feedback.homing_mask;
    in_.motion = motion_of(last.state, is_dry_run, (homing & all_joints(machine)) != 0);
    fill(machine, next, last);
    const monitoring::Result result = monitor_.check(in_);
    return {alarm_of(result.finding), number_of(machine, result), result.value};
  }
  [[nodiscard]] const monitoring::Monitor& monitor() const noexcept { return monitor_; }

 private:
  /// As alarms count: the joint, or behind the joints the drive of a stage.
  [[nodiscard]] static int number_of(const MachineModel& machine,
                                     const monitoring::Result& result) noexcept {
    if (!has_stage(machine) || !monitoring::is_of_drive(result.finding)) return result.axis;
    if (result.axis == machine.stage.linear_joint) return machine.joint_count;
    if (result.axis == machine.stage.rotary_joint) return machine.joint_count + 1;
    return result.axis;
  }
  void fill(const MachineModel& machine, const CycleInputs& next,
            const CycleRecord& last) noexcept {
    const Feedback& f = next.feedback;
    const std::uint32_t all = all_joints(machine);
    in_.is_guard_open = f.is_guard_open;
    in_.periods = 1 + static_cast<int>(next.lost_periods);
    in_.cycle = last.setpoint.cycle;
    in_.commanded = last.setpoint.position;
    in_.known_mask = f.referenced_mask;
    in_.arrival_ns = f.joint_arrival_ns;
    in_.cycle_seen = f.joint_cycle_seen;
    in_.reported = f.position;
    if (has_stage(machine)) {  // a joint depends on several drives: it is as old as the oldest
      in_.measured = joints_of(machine, f.position);
      in_.arrival_ns.fill(f.arrival_ns);
      in_.cycle_seen.fill(f.cycle_seen);
    } else {
      in_.measured = f.position;
    }
    in_.has_report =
        (f.joint_mask & all) == all && are_new(machine, next) && are_finite(machine, in_.measured);
    if (f.is_guard_open && in_.has_report) follow_tip(machine, next.tool_length_mm);
  }
  /// The tip of the measured joints; another tool is no motion of it.
  void follow_tip(const MachineModel& machine, double tool_length_mm) noexcept {
    const Array3 tip = tip_over_base(machine, tool_length_mm, in_.measured);
    if (tool_length_mm != tool_length_mm_) {
      const Array3 before = tip_over_base(machine, tool_length_mm_, in_.measured);
      for (std::size_t i = 0; i < tip.size(); ++i) tip_offset_[i] += before[i] - tip[i];
      tool_length_mm_ = tool_length_mm;
    }
    for (std::size_t i = 0; i < tip.size(); ++i) in_.tip[i] = tip[i] + tip_offset_[i];
  }
  /// Time that the host stalled does not count against the drives.
  [[nodiscard]] bool are_new(const MachineModel& machine, const CycleInputs& next) const noexcept {
    const std::int64_t allowed_ns = timeout_ns_ + next.lost_periods * machine.cycle_ns;
    for (std::size_t i = 0; i < static_cast<std::size_t>(machine.joint_count); ++i) {
      const std::int64_t arrival_ns = in_.arrival_ns[i];
      if (arrival_ns == 0 || next.now_ns - arrival_ns > allowed_ns) return false;
    }
    return true;
  }
  [[nodiscard]] static bool are_finite(const MachineModel& machine, const JointVector& q) noexcept {
    for (std::size_t i = 0; i < static_cast<std::size_t>(machine.joint_count); ++i) {
      if (!std::isfinite(q[i])) return false;
    }
    return true;
  }

  std::int64_t timeout_ns_;
  double tool_length_mm_ = 0;  ///< that in_.tip is of
  Array3 tip_offset_{};        ///< between that tip and the one that is followed, tools changing
  monitoring::Monitor monitor_;
  monitoring::Inputs in_;
};

}  // namespace meridian::interpolator
