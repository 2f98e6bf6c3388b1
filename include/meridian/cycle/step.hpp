// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/drive_watch.hpp"
#include "meridian/cycle/dry_run.hpp"
#include "meridian/cycle/guard.hpp"
#include "meridian/cycle/jog/homing.hpp"
#include "meridian/cycle/jog/jogging.hpp"
#include "meridian/cycle/joint_masks.hpp"
#include "meridian/cycle/obey.hpp"
#include "meridian/cycle/state_table.hpp"
#include "meridian/cycle/stop/follow_plan.hpp"
#include "meridian/cycle/stop/stop_motion.hpp"
#include "meridian/cycle/supervise.hpp"

/// The cycle. Everything reached from step() is noexcept, bounded and free of allocation.
namespace meridian {

/// Whether the action peer answers the action that is waited for.
[[nodiscard]] inline bool is_awaited(const CycleState& state, const ActionAnswer& answer) noexcept {
  return answer.is_answered && state.action == ActionState::kWaiting &&
         answer.sequence == state.sequence;
}

/// The answer of the action peer, wherever the machine is meanwhile.
inline void take_action_answer(Cycle& c) noexcept {
  if (!is_awaited(c.state, c.in.action)) return;
  c.state.action = c.in.action.is_done ? ActionState::kDone : ActionState::kRefused;
  emit(c, EventCode::kActionAnswered, c.state.sequence, 0, c.in.action.is_done ? 1 : 0);
}

/// The drives went on with the last velocity for the periods that were lost: feedback of that
/// setpoint is ahead of it by so much.
inline void mark_bridged(const CycleInputs& in, double dt, CycleState& state) noexcept {
  const std::uint64_t last = in.cycle - in.lost_periods - 1;
  SentSetpoint& sent = state.sent[last % kSentCycles];
  if (in.lost_periods > 0 && sent.cycle == last) sent.bridged = dt * in.lost_periods;
}

/// Drives are off: the setpoint is where they are.
inline void follow_feedback(Cycle& c) noexcept {
  if (is_feedback_there(c)) take_over_feedback(c);
  rest(c.state);
  c.previous = c.state.joints;
}

/// Ready for a program, from here: what was planned before knew another place.
inline void be_ready(Cycle& c) noexcept {
  if (c.reader.piece() != nullptr || c.reader.advance() != nullptr) drop_program(c);
  enter(c, State::kReady);
}

inline void wait_for_drives_on(Cycle& c) noexcept {
  const std::uint32_t all = all_joints(c.machine);
  rest(c.state);
  if ((c.drives.enabled_mask & all) == all) {
    be_ready(c);
  } else if (c.state.state_time > c.state.options.enable_timeout_s) {
    raise(c, Alarm::kEnableTimeout, first_bit(~c.drives.enabled_mask & all));
  }
}

inline void wait_for_drives_off(Cycle& c) noexcept {
  rest(c.state);
  const bool is_off = (c.drives.enabled_mask & all_joints(c.machine)) == 0;
  if (is_off || c.state.state_time > c.state.options.disable_timeout_s) enter(c, State::kOff);
}

/// One cycle of a hand on the joints. False where they are nowhere.
[[nodiscard]] inline bool jog_by_hand(Cycle& c) noexcept {
  const JogStep step = follow_jogging(c);
  if (step == JogStep::kOver) be_ready(c);
  return step != JogStep::kNoJoints;
}

/// One cycle of drives that home themselves. False when that is over.
[[nodiscard]] inline bool home(Cycle& c) noexcept {
  const HomingStep step = follow_homing(c);
  if (step != HomingStep::kStuck) return step == HomingStep::kGoesOn;
  const std::uint32_t busy = c.state.homing.busy;
  raise(c, Alarm::kHomingTimeout, first_bit(busy), c.state.homing.time);
  return true;
}

/// What a stop ends in.
inline void arrive(Cycle& c) noexcept {
  finish_stop(c);
  if (c.state.state == State::kHolding) {
    enter(c, State::kHeld);
    return;
  }
  drop_program(c);
  enter(c, c.state.state == State::kAborting ? State::kReady : State::kFault);
}

/// One cycle of halting drives that home themselves. A FaultStop is over when they stand, or had
/// the time to: what they report need not be new.
inline void come_to_rest_from_homing(Cycle& c) noexcept {
  const bool goes_on = home(c);
  const bool is_fault = c.state.state == State::kFaultStop;
  if (goes_on && !(is_fault && c.state.homing.phase > Homing::Phase::kHalt)) return;
  c.state.homing = {};
  arrive(c);
}

/// One cycle of whatever stops. False if the path gave no joints.
[[nodiscard]] inline bool come_to_rest(Cycle& c) noexcept {
  if (c.state.jogging.is_active()) {
    const JogStep step = follow_braking(c);
    if (step == JogStep::kOver) arrive(c);
    return step != JogStep::kNoJoints;
  }
  if (c.state.homing.is_active()) {
    come_to_rest_from_homing(c);
    return true;
  }
  if (!follow_stop(c)) return false;
  if (is_stop_over(c.state.stop)) arrive(c);
  return true;
}

/// One cycle of the state in force. False if the path gave no joints.
[[nodiscard]] inline bool move(Cycle& c) noexcept {
  switch (c.state.state) {
    case State::kOff:
    case State::kFault:
      follow_feedback(c);
      watch_drives(c);
      return true;
    case State::kEnabling:
      wait_for_drives_on(c);
      return true;
    case State::kDisabling:
      wait_for_drives_off(c);
      watch_drives(c);
      return true;
    case State::kReady:
    case State::kLoaded:
      rest(c.state);
      if (c.reader.piece() != nullptr || c.reader.advance() != nullptr) enter(c, State::kLoaded);
      return true;
    case State::kApproaching:
    case State::kRunning:
    case State::kStarving:
      return follow_plan(c);
    case State::kHeld:
    case State::kStepping:
      rest(c.state);
      return true;
    case State::kStarved:
      wait_for_blocks(c);
      return true;
    case State::kJogging:
      return jog_by_hand(c);
    case State::kHoming:
      if (!home(c)) be_ready(c);
      return true;
    case State::kHolding:
    case State::kAborting:
    case State::kFaultStop:
      return come_to_rest(c);
  }
  return true;
}

/// The joints whose position means something: all that a program moves, else those with a
/// reference; none where drives ran out by themselves and brake from there.
[[nodiscard]] inline std::uint32_t joints_with_travel(const Cycle& c) noexcept {
  if (c.state.stop.mode == StopMode::kOffPathFromDrives) return 0;
  const State state = c.state.state;
  const bool has_hand = c.state.jogging.is_active() || c.state.homing.is_active();
  const bool is_program =
      is_on_path(state) && state != State::kFaultStop && state != State::kJogging && !has_hand;
  return is_program ? ~0U : c.drives.referenced_mask;
}

/// Gauge line to tip of the tool that moves.
[[nodiscard]] inline double tool_length_of(const Cycle& c) noexcept {
  const Jogging& jogging = c.state.jogging;
  if (jogging.is_active() && jogging.has_order) return jogging.order.tool_length_mm;
  const PathPiece* const path = c.reader.path();
  return path != nullptr ? path->tool_length_mm : c.in.tool_length_mm;
}

/// What check() does not know the tool for: whether the tip leaves its box.
[[nodiscard, gnu::noinline]] inline GuardVerdict check_tip(const Cycle& c,
                                                           std::uint32_t has_travel) noexcept {
  return check_tip_box(c.machine, tool_length_of(c), c.state.joints, c.previous, has_travel);
}

[[nodiscard]] inline GuardVerdict check_setpoint(const Cycle& c,
                                                 std::uint32_t has_travel) noexcept {
  const GuardVerdict verdict =
      check(c.machine, c.state.joints, c.state.velocity, c.previous, c.elapsed, has_travel);
  const bool has_more = c.machine.tip_box.is_set && verdict.alarm == Alarm::kNone;
  return has_more ? check_tip(c, has_travel) : verdict;
}

/// The last look before a setpoint leaves. One that must not be sent is replaced by a stop of every
/// joint along its last velocity, and where even that must not be sent, by standing still.
inline void guard(Cycle& c, bool has_joints, const JointVector& last_velocity) noexcept {
  if (!is_enabled(c.state.state)) return;
  const std::uint32_t has_travel = joints_with_travel(c);
  GuardVerdict verdict = check_setpoint(c, has_travel);
  if (!has_joints) verdict.alarm = Alarm::kUnreachable;
  if (verdict.alarm == Alarm::kNone) return;
  c.state.joints = c.previous;
  raise(c, verdict.alarm, verdict.joint, verdict.value);
  c.state.jogging = {};
  c.state.stop = stop_off_path(c.machine, c.previous, last_velocity);
  (void)follow_stop(c);
  verdict = check_setpoint(c, has_travel);
  if (verdict.alarm == Alarm::kNone) return;
  c.state.joints = c.previous;
  rest(c.state);
  c.state.stop = stop_off_path(c.machine, c.previous, {});
}

/// Rate of plan time in force: of a stop, its speed in shares of the planned one.
[[nodiscard]] inline double rate_of(const CycleState& state) noexcept {
  const StopInProgress& stop = state.stop;
  if (!stop.is_active() || is_along_plan(stop.mode)) return state.rate.rate();
  return stop.speed_begin > 0 ? stop.rate_begin * state.on_path.ds / stop.speed_begin : 0;
}

/// Takes the setpoint through the stage: what is sent are drive coordinates. Joints that still are
/// those of the feedback go out as the drives reported them, bit for bit.
[[gnu::noinline]] inline void put_through_stage(const Cycle& c, Setpoint& setpoint) noexcept {
  const CycleState& state = c.state;
  Joints<Jet<1>> q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] = Jet<1>::with_derivative(state.joints[i], state.velocity[i]);
  }
  const Joints<Jet<1>> u = drives_of(c.machine, q);
  const bool is_latched = state.joints == state.latched_joints;
  for (std::size_t i = 0; i < u.size(); ++i) {
    setpoint.position[i] = is_latched ? state.latched_drives[i] : value_of(u[i]);
    setpoint.velocity[i] = u[i].derivative(1);
  }
}

