// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/guard.hpp"
#include "meridian/cycle/jog/homing.hpp"
#include "meridian/cycle/jog/jogging.hpp"
#include "meridian/cycle/jog/probing.hpp"
#include "meridian/cycle/joint_masks.hpp"
#include "meridian/cycle/state_table.hpp"
#include "meridian/cycle/stop/on_path.hpp"
#include "meridian/cycle/stop/stop_motion.hpp"

/// What makes the machine stop by itself: drives, feedback, emergency input, probe, lost periods.
/// RT: cycle.
namespace meridian {

/// Whether every drive reports a finite position, joints have them, and the report is fresh. Time
/// that the host stalled does not count against the drives.
[[nodiscard]] inline bool is_feedback_there(const Cycle& c) noexcept {
  const Feedback& f = c.drives;
  const double age = static_cast<double>(c.in.now_ns - f.arrival_ns) * 1e-9;
  for (const double q : c.feedback) {
    if (!std::isfinite(q)) return false;
  }
  return f.arrival_ns != 0 && (f.joint_mask & all_joints(c.machine)) == all_joints(c.machine) &&
         age <= c.state.options.feedback_timeout_s + c.dt * c.in.lost_periods;
}

/// Reports an alarm, once until the next reset.
inline void report_alarm(Cycle& c, Alarm alarm, int joint, double value) noexcept {
  const std::uint32_t bit = 1U << static_cast<unsigned>(alarm);
  if ((c.state.alarms_reported & bit) != 0) return;
  c.state.alarms_reported |= bit;
  emit(c, EventCode::kAlarm, static_cast<std::uint64_t>(alarm), static_cast<std::uint64_t>(joint),
       value);
}

/// Reports an alarm and enters FaultStop: on the path, or by commanding drives that are homing to
/// stop. A FaultStop that is going on continues.
inline void raise(Cycle& c, Alarm alarm, int joint = 0, double value = 0) noexcept {
  report_alarm(c, alarm, joint, value);
  if (c.state.state == State::kFaultStop) return;
  c.state.alarm = alarm;
  if (c.state.jogging.is_active()) {
    brake_jogging(c.state.jogging, true);
  } else if (c.state.homing.is_active()) {
    halt_homing(c.state.homing);
  } else {
    begin_stop(c, StopKind::kFault);
  }
  enter(c, State::kFaultStop);
}

/// Whether feedback is farther from the setpoint that it saw than the joint or drive `spec` may be,
/// and the way that drives bridged by its velocity.
[[nodiscard]] inline bool is_behind(const JointSpec& spec, double error, double velocity,
                                    double bridged) noexcept {
  return !(std::abs(error) <= spec.limits.following_error + std::abs(velocity) * bridged);
}

/// first_joint_behind() for the drives of a stage.
[[nodiscard, gnu::noinline]] inline int first_stage_drive_behind(const Cycle& c,
                                                                 const SentSetpoint& sent,
                                                                 double& error) noexcept {
  const LimitedVector seen = limited_of(c.machine, {}, c.drives.position);
  const LimitedVector position = limited_of(c.machine, {}, sent.drive_position);
  const LimitedVector velocity = limited_of(c.machine, {}, sent.drive_velocity);
  for (int i = c.machine.joint_count; i < limited_count(c.machine); ++i) {
    const auto n = static_cast<std::size_t>(i);
    error = seen[n] - position[n];
    if (is_behind(limited_spec(c.machine, i), error, velocity[n], sent.bridged)) return i;
  }
  return -1;
}

/// The joint, or drive of the stage, whose feedback is farther from the setpoint that it saw than
/// its limit; -1: none. Drives that are homing follow nothing.
[[nodiscard]] inline int first_joint_behind(const Cycle& c, double& error) noexcept {
  const Feedback& f = c.drives;
  const SentSetpoint& sent = c.state.sent[f.cycle_seen % kSentCycles];
  if (sent.cycle != f.cycle_seen || f.cycle_seen == 0) return -1;
  const std::uint32_t busy = c.state.homing.busy;
  for (int i = 0; i < c.machine.joint_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    if ((busy >> n & 1U) != 0) continue;
    error = c.feedback[n] - sent.position[n];
    if (is_behind(c.machine.joints[n], error, sent.velocity[n], sent.bridged)) return i;
  }
  return has_stage(c.machine) && busy == 0 ? first_stage_drive_behind(c, sent, error) : -1;
}

/// The first joint whose drive is missing in the feedback, or whose position is no number; where
/// there is none, the first of the group that has not reported for the longest.
[[nodiscard, gnu::noinline]] inline int first_silent_joint(const Cycle& c) noexcept {
  for (int i = 0; i < c.machine.joint_count; ++i) {
    const bool is_there = (c.drives.joint_mask >> static_cast<unsigned>(i) & 1U) != 0;
    if (!is_there || !std::isfinite(c.feedback[static_cast<std::size_t>(i)])) return i;
  }
  return c.drives.oldest_joint;
}

/// How many setpoints were sent since the one that the drives took last, which keeps a stall of the
/// host out of it; where that is none of ours, or too old to be known, one more than before.
[[nodiscard]] inline std::uint64_t count_unheard(const Cycle& c) noexcept {
  const std::uint64_t seen = c.drives.cycle_seen;
  const SentSetpoint& sent = c.state.sent[seen % kSentCycles];
  const bool is_ours = sent.cycle == seen && seen != 0;
  return is_ours ? c.in.cycle - seen - (c.state.periods_lost - sent.periods_lost)
                 : c.state.unheard + 1;
}

/// For how long drives may report and take no setpoints, in periods beside the two times that are
/// granted anyway: the bridge to setpoints that are missing, the timeout to reports that are late.
inline constexpr int kHearingSlack = 4;

/// Whether drives that report have not taken a setpoint for longer than drives that hear them could
/// have been without one: nobody knows where they were to be, and no following error is checked.
[[nodiscard]] inline bool is_unheard(const Cycle& c) noexcept {
  return c.dt * static_cast<double>(static_cast<std::int64_t>(c.state.unheard) -
                                    (c.machine.bridge_cycles + kHearingSlack)) >
         c.state.options.feedback_timeout_s;
}

/// Whether a program relies on the references: it goes on, or waits to. One that comes to rest is
/// let come to rest.
[[nodiscard]] constexpr bool is_in_program(State state) noexcept {
  switch (state) {
    case State::kApproaching:
    case State::kRunning:
    case State::kHeld:
    case State::kStarving:
    case State::kStarved:
    case State::kStepping:
      return true;
    default:
      return false;
  }
}

/// Looks at the probe: a contact that is sought stops the program as an abort does.
[[gnu::noinline]] inline void check_probe(Cycle& c) noexcept {
  if (c.state.state == State::kFaultStop) return;
  switch (see_probe(c)) {
    case ProbeNews::kNone:
      return;
    case ProbeNews::kFound:
      if (!c.state.stop.is_active()) begin_stop(c, StopKind::kHold);
      return enter(c, State::kAborting);
    case ProbeNews::kTouch:
      return raise(c, Alarm::kContact);
    case ProbeNews::kLost:
      return raise(c, Alarm::kProbeLost);
  }
}

/// Looks at drives and feedback while they are enabled.
inline void check_drives(Cycle& c) noexcept {
  const Feedback& f = c.drives;
  const std::uint32_t all = all_joints(c.machine);
  const std::uint32_t are_on = c.in.feedback.enabled_mask & all;
  if (f.emergency_stop) raise(c, Alarm::kEmergencyStop);
  if ((f.foreign_mask & all) != 0) raise(c, Alarm::kDrivesAstray, first_bit(f.foreign_mask & all));
  if (c.state.is_dry_run && are_on != 0) raise(c, Alarm::kDriveEnabled, first_bit(are_on));
  if (!is_feedback_there(c)) {
    raise(c, Alarm::kFeedbackLost, first_silent_joint(c),
          static_cast<double>(c.in.now_ns - f.arrival_ns) * 1e-9);
    return;  // what it says is old
  }
  if ((f.fault_mask & all) != 0) raise(c, Alarm::kDriveFault, first_bit(f.fault_mask & all));
  if (c.state.state == State::kEnabling || c.state.state == State::kFaultStop) {
    c.state.unheard = 0;
    return;
  }
  if ((f.enabled_mask & all) != all) raise(c, Alarm::kDriveFault, first_bit(~f.enabled_mask & all));
  if ((f.referenced_mask & all) != all && is_in_program(c.state.state)) {
    raise(c, Alarm::kReferenceLost, first_bit(~f.referenced_mask & all));
  }
  c.state.unheard = count_unheard(c);
  if (is_unheard(c)) {
    raise(c, Alarm::kSetpointsUnheard, f.deafest_joint,
          c.dt * static_cast<double>(c.state.unheard));
  }
  double error = 0;
  const int joint = first_joint_behind(c, error);
  if (joint >= 0) raise(c, Alarm::kFollowingError, joint, error);
  const unsigned has_probe =
      static_cast<unsigned>(f.probe) | static_cast<unsigned>(c.state.probing.state);
  if (has_probe != 0) check_probe(c);
}

/// Finds the place of the path ahead that is nearest to `joints` (1 rad counts kAxisLength mm),
/// Newton from the point in force, never past the plan's rest. The piece in force goes along.
[[nodiscard]] inline double find_nearest(Cycle& c, const JointVector& joints,
                                         double& passed) noexcept {
  constexpr double kClose_mm = 1e-9;
  double s = c.state.on_path.s;
  for (int n = 0; n < 20; ++n) {
    if (!put_on_path(c, s, 1.0)) break;
    double along = 0, square = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(c.machine.joint_count); ++i) {
      const double weight = c.machine.joints[i].is_rotary ? kAxisLength_mm_per_rad : 1.0;
      along += weight * weight * c.state.velocity[i] * (joints[i] - c.state.joints[i]);
      square += weight * weight * c.state.velocity[i] * c.state.velocity[i];
    }
    if (!(square > 0)) break;
    const double last = s;
    s = std::max(0.0, s + along / square);
    if (!walk_to(c, s, passed) || std::abs(s - last) < kClose_mm) break;
  }
  return s;
}

