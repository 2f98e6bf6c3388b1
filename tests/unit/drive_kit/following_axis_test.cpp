// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/csp/following_axis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>

#include "unit/drive_kit/scripted_hardware.hpp"

namespace meridian::drive {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kVelocity = 100;  // mm/s

JointSpec spec() {
  JointSpec joint;
  joint.limits.travel_min = -500;
  joint.limits.travel_max = 500;
  joint.limits.velocity = 300;
  joint.limits.following_error = 5;
  joint.limits.fault_acceleration = 5000;
  return joint;
}

class Following : public testing::Test {
 protected:
  void words(std::initializer_list<std::uint16_t> controlwords) {
    for (const std::uint16_t word : controlwords) axis_.take_controlword(word);
  }
  void enable() { words({0x06, 0x07, 0x0F}); }
  void period(const AxisInput& input) {
    motors_.write(0, axis_.lead(input, kPeriod_s, 0, motors_));
    motors_.exchange(kPeriod_s);
    axis_.see(motors_.read(0), kPeriod_s);
  }
  void setpoint(double position, double velocity = 0) {
    period({.is_new = true,
            .is_enabled = true,
            .position = position,
            .velocity = velocity,
            .elapsed_s = kPeriod_s});
  }
  void nothing(int periods_without) {
    period({.periods_without = periods_without, .bridged_s = periods_without <= 3 ? kPeriod_s : 0});
  }
  [[nodiscard]] const Output& output() const { return motors_.outputs[0]; }
  [[nodiscard]] Reading& reading() { return motors_.readings[0]; }
  /// At kVelocity, at `position` in the end.
  void run_to(double position) {
    const double begin = position - 20 * kVelocity * kPeriod_s;
    reading().position = begin;
    axis_.see(reading(), kPeriod_s);
    enable();
    for (int n = 0; n <= 20; ++n) setpoint(begin + n * kVelocity * kPeriod_s, kVelocity);
  }

  test::ScriptedHardware motors_;
  FollowingAxis axis_{spec(), {}, 0};
};

TEST_F(Following, ThePowerStageIsOnWhereOperationIsEnabledAlone) {
  for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x06, 0x07}) {
    words({word});
    setpoint(0);
    EXPECT_FALSE(output().is_on) << word;
  }
  words({0x0F});
  setpoint(0);
  EXPECT_TRUE(output().is_on);
  words({0x07});
  nothing(1);
  EXPECT_FALSE(output().is_on);
}

TEST_F(Following, WritesTheSetpointAndItsVelocityToTheMotor) {
  run_to(10);
  EXPECT_DOUBLE_EQ(output().position, 10);
  EXPECT_DOUBLE_EQ(output().velocity, kVelocity);
  EXPECT_NE(axis_.statusword() & kStatusFollows, 0);
}

TEST_F(Following, AVelocityThatTheMotorDoesNotReportIsTheDifferenceOfPositions) {
  run_to(10);
  EXPECT_NEAR(axis_.velocity(), kVelocity, 1e-6);
  reading().velocity = 7;
  axis_.see(reading(), kPeriod_s);
  EXPECT_EQ(axis_.velocity(), 7);
}

TEST_F(Following, LostSetpointsAreBridgedAndTheRampBehindKeepsTheLimits) {
  run_to(10);
  double before = output().position, velocity = kVelocity, distance = 0, steepest = 0;
  for (int n = 1; axis_.state() != DriveState::kFault && n < 100; ++n) {
    nothing(n);
    const double now = (output().position - before) / kPeriod_s;
    EXPECT_LE(now, kVelocity * (1 + 1e-9)) << "never faster than it was sent";
    EXPECT_GE(now, -1e-9) << "never back";
    if (n > 1) steepest = std::max(steepest, std::abs(now - velocity) / kPeriod_s);
    distance += output().position - before;
    before = output().position;
    velocity = now;
  }
  EXPECT_EQ(axis_.error(), kErrorSetpointsStopped);
  EXPECT_LE(steepest, 5000 * (1 + 1e-6));
  EXPECT_NEAR(distance, 0.3 + kVelocity * kVelocity / (2 * 5000), 1e-6)
      << "the bridge and the ramp";
}

