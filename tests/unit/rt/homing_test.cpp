// SPDX-License-Identifier: Apache-2.0
#include "meridian/rt/homing.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "unit/rt/hand.hpp"

namespace meridian {
namespace {

using test::Hand;

/// Drives that home themselves as they are asked to: they creep to their reference, where their
/// position becomes `kThere` of what they called it before.
class Homed : public testing::Test {
 protected:
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
    f.homing_mask = is_deaf ? f.homing_mask : asked.mode_mask;
    for (int joint = 0; joint < 5; ++joint) {
      const std::uint32_t bit = 1U << joint;
      const auto i = static_cast<std::size_t>(joint);
      const bool is_searching = (asked.start_mask & f.homing_mask & bit) != 0;
      if (is_searching && searched[i] == 0) order.push_back(joint);
      searched[i] = is_searching ? searched[i] + 1 : 0;
      const auto set = [bit](std::uint32_t& mask, bool is_set) {
        mask = is_set ? mask | bit : mask & ~bit;
      };
      if (is_searching) f.position[i] += 0.01;
      const bool is_there = is_searching && searched[i] >= kSearch_cycles && joint != lost;
      if (is_there && (f.referenced_mask & bit) == 0) f.position[i] += kThere;
      set(f.homed_mask, is_there);
      set(f.homing_error_mask, is_searching && joint == broken && searched[i] > 10);
      set(f.still_mask, !is_searching || is_there);
      if (is_there) f.referenced_mask |= bit;
    }
  }
  [[nodiscard]] Event alarm() const { return hand.world.last(EventCode::kAlarm); }

  Hand hand{test::lai_machine(), {}, 0};
  std::array<int, 5> searched{};
  std::vector<int> order;  ///< in which drives began to search
  int broken = -1, lost = -1;
  bool is_deaf = false;
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

TEST_F(Homed, ADriveThatSearchesTooLongIsTold) {
  hand.world.state.options.homing_timeout_s = 0.5;
  lost = 0;
  home(3);
  ASSERT_TRUE(run_until(State::kReady, 5));
  EXPECT_EQ(static_cast<Alarm>(alarm().a), Alarm::kHomingTimeout);
  EXPECT_EQ(alarm().b, 0U);
  EXPECT_GT(alarm().x, 0.5);
}

TEST_F(Homed, DrivesThatKnowNoHomingModeAreTold) {
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
