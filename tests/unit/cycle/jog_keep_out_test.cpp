// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "meridian/cycle/jog/jogging.hpp"
#include "support/keep_out_machine.hpp"
#include "support/machines.hpp"
#include "unit/cycle/hand.hpp"

/// Jogging about a keep-out box: it ends at the face, and no guard fires.
namespace meridian {
namespace {

using test::Hand;

/// b3 from 100 to 200 while b4 is from -50 to 50.
MachineModel machine_with_a_vice() {
  return test::with_keep_out(test::lai_machine(), 0b101, {100, 0, -50}, {200, 0, 50});
}

TEST(JogKeepOut, EndsAtTheFaceOfTheBox) {
  for (const double velocity : {20.0, 290.0}) {
    Hand hand(machine_with_a_vice());
    ASSERT_TRUE(hand.lay_on(0));
    hand.hold(0, velocity, 8);
    EXPECT_NEAR(hand.world.state.joints[0], 100, 1e-6);
    EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
  }
}

TEST(JogKeepOut, GoesPastTheBoxWhereAnotherJointIsOutsideOfIt) {
  Hand hand(machine_with_a_vice(), {0, 0, 60});
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 290, 2);
  EXPECT_GT(hand.world.state.joints[0], 250);
  hand.world.run_for(1);
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, -290, 0.8);
  hand.world.run_for(1);
  ASSERT_GT(hand.world.state.joints[0], 100);
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

TEST(JogKeepOut, ComesOutOfTheBoxToTheNearerFaceAlone) {
  Hand hand(machine_with_a_vice(), {120, 0, 0});
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 100, 0.5);
  EXPECT_NEAR(hand.world.state.joints[0], 120, 1e-9);
  hand.hold(0, -100, 0.5);
  hand.world.run_for(1);
  EXPECT_LT(hand.world.state.joints[0], 90);
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

TEST(JogKeepOut, OfTheToolEndsAheadOfTheBox) {
  for (const int axis : {0, 1, 2}) {
    for (const double velocity : {-80.0, 80.0}) {
      const JointVector at{70, 20, 80, 0.6, 0.4};
      Hand hand(machine_with_a_vice(), at);
      ASSERT_TRUE(hand.lay_on(kMaxJoints + axis));
      hand.hold(kMaxJoints + axis, velocity, 3);
      hand.world.run_for(1);
      EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0) << axis << " " << velocity;
      const KeepOutBox& box = hand.world.machine.keep_out.boxes()[0];
      for (const CycleRecord& record : hand.world.records) {
        ASSERT_LE(depth_inside(box, record.joints), kKeepOutRounding) << axis << " " << velocity;
      }
    }
  }
}

TEST(JogKeepOut, OfTheToolStopsShortOfABoxInItsWay) {
  constexpr double kAway_mm = 50;  // of the 100 that are surveyed
  const JointVector at{150, 0, 50 + kAway_mm, 0, 0};
  Hand open(test::lai_machine(), at), boxed(machine_with_a_vice(), at);
  for (Hand* hand : {&open, &boxed}) {
    ASSERT_TRUE(hand->lay_on(kMaxJoints + 2));
    hand->hold(kMaxJoints + 2, 300, 3);
    EXPECT_EQ(hand->world.count(EventCode::kAlarm), 0);
  }
  EXPECT_GT(std::abs(open.world.state.joints[2] - at[2]), 1.5 * kAway_mm);
  const double distance = std::abs(boxed.world.state.joints[2] - at[2]);
  EXPECT_LE(distance, kAway_mm);
  EXPECT_GT(distance, 0.8 * kAway_mm);
}

}  // namespace
}  // namespace meridian
