// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/jog/homing.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "unit/cycle/hand.hpp"

namespace meridian {
namespace {

using test::Hand;

/// Drives that home themselves as they are asked to: they creep to their reference, where their
/// position becomes `kThere` of what they called it before.
class Homed : public testing::Test {
 protected:
  explicit Homed(const MachineModel& machine = test::lai_machine()) : hand(machine, {}, 0) {}

  static constexpr double kThere = 100;
  static constexpr int kSearch_cycles = 40;

  void run(double seconds) {
    for (double t = 0; t < seconds; t += hand.world.dt()) {
      hand.world.run();
      work();
    }
  }
  [[nodiscard]] bool run_until(State wanted, double seconds) {
    for (double t = 0; t < seconds && hand.world.now() != wanted; t += hand.world.dt()) run(1e-4);
    return hand.world.now() == wanted;
  }
  void home(double mask = 0) { hand.world.command(Verb::kHome, mask); }

  void work() {
    const HomingAsked asked = asked_of(hand.world.state.homing);
    Feedback& f = hand.world.in.feedback;
    ++cycles;
    f.homing_mask = is_deaf ? f.homing_mask : asked.mode_mask;
    if (late >= 0 && asked.mode_mask != last_mask) changed = cycles;
    last_mask = asked.mode_mask;
    if (late >= 0 && cycles - changed < 20) f.homing_mask ^= 1U << late;
    for (int joint = 0; joint < 5; ++joint) {
      const std::uint32_t bit = 1U << joint;
      const auto i = static_cast<std::size_t>(joint);
      const bool is_searching = (asked.start_mask & f.homing_mask & bit) != 0;
      if (is_searching && searched[i] == 0) order.push_back(joint);
      if (!is_searching && searched[i] > 0) halted[i] = cycles;
      searched[i] = is_searching ? searched[i] + 1 : 0;
      const auto set = [bit](std::uint32_t& mask, bool is_set) {
        mask = is_set ? mask | bit : mask & ~bit;
      };
      const bool is_coasting = !is_searching && halted[i] != 0 && cycles - halted[i] < coast;
      if (is_searching || is_coasting) f.position[i] += 0.01;
      if (joint == 2 && (f.homing_mask & bit) == 0) f.position[i] -= sag;
      const bool is_there = is_searching && searched[i] >= kSearch_cycles + joint && joint != lost;
      if (is_there && (f.referenced_mask & bit) == 0) f.position[i] += kThere;
      set(f.homed_mask, is_there);
      const bool is_old = joint == failed_before && (keeps_error || searched[i] < 5);
      set(f.homing_error_mask, is_old || (is_searching && joint == broken && searched[i] > 10));
      set(f.still_mask, (!is_searching && !is_coasting) || is_there);
      if (is_there) f.referenced_mask |= bit;
    }
  }
  [[nodiscard]] Event alarm() const { return hand.world.last(EventCode::kAlarm); }

