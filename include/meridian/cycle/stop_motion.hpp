// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/follow_plan.hpp"
#include "meridian/cycle/on_path.hpp"
#include "meridian/cycle/single_block.hpp"
#include "meridian/cycle/stop_margin.hpp"

/// Stops: feed hold, abort and FaultStop, on the path and, where it cannot be evaluated, beside it.
/// RT: cycle.
namespace meridian {

/// A FaultStop that starts beside the path leaves this share of the joints' FaultStop limits to the
/// way back to it.
inline constexpr double kReturnShare = 0.2;

/// A hold that has gone along the plan for so long without authority for a law of its own takes the
/// stop that its window ends in, s.
inline constexpr double kAlongPlan_s = 0.3;
/// But not where the planner could not go on from there, if the rate brings the plan to rest in so
/// much of its time.
inline constexpr double kRestByRate_s = 2;

/// How fast a FaultStop may lower the rate of plan time with `share` of the FaultStop limits. Plans
/// leave room for the rate's own bounds Ω₁, Ω₂ in the limits v, a, j of every joint; what the
/// FaultStop limits are beyond them is left for more of both, D and κ D:
///
///     a + D v <= a_fault,   j + 3 D a + κ D v <= j_fault,   κ = Ω₂/Ω₁
///
/// Source: docs/motion.md, sections 3 and 9.
[[nodiscard, gnu::noinline]] inline RateBounds fault_rate_bounds(const MachineModel& machine,
                                                                 double share) noexcept {
  constexpr double kRatio = kRateCurvature_per_s2 / kRateSlope_per_s, kShare = 0.99;
  double more = 1e3;
  for (int i = 0; i < limited_count(machine); ++i) {
    const JointLimits& limits = limited_spec(machine, i).limits;
    const double accel = kShare * share * limits.fault_acceleration - limits.acceleration;
    const double jerk = kShare * share * limits.fault_jerk - limits.jerk;
    const double per_jerk = 3 * limits.acceleration + kRatio * limits.velocity;
    more = std::min({more, accel / limits.velocity, jerk / per_jerk});
  }
  const RateBounds own = rate_bounds(machine);
  if (!(more > 0)) return own;
  return {own.slope + more, own.curvature + kRatio * more};
}

/// Lets the rate of plan time fall, as fast as `kind` may.
inline void lower_rate(Cycle& c, StopKind kind, double share) noexcept {
  if (kind == StopKind::kHold) return c.state.rate.aim(0);
  // The program is void: the first rest of the plan is the best, wherever blocks end.
  c.state.single_block.leave_brake();
  c.state.rate.stop(fault_rate_bounds(c.machine, share));
  c.reader.keep_tail(*c.reader.piece());
}

/// Lays out the stop in progress with `authority`, from `begin` on the path in force.
inline void lay_out_stop(CycleState& state, const PathState& begin,
                         const StopMargin& authority) noexcept {
  StopInProgress& stop = state.stop;
  stop.law = StopLaw(begin, authority);
  stop.speed_begin = begin.ds;
  stop.stopping_time = stop.time + stop.law.duration();
  stop.stopping_distance += stop.law.distance();
  stop.time = 0;
  stop.change(StopEvent::kLaidOut);
  stop.begin = state.joints;
  state.single_block.leave_brake();
}

/// Path length to the end of the block that the rate brakes for.
[[nodiscard]] inline double distance_to_block_end(const Cycle& c) noexcept {
  const SingleBlock& single = c.state.single_block;
  MotionAhead ahead(c.reader);
  const TimePiece* piece = c.reader.piece();
  double distance = -c.state.on_path.s;
  for (int n = 0; n < single.pieces; ++n) {
    const TimePiece* next = ahead.next();
    if (next == nullptr) break;
    const PathPiece* path = c.reader.path_of(*piece);
    if (next->path_index != piece->path_index && path != nullptr) distance += path->length;
    piece = next;
  }
  return distance + state_at(*piece, single.time).s;
}

/// Whether a hold from `begin` with `authority` would end at the end of a block that the rate
/// brakes for, which rounding may make behind it, or beyond: the brake is no longer way to rest
/// then.
[[nodiscard]] inline bool passes_block_end(const Cycle& c, const PathState& begin,
                                           const StopMargin& authority) noexcept {
  if (!c.state.single_block.is_braking() || !(authority.jerk > 0)) return false;
  return StopLaw(begin, authority).distance() > distance_to_block_end(c) - kSameEnd_mm;
}

/// Whether a law with `authority` from `begin` gets no faster than one from the plan there. While
/// the rate of plan time still rises, of a resume, it adds to s̈: the planner reckons with the s̈ of
/// the plan, and the law could let go of more above the velocity that a joint has.
/// Proof: tests/unit/cycle/stop_rise_test.cpp.
[[nodiscard]] inline bool is_rise_planned(const Cycle& c, const PathState& begin,
                                          const StopMargin& authority) noexcept {
  constexpr double kRounding = 1 + 1e-9;
  const TimePiece& piece = *c.reader.piece();
  if (!(begin.dds > 0) || !(authority.jerk > 0)) return true;
  const PathState plan = state_at(piece, c.state.piece_time);
  return peak_of(begin, authority) <= kRounding * peak_of(plan, authority);
}

/// What a stop of `kind` may use from here where the machine may brake harder than plans do at any
/// rate: on the law of another stop, or along the plan in a FaultStop.
[[nodiscard]] inline StopMargin authority_where_it_brakes(const Cycle& c, StopKind kind) noexcept {
  const TimePiece& piece = *c.reader.piece();
  const PathState& here = c.state.on_path;
  if (!(piece.slow_velocity > 0) || !(here.dds < 0)) return authority_of(piece, kind, here);
  return authority_on_law(piece, kind, here, state_at(piece, c.state.piece_time));
}

/// Begins the stop from where and how the machine moves along its path; nothing moves: it is over
/// at once. A stop that was going on is laid out anew with the authority of `kind`. Without
/// authority it goes on as it was, or along the plan, for whose rate every plan leaves room, to the
/// end of its window's tail at the latest: of a hold, where kAlongPlan_s are over.
inline void begin_stop(Cycle& c, StopKind kind, double share = 1.0) noexcept {
  StopInProgress& stop = c.state.stop;
  const double rate = stop.is_active() && stop.speed_begin > 0
                          ? stop.rate_begin * c.state.on_path.ds / stop.speed_begin
                          : c.state.rate.rate();
  StopMargin authority;
  PathState begin{c.state.on_path.s, 0, 0, 0};
  if (is_on_move(c)) {
    const TimePiece& piece = *c.reader.piece();
    begin = c.state.on_path;
    if (!(begin.ds > 0)) begin = {state_at(piece, c.state.piece_time).s, 0, 0, 0};
    const bool is_on_law = stop.mode == StopMode::kOnPath;
    authority = is_on_law ? authority_where_it_brakes(c, kind) : authority_of(piece, kind, begin);
    authority = {authority.accel * share, authority.jerk * share};
    if (kind == StopKind::kHold && passes_block_end(c, begin, authority)) authority = {};
    if (!is_rise_planned(c, begin, authority)) authority = {};
  }
  const bool was_by_rate = is_along_plan(stop.mode);
  const bool has_authority = authority.jerk > 0 || !(begin.ds > 0);
  if (!has_authority && stop.mode == StopMode::kOnPath && share == 1.0) {
    stop.kind = kind;  // its law may be laid out anew by what this kind may use
    return;
  }
  const StopInProgress before = stop;
  stop = {};
  stop.rate_begin = rate;
  stop.kind = kind;
  if (has_authority) return lay_out_stop(c.state, begin, authority);
  stop.change(kind == StopKind::kFault ? StopEvent::kFault : StopEvent::kHold);
  if (was_by_rate) {
    stop.time = before.time;
    stop.stopping_distance = before.stopping_distance;
  }
  lower_rate(c, kind, share);
}

/// Lessens `authority` so that the drives of a stage stop inside their FaultStop limits too, the
/// joints running along `direction` from `joints`: where the curvature of the stage alone takes
/// most of a limit, a quarter of it.
[[nodiscard, gnu::noinline]] inline StopMargin authority_beside_stage(
    const MachineModel& machine, const JointVector& joints, const JointVector& direction,
    StopMargin authority) noexcept {
  Joints<Jet<3>> moving;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    moving[i] = Jet<3>::with_derivative(joints[i], direction[i]);
  }
  const Limited<Jet<3>> all = limited_of(machine, moving);
  for (int i = machine.joint_count; i < limited_count(machine); ++i) {
    const auto n = static_cast<std::size_t>(i);
    const JointLimits& limits = limited_spec(machine, i).limits;
    const double d1 = std::abs(all[n].derivative(1)), d2 = std::abs(all[n].derivative(2)),
                 d3 = std::abs(all[n].derivative(3));
    const double accel = std::max(limits.fault_acceleration - d2, 0.25 * limits.fault_acceleration);
    if (accel < authority.accel * d1) authority.accel = accel / d1;
    const double jerk =
        std::max(limits.fault_jerk - d3 - 3 * d2 * authority.accel, 0.25 * limits.fault_jerk);
    if (jerk < authority.jerk * d1) authority.jerk = jerk / d1;
  }
  return authority;
}

