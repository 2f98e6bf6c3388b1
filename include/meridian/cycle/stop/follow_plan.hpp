// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/jog/probing.hpp"
#include "meridian/cycle/single_block.hpp"
#include "meridian/cycle/state_table.hpp"
#include "meridian/cycle/stop/on_path.hpp"

/// The program's motion in plan time: Approaching, Running, Starving, and the rests between.
/// RT: cycle.
namespace meridian {

/// The state that running the piece in force means.
[[nodiscard]] inline State running_state(const Cycle& c) noexcept {
  if (!is_on_move(c)) {
    return c.state.state == State::kApproaching ? State::kApproaching : State::kRunning;
  }
  if (c.reader.piece()->is_tail) return State::kStarving;
  return c.reader.path()->motion == MotionKind::kApproach ? State::kApproaching : State::kRunning;
}

/// Plan and queue are at their end and the program is not: at rest, waiting for blocks.
inline void starve(Cycle& c) noexcept {
  report_block_done(c);
  rest(c.state);
  ++c.state.starvations;
  c.state.starved_session = c.in.session;
  enter(c, State::kStarving);
  enter(c, State::kStarved);
}

/// The rate that the override of the piece in force asks for, over the factor that the piece's feed
/// was planned with.
[[nodiscard]] inline double wanted_rate(const Cycle& c) noexcept {
  const MotionKind motion = c.reader.path()->motion;
  const bool is_rapid = motion == MotionKind::kRapid || motion == MotionKind::kApproach;
  // The stop distance that a probing move was begun with is that of its own feed.
  const bool is_probing = c.state.probing.state == ProbeState::kSeeking;
  const double feed_override =
      is_probing ? std::min(c.state.feed_override, 1.0) : c.state.feed_override;
  double wanted = is_rapid ? c.state.rapid_override : feed_override / c.reader.piece()->feed_factor;
  // It comes in mid-cut and ends in the cut: whoever slowed the cut down slowed it too.
  if (motion == MotionKind::kRewind) wanted = std::min(wanted, c.state.rapid_override);
  return wanted;
}

/// Lets the rate follow the override of the piece in force. Where the plan rests, it jumps there.
inline void aim_rate(Cycle& c) noexcept {
  const double wanted = wanted_rate(c);
  if (is_plan_at_rest(c)) {
    c.state.rate.reset(rate_from_rest(c, std::min(wanted, 1.0)));
  } else {
    c.state.rate.aim(wanted);
  }
}

/// An action that was refused or timed out: Held with an alarm; a resume asks for it again.
inline void fail_action(Cycle& c) noexcept {
  emit(c, EventCode::kAlarm, static_cast<std::uint64_t>(Alarm::kActionFailed), 0,
       c.state.barrier_time);
  c.state.action = ActionState::kNotReported;
  c.state.barrier_time = 0;
  enter(c, State::kHeld);
}

/// One period at an action: it is reported once, then waited for.
inline void wait_for_action(Cycle& c) noexcept {
  if (c.state.action == ActionState::kNotReported) {
    emit(c, EventCode::kActionDue, c.state.sequence, c.state.line);
    c.state.action = ActionState::kWaiting;
  } else if (c.state.action == ActionState::kDone) {
    leave_barrier(c);
  } else if (c.state.action == ActionState::kRefused ||
             c.state.barrier_time > c.state.options.action_timeout_s) {
    fail_action(c);
  }
}

/// One period at a program stop: Held; the piece in force stays until resume() steps over it. An
/// optional one is no action: the action peer does not hear of it.
inline void stop_at_barrier(Cycle& c) noexcept {
  if (c.reader.piece()->kind == TimeKind::kStop) {
    emit(c, EventCode::kActionDue, c.state.sequence, c.state.line);
  }
  enter(c, State::kHeld);
}

/// One period at a rest of the plan that something must end.
inline void wait_at_barrier(Cycle& c) noexcept {
  const TimePiece& piece = *c.reader.piece();
  rest(c.state);
  c.state.barrier_time += c.dt;
  switch (piece.kind) {
    case TimeKind::kDwell:
      if (c.state.barrier_time >= piece.duration - 1e-6 * c.dt) leave_barrier(c);
      return;
    case TimeKind::kAction:
      return wait_for_action(c);
    case TimeKind::kStop:
      return stop_at_barrier(c);
    case TimeKind::kOptionalStop:
      if (c.state.stops_at_optional) return stop_at_barrier(c);
      next_piece(c);
      return;
    case TimeKind::kEnd:
      if (may_touch_yet(c)) return;
      report_block_done(c);
      end_probing(c);
      emit(c, EventCode::kProgramEnd, piece.sequence);
      c.reader.advance();
      c.state.piece_time = 0;
      enter(c, State::kReady);
      return;
    case TimeKind::kMove:
      return;
  }
}

/// At a rest of the plan: the override of the piece that begins is in force at once. Returns the
/// plan time that `beyond` at the old rate is at the new one, never more than a period of it.
[[nodiscard]] inline double take_up_override(Cycle& c, double beyond) noexcept {
  const double old_rate = c.state.rate.rate();
  aim_rate(c);
  const double rate = c.state.rate.rate();
  return rate * (beyond < old_rate * c.dt ? beyond / old_rate : c.dt);
}

/// One period of plan time on the motion in force and those behind it, up to the next barrier.
/// False if the path cannot be evaluated.
[[nodiscard]] inline bool move_one_period(Cycle& c) noexcept {
  SingleBlock& single = c.state.single_block;
  if (!single.is_braking()) aim_rate(c);
  const bool seeks_end = single.is_on && !single.is_braking();
  c.state.piece_time += seeks_end ? advance_to_block_end(c) : c.state.rate.advance(c.dt);
  if (single.is_braking()) {
    follow_braking_rate(c);
    return true;
  }
  for (int n = 0; n < kMaxPieces && is_on_move(c); ++n) {
    const double beyond = c.state.piece_time - c.reader.piece()->duration;
    if (beyond < 0) return true;
    const TimePiece& piece = *c.reader.piece();
    const PathState end = state_at(piece, piece.duration);
    if (!settle_at_end(c, end)) return false;
    if (single.is_on && rests_after_motion(c, end)) return true;
    if (!next_piece(c) || !is_on_move(c)) continue;
    c.state.piece_time = is_plan_at_rest(c) ? take_up_override(c, beyond) : beyond;
  }
  return true;
}

/// Puts the joints where plan time is now.
[[nodiscard]] inline bool put_at_plan_time(Cycle& c) noexcept {
  const TimePiece& piece = *c.reader.piece();
  const PathState p = state_at(piece, std::min(c.state.piece_time, piece.duration));
  const double w = c.state.rate.rate();
  c.state.on_path = {p.s, p.ds * w, p.dds * w * w + p.ds * c.state.rate.slope(), 0};
  return put_on_path(c, p.s, p.ds * w);
}

/// Goes on with the program by the periods of this cycle. False if the path cannot be evaluated;
/// the joints are then no setpoint.
[[nodiscard]] inline bool follow_plan(Cycle& c) noexcept {
  for (int n = 0; n < c.periods; ++n) {
    if (c.reader.piece() == nullptr && !next_piece(c)) {
      starve(c);
      return true;
    }
    if (is_on_move(c)) {
      if (!move_one_period(c)) return false;
      if (c.state.state == State::kStepping) return put_at_plan_time(c);
    } else {
      if (c.state.state == State::kStarving) enter(c, State::kRunning);
      wait_at_barrier(c);
      if (!is_on_path(c.state.state)) return true;
    }
  }
  if (!is_on_move(c)) {
    rest(c.state);
    if (c.reader.piece() == nullptr) starve(c);
    return true;
  }
  enter(c, running_state(c));
  return put_at_plan_time(c);
}

/// Starved: goes on by itself where blocks came in time and from the same session.
inline void wait_for_blocks(Cycle& c) noexcept {
  rest(c.state);
  if (c.reader.piece() == nullptr && !next_piece(c)) return;
  if (c.state.state_time <= c.machine.starve_auto_resume_s &&
      c.in.session == c.state.starved_session) {
    enter(c, running_state(c));
  }
}

}  // namespace meridian
