// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/feed_limits.hpp"

#include <algorithm>

namespace meridian {

FeedLimits make_feed_limits(const MachineModel& model, const RateReserve& reserve) noexcept {
  constexpr double kLargestShare = 0.5;  // of the jerk that the reserve may take
  FeedLimits out;
  out.count = limited_count(model);
  out.slope = reserve.slope;
  out.curvature = reserve.curvature;
  for (int i = 0; i < out.count; ++i) {
    const JointLimits& limits = limited_spec(model, i).limits;
    // What a share of velocity and acceleration leaves of the jerk: no less than in proportion.
    const auto jerk_beside = [&](double share) {
      return out.jerk_room().within(limits.jerk - share * reserve.curvature * limits.velocity,
                                    3 * share * limits.acceleration);
    };
    const double wanted = limits.jerk - jerk_beside(1);
    const double share = std::min(1.0, kLargestShare * limits.jerk / std::max(wanted, 1e-300));
    out.velocity[i] = share * limits.velocity;
    out.acceleration[i] = share * limits.acceleration;
    out.jerk[i] = jerk_beside(share);
    out.full_jerk[i] = limits.jerk;
  }
  return out;
}

}  // namespace meridian