/// A stop of every joint along its last velocity, all in the same time: the last resort where the
/// path gives no setpoint that may be sent.
[[nodiscard]] inline StopInProgress stop_off_path(const MachineModel& machine,
                                                  const JointVector& joints,
                                                  const JointVector& velocity,
                                                  StopEvent event = StopEvent::kPathLost) noexcept {
  StopInProgress stop;
  stop.change(event);
  stop.begin = joints;
  StopMargin authority{1e9, 1e12};
  bool is_moving = false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(machine.joint_count); ++i) {
    const double speed = std::abs(velocity[i]);
    if (!(speed > 0) || !std::isfinite(speed)) continue;
    const JointLimits& limits = machine.joints[i].limits;
    stop.direction[i] = velocity[i];
    authority.accel = std::min(authority.accel, limits.fault_acceleration / speed);
    authority.jerk = std::min(authority.jerk, limits.fault_jerk / speed);
    is_moving = true;
  }
  if (is_moving && has_stage(machine)) {
    authority = authority_beside_stage(machine, joints, stop.direction, authority);
  }
  stop.law = StopLaw({0, is_moving ? 1.0 : 0.0, 0, 0}, authority);
  return stop;
}

/// Time from the begin to rest.
[[nodiscard]] inline double duration_of(const StopInProgress& stop) noexcept {
  return std::max(stop.law.duration(), stop.deviation_time);
}

