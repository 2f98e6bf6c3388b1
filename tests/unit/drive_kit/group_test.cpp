// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/group.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <utility>

#include "support/heap_watch.hpp"
#include "unit/drive_kit/scripted_hardware.hpp"

namespace meridian::drive {
namespace {

constexpr std::uint64_t kMaster = 41, kOther = 42, kService = 7;

GroupSpec joints_2_and_4() {
  GroupSpec spec;
  spec.number = 3;
  spec.joints = 5;
  for (const int joint : {2, 4}) {
    GroupAxis axis;
    axis.joint = joint;
    axis.spec.limits.velocity = 300;
    axis.spec.limits.following_error = 5;
    axis.spec.limits.fault_acceleration = 5000;
    spec.axes.push_back(axis);
  }
  return spec;
}

class PartOfAMachine : public testing::Test {
 protected:
  Drop command(std::uint8_t drive, std::uint16_t controlword, std::uint64_t sender = kMaster) {
    dds::DriveCommand command;
    command.drive = drive;
    command.controlword = controlword;
    command.service_id = kService;
    return group_.take(command, sender);
  }
  void enable() {
    for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F}) {
      for (std::uint8_t drive = 0; drive < 5; ++drive) (void)command(drive, word);
    }
  }
  Drop send(double step, std::uint16_t flags = kSetpointEnabled, std::uint64_t sender = kMaster,
            double velocity = 0) {
    dds::SetpointSample sample;
    sample.setpoint.cycle = ++cycle_;
    sample.setpoint.due_ns = static_cast<std::int64_t>(cycle_) * 1'000'000;
    sample.setpoint.flags = flags;
    for (std::size_t i = 0; i < 6; ++i) {
      position_[i] += step * static_cast<double>(i);
      sample.setpoint.position[i] = position_[i];
    }
    sample.setpoint.velocity.fill(velocity);
    sample.crc = dds::setpoint_crc(sample.setpoint, kService);
    return group_.take(sample, sender, sample.setpoint.due_ns);
  }

  test::ScriptedHardware motors_;
  Group group_{joints_2_and_4()};
  JointVector position_{};
  std::uint64_t cycle_ = 100;
};

TEST_F(PartOfAMachine, AxesTakeTheSetpointsOfTheirJointsAndReportThem) {
  enable();
  (void)send(0.01);
  group_.work(1, motors_);
  EXPECT_DOUBLE_EQ(motors_.outputs[0].position, 0.02);
  EXPECT_DOUBLE_EQ(motors_.outputs[1].position, 0.04);
  const dds::DriveFeedback feedback = group_.feedback();
  EXPECT_EQ(feedback.drive_group, 3U);
  EXPECT_EQ(feedback.joint_mask, 0x14U);
  EXPECT_EQ(feedback.referenced_mask, 0x14U);
  EXPECT_DOUBLE_EQ(feedback.position[4], 0.04);
  EXPECT_EQ(feedback.statusword[0], 0);
  EXPECT_EQ(drive_state(feedback.statusword[2]), DriveState::kOperationEnabled);
  EXPECT_EQ(feedback.cycle_seen, 101U);
  EXPECT_EQ(feedback.service_id, kService);
}

TEST_F(PartOfAMachine, CommandsToTheOtherJointsOfTheMachineAreTheMastersToo) {
  EXPECT_EQ(command(0, 0x06), Drop::kNone);
  EXPECT_EQ(group_.pin().state(), MasterPin::State::kPinned);
  EXPECT_EQ(command(5, 0x06), Drop::kImplausible) << "the machine has five";
  EXPECT_EQ(command(2, 0x06, kOther), Drop::kForeignCommand);
}

TEST_F(PartOfAMachine, ACommandIsForTheAxisOfItsJointAlone) {
  for (const std::uint8_t drive : std::initializer_list<std::uint8_t>{0, 1, 3, 4}) {
    EXPECT_EQ(command(drive, 0x06), Drop::kNone);
  }
  EXPECT_EQ(group_.axis(0).state(), DriveState::kSwitchOnDisabled) << "joint 2";
  EXPECT_EQ(group_.axis(1).state(), DriveState::kReadyToSwitchOn) << "joint 4";
}

TEST_F(PartOfAMachine, TheStopInputIsReported) {
  group_.work(1, motors_);
  EXPECT_FALSE(group_.feedback().is_emergency_stop);
  motors_.is_stop_open = true;
  group_.work(1, motors_);
  EXPECT_TRUE(group_.feedback().is_emergency_stop);
}

