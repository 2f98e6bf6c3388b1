// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace meridian {

/// The parabola through three samples at equal steps. What a smooth function reaches between them
/// is about its top.
struct Parabola {
  Parabola(double left, double at_middle, double right) noexcept
      : middle(at_middle), bend(2 * at_middle - left - right), slope(right - left) {}

  /// Where it has one: bend > 0.
  [[nodiscard]] double top() const noexcept { return middle + slope * slope / (8 * bend); }

  double middle = 0;
  double bend = 0;   ///< -f'' times the square of a step
  double slope = 0;  ///< 2 f' times a step, at the middle
};

}  // namespace meridian
