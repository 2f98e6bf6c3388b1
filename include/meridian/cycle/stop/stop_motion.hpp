// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/single_block.hpp"
#include "meridian/cycle/stop/begin_stop.hpp"
#include "meridian/cycle/stop/follow_plan.hpp"
#include "meridian/cycle/stop/on_path.hpp"
#include "meridian/cycle/stop/stop_margin.hpp"
#include "meridian/cycle/stop/stop_off_path.hpp"

/// How a stop goes on, from its begin (begin_stop.hpp) to rest: feed hold, abort and FaultStop.
/// RT: cycle.
namespace meridian {

/// A hold that has gone along the plan for so long without authority for a law of its own takes the
/// stop that its window ends in, s.
inline constexpr double kAlongPlan_s = 0.3;
/// But not where the planner could not go on from there, if the rate brings the plan to rest in so
/// much of its time.
inline constexpr double kRestByRate_s = 2;

/// Time from the begin to rest.
[[nodiscard]] inline double duration_of(const StopInProgress& stop) noexcept {
  return std::max(stop.law.duration(), stop.deviation_time);
}

[[nodiscard]] inline bool is_stop_over(const StopInProgress& stop) noexcept {
  return !stop.is_active() || (!is_along_plan(stop.mode) && stop.time >= duration_of(stop));
}

/// The path came to its end before the stop did (never by more than rounding, see StopLaw).
inline void end_stop_here(CycleState& state) noexcept {
  rest(state);
  state.stop.law = StopLaw({state.on_path.s, 0, 0, 0}, {});
  state.stop.begin = state.joints;
}

/// One period of a stop along the plan, no farther than to the end of a block that the rate brakes
/// for. False where it is over, or the plan rests before its rate does.
[[nodiscard, gnu::noinline]] inline bool slow_down_one_period(Cycle& c) noexcept {
  const SingleBlock& single = c.state.single_block;
  c.state.piece_time += c.state.rate.advance(c.dt);
  for (int n = 0; n < kMaxPieces; ++n) {
    const TimePiece& piece = *c.reader.piece();
    const bool is_last = single.is_braking() && single.pieces == 0;
    if (is_last) c.state.piece_time = std::min(c.state.piece_time, single.time);
    const double beyond = c.state.piece_time - piece.duration;
    if (is_last || beyond < 0) return c.state.rate.rate() > 0 || !c.state.rate.is_settled();
    if (!settle_at_end(c, state_at(piece, piece.duration))) return false;
    if (!next_piece(c) || !is_on_move(c) || is_plan_at_rest(c)) return false;
    if (c.state.single_block.pieces > 0) --c.state.single_block.pieces;
    c.state.piece_time = beyond;
  }
  return true;
}

/// Whether a FaultStop's law with `authority` may begin here. Its rate falls faster than authority
/// reckons with: the deceleration must be one that the law has anyway, on the way down from a speed
/// that has the same authority.
[[nodiscard]] inline bool is_reckoned_with(const Cycle& c, const StopMargin& authority) noexcept {
  const PathState& here = c.state.on_path;
  if (here.dds >= 0) return true;
  const TimePiece& piece = *c.reader.piece();
  const double top = here.ds + 0.5 * here.dds * here.dds / authority.jerk;
  if (-here.dds > authority.accel || top > state_at(piece, c.state.piece_time).ds) return false;
  const StopMargin same = authority_of(piece, StopKind::kFault, {here.s, top, here.dds, 0});
  return same.accel == authority.accel && same.jerk == authority.jerk;
}

/// The authority of the law for which a stop along the plan may leave it here; none: not yet.
[[nodiscard]] inline StopMargin authority_to_leave_plan(const Cycle& c) noexcept {
  const StopInProgress& stop = c.state.stop;
  const bool is_beside = stop.time < stop.deviation_time;
  if (!is_on_move(c) || is_beside || !(c.state.on_path.ds > 0)) return {};
  const bool is_fault = stop.mode == StopMode::kFaultAlongPlan;
  const TimePiece& piece = *c.reader.piece();
  const StopMargin authority = is_fault ? authority_where_it_brakes(c, StopKind::kFault)
                                        : authority_of(piece, StopKind::kHold, c.state.on_path);
  if (!(authority.jerk > 0)) return {};
  if (is_fault && !(piece.slow_velocity > 0) && !is_reckoned_with(c, authority)) return {};
  if (!is_fault && passes_block_end(c, c.state.on_path, authority)) return {};
  const StopKind kind = is_fault ? StopKind::kFault : StopKind::kHold;
  return is_rise_planned(c, kind, c.state.on_path, authority) ? authority : StopMargin{};
}

/// Lays the stop on the path out anew where the piece that it has come to, or the speed, has more
/// authority than it began with.
inline void shorten_stop(Cycle& c) noexcept {
  StopInProgress& stop = c.state.stop;
  if (stop.time < stop.deviation_time || !is_on_move(c)) return;
  const PathState& here = c.state.on_path;
  const double left = stop.law.duration() - stop.time;
  if (!(here.ds > 0) || !(left > c.dt)) return;
  const TimePiece& piece = *c.reader.piece();
  const PathState plan = state_at(piece, c.state.piece_time);
  const StopMargin authority = authority_on_law(piece, stop.kind, here, plan);
  if (!(authority.jerk > 0)) return;
  const StopLaw law(here, authority);
  if (!(law.duration() < left - c.dt)) return;
  const double rest = stop.law.at(stop.law.duration()).s - stop.passed;
  if (law.distance() > rest - here.s) return;
  stop.stopping_time += law.duration() - left;
  stop.stopping_distance += law.distance() - (rest - here.s);
  stop.rate_begin *= here.ds / stop.speed_begin;
  stop.speed_begin = here.ds;
  stop.law = law;
  stop.time = stop.passed = stop.deviation_time = 0;
}

/// How far a stop by a law came in the periods of a cycle.
enum class LawStep : std::uint8_t { kOnPath, kAtPathEnd, kLost };

/// Goes on by the periods of this cycle, one after the other, as if none had been lost, bit for
/// bit.
[[nodiscard]] inline LawStep follow_law(Cycle& c) noexcept {
  StopInProgress& stop = c.state.stop;
  for (int n = 0; n < c.periods; ++n) {
    shorten_stop(c);
    stop.time += c.dt;
    PathState p = stop.law.at(stop.time);
    p.s -= stop.passed;
    const bool is_inside = walk_to(c, p.s, stop.passed);
    c.state.on_path = p;
    if (!is_inside) return is_on_move(c) ? LawStep::kLost : LawStep::kAtPathEnd;
    c.state.piece_time = time_at(*c.reader.piece(), p.s, c.state.piece_time + c.dt);
  }
  return LawStep::kOnPath;
}

/// Leaves the plan for a law of its own where there is authority for one by now.
inline void leave_plan(Cycle& c) noexcept {
  const StopMargin authority = authority_to_leave_plan(c);
  if (!(authority.jerk > 0)) return;
  c.state.stop.rate_begin = c.state.rate.rate();
  lay_out_stop(c.state, c.state.on_path, authority);
}

/// Whether a stop along the plan may end in its window's tail: the program is void, or can go on
/// from there, or nothing else would end the stop.
[[nodiscard]] inline bool may_keep_tail(const Cycle& c) noexcept {
  return c.state.state != State::kHolding || c.reader.is_tail_remembered() ||
         c.state.rate.plan_time_to_rest() > kRestByRate_s;
}

/// Goes on with a stop along the plan by the periods of this cycle.
[[nodiscard]] inline bool follow_stop_by_rate(Cycle& c) noexcept {
  StopInProgress& stop = c.state.stop;
  const bool is_late = stop.time > kAlongPlan_s && !c.state.single_block.is_braking();
  if (is_late && is_on_move(c) && may_keep_tail(c)) c.reader.keep_tail(*c.reader.piece());
  bool goes_on = true;
  for (int n = 0; n < c.periods && goes_on; ++n) {
    stop.time += c.dt;
    goes_on = slow_down_one_period(c);
  }
  if (is_on_move(c) && !put_at_plan_time(c)) return false;
  stop.stopping_distance += c.state.on_path.ds * c.elapsed;
  if (goes_on) {
    add_deviation(c.state, c.machine.joint_count);
    return true;
  }
  rest(c.state);
  // The law has no duration: the stop is over, where nothing is left of a deviation.
  stop.change(StopEvent::kPlanRests);
  stop.begin = c.state.joints;
  stop.stopping_time = stop.time;
  add_deviation(c.state, c.machine.joint_count);
  return true;
}

/// The periods of this cycle off the path, or where nothing is cut and the joints stay.
inline void follow_without_path(Cycle& c) noexcept {
  StopInProgress& stop = c.state.stop;
  for (int n = 0; n < c.periods; ++n) stop.time += c.dt;  // as if none had been lost, bit for bit
  if (is_off_path(stop.mode)) return put_off_path(c.state, c.machine.joint_count);
  c.state.joints = stop.begin;
  rest(c.state);
}

/// Goes on with the stop by the periods of this cycle. False if the path cannot be evaluated.
[[nodiscard]] inline bool follow_stop(Cycle& c) noexcept {
  StopInProgress& stop = c.state.stop;
  if (is_along_plan(stop.mode)) leave_plan(c);
  if (is_along_plan(stop.mode)) return follow_stop_by_rate(c);
  if (is_off_path(stop.mode) || !is_on_move(c)) {
    follow_without_path(c);
  } else {
    const LawStep step = follow_law(c);
    if (step == LawStep::kLost) return false;
    if (step == LawStep::kAtPathEnd) {
      end_stop_here(c.state);
    } else if (!put_on_path(c, c.state.on_path.s, c.state.on_path.ds)) {
      return false;
    }
  }
  add_deviation(c.state, c.machine.joint_count);
  return true;
}

/// At rest: the rate is zero, and plan time is the one of the point that was reached.
inline void finish_stop(Cycle& c) noexcept {
  const StopInProgress& stop = c.state.stop;
  rest(c.state);
  if (stop.stopping_time > 0) {
    emit(c, EventCode::kStopped, static_cast<std::uint64_t>(stop.stopping_time * 1e9), 0,
         stop.stopping_distance);
  }
  c.state.stop = {};
  c.state.single_block.leave_brake();
  c.state.rate.reset(0);
}

}  // namespace meridian
