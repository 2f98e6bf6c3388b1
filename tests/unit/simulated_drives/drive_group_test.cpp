// SPDX-License-Identifier: Apache-2.0
#include "unit/simulated_drives/drive_group.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace meridian::drives {
namespace {

using drive::Drop;

TEST_F(Group, StandsAtHomeAndReportsEveryJoint) {
  model_.joints[2].home = -33;
  DriveGroup group(model_, {});
  const dds::DriveFeedback feedback = group.feedback();
  EXPECT_EQ(feedback.joint_mask, 0x1Fu);
  EXPECT_EQ(feedback.referenced_mask, 0x1Fu);
  EXPECT_EQ(feedback.position[2], -33);
  EXPECT_EQ(feedback.sample + 1, group.feedback().sample);
}

TEST_F(Group, FollowsSetpointsAndTellsTheirCycle) {
  enable();
  send(1);
  group_.work(1);
  const dds::DriveFeedback feedback = group_.feedback();
  EXPECT_EQ(feedback.position[0], 1);
  EXPECT_EQ(feedback.cycle_seen, 101u);
}

TEST_F(Group, AnOldSetpointIsNotFollowed) {
  enable();
  send(1);
  group_.work(1);
  cycle_ -= 2;
  send(0.5);
  group_.work(1);
  EXPECT_EQ(group_.feedback().position[0], 1);
  EXPECT_EQ(group_.dropped()[Drop::kOutOfOrder], 1U);
  EXPECT_EQ(group_.drive(0).state(), DriveState::kOperationEnabled);
}

TEST_F(Group, ASetpointThatIsNoNumberIsRefusedAndTheDriveStops) {
  for (const double x : {std::numeric_limits<double>::quiet_NaN(), 1e308}) {
    DriveGroup fresh(model_, {LagKind::kFirstOrder, 0});
    group_ = fresh;
    enable();
    send(1);
    group_.work(1);
    send(x);
    group_.work(1);
    EXPECT_EQ(group_.feedback().position[0], 1);
    EXPECT_EQ(group_.drive(0).error(), drive::kErrorSetpointNoNumber);
    EXPECT_EQ(group_.drive(1).error(), drive::kErrorNone) << "the other drives follow";
    come_to_rest();
    EXPECT_EQ(group_.drive(0).state(), DriveState::kFault);
  }
}

TEST_F(Group, ASetpointOfTheMasterWithABadChecksumIsDroppedAndCounted) {
  enable();
  send(1);
  group_.work(1);
  Setpoint setpoint;
  setpoint.cycle = ++cycle_;
  setpoint.position[0] = 1.1;
  setpoint.flags = kSetpointEnabled;
  dds::SetpointSample spoilt = signed_by(7, setpoint);
  spoilt.setpoint.position[0] = 1.2;
  EXPECT_EQ(group_.take(spoilt, kMaster), Drop::kChecksum);
  EXPECT_EQ(group_.take(signed_by(8, setpoint), kMaster), Drop::kChecksum) << "of another service";
  group_.work(1);
  EXPECT_EQ(group_.feedback().position[0], 1);
  EXPECT_EQ(group_.dropped()[Drop::kChecksum], 2U);
  EXPECT_EQ(group_.drive(0).state(), DriveState::kOperationEnabled) << "bridged as if it was lost";
  EXPECT_EQ(group_.take(signed_by(7, setpoint), kMaster), Drop::kNone);
}

TEST_F(Group, ASetpointThatTheWireHeldBackIsDropped) {
  enable();
  const auto arrive = [this](std::int64_t delay_ns) {
    Setpoint setpoint;
    setpoint.cycle = ++cycle_;
    setpoint.due_ns = static_cast<std::int64_t>(cycle_) * 1'000'000;
    setpoint.flags = kSetpointEnabled;
    const Drop drop =
        group_.take(signed_by(7, setpoint), kMaster, setpoint.due_ns + 5'000'000'000 + delay_ns);
    group_.work(1);
    return drop;
  };
  EXPECT_EQ(arrive(0), Drop::kNone);
  EXPECT_EQ(arrive(3'000'000), Drop::kNone);
  EXPECT_EQ(arrive(30'000'000), Drop::kStale);
}

TEST_F(Group, AJumpOverManyCyclesGoesNoFartherThanTheDrivesOwnPeriodsAllow) {
  enable();
  send(1);
  group_.work(1);
  cycle_ += 1'000'000;  // in which 300 km could be passed
  send(100);
  group_.work(1);
  EXPECT_EQ(group_.drive(0).error(), drive::kErrorSetpointStep);
  EXPECT_EQ(group_.feedback().position[0], 1);
}

TEST_F(Group, ASetpointOfADryRunIsAsIfNoneHadCome) {
  enable();
  send(1);
  group_.work(1);
  for (const unsigned more : {0U, unsigned{kSetpointDryEnabled}, unsigned{kSetpointEnabled}}) {
    send(2, static_cast<std::uint16_t>(kSetpointDry | more), 50);
    group_.work(1);
    EXPECT_EQ(group_.feedback().position[0], 1);
    EXPECT_EQ(group_.feedback().cycle_seen, 101U);
  }
  for (int n = 0; n < model_.bridge_cycles; ++n) {
    send(2, kSetpointDry | kSetpointDryEnabled, 50);
    group_.work(1);
  }
  EXPECT_NE(group_.drive(0).state(), DriveState::kOperationEnabled) << "and so it is missed";
  EXPECT_EQ(group_.feedback().position[0], 1);
}

TEST_F(Group, DoesNotTakeItsOwnStallForSilenceOfTheService) {
  enable();
  send(1);
  group_.work(1);
  group_.work(60);  // the host held both of them up
  EXPECT_EQ(group_.drive(0).state(), DriveState::kOperationEnabled);
  send(1);
  group_.work(1);
  group_.work(60);
  group_.work(1);  // awake again, and still nothing: that is silence
  EXPECT_NE(group_.drive(0).state(), DriveState::kOperationEnabled);
}

TEST_F(Group, InjectsFaultsAfterTheTimeEnabled) {
  group_.inject({Injection::Kind::kFault, 0.005, 3});
  enable();
  for (int i = 0; i < 4; ++i) {
    send(0);
    group_.work(1);
  }
  EXPECT_EQ(group_.drive(3).error(), drive::kErrorNone);
  send(0);
  group_.work(1);
  EXPECT_EQ(group_.drive(3).error(), drive::kErrorDevice);
}

TEST_F(Group, InjectsSilenceAndTheStopInput) {
  group_.inject({Injection::Kind::kSilence, 0, 0});
  group_.inject({Injection::Kind::kEmergency, 0, 0});
  group_.work(1);
  EXPECT_FALSE(group_.is_silent());
  enable();
  group_.work(1);
  EXPECT_TRUE(group_.is_silent());
  EXPECT_TRUE(group_.feedback().is_emergency_stop);
}

TEST_F(Group, InjectsAnOpenGuardAndAPositionThatCreeps) {
  enable();
  const double stood = group_.feedback().position[0];
  group_.inject_now({Injection::Kind::kGuard, 0, 0});
  group_.inject_now({Injection::Kind::kCreep, 0, 0, 5});
  EXPECT_TRUE(group_.feedback().is_guard_open);
  for (int n = 0; n < 99; ++n) (void)group_.feedback();
  EXPECT_NEAR(group_.feedback().position[0] - stood, 101 * 5e-3, 1e-9);
  group_.inject_now({Injection::Kind::kMend, 0, 0});
  EXPECT_FALSE(group_.feedback().is_guard_open);
  EXPECT_NEAR(group_.feedback().position[0], stood, 1e-9);
}

TEST_F(Group, AStallOfItsOwnLeadsOnNoFartherThanTheBridgeAndTheRamp) {
  enable();
  send(1, kSetpointEnabled, 100);
  group_.work(1);
  const double sent = group_.drive(0).position() + group_.drive(0).following_error();
  group_.work(1000);
  const double led_to = group_.drive(0).position() + group_.drive(0).following_error();
  const double ramp = 100 * 100 / (2 * drive_spec(model_, 0).limits.fault_acceleration);
  EXPECT_NEAR(led_to - sent, 100 * 1e-3 * model_.bridge_cycles + ramp, 1e-9);
}

TEST_F(Group, AStallOfItsOwnCountsAsOneStepOfManyPeriods) {
  enable();
  send(1);
  group_.work(1);
  group_.work(2);
  EXPECT_EQ(group_.periods_bridged(), 2u);
  EXPECT_EQ(group_.drive(0).state(), DriveState::kOperationEnabled);
  group_.work(2);
  group_.work(1);
  EXPECT_NE(group_.drive(0).state(), DriveState::kOperationEnabled);
}

}  // namespace
}  // namespace meridian::drives
