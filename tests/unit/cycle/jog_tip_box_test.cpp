// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "meridian/cycle/jog/jogging.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "support/machines.hpp"
#include "unit/cycle/hand.hpp"

/// Jogging in a tip box: it ends at the face, and no guard fires.
namespace meridian {
namespace {

using test::Hand;

[[nodiscard]] Array3 tip_of(const MachineModel& model, const JointVector& joints) {
  return tip_over_base(model, model.tool_length_mm, joints);
}

/// The box that reaches `half_mm` about the tip at `joints`.
MachineModel machine_about(const JointVector& joints, double half_mm) {
  MachineModel model = test::lai_machine();
  const Array3 tip = tip_of(model, joints);
  model.tip_box.is_set = true;
  for (std::size_t i = 0; i < 3; ++i) {
    model.tip_box.min[i] = tip[i] - half_mm;
    model.tip_box.max[i] = tip[i] + half_mm;
  }
  return model;
}

double farthest_out(const Hand& hand) {
  double out = -1e9;
  for (const CycleRecord& record : hand.world.records) {
    const Array3 tip = tip_of(hand.world.machine, record.joints);
    for (std::size_t i = 0; i < 3; ++i) {
      out = std::max(out, beyond_face(hand.world.machine.tip_box, i, tip[i]));
    }
  }
  return out;
}

TEST(JogTipBox, OfAJointEndsWithTheTipOnTheFace) {
  const JointVector at{70, 20, 80, 0.6, 0.4};
  for (const int joint : {0, 2, 4}) {
    for (const double share : {-0.9, 0.9}) {
      Hand hand(machine_about(at, 30), at);
      ASSERT_TRUE(hand.lay_on(joint));
      const double velocity = share * hand.world.machine.joints[joint].limits.velocity;
      hand.hold(joint, velocity, 2);
      hand.world.run_for(1);
      EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0) << joint;
      EXPECT_NEAR(farthest_out(hand), 0, 1e-6) << joint;
    }
  }
}

TEST(JogTipBox, SaysNothingOfAJointThatMovesTheTableAlone) {
  const JointVector at{70, 20, 80, 0.6, 0.4};
  Hand hand(machine_about(at, 30), at);
  ASSERT_TRUE(hand.lay_on(1));
  hand.hold(1, 290, 1);
  EXPECT_GT(hand.world.state.joints[1], 200);
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

TEST(JogTipBox, LetsATipThatIsOutsideComeInAlone) {
  const JointVector inside{70, 20, 80, 0.6, 0}, outside{120, 20, 80, 0.6, 0};
  Hand hand(machine_about(inside, 30), outside);
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 100, 0.5);
  EXPECT_NEAR(hand.world.state.joints[0], 120, 1e-9);
  hand.hold(0, -100, 2);
  hand.world.run_for(1);
  EXPECT_NEAR(hand.world.state.joints[0], 40, 1e-6) << "in, and to the other face";
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

TEST(JogTipBox, IsNotKnownWhereAJointThatMovesTheTipHasNoReference) {
  const JointVector at{70, 20, 80, 0.6, 0.4};
  Hand hand(machine_about(at, 30), at, 0b01111);
  ASSERT_TRUE(hand.lay_on(0));
  hand.hold(0, 290, 1);
  EXPECT_GT(hand.world.state.joints[0], 200);
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

TEST(JogTipBox, OfTheToolEndsInTheBox) {
  const JointVector at{70, 20, 80, 0.6, 0.4};
  for (const int axis : {0, 1, 2}) {
    for (const double velocity : {-80.0, 80.0}) {
      MachineModel model = machine_about(at, 30);
      Hand hand(model, at);
      ASSERT_TRUE(hand.lay_on(kMaxJoints + axis));
      hand.hold(kMaxJoints + axis, velocity, 3);
      hand.world.run_for(1);
      EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0) << axis << " " << velocity;
      EXPECT_LE(farthest_out(hand), kTipBoxRounding) << axis << " " << velocity;
    }
  }
}

TEST(JogTipBox, OfTheToolStopsShortOfTheFaceByAStepOfItsSurveyAtMost) {
  const JointVector at{70, 20, 80, 0, 0};
  Hand hand(machine_about(at, 50), at);
  ASSERT_TRUE(hand.lay_on(kMaxJoints + 2));
  hand.hold(kMaxJoints + 2, 300, 3);
  const double distance = std::abs(hand.world.state.joints[2] - at[2]);
  EXPECT_LE(distance, 50);
  EXPECT_GT(distance, 45);
  EXPECT_EQ(hand.world.count(EventCode::kAlarm), 0);
}

}  // namespace
}  // namespace meridian
