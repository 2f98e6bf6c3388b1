// SPDX-License-Identifier: Apache-2.0
#include "service/drives/drive_group.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>

#include "support/machines.hpp"

namespace meridian::drives {
namespace {

class Group : public testing::Test {
 protected:
  void command(std::uint16_t controlword, std::uint64_t service = 7) {
    for (std::uint8_t i = 0; i < 5; ++i) {
      dds::DriveCommand word;
      word.drive = i;
      word.controlword = controlword;
      word.service_id = service;
      group_.take(word);
    }
  }
  void enable() {
    for (const std::uint16_t controlword : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F})
      command(controlword);
  }
  void send(double x, std::uint16_t flags = kSetpointEnabled, double velocity = 0) {
    dds::SetpointSample sample;
    sample.setpoint.cycle = ++cycle_;
    sample.setpoint.position[0] = x;
    sample.setpoint.velocity[0] = velocity;
    sample.setpoint.flags = flags;
    group_.take(sample);
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
}

TEST_F(Group, ASetpointThatIsNoNumberIsNotFollowed) {
  enable();
  send(1);
  group_.work(1);
  send(std::numeric_limits<double>::quiet_NaN());
  group_.work(1);
  EXPECT_EQ(group_.feedback().position[0], 1);
  send(1e308);
  group_.work(1);
  send(1, kSetpointEnabled, -1e308);
  group_.work(1);
  EXPECT_EQ(group_.feedback().position[0], 1) << "sums of such numbers overflow";
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

TEST_F(Group, ObeysOneServiceUntilItIsOff) {
  enable();
  command(0x00, 8);
  EXPECT_EQ(group_.drive(0).state(), DriveState::kOperationEnabled);
  command(0x06, 7);
  command(0x07, 8);
  EXPECT_EQ(group_.drive(0).state(), DriveState::kSwitchedOn);
  EXPECT_EQ(group_.service_id(), 8u);
}

/// Two services send to the same drives, as each may that did not hear of the other.
class TwoServices : public Group {
 protected:
  static constexpr std::uint64_t kObeyed = 41, kOther = 42;  // participants
  void command(std::uint16_t controlword, std::uint64_t service, std::uint64_t sender) {
    for (std::uint8_t i = 0; i < 5; ++i) {
      dds::DriveCommand word;
      word.drive = i;
      word.controlword = controlword;
      word.service_id = service;
      group_.take(word, sender);
    }
  }
  bool send(std::uint64_t cycle, double x, std::uint16_t flags, std::uint64_t sender) {
    dds::SetpointSample sample;
    sample.setpoint.cycle = cycle;
    sample.setpoint.position[0] = x;
    sample.setpoint.velocity[0] = 100;
    sample.setpoint.flags = flags;
    return group_.take(sample, sender);
  }
};

TEST_F(TwoServices, DrivesTakeTheSetpointsOfTheOneThatTheyObeyAlone) {
  for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F}) {
    command(word, 7, kObeyed);
  }
  for (std::uint64_t n = 0; n < 20; ++n) {  // the other has run for an hour, and is Off
    EXPECT_TRUE(send(100 + n, 0.1 * static_cast<double>(n), kSetpointEnabled, kObeyed));
    EXPECT_FALSE(send(3'600'000 + n, -50, 0, kOther));
    command(0x06, 8, kOther);
    group_.work(1);
    ASSERT_NEAR(group_.feedback().position[0], 0.1 * static_cast<double>(n), 1e-12) << n;
    ASSERT_EQ(group_.feedback().cycle_seen, 100 + n);
  }
  EXPECT_EQ(group_.setpoints_of_others(), 20U);
  EXPECT_EQ(group_.setpoints_seen(), 20U);
}

TEST_F(TwoServices, AnotherOnesSetpointsDoNotBridgeAGapOfTheOneThatIsObeyed) {
  for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F}) {
    command(word, 7, kObeyed);
  }
  (void)send(100, 0, kSetpointEnabled, kObeyed);
  for (std::uint64_t n = 0; n < 10; ++n) {
    (void)send(101 + n, 0, kSetpointEnabled, kOther);
    group_.work(1);
  }
  EXPECT_NE(group_.drive(0).state(), DriveState::kOperationEnabled) << "their watchdog sees it";
}

TEST_F(TwoServices, TheOtherOneIsTakenWhenItIsObeyed) {
  command(0x06, 7, kObeyed);
  (void)send(3'600'000, 1, 0, kObeyed);
  command(0x06, 8, kOther);
  EXPECT_FALSE(send(3'600'001, 1, 0, kObeyed));
  EXPECT_TRUE(send(5, 1, 0, kOther));
  EXPECT_EQ(group_.feedback().cycle_seen, 5U);
}

TEST_F(TwoServices, AServiceThatIsFoundAgainUnderAnotherNumberIsTakenWithItsNextWord) {
  command(0x06, 7, kObeyed);
  EXPECT_FALSE(send(10, 1, 0, 43));
  command(0x06, 7, 43);
  EXPECT_TRUE(send(11, 1, 0, 43));
}

TEST_F(Group, ObeysTheNextServiceWhereOneDiedBeforeItsFirstEnabledSetpoint) {
  enable();
  send(0, 0);
  for (int n = 0; n < 10; ++n) group_.work(1);
  command(0x06, 8);
  EXPECT_EQ(group_.service_id(), 8U);
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

TEST_F(Group, BridgesAsTheServiceSaysThatItObeysNotOneThatClaimsTheMachine) {
  const auto periods_until_quick_stop = [this] {
    enable();
    int periods = 0;
    for (send(0); group_.drive(0).state() == DriveState::kOperationEnabled; ++periods) {
      group_.work(1);
      if (periods > 100) break;
    }
    return periods;
  };
  group_.take(service(7, 20, true));
  group_.take(service(8, 1, false));
  group_.take(service(8, 2, true));
  command(0x06);
  group_.take(service(9, 50, true));
  EXPECT_NEAR(periods_until_quick_stop(), 20, 3) << "obeys 7";
}

TEST_F(Group, ARestartedServiceMayCountCyclesAnew) {
  enable();
  send(1);
  group_.work(1);
  command(0x06);
  cycle_ = 0;
  send(1);
  EXPECT_EQ(group_.feedback().cycle_seen, 1u);
}

TEST_F(Group, InjectsFaultsAfterTheTimeEnabled) {
  group_.inject({Injection::Kind::kFault, 0.005, 3});
  enable();
  for (int i = 0; i < 4; ++i) {
    send(0);
    group_.work(1);
  }
  EXPECT_EQ(group_.drive(3).error(), kErrorNone);
  send(0);
  group_.work(1);
  EXPECT_EQ(group_.drive(3).error(), kErrorDevice);
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
