// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How fast the cycle may change the rate w = d(plan time)/dt at which it runs through the plan
/// (override, resume). With 0 <= w <= 1, |w'| <= kRateSlope and |w''| <= kRateCurvature the motion
/// s(τ(t)) has
///
///     s̈ = s'' w² + s' w',   s⃛ = s''' w³ + 3 s'' w w' + s' w''
///
/// so a plan with |s''| + kRateSlope |s'| <= A and |s'''| + 3 kRateSlope |s''| + kRateCurvature
/// |s'|
/// <= J stays inside A and J at every override. Planner and cycle share these numbers
/// (docs/motion.md).
namespace meridian {

inline constexpr double kRateSlope_per_s = 1.0;
inline constexpr double kRateCurvature_per_s2 = 10.0;

}  // namespace meridian