inline void write_record(Cycle& c) noexcept {
  CycleState& state = c.state;
  CycleRecord& out = c.out.record;
  bool is_moving = false;
  for (const double v : state.velocity) is_moving |= v != 0;
  unsigned flags = 0;
  if (is_enabled(state.state)) flags |= state.is_dry_run ? kSetpointDryEnabled : kSetpointEnabled;
  if (state.is_dry_run) flags |= kSetpointDry;
  if (is_moving) flags |= kSetpointMoving;
  if (state.state == State::kFaultStop) flags |= kSetpointFaultStop;
  out.setpoint = {c.in.cycle,
                  c.in.due_ns,
                  state.joints,
                  state.velocity,
                  state.line,
                  state.epoch,
                  static_cast<std::uint16_t>(flags)};
  out.joints = state.joints;
  out.sequence = state.sequence;
  out.plan_time_s = state.program_time + state.piece_time;
  out.rate = rate_of(state);
  out.state = state.state;
  out.motion = state.motion;
  out.lateness_ns = static_cast<std::int32_t>(c.in.now_ns - c.in.due_ns);
  out.computation_ns = c.in.computation_ns;
  SentSetpoint& sent = state.sent[c.in.cycle % kSentCycles];
  sent.cycle = c.in.cycle;
  sent.bridged = 0;
  sent.periods_lost = state.periods_lost;
  sent.position = state.joints;
  sent.velocity = state.velocity;
  if (!has_stage(c.machine)) return;
  put_through_stage(c, out.setpoint);
  sent.drive_position = out.setpoint.position;
  sent.drive_velocity = out.setpoint.velocity;
}