TEST_F(PartOfAMachine, AnOpenGuardIsReported) {
  group_.work(1, motors_);
  EXPECT_FALSE(group_.feedback().is_guard_open);
  motors_.is_a_guard_open = true;
  group_.work(1, motors_);
  EXPECT_TRUE(group_.feedback().is_guard_open);
}

TEST_F(PartOfAMachine, TheTouchProbeIsReported) {
  for (const drive::Probe probe : {Probe::kNone, Probe::kFree, Probe::kContact}) {
    motors_.touch_probe = probe;
    group_.work(1, motors_);
    EXPECT_EQ(static_cast<int>(group_.feedback().probe), static_cast<int>(probe));
  }
}

TEST_F(PartOfAMachine, NothingMovesInADryRun) {
  enable();
  (void)send(0);
  group_.work(1, motors_);
  for (int n = 0; n < 3; ++n) {
    (void)send(0.01, kSetpointDry | kSetpointDryEnabled);
    group_.work(1, motors_);
    EXPECT_EQ(motors_.outputs[1].position, 0);
  }
}

TEST_F(PartOfAMachine, ASetpointIsTakenOnceInOrderInTimeAndFromTheMasterAlone) {
  enable();
  (void)send(0);
  group_.work(1, motors_);
  const auto sample = [this](std::uint64_t cycle, std::int64_t due_ns) {
    dds::SetpointSample one;
    one.setpoint.cycle = cycle;
    one.setpoint.due_ns = due_ns;
    one.setpoint.position[2] = 0.1;
    one.setpoint.flags = kSetpointEnabled;
    one.crc = dds::setpoint_crc(one.setpoint, kService);
    return one;
  };
  const auto at = [](std::uint64_t cycle) { return static_cast<std::int64_t>(cycle) * 1'000'000; };
  EXPECT_EQ(group_.take(sample(cycle_, at(cycle_)), kMaster, at(cycle_)), Drop::kOutOfOrder)
      << "doubled";
  EXPECT_EQ(group_.take(sample(cycle_ - 5, at(cycle_)), kMaster, at(cycle_)), Drop::kOutOfOrder)
      << "overtaken";
  const std::uint64_t next = cycle_ + 1;
  EXPECT_EQ(group_.take(sample(next, at(next)), kMaster, at(next) + 30'000'000), Drop::kStale)
      << "late";
  EXPECT_EQ(group_.take(sample(next, at(next)), kOther, at(next)), Drop::kForeignSetpoint);
  group_.work(1, motors_);
  EXPECT_EQ(motors_.outputs[0].position, 0) << "nothing of all that";
  EXPECT_EQ(group_.periods_bridged(), 1U);
  EXPECT_EQ(group_.take(sample(next, at(next)), kMaster, at(next)), Drop::kNone);
  group_.work(1, motors_);
  EXPECT_EQ(motors_.outputs[0].position, 0.1);
}

TEST_F(PartOfAMachine, TheTimeBetweenTwoPositionsIsThatOfTheServicesCycles) {
  enable();
  const auto elapsed_after = [this](int setpoints) {
    for (int n = 0; n < setpoints; ++n) (void)send(0.01);
    group_.work(1, motors_);
    return motors_.outputs[0].elapsed_s;
  };
  (void)elapsed_after(1);
  EXPECT_NEAR(elapsed_after(1), 1e-3, 1e-12);
  EXPECT_NEAR(elapsed_after(2), 2e-3, 1e-12) << "two at once";
  EXPECT_NEAR(elapsed_after(0), 1e-3, 1e-12) << "none: the bridge leads on";
  EXPECT_NEAR(elapsed_after(1), 0, 1e-12) << "the bridge was there already";
  EXPECT_NEAR(elapsed_after(1), 1e-3, 1e-12);
}

TEST_F(PartOfAMachine, LostPeriodsOfItsOwnAreOneExchange) {
  group_.work(4, motors_);
  EXPECT_DOUBLE_EQ(motors_.exchanged_s, 4e-3);
}

