// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_travel.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/path/pose_at.hpp"
#include "service/core/planner/feed/cells/joint_cells.hpp"
#include "service/core/planner/singular/pole/pole_bounds.hpp"

namespace meridian {
namespace {

constexpr double kMaxStep_mm = 0.5;

}  // namespace

RouteAfter follow_after(const PoleTask& task, const PolePass& pass, double begin,
                        const JointVector& joints, int branch) noexcept {
  const int free = redundant_joint(task.model);
  JointVector last = joints;
  double step = kMaxStep_mm;
  for (double u = begin; u < pass.known_end;) {
    const double next = std::min(pass.known_end, u + step);
    const BandSpan& span = task.spans.span_at(next);
    const ToolPose pose = pose_on(span.c, std::clamp(next - span.u0, 0.0, span.length));
    const bool is_behind = next > pass.end;
    if (is_behind && pole_distance(task.model, pose.axis) < kOtherTolerances * task.tolerance_rad) {
      return {true, false, last[free]};
    }
    const auto at = solve(task.model, task.tool_length_mm, pose, branch, last);
    if (at.status == SolveStatus::kUnreachable) return {};
    if (std::abs(at.q[free] - last[free]) > kMaxFollowed_rad && step > kMinFollowed_mm) {
      step *= 0.5;
      continue;
    }
    if (first_joint_outside_travel(task.model, at.q, kTravelMargin) >= 0) return {};
    last = at.q;
    u = next;
    step = std::min(2 * step, kMaxStep_mm);
  }
  return {true, true, last[free]};
}

}  // namespace meridian
