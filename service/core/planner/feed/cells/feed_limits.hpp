// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "meridian/kinematics/limited.hpp"
#include "meridian/planner/rate_limits.hpp"
#include "meridian/planner/rate_room.hpp"

namespace meridian {

/// How fast the cycle may change the rate of plan time while a plan of the feed runs; zero: never.
struct RateReserve {
  double slope = kRateSlope_per_s;
  double curvature = kRateCurvature_per_s2;
};

/// What a plan of the feed may use of every joint and drive of the stage: the machine's limits less
/// what the rate filter may add (RateRoom): with |q⃛| <= jerk besides, every run of the plan at a
/// rate in [0, 1] stays inside the machine's limits (docs/motion.md, eq. 8.3). Units: mm, rad, s.
struct FeedLimits {
  int count = 0;
  LimitedVector velocity{}, acceleration{}, jerk{};
  LimitedVector full_jerk{};        ///< the machine's
  double slope = 0, curvature = 0;  ///< of the rate, 1/s and 1/s²

  [[nodiscard]] RateRoom acceleration_room() const noexcept {
    return RateRoom::of_acceleration(slope, curvature);
  }
  [[nodiscard]] RateRoom jerk_room() const noexcept { return RateRoom::of_jerk(slope, curvature); }

  /// Jerk less what A and V may take of it, and no room for the rate beside.
  [[nodiscard]] FeedLimits without_rate() const noexcept {
    FeedLimits out = *this;
    out.full_jerk = jerk;
    out.slope = out.curvature = 0;
    return out;
  }

  /// Every limit times a share.
  [[nodiscard]] FeedLimits scaled(double share_v, double share_a, double share_j) const noexcept {
    FeedLimits out = *this;
    for (int i = 0; i < count; ++i) {
      out.velocity[i] *= share_v;
      out.acceleration[i] *= share_a;
      out.jerk[i] *= share_j;
      out.full_jerk[i] *= share_j;
    }
    return out;
  }
};

/// Where a machine's jerk is too small for the reserve beside full velocity and acceleration, the
/// plan uses less of those two, so that at least half of the jerk is left.
[[nodiscard]] FeedLimits make_feed_limits(const MachineModel& model,
                                          const RateReserve& reserve) noexcept;

}  // namespace meridian
