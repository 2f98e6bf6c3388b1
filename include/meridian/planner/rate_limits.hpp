// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How fast the cycle may change the rate w = d(plan time)/dt at which it runs through the plan
/// (override, resume). With 0 <= w <= 1, |w'| <= kRateSlope and |w''| <= kRateCurvature the motion
/// s(τ(t)) has
///
///     s̈ = s'' w² + s' w',   s⃛ = s''' w³ + 3 s'' w w' + s' w''
///
/// so a plan with |s''| + kRateSlope |s'| <= A and |s'''| + 3 kRateSlope |s''| +
/// kRateCurvature |s'| <= J stays inside A and J at every override. Less is enough, as |w'| is
/// small where w is near 1: rate_room.hpp. Planner and cycle share these numbers (docs/motion.md).
namespace meridian {

inline constexpr double kRateSlope_per_s = 1.0;
inline constexpr double kRateCurvature_per_s2 = 10.0;

/// Both for a machine whose override takes longer: MachineModel::override_ramp_s, at least 1 s.
struct RateLimits {
  double slope_per_s = kRateSlope_per_s;
  double curvature_per_s2 = kRateCurvature_per_s2;
};
[[nodiscard]] constexpr RateLimits rate_limits(double override_ramp_s) noexcept {
  const double ramp_s = override_ramp_s > 1 ? override_ramp_s : 1.0;
  return {kRateSlope_per_s / ramp_s, kRateCurvature_per_s2 / ramp_s};
}

}  // namespace meridian
