// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "meridian/kinematics/machine_model.hpp"
#include "service/dds/messages.hpp"
#include "service/drives/cia402.hpp"
#include "service/drives/homing_search.hpp"
#include "service/drives/servo.hpp"

namespace meridian::drives {

/// What the group passes to a drive for one period.
struct DriveInput {
  bool is_new = false;         ///< a setpoint came since the last period
  bool is_enabled = false;     ///< it asks to be followed
  bool is_fault_stop = false;  ///< it is of a FaultStop
  double position = 0, velocity = 0;
  double elapsed_s = 0;     ///< since the setpoint before it
  int periods_without = 0;  ///< periods since the newest setpoint, lost ones too
  int bridge_cycles = 3;    ///< so many are bridged by the velocity
  double bridged_s = 0;     ///< what of this step the bridge still covers; 0 with a new setpoint
};

/// One simulated servo drive in cyclic synchronous position mode or homing mode: CiA 402 states,
/// servo lag, following error, the check of each setpoint, and the watchdog that bridges missing
/// setpoints by the sent velocity, then ramps down and goes to fault: nobody's drive stays in
/// operation. Time is the argument of work(). Proof: tests/unit/drives/drive_test.cpp.
class Drive {
 public:
  /// It stands at `home`, or beside it without a reference (HomingPlan).
  Drive(const JointSpec& spec, const ServoLag& lag, const HomingPlan& homing = {});

  /// Objects 6040h and 6060h; a mode that it does not know changes nothing.
  void take_controlword(std::uint16_t controlword,
                        std::uint8_t mode = dds::kCyclicPositionMode) noexcept;
  /// One period of `dt_s`.
  void work(const DriveInput& input, double dt_s) noexcept;
  /// The drive finds something wrong with itself: it ramps down and goes to fault.
  void fail(std::uint16_t error) noexcept;
  /// The shaft is stuck: the position stays as it is while it is blocked.
  void block_shaft(bool is_blocked) noexcept { is_blocked_ = is_blocked; }
  /// Without power the drive is in switch on disabled, whatever the controlword asks for.
  void set_power(bool has_power) noexcept;
  /// Follows with another time constant than its own; nothing: with its own.
  void set_time_constant(std::optional<double> time_constant_s) noexcept {
    sick_time_constant_s_ = time_constant_s;
  }

  [[nodiscard]] DriveState state() const noexcept { return state_; }
  [[nodiscard]] std::uint16_t statusword() const noexcept;
  [[nodiscard]] std::uint16_t error() const noexcept { return error_; }
  [[nodiscard]] std::uint8_t mode() const noexcept { return mode_; }
  [[nodiscard]] bool is_referenced() const noexcept { return homing_.is_referenced(); }
  [[nodiscard]] double position() const noexcept { return servo_.position; }
  [[nodiscard]] double velocity() const noexcept { return servo_.velocity; }
  [[nodiscard]] double following_error() const noexcept { return target_ - servo_.position; }

 private:
  void take_mode(std::uint8_t mode) noexcept;
  void take_target(const DriveInput& input, double dt_s) noexcept;
  void refuse(std::uint16_t error, double dt_s) noexcept;
  void search(const DriveInput& input, double dt_s) noexcept;
  void miss_setpoints(double dt_s) noexcept;
  void ramp_down(double dt_s) noexcept;

  JointSpec spec_;
  JointLimits limits_;
  ServoLag lag_;
  DriveState state_ = DriveState::kSwitchOnDisabled;
  std::uint16_t controlword_ = 0;
  std::uint16_t error_ = kErrorNone;
  std::uint8_t mode_ = dds::kCyclicPositionMode;
  HomingSearch homing_;
  ServoState servo_;
  double target_ = 0, target_velocity_ = 0;
  double accepted_ = 0;        ///< position of the last setpoint that it follows
  bool is_following_ = false;  ///< took an enabled setpoint since operation was enabled
  bool is_blocked_ = false, has_power_ = true;
  std::optional<double> sick_time_constant_s_;
};

}  // namespace meridian::drives