TEST_F(Following, AFaultOfTheHardwareRampsDownAndSaysWhich) {
  run_to(10);
  reading().error = 0x2310;
  nothing(1);
  EXPECT_EQ(axis_.state(), DriveState::kFaultReaction);
  EXPECT_EQ(axis_.error(), 0x2310);
  double before = output().velocity;
  while (axis_.state() == DriveState::kFaultReaction) {
    EXPECT_TRUE(output().is_on) << "the ramp needs the power stage";
    nothing(2);
    EXPECT_LE(before - output().velocity, 5000 * kPeriod_s * (1 + 1e-9));
    before = output().velocity;
  }
  EXPECT_EQ(axis_.state(), DriveState::kFault);
  nothing(3);
  EXPECT_FALSE(output().is_on);
}

TEST_F(Following, AFaultThatStandsIsResetWhenTheHardwareHasClearedItsOwn) {
  reading().error = 0x2310;
  nothing(0);
  nothing(0);
  ASSERT_EQ(axis_.state(), DriveState::kFault);
  words({0x00, 0x80});
  nothing(0);
  EXPECT_TRUE(output().is_reset);
  EXPECT_EQ(axis_.state(), DriveState::kFault) << "not yet";
  reading().error = 0;
  nothing(0);
  EXPECT_EQ(axis_.state(), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(axis_.error(), kErrorNone);
  nothing(0);
  EXPECT_FALSE(output().is_reset);
}

TEST_F(Following, AFaultWhileItIsOffSwitchesNothingOn) {
  words({0x06});
  nothing(0);
  reading().error = 0x2310;
  for (int n = 0; n < 3; ++n) {
    nothing(0);
    EXPECT_FALSE(output().is_on);
  }
  EXPECT_EQ(axis_.state(), DriveState::kFault);
}

TEST_F(Following, WithoutPowerItIsSwitchOnDisabledWhateverIsAsked) {
  run_to(10);
  reading().has_power = false;
  nothing(1);
  EXPECT_EQ(axis_.state(), DriveState::kSwitchOnDisabled);
  enable();
  nothing(1);
  EXPECT_EQ(axis_.state(), DriveState::kSwitchOnDisabled);
  EXPECT_FALSE(output().is_on);
  reading().has_power = true;
  nothing(1);
  EXPECT_EQ(axis_.state(), DriveState::kSwitchOnDisabled) << "nothing starts by itself";
}

TEST_F(Following, ReportsOperationEnabledWhenThePowerStageIsReady) {
  reading().is_ready = false;
  enable();
  setpoint(0);
  EXPECT_TRUE(output().is_on);
  EXPECT_EQ(drive_state(axis_.statusword()), DriveState::kSwitchedOn);
  reading().is_ready = true;
  setpoint(0);
  EXPECT_EQ(drive_state(axis_.statusword()), DriveState::kOperationEnabled);
}

TEST_F(Following, APositionThatIsNoNumberIsAFaultAndIsNotReported) {
  run_to(10);
  reading().position = std::numeric_limits<double>::quiet_NaN();
  motors_.is_stuck = true;
  nothing(1);
  EXPECT_EQ(axis_.error(), kErrorNoPosition);
  EXPECT_NEAR(axis_.position(), 10, 0.2);
}

TEST_F(Following, AMotorThatDoesNotMoveIsAFollowingError) {
  run_to(10);
  motors_.is_stuck = true;
  for (int n = 1; n < 100 && axis_.error() == kErrorNone; ++n) {
    setpoint(10 + n * kVelocity * kPeriod_s, kVelocity);
  }
  EXPECT_EQ(axis_.error(), kErrorFollowing);
  EXPECT_NE(axis_.statusword() & kStatusFollowingError, 0);
}

TEST_F(Following, AQuickStopRampsDownAndHoldsWithThePowerStageOn) {
  run_to(10);
  words({0x02});
  for (int n = 0; n < 40; ++n) setpoint(99, kVelocity);
  EXPECT_EQ(axis_.state(), DriveState::kQuickStop);
  EXPECT_TRUE(output().is_on);
  EXPECT_EQ(output().velocity, 0);
  EXPECT_NEAR(output().position, 10 + 1, 0.11) << "100 mm/s at 5000 mm/s2";
}

}  // namespace
}  // namespace meridian::drive
