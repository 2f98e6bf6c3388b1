// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "meridian/drive_hardware.hpp"
#include "meridian/kinematics/machine_model.hpp"
#include "service/drives/kit/csp/cia402.hpp"
#include "service/drives/kit/csp/homing_run.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::drive {

/// What the group passes to an axis for one period.
struct AxisInput {
  bool is_new = false;         ///< a setpoint came since the last period
  bool is_enabled = false;     ///< it asks to be followed
  bool is_fault_stop = false;  ///< it is of a FaultStop
  double position = 0, velocity = 0;
  double elapsed_s = 0;     ///< since the setpoint before it
  int periods_without = 0;  ///< periods since the newest setpoint, lost ones too
  int bridge_cycles = 3;    ///< so many are bridged by the velocity
  double bridged_s = 0;     ///< what of this step the bridge covers; 0 with a new setpoint
  double slept_s = 0;       ///< of it, lost periods: the motor went on at the velocity of before
  double bridge_s = 0;      ///< one bridge: so much of a stop may be lost periods
};

/// One axis in cyclic synchronous position mode or homing mode: CiA 402 states, following error,
/// the check of each setpoint, and the watchdog that bridges missing setpoints by the sent
/// velocity, then ramps down and goes to fault: nobody's drive stays in operation. A period is
/// lead(), the hardware's exchange, see(). Time is an argument. Proof:
/// tests/unit/drive_kit/following_axis_test.cpp, tests/unit/simulated_drives/drive_test.cpp.
class FollowingAxis {
 public:
  /// It stands at `position`.
  FollowingAxis(const JointSpec& spec, const HomingSpec& homing, double position);

  /// Objects 6040h and 6060h; a mode that it does not know changes nothing.
  void take_controlword(std::uint16_t controlword,
                        std::uint8_t mode = dds::kCyclicPositionMode) noexcept;
  /// First half of a period: where to. `axis`: its number for the hardware.
  [[nodiscard]] Output lead(const AxisInput& input, double dt_s, int axis,
                            Hardware& hardware) noexcept;
  /// Second half of a period: where it is.
  void see(const Reading& reading, double dt_s) noexcept;
  /// Something is wrong with the drive: it ramps down and goes to fault.
  void fail(std::uint16_t error) noexcept;
  /// Without power the drive is in switch on disabled, whatever the controlword asks for.
  void set_power(bool has_power) noexcept;

  [[nodiscard]] DriveState state() const noexcept { return state_; }
  [[nodiscard]] std::uint16_t statusword() const noexcept;
  [[nodiscard]] std::uint16_t error() const noexcept { return error_; }
  [[nodiscard]] std::uint8_t mode() const noexcept { return mode_; }
  [[nodiscard]] bool is_referenced() const noexcept { return homing_.is_referenced(); }
  [[nodiscard]] double position() const noexcept { return position_; }
  [[nodiscard]] double velocity() const noexcept { return velocity_; }
  [[nodiscard]] double following_error() const noexcept { return target_ - position_; }

 private:
  void take_mode(std::uint8_t mode) noexcept;
  void take_target(const AxisInput& input, double dt_s) noexcept;
  void refuse(std::uint16_t error, const AxisInput& input, double dt_s) noexcept;
  void search(const AxisInput& input, double dt_s, int axis, Hardware& hardware) noexcept;
  void miss_setpoints(const AxisInput& input, double dt_s) noexcept;
  [[nodiscard]] double spend_lost(double slept_s) noexcept;
  void ramp_down(double level_s, double dt_s) noexcept;
  void hold() noexcept;
  void end_reset() noexcept;
  [[nodiscard]] double named(double position) const noexcept;
  [[nodiscard]] Output output() const noexcept;

  JointSpec spec_;
  JointLimits limits_;
  DriveState state_ = DriveState::kSwitchOnDisabled;
  std::uint16_t controlword_ = 0;
  std::uint16_t error_ = kErrorNone;
  std::uint8_t mode_ = dds::kCyclicPositionMode;
  HomingRun homing_;
  Reading reading_;  ///< the newest
  double position_, velocity_ = 0;
  double offset_ = 0;  ///< of HomingMethod::kByIndex: what positions are called more
  double target_, target_velocity_ = 0;
  double slept_left_s_ = 0;    ///< of the bridge that a stop may lose
  double accepted_ = 0;        ///< position of the last setpoint that it follows
  bool is_following_ = false;  ///< took an enabled setpoint since operation was enabled
  bool has_power_ = true;
  bool is_on_ = false;  ///< the power stage is told to be on
  bool is_reset_asked_ = false, is_reset_waiting_ = false;
};

}  // namespace meridian::drive
