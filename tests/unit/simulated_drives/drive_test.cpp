// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <optional>

#include "service/drives/kit/csp/following_axis.hpp"
#include "service/drives/simulated/simulated_servos.hpp"

namespace meridian::drives {
namespace {

constexpr double kPeriod_s = 1e-3;
constexpr double kVelocity = 100;  // mm/s

/// One axis of the library with a simulated servo behind it.
class Drive {
 public:
  Drive(const JointSpec& spec, const ServoLag& lag, const HomingPlan& homing = {}) : servos_(lag) {
    servos_.add(spec, homing);
    axis_.emplace(spec, homing_of(homing), servos_.servo(0).servo.position);
  }
  void take_controlword(std::uint16_t controlword, std::uint8_t mode = dds::kCyclicPositionMode) {
    axis_->take_controlword(controlword, mode);
  }
  void work(const drive::AxisInput& input, double dt_s) {
    servos_.write(0, axis_->lead(input, dt_s, 0, servos_));
    servos_.exchange(dt_s);
    axis_->see(servos_.read(0), dt_s);
  }
  void fail(std::uint16_t error) { axis_->fail(error); }
  void block_shaft(bool is_blocked) { servos_.servo(0).is_blocked = is_blocked; }

  [[nodiscard]] DriveState state() const { return axis_->state(); }
  [[nodiscard]] std::uint16_t statusword() const { return axis_->statusword(); }
  [[nodiscard]] std::uint16_t error() const { return axis_->error(); }
  [[nodiscard]] std::uint8_t mode() const { return axis_->mode(); }
  [[nodiscard]] bool is_referenced() const { return axis_->is_referenced(); }
  [[nodiscard]] double position() const { return axis_->position(); }
  [[nodiscard]] double velocity() const { return axis_->velocity(); }
  [[nodiscard]] double following_error() const { return axis_->following_error(); }