/// How long joints that are `deviation` beside the path take back to it with kReturnShare of their
/// limits. 1.875, 5.774 and 60 are the largest derivatives of the polynomial of add_deviation().
[[nodiscard]] inline double time_to_return(const JointLimits& limits, double deviation) noexcept {
  const double d = std::abs(deviation) / kReturnShare;
  return std::max({1.875 * d / limits.velocity, std::sqrt(5.774 * d / limits.fault_acceleration),
                   std::cbrt(60 * d / limits.fault_jerk)});
}

/// The same for the drives of a stage between `joints` and the joints `deviation` beside them. They
/// are not linear in between: twice the way bounds that.
[[nodiscard, gnu::noinline]] inline double time_for_stage_to_return(
    const MachineModel& machine, const JointVector& joints, const JointVector& deviation) noexcept {
  JointVector beside = joints;
  for (std::size_t i = 0; i < beside.size(); ++i) beside[i] += deviation[i];
  const LimitedVector from = limited_of(machine, joints), to = limited_of(machine, beside);
  double time = 0;
  for (int i = machine.joint_count; i < limited_count(machine); ++i) {
    const auto n = static_cast<std::size_t>(i);
    time = std::max(time, time_to_return(limited_spec(machine, i).limits, 2 * (to[n] - from[n])));
  }
  return time;
}

