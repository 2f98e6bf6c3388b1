// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "meridian/cycle/stop_law.hpp"
#include "meridian/planner/stop_product.hpp"
#include "meridian/planner/time_law.hpp"
#include "meridian/planner/time_piece.hpp"

namespace meridian {

enum class StopKind : std::uint8_t { kHold, kFault };

/// Of a smooth plan: a stop whose deceleration is that much of what it may use, or more, has not
/// been looked at. It comes from another stop.
inline constexpr double kMaxEasing = 1.2;

/// The fastest that a machine in `state` gets while a stop lets go of s̈ > 0.
[[nodiscard]] inline double peak_of(const PathState& state, const StopMargin& authority) noexcept {
  const double rise = std::max(state.dds, 0.0);
  return state.ds + 0.5 * rise * rise / authority.jerk;
}

/// Acceleration and jerk along the path that a stop from `state` may use. 0: there is no authority,
/// the plan itself is the way on, for whose rate it leaves room.
///
/// Of a smooth plan: (A, J) up to a speed, others up to a lower one (planner/time_piece.hpp).
///
/// Of a plan from rest to rest: the planner gives (A₁, J₁) that hold up to the speed v₁, and (A₀,
/// J₀) that hold next to rest. Both keep |q'| A + |q''| v² and |q'| J + 3 |q''| P + |q'''| v³ of
/// every joint below what it may do; P is the largest ṡ |s̈| of the stop (planner/stop_product.hpp).
/// At the share x = v/v₁ of the speed a weighted sum of the two keeps them too:
///
///     A = (1 - x²) A₀ + x² A₁, at most A₁/x
///     J = (1 - y) J₀ + y J₁,   y = max(P/P₁, x³); (A₁, J₁) where y > 1
///
/// A need not be more than the stop will use, sqrt(J v + a²/2): less of it leaves more jerk.
/// RT: cycle. Proof: tests/property/cycle/stop_margin_test.cpp.
[[nodiscard]] inline StopMargin authority_of(const TimePiece& piece, StopKind kind,
                                             const PathState& state) noexcept {
  const bool is_fault = kind == StopKind::kFault;
  const StopMargin fast = is_fault ? StopMargin{piece.fault_accel, piece.fault_jerk}
                                   : StopMargin{piece.stop_accel, piece.stop_jerk};
  const double slow_accel = is_fault ? piece.slow_fault_accel : piece.slow_stop_accel;
  const double slow_jerk = is_fault ? piece.slow_fault_jerk : piece.slow_stop_jerk;
  const StopMargin slow{slow_accel, slow_jerk};
  const bool is_slow = piece.slow_velocity > 0 && slow_jerk > 0 && slow_accel >= -state.dds;
  if (is_slow && peak_of(state, slow) <= piece.slow_velocity) return slow;
  const double peak = peak_of(state, fast);
  if (!(peak <= (is_fault ? piece.fault_velocity : piece.stop_velocity))) return {};
  if (piece.slow_velocity > 0 && -state.dds > kMaxEasing * fast.accel) return {};
  const bool is_slower = peak < piece.authority_velocity;
  if (!is_slower || !(slow_accel >= fast.accel) || !(slow_jerk >= fast.jerk)) return fast;
  const double x = peak / piece.authority_velocity;
  const double used = std::sqrt(slow_jerk * state.ds + 0.5 * state.dds * state.dds);
  const double max = std::min((1 - x * x) * slow_accel + x * x * fast.accel, fast.accel / x);
  const double accel = std::min(max, std::max(used, std::abs(state.dds)));
  const double top = state.ds + 0.5 * state.dds * state.dds / fast.jerk;
  const double product = largest_stop_product(top, accel, slow_jerk);
  const double product_fast = largest_stop_product(piece.authority_velocity, fast.accel, fast.jerk);
  const double y = std::max(product / product_fast, x * x * x);
  if (!(y <= 1)) return fast;
  return {accel, (1 - y) * slow_jerk + y * fast.jerk};
}

}  // namespace meridian
