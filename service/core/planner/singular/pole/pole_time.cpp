// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/pole/pole_time.hpp"

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
  double largest = std::max(std::sqrt(tip) / span.feed_mm_per_s, 1 / span.u_speed_mm_per_s);
  for (int i = 0; i < model.joint_count; ++i) {
    const JointLimits& limits = model.joints[i].limits;
    largest = std::max(largest, std::abs(q[i].derivative(1)) / limits.velocity);
    const double bend = std::abs(q[i].derivative(2)) / limits.acceleration;
    if (bend > largest * largest) largest = std::sqrt(bend);
    const double twist = std::abs(q[i].derivative(3)) / limits.jerk;
    if (twist > largest * largest * largest) largest = std::cbrt(twist);
  }
  return largest;
}

}  // namespace meridian
