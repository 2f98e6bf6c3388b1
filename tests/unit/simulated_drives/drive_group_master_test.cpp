// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <initializer_list>

#include "unit/simulated_drives/drive_group.hpp"

namespace meridian::drives {
namespace {

using drive::Drop;
using drive::MasterPin;

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
  EXPECT_NEAR(periods_of_silence_bridged(), 20, 3);
}

TEST_F(Group, BridgesAsItsNextMasterSaidWhileItStillObeyedTheLast) {
  constexpr std::uint64_t kLast = kMaster + 1, kFlood = kMaster + 2;
  command(0x06, 6, kLast);
  hear(service(7, 20, true), kMaster);
  for (std::uint64_t id = 100; id < 200; ++id) hear(service(id, 1, true), kFlood);
  group_.see_master(false);
  enable();
  EXPECT_NEAR(periods_of_silence_bridged(), 20, 3);
}

}  // namespace
}  // namespace meridian::drives
