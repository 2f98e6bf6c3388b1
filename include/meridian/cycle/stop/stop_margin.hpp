// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "meridian/cycle/stop/stop_law.hpp"
#include "meridian/cycle/stop/stop_mode.hpp"
#include "meridian/planner/stop_product.hpp"
#include "meridian/planner/time_law.hpp"
#include "meridian/planner/time_piece.hpp"

namespace meridian {

/// Of a smooth plan: a stop whose deceleration is that much of what it may use, or more, has not
/// been looked at. It comes from another stop.
inline constexpr double kMaxEasing = 1.2;

/// The fastest that a machine in `state` gets while a stop lets go of s̈ > 0.
[[nodiscard]] inline double peak_of(const PathState& state, const StopMargin& authority) noexcept {
  const double rise = std::max(state.dds, 0.0);
  return state.ds + 0.5 * rise * rise / authority.jerk;
}

/// What a piece grants to one kind of stop (planner/time_piece.hpp).
struct StopMarginSet {
  StopMargin planned;  ///< up to `planned_velocity`
  double planned_velocity = 0;
  StopMargin slow;  ///< up to TimePiece::slow_velocity
  StopMargin rest;  ///< next to rest
};
[[nodiscard]] inline StopMarginSet margins_of(const TimePiece& piece, StopKind kind) noexcept {
  if (kind == StopKind::kFault) {
    return {{piece.fault_accel, piece.fault_jerk},
            piece.fault_velocity,
            {piece.slow_fault_accel, piece.slow_fault_jerk},
            {piece.rest_fault_accel, piece.rest_fault_jerk}};
  }
  return {{piece.stop_accel, piece.stop_jerk},
          piece.stop_velocity,
          {piece.slow_stop_accel, piece.slow_stop_jerk},
          {piece.rest_stop_accel, piece.rest_stop_jerk}};
}

/// The two ends of what a stop may use: next to rest, and up to a speed.
struct StopMarginRange {
  StopMargin rest, fast;
  double velocity = 0;  ///< of `fast`
};

/// What may be used between both ends by a stop from `state` whose speed is nowhere above `peak`.
/// Both keep |q'| A + |q''| v² and |q'| J + 3 |q''| P + |q'''| v³ of every joint below what it may
/// do; P is the largest ṡ |s̈| of the stop (planner/stop_product.hpp). At the share x = peak/v₁ of
/// the speed a weighted sum keeps them too:
///
///     A = (1 - w) A₀ + w A₁,   J = (1 - y) J₀ + y J₁,   y >= P/P₁;   (A₁, J₁) where y > 1
///
/// Of a plan from rest to rest, whose bounds are for the speed v₁ everywhere on the stop: w = x²,
/// but A <= A₁/x, and y >= x³. Of a smooth plan, whose bounds are for what the stop from v₁ does in
/// every cell, with what the rate adds to s̈: w = x, and y >= x and x A/A₁ (`is_by_cell`).
/// A need not be more than the stop will use, sqrt(J v + a²/2): less of it leaves more jerk.
[[nodiscard]] inline StopMargin margin_between(const StopMarginRange& range, const PathState& state,
                                               double peak, bool is_by_cell) noexcept {
  const StopMargin &rest = range.rest, &fast = range.fast;
  const double x = peak / range.velocity, w = is_by_cell ? x : x * x;
  if (!(x < 1) || !(rest.accel >= fast.accel) || !(rest.jerk >= fast.jerk)) return fast;
  const double used = std::sqrt(rest.jerk * state.ds + 0.5 * state.dds * state.dds);
  const double sum = (1 - w) * rest.accel + w * fast.accel;
  const double max = is_by_cell ? sum : std::min(sum, fast.accel / x);
  const double accel = std::min(max, std::max(used, std::abs(state.dds)));
  const double top = state.ds + 0.5 * state.dds * state.dds / fast.jerk;
  const double product = largest_stop_product(top, accel, rest.jerk);
  const double product_fast = largest_stop_product(range.velocity, fast.accel, fast.jerk);
  const double by_speed = is_by_cell ? x * std::max(1.0, accel / fast.accel) : x * x * x;
  const double y = std::max(product / product_fast, by_speed);
  if (!(y <= 1)) return fast;
  return {accel, (1 - y) * rest.jerk + y * fast.jerk};
}

/// Acceleration and jerk along the path that a stop from `state` may use. 0: there is no authority,
/// the plan itself is the way on, for whose rate it leaves room.
///
/// Of a smooth plan: (A, J) up to a speed, others up to a lower one, and what lies between these
/// and those next to rest. Of a plan from rest to rest: between rest and the planned speed. RT:
/// cycle. Proof: tests/property/cycle/stop_margin_test.cpp.
[[nodiscard]] inline StopMargin authority_of(const TimePiece& piece, StopKind kind,
                                             const PathState& state) noexcept {
  const auto [fast, velocity, slow, rest] = margins_of(piece, kind);
  const bool is_slow = piece.slow_velocity > 0 && slow.jerk > 0 && slow.accel >= -state.dds;
  const double slow_peak = is_slow ? peak_of(state, slow) : 0;
  if (is_slow && slow_peak <= piece.slow_velocity) {
    return margin_between({rest, slow, piece.slow_velocity}, state, slow_peak, true);
  }
  const double peak = peak_of(state, fast);
  if (!(peak <= velocity)) return {};
  if (piece.slow_velocity > 0 && -state.dds > kMaxEasing * fast.accel) return {};
  if (!(piece.authority_velocity > 0)) return fast;
  return margin_between({rest, fast, piece.authority_velocity}, state, peak, false);
}

/// The same of a smooth plan for a stop that is on a law of its own already: it brakes, and is in
/// `state` where the plan would be in `plan`; none where neither bounds what a stop from there
/// does.
///
/// They bound it where on the law from some state that has them, at the same s, it lies further
/// ahead: it is slower than the plan, brakes at least as hard as the plan at its speed, and its
/// law's peak speed is not above the one that they are granted for. RT: cycle.
/// Proof: tests/property/planner/smooth_stop_test.cpp.
[[nodiscard]] inline StopMargin authority_on_law(const TimePiece& piece, StopKind kind,
                                                 const PathState& state,
                                                 const PathState& plan) noexcept {
  if (!(piece.slow_velocity > 0) || !(state.dds <= 0) || !(state.ds < plan.ds)) return {};
  const double rate = state.ds / plan.ds;
  if (state.dds > rate * rate * plan.dds) return {};
  const auto [fast, velocity, slow, rest] = margins_of(piece, kind);
  const auto top_of = [&](const StopMargin& margin) {
    return state.ds + 0.5 * state.dds * state.dds / margin.jerk;
  };
  const auto is_granted = [&](const StopMargin& margin, double up_to) {
    return margin.jerk > 0 && -state.dds <= margin.accel && top_of(margin) <= up_to;
  };
  if (is_granted(slow, piece.slow_velocity)) {
    return margin_between({rest, slow, piece.slow_velocity}, state, top_of(slow), true);
  }
  return is_granted(fast, std::min(plan.ds, velocity)) ? fast : StopMargin{};
}

}  // namespace meridian
