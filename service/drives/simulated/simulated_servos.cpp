// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/simulated_servos.hpp"

namespace meridian::drives {

namespace {

constexpr double kSearchShare = 0.1;  ///< of the velocity limit

/// How far from home a drive without a reference stands, inside travel.
[[nodiscard]] double away_from_home(const JointSpec& spec) noexcept {
  const double offset = spec.is_rotary ? 0.05 : 5.0;
  const bool has_room = spec.is_endless || spec.home + offset <= spec.limits.travel_max;
  return has_room ? offset : -offset;
}

}  // namespace

SimulatedServo::SimulatedServo(const JointSpec& spec, const HomingPlan& plan)
    : servo{plan.is_referenced ? spec.home : 0, 0},
      search(plan, spec.home, plan.is_referenced ? 0 : spec.home + away_from_home(spec),
             kSearchShare * spec.limits.velocity) {}

drive::HomingSpec homing_of(const HomingPlan& plan) {
  drive::HomingSpec spec;
  spec.method = drive::HomingMethod::kByCallback;
  spec.is_referenced = plan.is_referenced;
  return spec;
}

drive::Reading SimulatedServos::read(int axis) noexcept {
  const SimulatedServo& one = servos_[static_cast<std::size_t>(axis)];
  drive::Reading reading;
  reading.position = one.servo.position;
  reading.velocity = one.servo.velocity;
  reading.has_power = one.has_power;
  return reading;
}

void SimulatedServos::write(int axis, const drive::Output& output) noexcept {
  servos_[static_cast<std::size_t>(axis)].output = output;
}

void SimulatedServos::exchange(double dt_s) noexcept {
  for (SimulatedServo& one : servos_) {
    if (!one.output.is_on || one.is_blocked) {
      one.servo.velocity = 0;
      continue;
    }
    const ServoLag lag{lag_.kind, one.sick_time_constant_s.value_or(lag_.time_constant_s)};
    one.servo = follow(one.servo, one.output.position, dt_s, lag);
  }
}

drive::Probe SimulatedServos::probe() noexcept {
  if (!probe_) return drive::Probe::kNone;
  JointVector drives{};
  for (std::size_t i = 0; i < servos_.size(); ++i) drives[i] = servos_[i].servo.position;
  return probe_->distance(drives) > 0 ? drive::Probe::kFree : drive::Probe::kContact;
}

drive::HomingStep SimulatedServos::home(int axis, const drive::HomingView& view) noexcept {
  SimulatedServo& one = servos_[static_cast<std::size_t>(axis)];
  const drive::HomingStep step = one.search.work(view);
  one.servo.position += step.shift;
  return step;
}

}  // namespace meridian::drives
