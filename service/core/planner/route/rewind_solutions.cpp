// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/route/rewind_solutions.hpp"

#include <algorithm>
#include <utility>

#include "meridian/kinematics/travel.hpp"
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

std::optional<JointVector> solve_other_branch(const MachineModel& model, double tool_length_mm,
                                              const ToolPose& pose, int branch,
                                              const JointVector& near) noexcept {
  auto other = solve(model, tool_length_mm, pose, branch == 0 ? 1 : 0, near);
  if (other.status != SolveStatus::kOk) return {};
  wind_into_travel(model, near, other.q);
  return other.q;
}

double room_of(const JointLimits& limits, double at, bool is_upwards) noexcept {
  const double below = at - limits.travel_min, above = limits.travel_max - at;
  const double after = is_upwards ? below : above;
  const double missing = 0.5 * kTurn_rad - after;
  return missing > 0 ? -missing : (is_upwards ? above : below);
}

}  // namespace meridian