[[nodiscard]] inline double time_to_return(const MachineModel& machine, const JointVector& joints,
                                           const JointVector& deviation) noexcept {
  double time = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(machine.joint_count); ++i) {
    time = std::max(time, time_to_return(machine.joints[i].limits, deviation[i]));
  }
  if (!has_stage(machine)) return time;
  return std::max(time, time_for_stage_to_return(machine, joints, deviation));
}

/// How long drives have ramped down that bridge fewer periods than were lost.
[[nodiscard]] inline double ramp_time_of_drives(const Cycle& c) noexcept {
  return c.dt * (c.in.lost_periods - static_cast<double>(c.machine.bridge_cycles));
}

/// Where the drives are after more lost periods than they bridge: where they report to be, if they
/// have done so since. A report of before the stall, which a cycle sees that woke ahead of the
/// thread that receives, is where they were; they have gone on with the last velocity and then
/// ramped down with the FaultStop acceleration.
[[nodiscard, gnu::noinline]] inline JointVector joints_after_stall(const Cycle& c) noexcept {
  const double age = static_cast<double>(c.in.now_ns - c.drives.arrival_ns) * 1e-9;
  const double fresh = c.dt * std::min(c.in.lost_periods, 2U);
  if (is_feedback_there(c) && age < fresh) return c.feedback;
  JointVector joints = c.state.joints;
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.machine.joint_count); ++i) {
    const double speed = std::abs(c.state.velocity[i]);
    const double decel = c.machine.joints[i].limits.fault_acceleration;
    const double time = std::min(ramp_time_of_drives(c), speed / decel);
    const double distance =
        speed * (c.dt * c.machine.bridge_cycles + time) - decel * time * time / 2;
    joints[i] += std::copysign(distance, c.state.velocity[i]);
  }
  return joints;
}

