// SPDX-License-Identifier: Apache-2.0
#include "service/drives/simulated/drive_group.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>

#include "support/machines.hpp"

namespace meridian::drives {
namespace {

using drive::Drop;
using drive::MasterPin;

constexpr std::uint64_t kMaster = 41, kOther = 42;  // participants

dds::SetpointSample signed_by(std::uint64_t service, const Setpoint& setpoint) {
  return {setpoint, dds::setpoint_crc(setpoint, service)};
}

class Group : public testing::Test {
 protected:
  void command(std::uint16_t controlword, std::uint64_t service = 7,
               std::uint64_t sender = kMaster) {
    for (std::uint8_t i = 0; i < 5; ++i) {
      dds::DriveCommand word;
      word.drive = i;
      word.controlword = controlword;
      word.service_id = service;
      group_.take(word, sender);
    }
  }
  /// The drives' own ramp is over.
  void come_to_rest() {
    for (int n = 0; n < 200; ++n) group_.work(1);
  }
  void enable() {
    for (const std::uint16_t controlword : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F})
      command(controlword);
  }
  void hear(const dds::MachineInfo& machine, std::uint64_t sender) {
    if (const auto bridge = drive::bridge_of(machine, sender)) group_.take(*bridge);
  }
  void send(double x, std::uint16_t flags = kSetpointEnabled, double velocity = 0) {
    Setpoint setpoint;
    setpoint.cycle = ++cycle_;
    setpoint.position[0] = x;
    setpoint.velocity[0] = velocity;
    setpoint.flags = flags;
    group_.take(signed_by(7, setpoint), kMaster);
  }

  MachineModel model_ = test::lai_machine();
  DriveGroup group_{model_, {LagKind::kFirstOrder, 0}};
  std::uint64_t cycle_ = 100;
};

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

TEST_F(Group, ObeysOneServiceUntilItIsOffAndGone) {
  enable();
  send(0);
  group_.work(1);
  command(0x00, 8, kOther);
  EXPECT_EQ(group_.drive(0).state(), DriveState::kOperationEnabled);
  command(0x06);
  command(0x07, 8, kOther);
  EXPECT_EQ(group_.drive(0).state(), DriveState::kReadyToSwitchOn)
      << "off, and the master is there";
  group_.see_master(true);
  command(0x07, 8, kOther);
  EXPECT_EQ(group_.feedback().service_id, 7U);
  group_.see_master(false);
  EXPECT_EQ(group_.feedback().service_id, 0U) << "nobody";
  command(0x07, 8, kOther);
  EXPECT_EQ(group_.drive(0).state(), DriveState::kSwitchedOn);
  EXPECT_EQ(group_.feedback().service_id, 8U);
  EXPECT_EQ(group_.dropped()[Drop::kForeignCommand], 15U);
}

TEST_F(Group, NobodyWhoQuotesTheIdOfTheMasterIsObeyedInAnyState) {
  const auto attack = [this](const char* when) {
    for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x00, 0x06, 0x07, 0x0F}) {
      command(word, 7, kOther);
    }
    for (double x = 0; x < 50; x += 0.3) {
      Setpoint setpoint;
      setpoint.cycle = 1'000'000 + static_cast<std::uint64_t>(x * 10);
      setpoint.position[0] = x;
      setpoint.velocity[0] = 300;
      setpoint.flags = kSetpointEnabled;
      EXPECT_EQ(group_.take(signed_by(7, setpoint), kOther), Drop::kForeignSetpoint) << when;
      group_.work(1);
      ASSERT_EQ(group_.feedback().position[0], 0) << when;
    }
  };
  command(0x06);
  send(0, 0);
  attack("off");
  EXPECT_EQ(group_.drive(0).state(), DriveState::kReadyToSwitchOn);
  command(0x07);
  command(0x0F);
  send(0);
  group_.work(1);
  group_.see_master(true);
  attack("ready, and the master is silent");
  come_to_rest();
  EXPECT_EQ(group_.drive(0).state(), DriveState::kFault) << "its silence is not bridged by others";
  attack("fault");
  EXPECT_EQ(group_.feedback().service_id, 7U);
}

TEST_F(Group, ADriveCommandOfNoServiceOrToNoDriveIsImplausible) {
  dds::DriveCommand word;
  EXPECT_EQ(group_.take(word, kMaster), Drop::kImplausible);
  word.service_id = 7;
  word.drive = 5;
  EXPECT_EQ(group_.take(word, kMaster), Drop::kImplausible);
  EXPECT_EQ(group_.feedback().service_id, 0U) << "such a one pins nobody";
}

TEST_F(Group, WithoutAMasterNoSetpointIsTaken) {
  Setpoint setpoint;
  setpoint.cycle = 1;
  EXPECT_EQ(group_.take(signed_by(7, setpoint), kMaster), Drop::kNoMaster);
  EXPECT_EQ(group_.feedback().cycle_seen, 0U);
}

/// Two services send to the same drives, as each may that did not hear of the other.
class TwoServices : public Group {
 protected:
  Drop send(std::uint64_t cycle, double x, std::uint16_t flags, std::uint64_t service,
            std::uint64_t sender) {
    Setpoint setpoint;
    setpoint.cycle = cycle;
    setpoint.position[0] = x;
    setpoint.velocity[0] = 100;
    setpoint.flags = flags;
    return group_.take(signed_by(service, setpoint), sender);
  }
};