[[nodiscard]] inline bool is_stop_over(const StopInProgress& stop) noexcept {
  return !stop.is_active() || (!is_along_plan(stop.mode) && stop.time >= duration_of(stop));
}

/// Adds what is left of the deviation from the path: 1 - 10x³ + 15x⁴ - 6x⁵ of it.
inline void add_deviation(CycleState& state, int joint_count) noexcept {
  const StopInProgress& stop = state.stop;
  if (stop.time >= stop.deviation_time) return;
  const double x = stop.time / stop.deviation_time;
  const double left = 1 - x * x * x * (10 - x * (15 - 6 * x));
  const double slope = -30 * x * x * (1 - x) * (1 - x) / stop.deviation_time;
  for (std::size_t i = 0; i < static_cast<std::size_t>(joint_count); ++i) {
    state.joints[i] += stop.deviation[i] * left;
    state.velocity[i] += stop.deviation[i] * slope;
  }
}

/// Puts the joints where the stop off the path is at its time.
inline void put_off_path(CycleState& state, int joint_count) noexcept {
  const StopInProgress& stop = state.stop;
  const PathState p = stop.law.at(stop.time);
  for (std::size_t i = 0; i < static_cast<std::size_t>(joint_count); ++i) {
    state.joints[i] = stop.begin[i] + stop.direction[i] * p.s;
    state.velocity[i] = stop.direction[i] * p.ds;
  }
}

/// The path came to its end before the stop did (never by more than rounding, see StopLaw).
inline void end_stop_here(CycleState& state) noexcept {
  rest(state);
  state.stop.law = StopLaw({state.on_path.s, 0, 0, 0}, {});
  state.stop.begin = state.joints;
}

/// One period of a stop along the plan, no farther than to the end of a block that the rate brakes
/// for. False where it is over, or the plan rests before its rate does.
[[nodiscard]] inline bool slow_down_one_period(Cycle& c) noexcept {
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
  if (!is_rise_planned(c, c.state.on_path, authority)) return {};
  return authority;
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

/// Goes on with the stop by the periods of this cycle. False if the path cannot be evaluated.
[[nodiscard]] inline bool follow_stop(Cycle& c) noexcept {
  StopInProgress& stop = c.state.stop;
  if (is_along_plan(stop.mode)) leave_plan(c);
  if (is_along_plan(stop.mode)) return follow_stop_by_rate(c);
  const bool is_off = is_off_path(stop.mode);
  if (is_off || !is_on_move(c)) {
    for (int n = 0; n < c.periods; ++n) stop.time += c.dt;  // as if none had been lost, bit for bit
  }
  if (is_off) {
    put_off_path(c.state, c.machine.joint_count);
    add_deviation(c.state, c.machine.joint_count);
    return true;
  }
  if (!is_on_move(c)) {
    c.state.joints = stop.begin;
    rest(c.state);
    add_deviation(c.state, c.machine.joint_count);
    return true;
  }
  const LawStep step = follow_law(c);
  if (step == LawStep::kLost) return false;
  if (step == LawStep::kAtPathEnd) {
    end_stop_here(c.state);
    add_deviation(c.state, c.machine.joint_count);
    return true;
  }
  if (!put_on_path(c, c.state.on_path.s, c.state.on_path.ds)) return false;
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
