// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "meridian/cycle/cycle_state.hpp"
#include "meridian/cycle/single_block.hpp"
#include "meridian/cycle/stop/on_path.hpp"
#include "meridian/cycle/stop/stop_margin.hpp"

/// How a stop begins: with which margin it lays out a law on the path, or why it goes along the
/// plan. RT: cycle.
namespace meridian {

/// A FaultStop that starts beside the path leaves this share of the joints' FaultStop limits to the
/// way back to it.
inline constexpr double kReturnShare = 0.2;

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

/// The state of the plan at the rate up to which `piece` grants `authority` to stops of `kind`.
[[nodiscard]] inline PathState granted_state(const TimePiece& piece, StopKind kind,
                                             const PathState& plan, double peak) noexcept {
  const double planned = std::min(plan.ds, margins_of(piece, kind).planned_velocity);
  const double velocity = peak <= piece.slow_velocity ? piece.slow_velocity : planned;
  const double rate = velocity / plan.ds;
  return {plan.s, velocity, rate * rate * plan.dds, 0};
}

/// Whether a law with `authority` from `begin` gets no faster than one from the plan there, and no
/// farther. While the rate of plan time still rises, of a resume, it adds to s̈: the planner reckons
/// with the s̈ of the plan. The law could let go of more above the velocity that a joint has, and
/// would come faster to where the path bends.
/// Proof: tests/unit/cycle/stop_rise_test.cpp.
[[nodiscard]] inline bool is_rise_planned(const Cycle& c, StopKind kind, const PathState& begin,
                                          const StopMargin& authority) noexcept {
  constexpr double kRounding = 1 + 1e-9;
  const TimePiece& piece = *c.reader.piece();
  if (!(begin.dds > 0) || !(authority.jerk > 0)) return true;
  const PathState plan = state_at(piece, c.state.piece_time);
  const double peak = peak_of(begin, authority);
  if (!(peak <= kRounding * peak_of(plan, authority))) return false;
  const double rate = begin.ds / plan.ds;
  if (begin.dds <= kRounding * rate * rate * plan.dds) return true;
  const PathState granted = granted_state(piece, kind, plan, peak);
  return StopLaw(begin, authority).distance() <= kRounding * StopLaw(granted, authority).distance();
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
    if (!is_rise_planned(c, kind, begin, authority)) authority = {};
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

}  // namespace meridian