TEST_F(TwoServices, DrivesTakeTheSetpointsOfTheOneThatTheyObeyAlone) {
  enable();
  for (std::uint64_t n = 0; n < 20; ++n) {  // the other has run for an hour, and is Off
    const double x = 0.1 * static_cast<double>(n);
    EXPECT_EQ(send(100 + n, x, kSetpointEnabled, 7, kMaster), Drop::kNone);
    EXPECT_EQ(send(3'600'000 + n, -50, 0, 8, kOther), Drop::kForeignSetpoint);
    command(0x06, 8, kOther);
    group_.work(1);
    ASSERT_NEAR(group_.feedback().position[0], x, 1e-12) << n;
    ASSERT_EQ(group_.feedback().cycle_seen, 100 + n);
  }
  EXPECT_EQ(group_.dropped()[Drop::kForeignSetpoint], 20U);
  EXPECT_EQ(group_.setpoints_seen(), 20U);
}

TEST_F(TwoServices, AnotherOnesSetpointsDoNotBridgeAGapOfTheOneThatIsObeyed) {
  enable();
  (void)send(100, 0, kSetpointEnabled, 7, kMaster);
  for (std::uint64_t n = 0; n < 10; ++n) {
    (void)send(101 + n, 0, kSetpointEnabled, 8, kOther);
    group_.work(1);
  }
  EXPECT_NE(group_.drive(0).state(), DriveState::kOperationEnabled) << "their watchdog sees it";
}

TEST_F(TwoServices, TheOtherOneIsTakenWhenItIsObeyedAndCountsItsOwnCycles) {
  command(0x06);
  (void)send(3'600'000, 1, 0, 7, kMaster);
  group_.see_master(false);
  command(0x06, 8, kOther);
  EXPECT_EQ(send(3'600'001, 1, 0, 7, kMaster), Drop::kForeignSetpoint);
  EXPECT_EQ(send(5, 1, 0, 8, kOther), Drop::kNone);
  EXPECT_EQ(group_.feedback().cycle_seen, 5U);
}

TEST_F(TwoServices, TheMasterThatComesBackWhileDrivesRampDownIsTheirMaster) {
  enable();
  (void)send(100, 0, kSetpointEnabled, 7, kMaster);
  group_.work(1);
  group_.see_master(false);
  command(0x06, 8, kOther);
  EXPECT_EQ(group_.pin().state(), MasterPin::State::kGone);
  EXPECT_EQ(send(101, 0, kSetpointEnabled, 7, kMaster), Drop::kNone);
  command(0x0F);
  EXPECT_EQ(group_.pin().state(), MasterPin::State::kPinned);
}

TEST_F(TwoServices, TheNextOneIsObeyedWhereOneDiedAndTheDrivesAreInFault) {
  enable();
  send(100, 0, 0, 7, kMaster);
  group_.see_master(false);
  command(0x06, 8, kOther);
  EXPECT_EQ(group_.pin().master().service_id, 7U);
  come_to_rest();
  group_.see_master(false);
  command(0x06, 8, kOther);
  EXPECT_EQ(group_.pin().master().service_id, 8U);
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

dds::MachineInfo service(std::uint64_t id, std::uint32_t bridge_cycles, bool is_serving) {
  dds::MachineInfo machine;
  machine.service_id = id;
  machine.bridge_cycles = bridge_cycles;
  machine.is_serving = is_serving;
  return machine;
}

TEST_F(Group, BridgesAsItsMasterSaysNotAsAnyoneWhoQuotesTheMastersId) {
  hear(service(7, 20, true), kMaster);
  hear(service(8, 1, false), kOther);
  hear(service(8, 2, true), kOther);
  command(0x06);
  hear(service(9, 50, true), kOther);
  hear(service(7, 60, true), kOther);
  enable();
  int periods = 0;
  for (send(0); group_.drive(0).state() == DriveState::kOperationEnabled; ++periods) {
    group_.work(1);
    if (periods > 100) break;
  }
  EXPECT_NEAR(periods, 20, 3);
}

TEST_F(Group, BridgesAsItsNextMasterSaidWhileItStillObeyedTheLast) {
  constexpr std::uint64_t kLast = kMaster + 1, kFlood = kMaster + 2;
  command(0x06, 6, kLast);
  hear(service(7, 20, true), kMaster);
  for (std::uint64_t id = 100; id < 200; ++id) hear(service(id, 1, true), kFlood);
  group_.see_master(false);
  enable();
  int periods = 0;
  for (send(0); group_.drive(0).state() == DriveState::kOperationEnabled; ++periods) {
    group_.work(1);
    if (periods > 100) break;
  }
  EXPECT_NEAR(periods, 20, 3);
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

TEST_F(Group, AStallOfItsOwnLeadsOnNoFartherThanTheBridge) {
  enable();
  send(1, kSetpointEnabled, 100);
  group_.work(1);
  const double sent = group_.drive(0).position() + group_.drive(0).following_error();
  group_.work(1000);
  const double led_to = group_.drive(0).position() + group_.drive(0).following_error();
  EXPECT_NEAR(led_to - sent, 100 * 1e-3 * model_.bridge_cycles, 1e-9);
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
