// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/pole_time.hpp"

#include "meridian/kinematics/kinematics.hpp"

namespace meridian {

Jet<3> free_at(const FreeQuintic& values, double t, double h) noexcept {
  FreeQuintic level = values;
  std::array<double, 4> out{};  // by the share
  for (std::size_t left = 6; left > 1; --left) {
    if (left == 4) out[3] = 60 * (level[3] - 3 * level[2] + 3 * level[1] - level[0]);
    if (left == 3) out[2] = 20 * (level[2] - 2 * level[1] + level[0]);
    if (left == 2) out[1] = 5 * (level[1] - level[0]);
    for (std::size_t n = 0; n + 1 < left; ++n) level[n] += (level[n + 1] - level[n]) * t;
  }
  return Jet<3>::from_derivatives({level[0], out[1] / h, out[2] / (h * h), out[3] / (h * h * h)});
}

double slowness(const MachineModel& model, const BandSpan& span, const Pose<Jet<3>>& pose,
                const Joints<Jet<3>>& q) noexcept {
  double tip = 0;
  for (int i = 0; i < 3; ++i) tip += pose.tip[i].derivative(1) * pose.tip[i].derivative(1);
  double most = std::max(std::sqrt(tip) / span.feed_mm_per_s, 1 / span.u_speed_mm_per_s);
  for (int i = 0; i < model.joint_count; ++i) {
    const JointLimits& limits = model.joints[i].limits;
    most = std::max(most, std::abs(q[i].derivative(1)) / limits.velocity);
    const double bend = std::abs(q[i].derivative(2)) / limits.acceleration;
    if (bend > most * most) most = std::sqrt(bend);
    const double twist = std::abs(q[i].derivative(3)) / limits.jerk;
    if (twist > most * most * most) most = std::cbrt(twist);
  }
  return most;
}

OutsideTime::OutsideTime(const PoleTask& task, const PolePlace& place, double side) noexcept
    : reach_(place.reach) {
  const double core = side < 0 ? place.core_begin : place.core_end;
  JointVector joints = place.joints;
  for (int k = 0; k < kNodes; ++k) {
    const double far = distance(k), near = distance(k + 1);
    const double u = core + side * 0.5 * (far + near);
    const BandSpan& span = task.spans.span_at(u);
    const auto pose = pose_of<Jet<3>>(span, u);
    const auto at = solve(task.model, task.tool_length_mm, pose, place.branch, joints);
    const bool is_there = at.status != SolveStatus::kUnreachable;
    for (int i = 0; is_there && i < task.model.joint_count; ++i) joints[i] = value_of(at.q[i]);
    free_[k] = joints[free_joint(task.model)];
    const double time = (far - near) * slowness(task.model, span, pose, at.q);
    sum_[k + 1] = sum_[k] + (std::isfinite(time) ? time : 0);
  }
}

double find_time(const PoleTask& task, std::span<const PoleZone> zones, int branch, double begin,
                 double end) noexcept {
  constexpr double kPartsOfSpan = 6, kMostParts = 2048, kLeastPart_mm = 1e-4;
  const double least_step = std::max((end - begin) / kMostParts, kLeastPart_mm);
  std::size_t n = 0;
  double sum = 0;
  for (double u = begin, next = begin; u < end; u = next) {
    next = std::min(u + std::max(task.spans.span_at(u).length / kPartsOfSpan, least_step), end);
    const double middle = 0.5 * (u + next);
    for (; n < zones.size() && zones[n].end <= middle; ++n) branch = zones[n].branch_after;
    const BandSpan& span = task.spans.span_at(middle);
    const auto pose = pose_of<Jet<3>>(span, middle);
    auto at = solve(task.model, task.tool_length_mm, pose, branch, {});
    if (n < zones.size() && zones[n].begin < middle) {
      const double h = zones[n].end - zones[n].begin;
      const Jet<3> free = free_at(zones[n].free, (middle - zones[n].begin) / h, h);
      at = solve_held(task.model, task.tool_length_mm, pose, free);
    }
    const double time = (next - u) * slowness(task.model, span, pose, at.q);
    sum += std::isfinite(time) ? time : 0;
  }
  return sum;
}

}  // namespace meridian
