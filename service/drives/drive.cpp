// SPDX-License-Identifier: Apache-2.0
#include "service/drives/drive.hpp"

#include <algorithm>
#include <cmath>

#include "service/drives/setpoint_check.hpp"

namespace meridian::drives {

namespace {

constexpr double kSearchShare = 0.1;  ///< of the velocity limit

/// How far from home a drive without a reference stands, inside travel.
[[nodiscard]] double away_from_home(const JointSpec& spec) noexcept {
  const double way = spec.is_rotary ? 0.05 : 5.0;
  const bool has_room = spec.is_endless || spec.home + way <= spec.limits.travel_max;
  return has_room ? way : -way;
}

}  // namespace

Drive::Drive(const JointSpec& spec, const ServoLag& lag, const HomingPlan& homing)
    : spec_(spec),
      limits_(spec.limits),
      lag_(lag),
      homing_(homing, spec.home, homing.is_referenced ? 0 : spec.home + away_from_home(spec),
              kSearchShare * spec.limits.velocity),
      servo_{homing.is_referenced ? spec.home : 0, 0},
      target_(servo_.position) {}

void Drive::take_mode(std::uint8_t mode) noexcept {
  if (mode == mode_ || (mode != dds::kCyclicPositionMode && mode != dds::kHomingMode)) return;
  mode_ = mode;
  target_ = servo_.position;
  target_velocity_ = 0;
  is_following_ = false;
}

void Drive::take_controlword(std::uint16_t controlword, std::uint8_t mode) noexcept {
  const DriveState before = state_;
  take_mode(mode);
  state_ = next_state(state_, controlword, controlword_);
  controlword_ = controlword;
  if (!has_power_) state_ = DriveState::kSwitchOnDisabled;
  if (before == DriveState::kFault && state_ != DriveState::kFault) error_ = kErrorNone;
  const bool is_entering =
      state_ == DriveState::kOperationEnabled && before != DriveState::kOperationEnabled;
  if (is_entering) {
    target_ = servo_.position;
    target_velocity_ = 0;
    is_following_ = false;
  }
  const bool may_search = state_ == DriveState::kOperationEnabled && mode_ == dds::kHomingMode;
  homing_.ask(may_search && (controlword & 0x10U) != 0);
}

void Drive::set_power(bool has_power) noexcept {
  has_power_ = has_power;
  if (!has_power_) state_ = DriveState::kSwitchOnDisabled;
}

void Drive::fail(std::uint16_t error) noexcept {
  if (state_ == DriveState::kFault || state_ == DriveState::kFaultReaction) return;
  error_ = error;
  state_ = DriveState::kFaultReaction;
  const double most = limits_.velocity > 0 ? limits_.velocity : INFINITY;
  target_velocity_ = std::clamp(servo_.velocity, -most, most);  // whatever jump it was to follow
}

void Drive::work(const DriveInput& input, double dt_s) noexcept {
  switch (state_) {
    case DriveState::kOperationEnabled:
      if (mode_ == dds::kHomingMode) {
        search(input, dt_s);
      } else {
        take_target(input, dt_s);
      }
      break;
    case DriveState::kQuickStop:
      ramp_down(dt_s);
      break;
    case DriveState::kFaultReaction:
      ramp_down(dt_s);
      if (target_velocity_ == 0) state_ = DriveState::kFault;
      break;
    default:  // the brake holds
      target_ = servo_.position;
      target_velocity_ = 0;
      servo_.velocity = 0;
      return;
  }
  if (is_blocked_) {
    servo_.velocity = 0;
  } else {
    const ServoLag lag{lag_.kind, sick_time_constant_s_.value_or(lag_.time_constant_s)};
    servo_ = follow(servo_, target_, dt_s, lag);
  }
  const bool is_lagging =
      limits_.following_error > 0 && std::abs(following_error()) > limits_.following_error;
  if (is_lagging && state_ == DriveState::kOperationEnabled) fail(kErrorFollowing);
}

void Drive::take_target(const DriveInput& input, double dt_s) noexcept {
  if (input.is_new) {
    if (input.is_enabled) {
      const std::uint16_t error =
          check_setpoint(spec_, {.position = input.position,
                                 .velocity = input.velocity,
                                 .is_fault_stop = input.is_fault_stop,
                                 .has_begun = is_following_,
                                 .from = is_following_ ? accepted_ : servo_.position,
                                 .elapsed_s = input.elapsed_s,
                                 .is_referenced = is_referenced()});
      if (error != kErrorNone) return refuse(error, dt_s);
      target_ = accepted_ = input.position;
    }
    is_following_ = input.is_enabled;
    target_velocity_ = is_following_ ? input.velocity : 0;
    return;
  }
  if (input.periods_without > input.bridge_cycles) return miss_setpoints(dt_s);
  if (is_following_) target_ += target_velocity_ * std::min(input.bridged_s, dt_s);
}

/// In homing mode setpoints lead nowhere, but a service that sends none any more is gone.
void Drive::search(const DriveInput& input, double dt_s) noexcept {
  if (input.periods_without > input.bridge_cycles) return miss_setpoints(dt_s);
  const double renamed = homing_.work(target_, servo_.position, dt_s);
  target_ += renamed;
  servo_.position += renamed;
}

void Drive::miss_setpoints(double dt_s) noexcept { refuse(kErrorSetpointsStopped, dt_s); }

/// Goes on with the last velocity that it accepted, and ramps that down.
void Drive::refuse(std::uint16_t error, double dt_s) noexcept {
  error_ = error;
  state_ = DriveState::kFaultReaction;
  homing_.ask(false);
  ramp_down(dt_s);
}

/// Slows the target down with the joint's FaultStop acceleration.
void Drive::ramp_down(double dt_s) noexcept {
  const double step =
      (limits_.fault_acceleration > 0 ? limits_.fault_acceleration : INFINITY) * dt_s;
  const double before = target_velocity_;
  target_velocity_ = std::copysign(std::max(0.0, std::abs(before) - step), before);
  if (target_velocity_ == 0) target_velocity_ = 0;  // no minus zero
  target_ += 0.5 * (before + target_velocity_) * dt_s;
}

std::uint16_t Drive::statusword() const noexcept {
  std::uint16_t word = drives::statusword(state_);
  if (mode_ == dds::kHomingMode) return word | homing_.statusword_bits();
  if (state_ == DriveState::kOperationEnabled && is_following_) word |= kStatusFollows;
  if (error_ == kErrorFollowing) word |= kStatusFollowingError;
  return word;
}

}  // namespace meridian::drives
