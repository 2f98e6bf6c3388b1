// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "meridian/kinematics/soft_limits.hpp"
#include "support/keep_out_machine.hpp"
#include "support/machines.hpp"

namespace meridian {
namespace {

constexpr double kPeriod_s = 1e-3;

MachineModel machine_under_guard() {
  MachineModel machine;
  machine.joint_count = 5;
  for (JointSpec& joint : machine.joints) {
    joint.limits.travel_min = -100;
    joint.limits.travel_max = 100;
    joint.limits.velocity = 200;
  }
  machine.joints[3].is_endless = true;
  return machine;
}

TEST(Guard, LetsAnHonestSetpointPass) {
  const JointVector last{1, 2, 3, 400, 5};
  JointVector next = last;
  next[0] += 0.2;
  EXPECT_EQ(check(machine_under_guard(), next, {}, last, kPeriod_s).alarm, Alarm::kNone);
}

TEST(Guard, StopsANumberThatIsNotFinite) {
  const JointVector last{};
  JointVector next{};
  next[2] = std::numeric_limits<double>::quiet_NaN();
  const GuardVerdict verdict = check(machine_under_guard(), next, {}, last, kPeriod_s);
  EXPECT_EQ(verdict.alarm, Alarm::kNotFinite);
  EXPECT_EQ(verdict.joint, 2);
}

TEST(Guard, StopsAVelocityThatIsNotFinite) {
  JointVector velocity{};
  velocity[4] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(check(machine_under_guard(), {}, velocity, {}, kPeriod_s).alarm, Alarm::kNotFinite);
}

TEST(Guard, StopsASetpointOutsideTravel) {
  JointVector last{}, next{};
  last[1] = 99.99;
  next[1] = 100.001;
  const GuardVerdict verdict = check(machine_under_guard(), next, {}, last, kPeriod_s);
  EXPECT_EQ(verdict.alarm, Alarm::kTravel);
  EXPECT_EQ(verdict.joint, 1);
  EXPECT_EQ(verdict.value, 100.001);
}

TEST(Guard, StopsASetpointOutsideASoftLimitInsideTheTravelOfTheMachine) {
  const MachineModel own = machine_under_guard();
  SoftLimits limits;
  ASSERT_EQ(limits.apply({LimitsWord::kSet, 1, -20, 35.5}, own), LimitsFault::kNone);
  MachineModel machine = own;
  shrink_travel(machine, travel_under(limits, own));
  JointVector last{}, next{};
  last[1] = 35.49;
  next[1] = 35.501;
  EXPECT_EQ(check(own, next, {}, last, kPeriod_s).alarm, Alarm::kNone);
  const GuardVerdict verdict = check(machine, next, {}, last, kPeriod_s);
  EXPECT_EQ(verdict.alarm, Alarm::kTravel);
  EXPECT_EQ(verdict.joint, 1);
  last[1] = -19.99;
  next[1] = -20.001;
  EXPECT_EQ(check(machine, next, {}, last, kPeriod_s).alarm, Alarm::kTravel);
}

TEST(Guard, AllowsARoundingBeyondTravelAndNoMore) {
  const MachineModel machine = machine_under_guard();
  for (const double end : {-100.0, 100.0}) {
    const double out = end < 0 ? -1 : 1;
    const JointVector inside{end - out * 0.01};
    EXPECT_EQ(check(machine, {end + out * 0.9e-9}, {}, inside, kPeriod_s).alarm, Alarm::kNone);
    EXPECT_EQ(check(machine, {end + out * 1.1e-9}, {}, inside, kPeriod_s).alarm, Alarm::kTravel);
    const JointVector outside{end + out * 5};
    EXPECT_EQ(check(machine, {outside[0] + out * 0.9e-11}, {}, outside, kPeriod_s).alarm,
              Alarm::kNone);
    EXPECT_EQ(check(machine, {outside[0] + out * 1.2e-11}, {}, outside, kPeriod_s).alarm,
              Alarm::kTravel);
  }
}

TEST(Guard, WhoStandsOutsideMayStandAndComeBackButGoNoFarther) {
  JointVector last{}, next{};
  last[1] = next[1] = 105;
  const MachineModel machine = machine_under_guard();
  EXPECT_EQ(check(machine, next, {}, last, kPeriod_s).alarm, Alarm::kNone);
  next[1] = 104.9;
  EXPECT_EQ(check(machine, next, {}, last, kPeriod_s).alarm, Alarm::kNone);
  next[1] = 105.001;
  EXPECT_EQ(check(machine, next, {}, last, kPeriod_s).alarm, Alarm::kTravel);
  EXPECT_EQ(check(machine, next, {}, last, kPeriod_s, ~2U).alarm, Alarm::kNone)
      << "a joint whose position says nothing";
}

/// Joint 0 from 10 to 20 while joint 2 is from -5 to 5.
MachineModel machine_with_a_box() {
  return test::with_keep_out(machine_under_guard(), 0b101, {10, 0, -5}, {20, 0, 5});
}

TEST(Guard, StopsASetpointInsideAKeepOutBox) {
  const MachineModel machine = machine_with_a_box();
  const JointVector last{9.99, 0, 0};
  const GuardVerdict verdict = check(machine, {10.001, 0, 0}, {}, last, kPeriod_s);
  EXPECT_EQ(verdict.alarm, Alarm::kKeepOut);
  EXPECT_EQ(verdict.joint, 0);
  EXPECT_EQ(verdict.value, 0);
  EXPECT_EQ(check(machine, {10, 0, 0}, {}, last, kPeriod_s).alarm, Alarm::kNone) << "its face";
  EXPECT_EQ(check(machine, {10.001, 0, 5.2}, {}, {9.99, 0, 5.2}, kPeriod_s).alarm, Alarm::kNone);
}

TEST(Guard, StopsASetpointBehindAKeepOutBoxThatIsThinnerThanAStep) {
  MachineModel machine = machine_under_guard();
  KeepOutBox wall;
  wall.joints = 0b001;
  wall.min = {10};
  wall.max = {10.05};
  ASSERT_TRUE(machine.keep_out.add(wall));
  EXPECT_EQ(check(machine, {10.1, 0, 0}, {}, {9.95, 0, 0}, kPeriod_s).alarm, Alarm::kKeepOut);
  EXPECT_EQ(check(machine, {9.9, 0, 0}, {}, {9.95, 0, 0}, kPeriod_s).alarm, Alarm::kNone);
}

/// A step over the corner of a box, in which it is `depth` deep in the middle.
GuardVerdict check_over_corner(double depth) {
  MachineModel machine = machine_under_guard();
  for (JointSpec& joint : machine.joints) joint.limits.fault_acceleration = 8000;
  machine = test::with_keep_out(machine, 0b11, {10, -5}, {20, 0});
  return check(machine, {10.05 + 2 * depth, 0.05}, {}, {9.95, -2 * depth - 0.05}, kPeriod_s);
}

TEST(Guard, ALineBetweenTwoSetpointsMayCutACornerAsFarAsAFaultStopBendsOffIt) {
  // a t²/8 = 0.001 mm
  EXPECT_EQ(check_over_corner(-0.001).alarm, Alarm::kNone);
  EXPECT_EQ(check_over_corner(0.0009).alarm, Alarm::kNone);
  EXPECT_EQ(check_over_corner(0.0011).alarm, Alarm::kKeepOut);
}

TEST(Guard, WhoStandsInAKeepOutBoxMayStandAndComeOutButGoNoDeeper) {
  const MachineModel machine = machine_with_a_box();
  const JointVector last{11, 0, 0};
  EXPECT_EQ(check(machine, last, {}, last, kPeriod_s).alarm, Alarm::kNone);
  EXPECT_EQ(check(machine, {10.9, 0, 0}, {}, last, kPeriod_s).alarm, Alarm::kNone);
  EXPECT_EQ(check(machine, {11.1, 0, 0}, {}, last, kPeriod_s).alarm, Alarm::kKeepOut);
}

TEST(Guard, AKeepOutBoxOfJointsWithoutAReferenceSaysNothing) {
  const MachineModel machine = machine_with_a_box();
  const JointVector last{9.99, 0, 0}, next{10.001, 0, 0};
  EXPECT_EQ(check(machine, next, {}, last, kPeriod_s, 0b001).alarm, Alarm::kNone);
  EXPECT_EQ(check(machine, next, {}, last, kPeriod_s, 0b101).alarm, Alarm::kKeepOut);
}

/// The tip of joints at zero is at (0, 0, -100): in the box by 10 mm along each axis.
MachineModel machine_with_a_tip_box() {
  MachineModel machine = machine_under_guard();
  machine.tip_box = {true, {-10, -10, -110}, {10, 10, -90}};
  return machine;
}

TEST(Guard, StopsASetpointThatTakesTheTipOutOfItsBox) {
  const MachineModel machine = machine_with_a_tip_box();
  const JointVector last{9.99};
  const GuardVerdict verdict = check_tip_box(machine, 100, {10.001}, last);
  EXPECT_EQ(verdict.alarm, Alarm::kTipBox);
  EXPECT_EQ(verdict.joint, 0);
  EXPECT_NEAR(verdict.value, 10.001, 1e-9);
  EXPECT_EQ(check_tip_box(machine, 100, {10}, last).alarm, Alarm::kNone) << "its face";
  EXPECT_EQ(check_tip_box(machine, 100, {0, 0, 10.1}, {}).joint, 2) << "b4 points down";
  EXPECT_EQ(check_tip_box(machine, 100, {0, 50, 0}, {}).alarm, Alarm::kNone) << "of the table";
}

TEST(Guard, LetsATipComeInThatIsOutsideOfItsBox) {
  const MachineModel machine = machine_with_a_tip_box();
  const JointVector last{12};
  EXPECT_EQ(check_tip_box(machine, 100, last, last).alarm, Alarm::kNone);
  EXPECT_EQ(check_tip_box(machine, 100, {11.9}, last).alarm, Alarm::kNone);
  EXPECT_EQ(check_tip_box(machine, 100, {12.1}, last).alarm, Alarm::kTipBox);
  EXPECT_EQ(check_tip_box(machine, 130, {}, {}).alarm, Alarm::kNone) << "a longer tool, at rest";
}

TEST(Guard, ATipBoxSaysNothingWhereAJointThatMovesTheTipHasNoReference) {
  const MachineModel machine = machine_with_a_tip_box();
  EXPECT_EQ(check_tip_box(machine, 100, {10.1}, {}, 0b00101).alarm, Alarm::kNone);
  EXPECT_EQ(check_tip_box(machine, 100, {10.1}, {}, 0b10101).alarm, Alarm::kTipBox);
}

TEST(Guard, ChecksTheDrivesOfAStageAsItDoesJoints) {
  MachineModel machine = test::hybrid_machine();  // its drives reach 300 mm/s
  const JointVector rest{};
  const double u = limited_value(machine, rest, 5);
  EXPECT_EQ(check_stage(machine, {0, 0.299}, rest, kPeriod_s, true).alarm, Alarm::kNone);
  EXPECT_EQ(check_stage(machine, {0, -0.299}, rest, kPeriod_s, true).alarm, Alarm::kNone);
  const GuardVerdict step = check_stage(machine, {0, 0.301}, rest, kPeriod_s, true);
  EXPECT_EQ(step.alarm, Alarm::kStep);
  EXPECT_EQ(step.joint, 5);
  EXPECT_NEAR(std::abs(step.value), 0.301, 1e-9);
  EXPECT_EQ(check_stage(machine, {0, 0.6}, rest, 2.1 * kPeriod_s, true).alarm, Alarm::kNone);
  const JointVector nowhere{0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(check_stage(machine, nowhere, rest, kPeriod_s, true).alarm, Alarm::kNotFinite);
  machine.stage_drives[0].limits.travel_max = u + 0.1;
  machine.stage_drives[0].limits.travel_min = u - 0.1;
  const GuardVerdict travel = check_stage(machine, {0, 0.2}, rest, kPeriod_s, true);
  EXPECT_EQ(travel.alarm, Alarm::kTravel);
  EXPECT_EQ(travel.joint, 5);
  EXPECT_EQ(check_stage(machine, {0, 0.2}, rest, kPeriod_s, false).alarm, Alarm::kNone);
  EXPECT_EQ(check(machine, {0, 0.2}, {}, rest, kPeriod_s).alarm, Alarm::kTravel);
  EXPECT_EQ(check(machine, {0, 0.2}, {}, rest, kPeriod_s, 0).alarm, Alarm::kNone);
}

TEST(Guard, EndlessJointsHaveNoTravel) {
  JointVector last{}, next{};
  last[3] = next[3] = 1e4;
  EXPECT_EQ(check(machine_under_guard(), next, {}, last, kPeriod_s).alarm, Alarm::kNone);
}

TEST(Guard, StopsAStepBeyondTheVelocityLimit) {
  JointVector next{};
  next[0] = -0.2001;
  const GuardVerdict verdict = check(machine_under_guard(), next, {}, {}, kPeriod_s);
  EXPECT_EQ(verdict.alarm, Alarm::kStep);
  EXPECT_EQ(verdict.value, -0.2001);
}

TEST(Guard, AllowsTheWayOfThePeriodsThatWereLost) {
  JointVector next{};
  next[0] = 0.59;
  EXPECT_EQ(check(machine_under_guard(), next, {}, {}, 3 * kPeriod_s).alarm, Alarm::kNone);
}

}  // namespace
}  // namespace meridian
