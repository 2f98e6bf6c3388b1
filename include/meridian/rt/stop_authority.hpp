// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "meridian/planner/stop_product.hpp"
#include "meridian/planner/time_law.hpp"
#include "meridian/planner/time_piece.hpp"
#include "meridian/rt/stop_law.hpp"

namespace meridian {

enum class StopKind : std::uint8_t { kHold, kFault };

/// Acceleration and jerk along the path that a stop from `state` may use.
///
/// The planner gives (A₁, J₁) that hold up to the speed v₁, and (A₀, J₀) that hold next to rest.
/// Both keep |q'| A + |q''| v² and |q'| J + 3 |q''| P + |q'''| v³ of every joint below what it may
/// do; P is the largest ṡ |s̈| of the stop (planner/stop_product.hpp). At the share x = v/v₁ of the
/// speed a weighted sum of the two keeps them too:
///
///     A = (1 - x²) A₀ + x² A₁, at most A₁/x
///     J = (1 - y) J₀ + y J₁,   y = max(P/P₁, x³); (A₁, J₁) where y > 1
///
/// A piece may have no authority for a hold (0): the stop then goes along the plan.
///
/// A need not be more than the stop will use, sqrt(J v + a²/2): less of it leaves more jerk.
/// RT: cycle. Proof: tests/property/rt/stop_authority_test.cpp.
[[nodiscard]] inline StopAuthority authority_of(const TimePiece& piece, StopKind kind,
                                                const PathState& state) noexcept {
  const bool is_fault = kind == StopKind::kFault;
  const StopAuthority fast = is_fault ? StopAuthority{piece.fault_accel, piece.fault_jerk}
                                      : StopAuthority{piece.stop_accel, piece.stop_jerk};
  const double slow_accel = is_fault ? piece.slow_fault_accel : piece.slow_stop_accel;
  const double slow_jerk = is_fault ? piece.slow_fault_jerk : piece.slow_stop_jerk;
  const double rise = std::max(state.dds, 0.0);
  const double peak = state.ds + 0.5 * rise * rise / fast.jerk;  // speed grows while a is let go
  const bool is_slower = peak < piece.authority_velocity;
  if (!is_slower || !(slow_accel >= fast.accel) || !(slow_jerk >= fast.jerk)) return fast;
  const double x = peak / piece.authority_velocity;
  const double used = std::sqrt(slow_jerk * state.ds + 0.5 * state.dds * state.dds);
  const double most = std::min((1 - x * x) * slow_accel + x * x * fast.accel, fast.accel / x);
  const double accel = std::min(most, std::max(used, std::abs(state.dds)));
  const double top = state.ds + 0.5 * state.dds * state.dds / fast.jerk;
  const double product = largest_stop_product(top, accel, slow_jerk);
  const double product_fast = largest_stop_product(piece.authority_velocity, fast.accel, fast.jerk);
  const double y = std::max(product / product_fast, x * x * x);
  if (!(y <= 1)) return fast;
  return {accel, (1 - y) * slow_jerk + y * fast.jerk};
}

}  // namespace meridian
