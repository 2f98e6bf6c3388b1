// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/rewind_solutions.hpp"

#include <algorithm>
#include <utility>

#include "meridian/kinematics/winding.hpp"

namespace meridian {
namespace {

bool is_better(const RewindSolution& a, const RewindSolution& b) noexcept {
  if (a.carries != b.carries) return a.carries > b.carries;
  return a.room != b.room ? a.room > b.room : a.time_s < b.time_s;
}

}  // namespace

void RewindSolutions::sort() noexcept {
  for (std::size_t n = 1; n < count_; ++n) {
    for (std::size_t k = n; k > 0 && is_better(solutions_[k], solutions_[k - 1]); --k) {
      std::swap(solutions_[k], solutions_[k - 1]);
    }
  }
}

double room_of(const JointLimits& limits, double at, bool is_upwards) noexcept {
  const double below = at - limits.travel_min, above = limits.travel_max - at;
  const double after = is_upwards ? below : above;
  const double missing = 0.5 * kTurn_rad - after;
  return missing > 0 ? -missing : (is_upwards ? above : below);
}

}  // namespace meridian
