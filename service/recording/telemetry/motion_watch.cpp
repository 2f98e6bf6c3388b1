// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/motion_watch.hpp"

#include <cmath>

#include "meridian/geometry/jet.hpp"
#include "meridian/kinematics/kinematics.hpp"

namespace meridian::telemetry {

void MotionWatch::see(const CycleRecord& record, double tool_length_mm) noexcept {
  const JointVector velocity = joint_velocity_of(model_, record.joints, record.setpoint.velocity);
  Joints<Jet<1>> joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i] = Jet<1>::with_derivative(record.joints[i], velocity[i]);
  }
  const Pose<Jet<1>> pose = forward(model_, tool_length_mm, joints);
  feed_mm_per_s_ =
      std::hypot(pose.tip[0].derivative(1), pose.tip[1].derivative(1), pose.tip[2].derivative(1));

  consecutive_ = record.setpoint.cycle == last_cycle_ + 1 ? consecutive_ + 1 : 0;
  last_cycle_ = record.setpoint.cycle;
  check(limited_of(model_, velocity, record.setpoint.velocity),
        static_cast<double>(model_.cycle_ns) * 1e-9);
}

void MotionWatch::check(const LimitedVector& velocities, double period_s) noexcept {
  const auto take = [this](double share, int joint) {
    if (share <= largest_share_) return;
    largest_share_ = share;
    joint_ = joint;
  };
  for (int joint = 0; joint < limited_count(model_); ++joint) {
    const auto i = static_cast<std::size_t>(joint);
    const JointLimits& limits = limited_spec(model_, joint).limits;
    const double velocity = velocities[i];
    const double acceleration = (velocity - velocity_[i]) / period_s;
    take(std::abs(velocity) / limits.velocity, joint);
    if (consecutive_ >= 1) take(std::abs(acceleration) / limits.acceleration, joint);
    if (consecutive_ >= 2) {
      take(std::abs(acceleration - acceleration_[i]) / period_s / limits.jerk, joint);
    }
    acceleration_[i] = acceleration;
  }
  velocity_ = velocities;
}

void MotionWatch::reset() noexcept {
  largest_share_ = 0;
  joint_ = -1;
}

}  // namespace meridian::telemetry
