// SPDX-License-Identifier: Apache-2.0
#include "service/analysis/simulate/limit_meter.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/kinematics/kinematics.hpp"

namespace meridian::simulate {

void LimitMeter::add(const CycleRecord& record, double tool_length_mm, double feed_mm_per_s,
                     LimitShares& shares) {
  std::rotate(samples_.begin(), samples_.begin() + 1, samples_.end());
  samples_.back() = limited_of(model_, record.joints, record.setpoint.position);
  known_ = record.setpoint.cycle == last_cycle_ + 1 ? std::min(known_ + 1, 4) : 1;
  last_cycle_ = record.setpoint.cycle;
  const Vector3 tip = forward(model_, tool_length_mm, record.joints).tip;
  const Vector3 step = tip - tip_;
  tip_ = tip;
  const bool is_moving = (record.setpoint.flags & kSetpointMoving) != 0;
  if (known_ < 4 || !is_moving || record.state != State::kRunning) return;
  const double period = static_cast<double>(model_.cycle_ns) * 1e-9;
  double largest = 0.5;
  std::uint64_t* nearest = &shares.none;
  const auto weigh = [&](double use, std::uint64_t& count) {
    if (!(use > largest)) return;
    largest = use;
    nearest = &count;
  };
  if (feed_mm_per_s > 0) weigh(step.norm() / (period * feed_mm_per_s), shares.feed);
  for (int i = 0; i < limited_count(model_); ++i) {
    const auto q = [&](int back) { return samples_[3 - back][i]; };
    const JointLimits& limits = limited_spec(model_, i).limits;
    auto& counts = shares.joints[i];
    weigh(std::abs(q(0) - q(1)) / (period * limits.velocity), counts[0]);
    weigh(std::abs(q(0) - 2 * q(1) + q(2)) / (period * period * limits.acceleration), counts[1]);
    weigh(std::abs(q(0) - 3 * q(1) + 3 * q(2) - q(3)) / (period * period * period * limits.jerk),
          counts[2]);
  }
  ++*nearest;
  ++shares.cycles;
}

}  // namespace meridian::simulate
