// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace meridian {

/// What q̈ and q⃛ of a plan come to at any rate w in [0, 1] that the cycle's rate filter may have.
/// Of q⃛ without w'' q̇, for which callers add Ω₂ |q̇|.
///
/// The filter always comes to rest at w <= 1, so |w'| <= min(Ω₁, √(2Ω₂ε)) with ε = 1 - w: full
/// |w'| never meets w = 1. `own` is |q̈| or |q⃛|, `below` what w' is multiplied by, |q̇| or 3 |q̈|:
///
///     max over ε of  (1-ε)ⁿ own + min(Ω₁, √(2Ω₂ε)) below,     n = 2, of jerk 3
///
/// largest() is an upper bound of it: (1-ε)ⁿ <= 1 - cε where ε is no more than the ε₁ from which
/// on |w'| may be Ω₁, with c = 2 - ε₁, of jerk 3 - 3ε₁; and the factor 1-ε that w' has in the jerk
/// is left out. Where Ω₂ = 10 Ω₁ it is at most 0.1 % too large, of jerk 5.3 %. Units: mm, rad, s.
/// Source: docs/motion.md, eq. 8.3. Proof: tests/unit/planner/rate_room_test.cpp.
class RateRoom {
 public:
  /// share · own + slope · below <= limit, the tightest of these at one place.
  struct Line {
    double share = 1, slope = 0;
  };

  [[nodiscard]] static RateRoom of_acceleration(double slope, double curvature) noexcept {
    const double end = end_of(slope, curvature);
    return {slope, curvature, end, 2 - end};
  }
  [[nodiscard]] static RateRoom of_jerk(double slope, double curvature) noexcept {
    const double end = end_of(slope, curvature);
    return {slope, curvature, end, 3 - 3 * end};
  }

  /// Largest value at any rate.
  [[nodiscard]] double largest(double own, double below) const noexcept {
    const double rise = root_ * below, fall = 2 * bend_ * own;  // e = √ε is best at rise / fall
    if (rise < fall * end_) return own + 0.5 * rise * rise / fall;
    return share_ * own + slope_ * below;
  }

  /// Largest `own` with largest(own, below) <= limit; negative: there is none.
  [[nodiscard]] double within(double limit, double below) const noexcept {
    const double rise = root_ * below;
    if (!(rise * turn_ < limit)) return (limit - slope_ * below) / share_;
    return 0.5 * (limit + std::sqrt(limit * limit - rise * rise / bend_));
  }

  /// The tangent of largest(own, below) = limit at `below`.
  [[nodiscard]] Line tangent(double limit, double below) const noexcept {
    const double rise = root_ * below, fall = 2 * bend_ * within(limit, below);
    if (!(rise < fall * end_)) return {share_, slope_};
    const double e = rise / fall;
    return {1 - bend_ * e * e, root_ * e};
  }

 private:
  RateRoom(double slope, double curvature, double end, double bend) noexcept
      : slope_(slope),
        root_(std::sqrt(2 * curvature)),
        end_(std::sqrt(end)),
        bend_(bend),
        share_(1 - bend * end),
        turn_(0.5 / (bend * end_) + 0.5 * end_) {}

  /// ε₁. 0: the curvature is small, and |w'| = Ω₁ is taken for possible at w = 1.
  [[nodiscard]] static double end_of(double slope, double curvature) noexcept {
    return curvature > slope * slope ? slope * slope / (2 * curvature) : 0;
  }

  double slope_, root_;
  double end_;    ///< √ε₁
  double bend_;   ///< c
  double share_;  ///< 1 - cε₁
  double turn_;   ///< limit over √(2Ω₂) below, above which the best ε is less than ε₁
};

}  // namespace meridian
