// SPDX-License-Identifier: Apache-2.0
#include "meridian/kinematics/soft_limits.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace meridian {
namespace {

/// X from -100 to 200 mm, C endless.
MachineModel two_joints() {
  MachineModel model;
  model.joint_count = 2;
  model.joints[0].limits.travel_min = -100;
  model.joints[0].limits.travel_max = 200;
  model.joints[1].is_rotary = model.joints[1].is_endless = true;
  return model;
}

LimitsOrder set(int joint, double min, double max) {
  return {LimitsWord::kSet, static_cast<std::uint8_t>(joint), min, max};
}

TEST(SoftLimits, AreSetAndClearedByJoint) {
  MachineModel own = two_joints();
  own.joint_count = 3;
  own.joints[2].limits = {.travel_min = -1, .travel_max = 1};
  SoftLimits limits;
  EXPECT_TRUE(limits.empty());
  EXPECT_EQ(limits.apply(set(0, -100, 50), own), LimitsFault::kNone);
  EXPECT_EQ(limits.apply(set(2, -0.5, 1), own), LimitsFault::kNone);
  EXPECT_EQ(limits.rows()[0], (SoftLimits::Row{true, -100, 50}));
  EXPECT_EQ(limits.apply({LimitsWord::kClear, 0}, own), LimitsFault::kNone);
  EXPECT_FALSE(limits.rows()[0].is_set);
  EXPECT_TRUE(limits.rows()[2].is_set);
  EXPECT_EQ(limits.apply({LimitsWord::kClear, LimitsOrder::kAllJoints}, own), LimitsFault::kNone);
  EXPECT_TRUE(limits.empty());
}

TEST(SoftLimits, OnlyShrinkTravel) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  SoftLimits limits;
  const auto refusal = [&limits](const LimitsOrder& order) {
    const SoftLimits before = limits;
    const LimitsFault fault = limits.apply(order, two_joints());
    EXPECT_EQ(limits, before) << "a word that is refused changes nothing";
    return fault;
  };
  EXPECT_EQ(refusal(set(0, -100.5, 50)), LimitsFault::kTravel);
  EXPECT_EQ(refusal(set(0, -50, 200.5)), LimitsFault::kTravel);
  EXPECT_EQ(refusal(set(0, 50, 50)), LimitsFault::kValue);
  EXPECT_EQ(refusal(set(0, kNone, 50)), LimitsFault::kValue);
  EXPECT_EQ(refusal(set(0, -50, kNone)), LimitsFault::kValue);
  EXPECT_EQ(refusal(set(1, -1, 1)), LimitsFault::kEndless);
  EXPECT_EQ(refusal(set(2, -1, 1)), LimitsFault::kJoint);
  EXPECT_EQ(refusal({LimitsWord::kClear, 2}), LimitsFault::kJoint);
  EXPECT_EQ(refusal(set(LimitsOrder::kAllJoints, -1, 1)), LimitsFault::kJoint);
  EXPECT_EQ(refusal({static_cast<LimitsWord>(7), 0, 0, 1}), LimitsFault::kWord);
}

TEST(SoftLimits, OfAMachineFileThatHasChangedAreFoundOut) {
  MachineModel own = two_joints();
  SoftLimits limits;
  ASSERT_EQ(limits.apply(set(0, -100, 50), own), LimitsFault::kNone);
  EXPECT_EQ(limits.find_fault(own), LimitsFault::kNone);
  own.joints[0].limits.travel_min = -90;
  EXPECT_EQ(limits.find_fault(own), LimitsFault::kTravel);
  own.joint_count = 0;
  EXPECT_EQ(limits.find_fault(own), LimitsFault::kJoint);
}

TEST(SoftLimits, ShrinkAModelAndGiveItItsTravelBack) {
  const MachineModel own = two_joints();
  MachineModel model = own;
  SoftLimits limits;
  ASSERT_EQ(limits.apply(set(0, -10, 50), own), LimitsFault::kNone);
  shrink_travel(model, travel_under(limits, own));
  EXPECT_EQ(model.joints[0].limits.travel_min, -10);
  EXPECT_EQ(model.joints[0].limits.travel_max, 50);
  EXPECT_TRUE(model.joints[1].is_endless);
  shrink_travel(model, travel_under(SoftLimits(), own));
  EXPECT_EQ(model.joints[0].limits.travel_min, -100);
  EXPECT_EQ(model.joints[0].limits.travel_max, 200);
  shrink_travel(model, SoftLimits());
  EXPECT_EQ(model.joints[0].limits.travel_max, 200) << "no pair: as it was";
}

}  // namespace
}  // namespace meridian