  Hand hand;
  std::array<int, 5> searched{}, halted{};
  int cycles = 0, changed = -100;
  std::uint32_t last_mask = 0;
  std::vector<int> order;  ///< in which drives began to search
  int broken = -1, lost = -1;
  int failed_before = -1;  ///< still reports its previous error until it searches
  int late = -1;           ///< changes its mode 20 cycles after the others
  int coast = 0;           ///< cycles that drives take to stand when they are halted
  double sag = 0;          ///< by which drive 2 is behind the setpoints that it follows
  bool is_deaf = false, keeps_error = false;
};

class HomedStage : public Homed {
 protected:
  HomedStage() : Homed(test::hybrid_machine()) {}
};

TEST_F(Homed, EveryJointInTheOrderOfTheMachineFileThenReady) {
  hand.world.state.options.homing_turns = {2, 2, 1, 2, 2};
  home();
  ASSERT_EQ(hand.world.now(), State::kHoming);
  ASSERT_TRUE(run_until(State::kReady, 5));
  EXPECT_EQ(order, (std::vector<int>{2, 0, 1, 3, 4}));
  EXPECT_EQ(hand.world.in.feedback.referenced_mask, 0x1FU);
  EXPECT_EQ(hand.world.count(EventCode::kJointsHomed), 2);
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0) << "a jump of the position is no fault";
  EXPECT_EQ(hand.world.state.joints, hand.world.in.feedback.position);
  EXPECT_GT(hand.world.state.joints[2], kThere);
}

TEST_F(Homed, SetpointsOfOtherJointsStandStill) {
  home(4);
  ASSERT_TRUE(run_until(State::kReady, 5));
  for (const CycleRecord& record : hand.world.records) EXPECT_EQ(record.joints[0], 0);
  EXPECT_EQ(hand.world.in.feedback.referenced_mask, 4U);
}

TEST_F(Homed, AloneOfAllJointsOneAfterTheOtherIsTheDefault) {
  home();
  ASSERT_TRUE(run_until(State::kReady, 5));
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST_F(Homed, AJointTwiceGivesItsReferenceAnew) {
  home(1);
  ASSERT_TRUE(run_until(State::kReady, 5));
  home(1);
  ASSERT_TRUE(run_until(State::kReady, 5));
  EXPECT_EQ(order, (std::vector<int>{0, 0}));
}

TEST_F(Homed, ADriveThatFindsNoReferenceEndsItWithAnAlarmAndWithoutAFault) {
  broken = 1;
  home();
  ASSERT_TRUE(run_until(State::kReady, 5));
  EXPECT_EQ(static_cast<Alarm>(alarm().a), Alarm::kHomingFailed);
  EXPECT_EQ(alarm().b, 1U);
  EXPECT_EQ(hand.world.in.feedback.referenced_mask, 1U) << "who was before it has its reference";
  EXPECT_EQ(order, (std::vector<int>{0, 1})) << "who came after it did not begin";
}

TEST_F(Homed, ADriveThatSearchesTooLongIsReported) {
  hand.world.state.options.homing_timeout_s = 0.5;
  lost = 0;
  home(3);
  ASSERT_TRUE(run_until(State::kReady, 5));
  EXPECT_EQ(static_cast<Alarm>(alarm().a), Alarm::kHomingTimeout);
  EXPECT_EQ(alarm().b, 0U);
  EXPECT_GT(alarm().x, 0.5);
}

TEST_F(Homed, DrivesThatKnowNoHomingModeAreReported) {
  is_deaf = true;
  home(16);
  ASSERT_TRUE(run_until(State::kReady, 5));
  EXPECT_EQ(static_cast<Alarm>(alarm().a), Alarm::kHomingTimeout);
  EXPECT_EQ(alarm().b, 4U);
}

TEST_F(Homed, DrivesThatDoNotComeBackAreAFault) {
  home(1);
  run(0.02);
  is_deaf = true;
  ASSERT_TRUE(run_until(State::kFault, 5));
  EXPECT_EQ(static_cast<Alarm>(alarm().a), Alarm::kHomingTimeout);
}

TEST_F(Homed, AbortHaltsTheDrivesAndTheMachineIsReady) {
  for (const Verb verb : {Verb::kAbort, Verb::kHold}) {
    home();
    run(0.02);
    ASSERT_NE(asked_of(hand.world.state.homing).start_mask, 0U);
    hand.world.command(verb);
    EXPECT_EQ(hand.world.now(), State::kAborting);
    EXPECT_EQ(asked_of(hand.world.state.homing).start_mask, 0U);
    ASSERT_TRUE(run_until(State::kReady, 5));
    EXPECT_EQ(asked_of(hand.world.state.homing).mode_mask, 0U);
    EXPECT_EQ(hand.world.in.feedback.referenced_mask, 0U);
  }
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

TEST_F(Homed, ADriveFaultEndsItInFault) {
  home();
  run(0.02);
  hand.world.in.feedback.fault_mask = 1;
  ASSERT_TRUE(run_until(State::kFault, 1));
  EXPECT_EQ(asked_of(hand.world.state.homing).mode_mask, 0U);
}

TEST_F(Homed, DrivesThatFollowSetpointsAreHeldAndDoNotSag) {
  sag = 0.05;
  late = 2;
  home(4);
  run(0.01);
  EXPECT_EQ(hand.world.state.joints[2], 0) << "not in homing mode yet";
  is_deaf = true, late = -1;
  hand.world.in.feedback.homing_mask = 0;
  ASSERT_TRUE(run_until(State::kReady, 5));
  for (const CycleRecord& record : hand.world.records) EXPECT_EQ(record.joints[2], 0);
}

TEST_F(Homed, AFaultHaltsTheDrivesAndLeavesThemOnUntilTheyStand) {
  coast = 50;
  home();
  run(0.02);
  hand.world.in.feedback.emergency_stop = true;
  const int begin = cycles;
  run(1e-4);
  ASSERT_EQ(hand.world.now(), State::kFaultStop);
  EXPECT_EQ(asked_of(hand.world.state.homing).start_mask, 0U);
  EXPECT_EQ(asked_of(hand.world.state.homing).mode_mask, 1U) << "halts in its own mode";
  ASSERT_TRUE(run_until(State::kFault, 1));
  EXPECT_GE(cycles - begin, coast) << "still moving";
  EXPECT_LE(cycles - begin, coast + 5);
  EXPECT_EQ(asked_of(hand.world.state.homing).mode_mask, 0U);
}

TEST_F(Homed, AFaultOfDrivesThatNeverStandEndsInTime) {
  coast = 1 << 30;
  home();
  run(0.02);
  hand.world.in.feedback.fault_mask = 2;
  run(kChangeMode_s - 0.1);
  EXPECT_EQ(hand.world.now(), State::kFaultStop);
  ASSERT_TRUE(run_until(State::kFault, 0.2));
  EXPECT_FALSE(hand.world.state.homing.is_active());
}

TEST_F(Homed, FeedbackThatIsLostLeavesNumbersAndEndsInTime) {
  home();
  run(0.02);
  hand.world.are_drives_alive = false;
  hand.world.in.feedback.position[0] = std::nan("");
  hand.world.in.feedback.still_mask = 0;
  for (int n = 0; hand.world.now() != State::kFault && n < 10000; ++n) hand.world.run();
  EXPECT_EQ(hand.world.now(), State::kFault);
  for (const CycleRecord& record : hand.world.records) ASSERT_TRUE(std::isfinite(record.joints[0]));
}

TEST_F(Homed, TheErrorOfTheTimeBeforeIsNoneOfThisTime) {
  failed_before = 0;
  home(1);
  ASSERT_TRUE(run_until(State::kReady, 5));
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
  EXPECT_EQ(hand.world.in.feedback.referenced_mask, 1U);
}

TEST_F(Homed, AnErrorThatStaysIsOne) {
  failed_before = 0;
  keeps_error = true;
  lost = 0;
  home(1);
  ASSERT_TRUE(run_until(State::kReady, 5));
  EXPECT_EQ(static_cast<Alarm>(alarm().a), Alarm::kHomingFailed);
}

TEST_F(HomedStage, BothDrivesHomeTogetherAndNoneGetsAStepOfTheOther) {
  for (const int joint : {1, 3}) {
    for (const int slow : {1, 3}) {
      late = slow;
      order.clear();
      hand.world.in.feedback.referenced_mask = 0;
      home(1 << joint);
      ASSERT_EQ(hand.world.now(), State::kHoming);
      while (hand.world.now() == State::kHoming) {
        const JointVector before = hand.world.records.back().setpoint.position;
        const std::uint32_t modes = hand.world.in.feedback.homing_mask;
        run(1e-4);
        const JointVector after = hand.world.records.back().setpoint.position;
        for (std::size_t i = 0; i < 5; ++i) {
          if ((modes >> i & 1U) != 0) continue;
          ASSERT_NEAR(after[i], before[i], 1e-9) << "drive " << i << " follows setpoints";
        }
      }
      EXPECT_EQ(order, (std::vector<int>{1, 3}));
      EXPECT_EQ(hand.world.in.feedback.referenced_mask, 0xAU);
      EXPECT_EQ(hand.world.now(), State::kReady);
    }
  }
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

TEST_F(HomedStage, BothHaveTheEarlierOfTheirTurns) {
  hand.world.state.options.homing_turns = {3, 2, 1, 4, 5};
  home();
  ASSERT_TRUE(run_until(State::kReady, 5));
  EXPECT_EQ(order, (std::vector<int>{2, 1, 3, 0, 4}));
}

TEST_F(Homed, NobodyStartsAProgramBefore) {
  EXPECT_EQ(hand.world.now(), State::kReady);
  home(32);
  EXPECT_EQ(hand.refusal(), Refusal::kOutOfRange) << "no such joint";
  home(1.5);
  EXPECT_EQ(hand.refusal(), Refusal::kOutOfRange);
  hand.world.in.session = 3;
  home();
  EXPECT_EQ(hand.refusal(), Refusal::kProgramPresent);
}

}  // namespace
}  // namespace meridian