/// More periods were lost than the drives bridge: they have gone on with the last velocity and then
/// ramped down. The FaultStop begins where they are, with the speed of that ramp, and leads them
/// back to the path.
inline void stop_from_drives(Cycle& c) noexcept {
  const JointVector position = joints_after_stall(c);
  raise(c, Alarm::kPeriodsLost, 0, static_cast<double>(c.in.lost_periods));
  if (!is_on_move(c) || is_off_path(c.state.stop.mode)) return;
  const double ramp_time = ramp_time_of_drives(c);
  double passed = 0;
  PathState begin = c.state.on_path;
  begin.s = find_nearest(c, position, passed);
  if (is_on_move(c)) {
    const TimePiece& piece = *c.reader.piece();
    c.state.piece_time = time_at(piece, begin.s, c.state.piece_time);
    const double ramped = begin.ds - piece.fault_accel * ramp_time;
    const double planned = state_at(piece, c.state.piece_time).ds;
    begin.ds = std::clamp(ramped, 0.0, planned);
    begin.dds = -piece.fault_accel * (1 - kReturnShare);
    // The rate that this is, should the stop have to go along the plan.
    if (planned > 0) c.state.rate.reset(begin.ds / planned);
    if (!put_on_path(c, begin.s, 0)) return;
  }
  c.state.on_path = begin;
  begin_stop(c, StopKind::kFault, 1 - kReturnShare);
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.machine.joint_count); ++i) {
    c.state.stop.deviation[i] = position[i] - c.state.joints[i];
  }
  c.state.stop.deviation_time = time_to_return(c.machine, c.state.joints, c.state.stop.deviation);
  c.previous = position;
  c.elapsed = c.dt;
  c.periods = 1;
}

/// The same while a joint is jogged, which has no path: it runs out from where it is, with what the
/// ramp has left of its speed.
inline void stop_jogging_from_drives(Cycle& c) noexcept {
  const JointVector velocity = c.state.velocity;
  const JointVector position = joints_after_stall(c);
  raise(c, Alarm::kPeriodsLost, 0, static_cast<double>(c.in.lost_periods));
  c.state.jogging = {};
  c.previous = c.state.joints = position;
  const double ramp_time = ramp_time_of_drives(c);
  JointVector left{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.machine.joint_count); ++i) {
    const double lost = c.machine.joints[i].limits.fault_acceleration * ramp_time;
    left[i] = std::copysign(std::max(0.0, std::abs(velocity[i]) - lost), velocity[i]);
  }
  c.state.stop = stop_off_path(c.machine, position, left, StopEvent::kDrivesWentOn);
  c.elapsed = c.dt;
  c.periods = 1;
}

/// The narrow port of the monitoring: it says what it found, and the machine stops. One that stops
/// already keeps the alarm that it stops for.
[[gnu::noinline]] inline void take_monitoring(Cycle& c) noexcept {
  const MonitoringAlarm& found = c.in.monitoring;
  const bool is_stopping = c.state.state == State::kFaultStop;
  if (is_enabled(c.state.state) && !is_stopping) raise(c, found.alarm, found.joint, found.value);
}

/// Looks at everything that may end in a FaultStop, before anything moves.
inline void supervise(Cycle& c) noexcept {
  const bool is_bridged = c.in.lost_periods <= static_cast<std::uint32_t>(c.machine.bridge_cycles);
  if (c.in.lost_periods > 0) {
    c.state.periods_lost += c.in.lost_periods;
    emit(c, EventCode::kPeriodsLost, c.in.lost_periods, is_bridged ? 1 : 0);
  }
  if (!is_enabled(c.state.state)) return;
  if (!is_bridged) {
    if (!c.state.jogging.axis.is_at_rest()) {
      stop_jogging_from_drives(c);
    } else if (c.state.on_path.ds > 0 || c.state.stop.is_active()) {
      stop_from_drives(c);
    }
    c.periods = 1;
  }
  check_drives(c);
  if (c.in.monitoring.alarm != Alarm::kNone) take_monitoring(c);
}

}  // namespace meridian