/// Computes one setpoint: takes in what is known, obeys, moves, guards, and reports.
///
/// `in.cycle` grows by 1 + `in.lost_periods` from call to call; plan time goes on by as many
/// periods, without output for those that were lost. The first call finds `state` in Off. The
/// result is a function of the arguments alone: the same inputs give the same setpoints bit for
/// bit. RT: cycle. Proof: tests/unit/cycle/step_*_test.cpp, tests/property/cycle.
inline void step(const MachineModel& machine, CycleState& state, MotionReader& reader,
                 const CycleInputs& in, StepOutput& out) noexcept {
  const double dt = static_cast<double>(machine.cycle_ns) * 1e-9;
  const int periods = 1 + static_cast<int>(in.lost_periods);
  std::optional<Feedback> dry;
  if (state.is_dry_run && is_enabled(state.state)) dry = dry_feedback(machine, state, in);
  const Feedback& drives = dry ? *dry : in.feedback;
  const bool is_converted = dry || has_stage(machine);
  JointVector converted;
  if (is_converted) converted = dry ? state.joints : joints_of(machine, drives.position);
  Cycle c{machine,
          state,
          reader,
          in,
          out,
          dt,
          periods,
          state.joints,
          dt * periods,
          drives,
          is_converted ? converted : drives.position};
  const JointVector last_velocity = state.velocity;
  out.event_count = 0;
  out.events_dropped = 0;
  state.state_time += dt * periods;
  reader.set_epoch(state.epoch);
  mark_bridged(in, dt, state);
  take_action_answer(c);
  supervise(c);
  obey(c);
  const bool has_joints = move(c);
  guard(c, has_joints, last_velocity);
  write_record(c);
}

}  // namespace meridian