/// The bridge is 3 cycles. Its end is one of the periods that this side lost, or not.
TEST_F(PartOfAMachine, TheRampBehindTheBridgeBeginsAtTheSentVelocityHoweverManyPeriodsAreLost) {
  constexpr double kStep = 0.05, kVelocity = 100, kAcceleration = 5000;  // mm, of joint 2
  for (int bridged = 0; bridged <= 3; ++bridged) {
    for (int lost = 0; lost <= 30; ++lost) {
      Group group{joints_2_and_4()};
      std::swap(group, group_);
      motors_ = {};
      position_ = {};
      enable();
      for (int n = 0; n < 5; ++n) {
        (void)send(kStep, kSetpointEnabled, kMaster, kVelocity);
        group_.work(1, motors_);
      }
      const double begin = motors_.outputs[0].position;
      for (int n = 0; group_.axis(0).state() != DriveState::kFault; ++n) {
        ASSERT_LT(n, 50);
        const Output before = motors_.outputs[0];
        group_.work(n == bridged ? 1 + lost : 1, motors_);
        const Output& now = motors_.outputs[0];
        const double dt_s = now.elapsed_s;
        const double off =
            now.position - before.position - 0.5 * (before.velocity + now.velocity) * dt_s;
        EXPECT_LE(before.velocity - now.velocity, kAcceleration * dt_s + 1e-9)
            << bridged << " " << lost;
        EXPECT_LE(std::abs(off), kAcceleration * dt_s * dt_s / 8 + 1e-9) << bridged << " " << lost;
      }
      EXPECT_EQ(group_.axis(0).error(), kErrorSetpointsStopped);
      // The bridge and the ramp; who loses periods goes on meanwhile, by one more bridge at most.
      const double stop = 0.3 + kVelocity * kVelocity / (2 * kAcceleration);
      const double distance = motors_.outputs[0].position - begin;
      EXPECT_GE(distance, stop - 1e-9) << bridged << " " << lost;
      EXPECT_LE(distance, stop + 0.3 + 1e-9) << bridged << " " << lost;
    }
  }
}

enum class Stop { kQuick, kFault, kSilence };

TEST_F(PartOfAMachine, AStopGoesOnForOneMoreBridgeAtMostWhereEveryPeriodIsLost) {
  constexpr double kStep = 0.05, kVelocity = 100, kAcceleration = 5000;  // mm, of joint 2
  constexpr double kRamp_s = kVelocity / kAcceleration;
  for (const int bridge : {3, 50}) {
    for (const int periods : {1, 2, 4, bridge + 1}) {
      for (const Stop stop : {Stop::kQuick, Stop::kFault, Stop::kSilence}) {
        Group group{joints_2_and_4()};
        std::swap(group, group_);
        motors_ = {};
        position_ = {};
        enable();
        group_.take(Bridge{{kMaster, kService}, bridge});
        for (int n = 0; n < 5; ++n) {
          (void)send(kStep, kSetpointEnabled, kMaster, kVelocity);
          group_.work(1, motors_);
        }
        motors_.readings[0].velocity = kVelocity;
        if (stop == Stop::kQuick) (void)command(2, 0x02);
        if (stop == Stop::kFault) group_.axis(0).fail(0x2310);
        const double begin = motors_.outputs[0].position;
        double moved_s = 0;
        for (int n = 0; motors_.outputs[0].velocity != 0 && n < 200; ++n) {
          group_.work(periods, motors_);
          moved_s += 1e-3 * periods;
        }
        const double bridge_s = 1e-3 * bridge, bridged_s = stop == Stop::kSilence ? bridge_s : 0;
        const double lost_s = periods > 1 ? bridge_s : 0;
        EXPECT_LE(moved_s, bridged_s + lost_s + kRamp_s + 2e-3 * periods)
            << bridge << " " << periods << " " << static_cast<int>(stop);
        EXPECT_LE(motors_.outputs[0].position - begin,
                  kVelocity * (bridged_s + lost_s + 0.5 * kRamp_s) + 1e-9)
            << bridge << " " << periods << " " << static_cast<int>(stop);
      }
    }
  }
}

TEST_F(PartOfAMachine, NoPeriodMakesAHeapCallWhateverComes) {
  if (!watch::is_heap_watched()) GTEST_SKIP() << "heap calls are not counted under sanitizers";
  enable();
  (void)send(0);
  group_.work(1, motors_);
  const watch::HeapWatch heap;
  for (int n = 0; n < 200; ++n) {
    if (n % 7 != 0) (void)send(0.001);
    if (n % 5 == 0) (void)send(0.001, kSetpointEnabled, kOther);
    if (n % 11 == 0) (void)command(2, 0x06, kOther);
    group_.take(Bridge{{kMaster, kService}, 3 + n % 2});
    group_.see_master(n < 150);
    if (n == 100) motors_.readings[0].error = 0x2310;
    if (n == 120) {
      motors_.readings[0].error = 0;
      (void)command(2, 0x00);
      (void)command(2, 0x80);
    }
    if (n == 130) (void)command(4, 0x02);
    group_.work(1 + n % 3 / 2, motors_);
    (void)group_.feedback();
  }
  const auto calls = heap.calls();
  EXPECT_EQ(calls, watch::HeapCalls{}) << watch::HeapWatch::callers(calls);
}

}  // namespace
}  // namespace meridian::drive
