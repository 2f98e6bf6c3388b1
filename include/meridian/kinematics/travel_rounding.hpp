// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"

namespace meridian {

/// How far beyond the end of its travel a joint may be asked for by rounded numbers: digits of a
/// file, lengthened by the machine's own lever arms. Units: mm, rad.
inline constexpr double kTravelRounding_mm = 1e-3;
inline constexpr double kTravelRounding_rad = units::rad_from_deg(1e-4);

/// Where joints are beyond the ends of their travel by rounding alone: the pose of the same joints
/// taken to those ends, and by 1e-9 (mm, rad) inside. Nothing where no joint is outside, or one is
/// farther outside than that. Drives of a stage are not rounded. RT: I/O only.
[[nodiscard]] inline std::optional<ToolPose> taken_into_travel(const MachineModel& model,
                                                               double tool_length_mm,
                                                               JointVector q) noexcept {
  constexpr double kInside = 1e-9;
  bool is_moved = false;
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& joint = model.joints[i];
    if (is_inside_travel(joint, q[i], kInside)) continue;
    const double margin = joint.is_rotary ? kTravelRounding_rad : kTravelRounding_mm;
    if (!is_inside_travel(joint, q[i], margin)) return std::nullopt;
    q[i] = std::clamp(q[i], joint.limits.travel_min + kInside, joint.limits.travel_max - kInside);
    is_moved = true;
  }
  if (!is_moved || first_joint_outside_travel(model, q, kInside) >= 0) return std::nullopt;
  return forward(model, tool_length_mm, q);
}

/// The same for a pose: on the first branch that is inside travel, or outside by rounding alone.
/// `reference`: where to look for joints that no pose decides. RT: I/O only. Proof:
/// tests/unit/kinematics/travel_rounding_test.cpp.
[[nodiscard]] inline std::optional<ToolPose> taken_into_travel(
    const MachineModel& model, double tool_length_mm, const ToolPose& pose,
    const JointVector& reference) noexcept {
  for (int branch = 0; branch < branch_count(model); ++branch) {
    auto found = solve(model, tool_length_mm, pose, branch, reference);
    if (found.status == SolveStatus::kUnreachable) continue;
    wind_into_travel(model, reference, found.q);
    if (first_joint_outside_travel(model, found.q, 1e-9) < 0) return std::nullopt;
    if (auto taken = taken_into_travel(model, tool_length_mm, found.q)) return taken;
  }
  return std::nullopt;
}

}  // namespace meridian
