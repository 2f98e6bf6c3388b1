// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

namespace meridian {

inline constexpr double kTurn_rad = 2.0 * std::numbers::pi;

/// Returns the whole turns, as a number, that bring `angle` nearest to `reference`.
///
/// Exactly half a turn away, the tie goes to the even number. Any winding below 2^51 turns is
/// accepted; a non-finite argument gives NaN. RT: cycle, no library call.
[[nodiscard]] inline double whole_turns(double angle, double reference) noexcept {
  // Adding and taking away 1.5·2^52 rounds to the nearest whole number.
  constexpr double kRounder = 6755399441055744.0;
  const double turns = (reference - angle) * (1.0 / kTurn_rad);
  return (turns + kRounder) - kRounder;
}

/// Returns the angle congruent to `angle` (mod 2π) that lies nearest to `reference`.
///
/// It keeps a rotary joint from rewinding: consecutive setpoints differ by at most half a turn.
/// Unit: rad. RT: cycle. Proof: tests/unit/kinematics/winding_test.cpp.
[[nodiscard]] inline double nearest_winding(double angle, double reference) noexcept {
  return angle + whole_turns(angle, reference) * kTurn_rad;
}

/// Returns the angle congruent to `angle` (mod 2π) inside [minimum, maximum] that lies nearest to
/// `reference`; where no winding is inside, the one nearest to `reference`.
///
/// `margin` widens the travel, so that an angle on its edge is not sent a whole turn away by
/// rounding. Unit: rad. Proof: tests/unit/kinematics/winding_test.cpp.
[[nodiscard]] inline double nearest_winding_inside(double angle, double reference, double minimum,
                                                   double maximum, double margin) noexcept {
  const double nearest = nearest_winding(angle, reference);
  if (nearest >= minimum - margin && nearest <= maximum + margin) return nearest;
  const double beyond = nearest < minimum ? minimum - margin - nearest : maximum + margin - nearest;
  const double turns =
      nearest < minimum ? std::ceil(beyond / kTurn_rad) : std::floor(beyond / kTurn_rad);
  const double moved = nearest + turns * kTurn_rad;
  return moved >= minimum - margin && moved <= maximum + margin ? moved : nearest;
}

}  // namespace meridian
