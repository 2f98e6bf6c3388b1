// SPDX-License-Identifier: Apache-2.0
#include "service/machine/scene/limit_shares.hpp"

#include <algorithm>
#include <cmath>

namespace meridian::scene {
namespace {

[[nodiscard]] std::array<double, 3> bounds_of(const JointLimits& limits, Bounds bounds) noexcept {
  const bool is_fault = bounds == Bounds::kOfFaultStop;
  return {limits.velocity, is_fault ? limits.fault_acceleration : limits.acceleration,
          is_fault ? limits.fault_jerk : limits.jerk};
}

}  // namespace

void LimitShares::add(const LimitedVector& positions, bool is_next, Bounds bounds) noexcept {
  const double rate = 1e9 / static_cast<double>(model_.cycle_ns);
  known_ = is_next ? std::min(known_ + 1, 3) : 0;
  std::array<LimitedVector, 3> now{positions, {}, {}};
  for (int i = 0; i < limited_count(model_); ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::array<double, 3> bound = bounds_of(limited_spec(model_, i).limits, bounds);
    double value = positions[at];
    for (int order = 0; order < known_; ++order) {
      const auto of = static_cast<std::size_t>(order);
      value = (value - before_[of][at]) * rate;
      if (of + 1 < now.size()) now[of + 1][at] = value;
      const double share = bound[of] > 0 ? std::abs(value) / bound[of] : 0;
      largest_[at][of] = std::max(largest_[at][of], share);
    }
  }
  before_ = now;
}

}  // namespace meridian::scene