 private:
  SimulatedServos servos_;
  std::optional<drive::FollowingAxis> axis_;
};

JointSpec joint_at(double home) {
  JointSpec joint;
  joint.home = home;
  joint.limits.travel_min = -500;
  joint.limits.travel_max = 500;
  joint.limits.velocity = 300;
  joint.limits.following_error = 5;
  joint.limits.fault_acceleration = 5000;
  return joint;
}

Drive enabled_drive(double position = 10, const HomingPlan& homing = {}) {
  Drive drive(joint_at(position), {LagKind::kSecondOrder, 0.002}, homing);
  for (const std::uint16_t controlword : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F})
    drive.take_controlword(controlword);
  return drive;
}

drive::AxisInput setpoint(double position, double velocity = 0) {
  return {.is_new = true,
          .is_enabled = true,
          .position = position,
          .velocity = velocity,
          .elapsed_s = kPeriod_s};
}
drive::AxisInput nothing(int periods_without) {
  return {.periods_without = periods_without, .bridged_s = kPeriod_s};
}

/// Runs the drive along x = 10 + v t until it is settled; returns the last setpoint.
double run_steadily(Drive& drive) {
  double position = 10;
  for (int i = 0; i < 300; ++i) {
    position += kVelocity * kPeriod_s;
    drive.work(setpoint(position, kVelocity), kPeriod_s);
  }
  return position;
}

TEST(SimulatedDrive, StandsWhileItIsNotEnabled) {
  Drive drive(joint_at(10), {});
  for (int i = 0; i < 10; ++i) drive.work(setpoint(12), kPeriod_s);
  EXPECT_EQ(drive.position(), 10);
  EXPECT_EQ(drive.error(), drive::kErrorNone);
}

TEST(SimulatedDrive, StaysWhereItIsWhenEnabled) {
  Drive drive = enabled_drive();
  for (int i = 0; i < 3; ++i) drive.work(nothing(i), kPeriod_s);
  EXPECT_EQ(drive.position(), 10);
  EXPECT_EQ(drive.state(), DriveState::kOperationEnabled);
}

TEST(SimulatedDrive, FaultsWhereItIsEnabledAndNobodySendsSetpoints) {
  for (const std::uint8_t mode : {dds::kCyclicPositionMode, dds::kHomingMode}) {
    Drive drive = enabled_drive();
    drive.work(setpoint(10, kVelocity), kPeriod_s);  // of before, which it does not ramp down from
    drive.take_controlword(0x0F, mode);
    drive.work({.is_new = true, .is_enabled = false}, kPeriod_s);
    for (int n = 1; n < 6; ++n) drive.work(nothing(n), kPeriod_s);
    EXPECT_EQ(drive.state(), DriveState::kFault);
    EXPECT_EQ(drive.error(), drive::kErrorSetpointsStopped);
    EXPECT_EQ(drive.position(), 10);
  }
}

TEST(SimulatedDrive, DoesNotFollowASetpointThatIsNotEnabled) {
  Drive drive = enabled_drive();
  drive.work({.is_new = true, .is_enabled = false, .position = 99}, kPeriod_s);
  EXPECT_EQ(drive.position(), 10);
}

TEST(SimulatedDrive, FollowsWithTheLagOfItsServo) {
  Drive drive = enabled_drive();
  run_steadily(drive);
  EXPECT_NEAR(drive.following_error(), kVelocity * (0.002 - 0.5 * kPeriod_s), 0.02);
  EXPECT_NEAR(drive.velocity(), kVelocity, 0.1 * kVelocity);  // it ripples with the period
  EXPECT_EQ(drive.statusword() & drive::kStatusFollows, drive::kStatusFollows);
}

TEST(SimulatedDrive, BridgesMissingSetpointsByTheSentVelocity) {
  Drive drive = enabled_drive();
  const double last = run_steadily(drive);
  for (int i = 1; i <= 3; ++i) drive.work(nothing(i), kPeriod_s);
  EXPECT_EQ(drive.state(), DriveState::kOperationEnabled);
  EXPECT_NEAR(drive.position() + drive.following_error(), last + 3 * kVelocity * kPeriod_s, 1e-9);
}

TEST(SimulatedDrive, RampsDownAndFaultsWhenSetpointsStayAway) {
  Drive drive = enabled_drive();
  const double last = run_steadily(drive);
  double fastest_change = 0, before = kVelocity;
  int periods = 0;
  for (int i = 1; drive.state() != DriveState::kFault && i < 1000; ++i, ++periods) {
    drive.work(nothing(i), kPeriod_s);
    fastest_change = std::max(fastest_change, std::abs(drive.velocity() - before) / kPeriod_s);
    before = drive.velocity();
  }
  EXPECT_EQ(drive.state(), DriveState::kFault);
  EXPECT_EQ(drive.error(), drive::kErrorSetpointsStopped);
  // 100 mm/s at 5000 mm/s²: 20 periods and 1 mm after three bridged ones.
  EXPECT_NEAR(periods, 23, 1);
  EXPECT_NEAR(drive.position(), last + 0.3 + 1.0, 0.2);
  EXPECT_LT(fastest_change, 2 * 5000);
}

TEST(SimulatedDrive, RefusesToBeginWhereItDoesNotStand) {
  Drive drive = enabled_drive();
  drive.work(setpoint(30), kPeriod_s);
  EXPECT_EQ(drive.error(), drive::kErrorSetpointBegin);
  for (int n = 0; n < 10; ++n) drive.work(setpoint(30), kPeriod_s);
  EXPECT_EQ(drive.state(), DriveState::kFault);
  EXPECT_EQ(drive.position(), 10);
}

TEST(SimulatedDrive, RefusesASetpointThatBreaksItsLimitsAndStopsByItsOwnRamp) {
  Drive drive = enabled_drive();
  const double last = run_steadily(drive);
  drive.work(setpoint(last + 1, kVelocity), kPeriod_s);  // 0.3 mm is what it can do in a period
  EXPECT_EQ(drive.state(), DriveState::kFaultReaction);
  EXPECT_EQ(drive.error(), drive::kErrorSetpointStep);
  double fastest_change = 0, before = drive.velocity();
  for (int n = 0; drive.state() != DriveState::kFault && n < 1000; ++n) {
    drive.work(setpoint(last + 1, kVelocity), kPeriod_s);
    fastest_change = std::max(fastest_change, std::abs(drive.velocity() - before) / kPeriod_s);
    before = drive.velocity();
  }
  EXPECT_EQ(drive.state(), DriveState::kFault);
  EXPECT_NEAR(drive.position(), last + 1.0, 0.2) << "100 mm/s at 5000 mm/s2";
  EXPECT_LT(fastest_change, 2 * 5000);
}

TEST(SimulatedDrive, ABlockedShaftEndsInAFollowingError) {
  Drive drive = enabled_drive();
  drive.block_shaft(true);
  run_steadily(drive);
  EXPECT_EQ(drive.position(), 10);
  EXPECT_EQ(drive.error(), drive::kErrorFollowing);
  EXPECT_NE(drive.statusword() & drive::kStatusFollowingError, 0);
}

TEST(SimulatedDrive, AFaultIsResetAndEnabledAgainWhereItStands) {
  Drive drive = enabled_drive();
  run_steadily(drive);
  drive.fail(drive::kErrorDevice);
  for (int i = 0; i < 100; ++i) drive.work(nothing(i), kPeriod_s);
  ASSERT_EQ(drive.state(), DriveState::kFault);
  const double stands = drive.position();
  for (const std::uint16_t controlword :
       std::initializer_list<std::uint16_t>{0x80, 0x06, 0x07, 0x0F}) {
    drive.take_controlword(controlword);
  }
  EXPECT_EQ(drive.state(), DriveState::kOperationEnabled);
  EXPECT_EQ(drive.error(), drive::kErrorNone);
  drive.work(nothing(1), kPeriod_s);
  EXPECT_EQ(drive.position(), stands);
}

/// Homes `drive` for so long, setpoints coming all the time; the words of the end.
std::uint16_t home(Drive& drive, int periods) {
  drive.take_controlword(0x0F, dds::kHomingMode);
  drive.work(setpoint(0), kPeriod_s);
  EXPECT_EQ(drive.statusword() & 0x3400, drive::kStatusTargetReached) << "not begun";
  drive.take_controlword(0x1F, dds::kHomingMode);
  for (int n = 0; n < periods; ++n) {
    drive.work(setpoint(1e6), kPeriod_s);
    if ((drive.statusword() & drive::kStatusTargetReached) != 0) break;
  }
  return drive.statusword() & 0x3400;
}

TEST(SimulatedDrive, FindsItsReferenceInHomingModeAndFollowsSetpointsAfterwards) {
  Drive drive = enabled_drive(10, {.is_referenced = false});
  EXPECT_FALSE(drive.is_referenced());
  EXPECT_EQ(drive.position(), 0) << "what it calls 0 is 5 mm beside home";
  EXPECT_EQ(home(drive, 1000), drive::kStatusTargetReached | drive::kStatusHomingAttained);
  EXPECT_TRUE(drive.is_referenced());
  EXPECT_NEAR(drive.position(), 10, 1e-5);
  drive.take_controlword(0x0F, dds::kCyclicPositionMode);
  EXPECT_EQ(drive.mode(), dds::kCyclicPositionMode);
  for (int n = 0; n < 30; ++n) drive.work(setpoint(10.1), kPeriod_s);
  EXPECT_NEAR(drive.position(), 10.1, 1e-5);
}

TEST(SimulatedDrive, SaysThatItFoundNoReferenceOrSearchesForEver) {
  Drive failing = enabled_drive(10, {.is_referenced = false, .fails = true});
  EXPECT_EQ(home(failing, 1000), drive::kStatusTargetReached | drive::kStatusHomingError);
  EXPECT_FALSE(failing.is_referenced());
  Drive hanging = enabled_drive(10, {.is_referenced = false, .hangs = true});
  EXPECT_EQ(home(hanging, 1000), 0);
  hanging.take_controlword(0x0F, dds::kHomingMode);
  EXPECT_EQ(hanging.statusword() & 0x3400, drive::kStatusTargetReached) << "interrupted";
}

TEST(SimulatedDrive, StopsItsSearchWhereTheServiceIsGone) {
  Drive drive = enabled_drive(10, {.is_referenced = false, .hangs = true});
  EXPECT_EQ(home(drive, 10), 0);
  for (int n = 1; n < 6; ++n) drive.work(nothing(n), kPeriod_s);
  EXPECT_EQ(drive.error(), drive::kErrorSetpointsStopped);
}

}  // namespace
}  // namespace meridian::drives
