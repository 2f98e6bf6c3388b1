// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/csp/following_axis.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "service/drives/kit/setpoint_check.hpp"

namespace meridian::drive {

FollowingAxis::FollowingAxis(const JointSpec& spec, const HomingSpec& homing, double position)
    : spec_(spec),
      limits_(spec.limits),
      homing_(homing, spec.limits.fault_acceleration),
      position_(position),
      target_(position) {
  reading_.position = position;
}

void FollowingAxis::hold() noexcept {
  target_ = position_;
  target_velocity_ = 0;
  homing_.stand();
}

void FollowingAxis::take_mode(std::uint8_t mode) noexcept {
  if (mode == mode_ || (mode != dds::kCyclicPositionMode && mode != dds::kHomingMode)) return;
  mode_ = mode;
  hold();
  is_following_ = false;
}

void FollowingAxis::take_controlword(std::uint16_t controlword, std::uint8_t mode) noexcept {
  const DriveState before = state_;
  take_mode(mode);
  state_ = next_state(state_, controlword, controlword_);
  controlword_ = controlword;
  if (before == DriveState::kFault && state_ != DriveState::kFault) {
    is_reset_asked_ = true;
    is_reset_waiting_ = reading_.error != kErrorNone;
    if (is_reset_waiting_) state_ = DriveState::kFault;  // until the hardware has cleared its own
  }
  if (!has_power_) state_ = DriveState::kSwitchOnDisabled;
  if (before == DriveState::kFault && state_ != DriveState::kFault) error_ = kErrorNone;
  const bool is_entering =
      state_ == DriveState::kOperationEnabled && before != DriveState::kOperationEnabled;
  if (is_entering) {
    hold();
    is_following_ = false;
  }
  const bool may_search = state_ == DriveState::kOperationEnabled && mode_ == dds::kHomingMode;
  homing_.ask(may_search && (controlword & 0x10U) != 0);
}

void FollowingAxis::set_power(bool has_power) noexcept {
  has_power_ = has_power;
  if (!has_power_) state_ = DriveState::kSwitchOnDisabled;
}

void FollowingAxis::fail(std::uint16_t error) noexcept {
  if (state_ == DriveState::kFault || state_ == DriveState::kFaultReaction) return;
  error_ = error;
  state_ = DriveState::kFaultReaction;
  const double max = limits_.velocity > 0 ? limits_.velocity : INFINITY;
  target_velocity_ = std::clamp(velocity_, -max, max);  // whatever jump it was to follow
}

Output FollowingAxis::lead(const AxisInput& input, double dt_s, int axis,
                           Hardware& hardware) noexcept {
  switch (state_) {
    case DriveState::kOperationEnabled:
      is_on_ = true;
      if (input.is_new) slept_left_s_ = input.bridge_s;
      if (mode_ == dds::kHomingMode) {
        search(input, dt_s, axis, hardware);
      } else {
        take_target(input, dt_s);
      }
      break;
    case DriveState::kQuickStop:
      is_on_ = true;
      ramp_down(spend_lost(input.slept_s), dt_s);
      break;
    case DriveState::kFaultReaction:  // on where it was on
      ramp_down(spend_lost(input.slept_s), dt_s);
      if (target_velocity_ == 0) state_ = DriveState::kFault;
      break;
    default:  // the brake holds
      is_on_ = false;
      hold();
      break;
  }
  return output();
}

Output FollowingAxis::output() const noexcept {
  Output out;
  out.is_on = is_on_;
  out.position = offset_ == 0 ? target_ : target_ - offset_;
  out.velocity = is_on_ ? target_velocity_ : 0;
  out.is_homing =
      state_ == DriveState::kOperationEnabled && homing_.is_searching() && homing_.is_by_drive();
  out.is_reset = is_reset_asked_;
  return out;
}

double FollowingAxis::named(double position) const noexcept {
  return offset_ == 0 ? position : position + offset_;
}

void FollowingAxis::see(const Reading& reading, double dt_s) noexcept {
  const bool is_number = std::abs(reading.position) < kBeyondAnything;
  const double before = position_;
  reading_ = reading;
  if (is_number) position_ = named(reading.position);
  const bool has_velocity = std::abs(reading.velocity) < kBeyondAnything;
  velocity_ = has_velocity ? reading.velocity : dt_s > 0 ? (position_ - before) / dt_s : 0;
  if (reading.has_power != has_power_) set_power(reading.has_power);
  end_reset();
  if (reading.error != kErrorNone) fail(reading.error);
  if (!is_number) fail(kErrorNoPosition);
  const bool is_lagging =
      limits_.following_error > 0 && std::abs(following_error()) > limits_.following_error;
  if (is_lagging && state_ == DriveState::kOperationEnabled) fail(kErrorFollowing);
}

void FollowingAxis::end_reset() noexcept {
  if (!is_reset_asked_ || reading_.error != kErrorNone) return;
  is_reset_asked_ = false;
  const bool was_waiting = std::exchange(is_reset_waiting_, false);
  if (!was_waiting || state_ != DriveState::kFault) return;
  state_ = DriveState::kSwitchOnDisabled;
  error_ = kErrorNone;
}

void FollowingAxis::take_target(const AxisInput& input, double dt_s) noexcept {
  if (input.is_new) {
    if (input.is_enabled) {
      const std::uint16_t error =
          check_setpoint(spec_, {.position = input.position,
                                 .velocity = input.velocity,
                                 .is_fault_stop = input.is_fault_stop,
                                 .has_begun = is_following_,
                                 .from = is_following_ ? accepted_ : position_,
                                 .elapsed_s = input.elapsed_s,
                                 .is_referenced = is_referenced()});
      if (error != kErrorNone) return refuse(error, input, dt_s);
      target_ = accepted_ = input.position;
    }
    is_following_ = input.is_enabled;
    target_velocity_ = is_following_ ? input.velocity : 0;
    return;
  }
  if (input.periods_without > input.bridge_cycles) return miss_setpoints(input, dt_s);
  if (is_following_) {
    const double beyond_s = input.slept_s - spend_lost(input.slept_s);
    ramp_down(input.bridged_s - beyond_s, dt_s);
  }
}

/// In homing mode setpoints lead nowhere, but a service that sends none any more is gone.
void FollowingAxis::search(const AxisInput& input, double dt_s, int axis,
                           Hardware& hardware) noexcept {
  if (input.periods_without > input.bridge_cycles) return miss_setpoints(input, dt_s);
  Reading reading = reading_;
  reading.index_position = named(reading_.index_position);
  const HomingView view{false, target_, position_, dt_s};
  const HomingStep step = homing_.work(view, reading, axis, hardware);
  const double farthest =
      limits_.velocity > 0 ? limits_.velocity * (1 + kVelocityMargin) * dt_s : INFINITY;
  const bool is_led = !homing_.is_by_drive();
  if (is_led && !(std::abs(step.target - target_) <= farthest + kStepMargin)) {
    return refuse(kErrorSetpointStep, input, dt_s);
  }
  target_ = step.target + step.shift;
  target_velocity_ = step.velocity;
  position_ += step.shift;
  if (homing_.owns_names()) offset_ += step.shift;
}

void FollowingAxis::miss_setpoints(const AxisInput& input, double dt_s) noexcept {
  refuse(kErrorSetpointsStopped, input, dt_s);
}

/// Goes on with the last velocity that it accepted, and ramps that down.
void FollowingAxis::refuse(std::uint16_t error, const AxisInput& input, double dt_s) noexcept {
  error_ = error;
  state_ = DriveState::kFaultReaction;
  homing_.ask(false);
  ramp_down(spend_lost(input.slept_s), dt_s);
}

/// How much of the lost time it goes on at its velocity: one bridge in a whole stop, so that a host
/// that loses periods again and again does not lengthen the stop each time.
double FollowingAxis::spend_lost(double slept_s) noexcept {
  const double level_s = std::min(slept_s, slept_left_s_);
  slept_left_s_ -= level_s;
  return level_s;
}

/// Goes on at the velocity for `level_s`, and slows down for the rest of the period with the
/// joint's FaultStop acceleration; without one it stands at once.
void FollowingAxis::ramp_down(double level_s, double dt_s) noexcept {
  const double acceleration =
      limits_.fault_acceleration > 0 ? limits_.fault_acceleration : INFINITY;
  const double before = target_velocity_, speed = std::abs(before);
  const double level = std::min(level_s, dt_s), rest_s = speed / acceleration;
  const bool stops = dt_s - level >= rest_s && dt_s > level;
  const double ramp = stops ? rest_s : dt_s - level;
  target_velocity_ =
      stops ? 0 : std::copysign(speed - (ramp > 0 ? acceleration * ramp : 0), before);
  target_ += before * level + 0.5 * (before + target_velocity_) * ramp;
}

std::uint16_t FollowingAxis::statusword() const noexcept {
  const bool is_waiting = state_ == DriveState::kOperationEnabled && !reading_.is_ready;
  std::uint16_t word = drive::statusword(is_waiting ? DriveState::kSwitchedOn : state_);
  if (mode_ == dds::kHomingMode) return word | homing_.statusword_bits();
  if (state_ == DriveState::kOperationEnabled && is_following_) word |= kStatusFollows;
  if (error_ == kErrorFollowing) word |= kStatusFollowingError;
  return word;
}

}  // namespace meridian::drive
