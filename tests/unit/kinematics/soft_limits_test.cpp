// SPDX-License-Identifier: Apache-2.0
#include "meridian/kinematics/soft_limits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "support/machines.hpp"

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

/// Joint 0 from 10 to 20 while joint 2 is from -5 to 5.
KeepOutBox drawn_box(const char* name) {
  KeepOutBox box;
  std::copy_n(name, std::char_traits<char>::length(name), box.name.begin());
  box.joints = 0b101;
  box.min = {10, 0, -5};
  box.max = {20, 0, 5};
  return box;
}

LimitsOrder about(LimitsWord word, const KeepOutBox& box) {
  LimitsOrder order;
  order.word = word;
  order.box = box;
  return order;
}

TEST(SoftLimits, PutUpBoxesByNameAndTakeThemAway) {
  const MachineModel own = test::lai_machine();
  SoftLimits limits;
  KeepOutBox vice = drawn_box("vice");
  EXPECT_EQ(limits.apply(about(LimitsWord::kKeepOut, vice), own), LimitsFault::kNone);
  vice.max[0] = 30;
  EXPECT_EQ(limits.apply(about(LimitsWord::kKeepOut, vice), own), LimitsFault::kNone);
  ASSERT_EQ(limits.keep_out().boxes().size(), 1U) << "the one of that name is replaced";
  EXPECT_EQ(limits.keep_out().boxes()[0], vice);
  const KeepOutBox probe = drawn_box("probe");
  EXPECT_EQ(limits.apply(about(LimitsWord::kKeepOut, probe), own), LimitsFault::kNone);
  EXPECT_EQ(limits.apply(about(LimitsWord::kOpen, drawn_box("nobody")), own), LimitsFault::kNoBox);
  EXPECT_EQ(limits.apply(about(LimitsWord::kOpen, vice), own), LimitsFault::kNone);
  ASSERT_EQ(limits.keep_out().boxes().size(), 1U);
  EXPECT_EQ(limits.keep_out().boxes()[0], probe);
  EXPECT_FALSE(limits.empty());
  EXPECT_EQ(limits.apply({LimitsWord::kClear}, own), LimitsFault::kNone);
  EXPECT_FALSE(limits.keep_out().empty()) << "clear is for travel";
  EXPECT_EQ(limits.apply(about(LimitsWord::kOpen, {}), own), LimitsFault::kNone);
  EXPECT_TRUE(limits.empty());
}

TEST(SoftLimits, PutUpNoBoxThatMeansNothing) {
  MachineModel own = test::lai_machine();
  SoftLimits limits;
  const auto fault_of = [&](const KeepOutBox& box) {
    const LimitsFault fault = limits.apply(about(LimitsWord::kKeepOut, box), own);
    EXPECT_TRUE(fault == LimitsFault::kNone || limits.keep_out().find(box) == nullptr);
    return fault;
  };
  EXPECT_EQ(fault_of(drawn_box("")), LimitsFault::kBox);
  KeepOutBox box = drawn_box("vice");
  box.name.fill('x');
  EXPECT_EQ(fault_of(box), LimitsFault::kBox) << "a name without an end";
  box = drawn_box("vice");
  box.joints = 0;
  EXPECT_EQ(fault_of(box), LimitsFault::kBox);
  box.joints = 0b100001;
  EXPECT_EQ(fault_of(box), LimitsFault::kBoxJoint);
  for (const double end : {20.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    box = drawn_box("vice");
    box.min[0] = end;
    EXPECT_EQ(fault_of(box), LimitsFault::kBox) << end;
  }
  own.joints[2].is_endless = true;
  EXPECT_EQ(fault_of(drawn_box("vice")), LimitsFault::kBoxJoint);
  own.joints[2].is_endless = false;
  ASSERT_TRUE(own.keep_out.add(drawn_box("tailstock")));
  EXPECT_EQ(fault_of(drawn_box("tailstock")), LimitsFault::kOwnBox);
  const char* const kNames[] = {"1", "2", "3", "4", "5", "6", "7"};
  for (const char* name : kNames) EXPECT_EQ(fault_of(drawn_box(name)), LimitsFault::kNone);
  EXPECT_EQ(fault_of(drawn_box("8")), LimitsFault::kBoxes);
  EXPECT_EQ(limits.find_fault(own), LimitsFault::kNone);
  ASSERT_TRUE(own.keep_out.add(drawn_box("new in the file")));
  EXPECT_EQ(limits.find_fault(own), LimitsFault::kBoxes);
}

TEST(SoftLimits, PutTheirBoxesBesideThoseOfTheMachine) {
  MachineModel own = test::lai_machine();
  ASSERT_TRUE(own.keep_out.add(drawn_box("tailstock")));
  SoftLimits limits;
  ASSERT_TRUE(limits.put(drawn_box("vice")));
  MachineModel model = own;
  for (int again = 0; again < 2; ++again) shrink_travel(model, travel_under(limits, own));
  ASSERT_EQ(model.keep_out.boxes().size(), 2U);
  EXPECT_EQ(model.keep_out.boxes()[1], drawn_box("vice"));
  shrink_travel(model, travel_under(SoftLimits(), own));
  EXPECT_EQ(model.keep_out, own.keep_out);
}

/// An order of a tip box from `min` to `max` along each axis.
LimitsOrder about_tip(double min, double max) {
  LimitsOrder order;
  order.word = LimitsWord::kTip;
  order.box.min = {min, min, min};
  order.box.max = {max, max, max};
  return order;
}

TEST(SoftLimits, HaveOneTipBoxInsideTheOneOfTheMachine) {
  MachineModel own = test::lai_machine();
  SoftLimits limits;
  EXPECT_EQ(limits.apply(about_tip(-50, 60), own), LimitsFault::kNone);
  EXPECT_EQ(limits.tip_box(), (TipBox{true, {-50, -50, -50}, {60, 60, 60}}));
  EXPECT_FALSE(limits.empty());
  for (const double end : {-50.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(limits.apply(about_tip(-50, end), own), LimitsFault::kTip) << end;
  }
  EXPECT_EQ(limits.apply(about_tip(-40, 40), own), LimitsFault::kNone) << "in place of the first";
  own.tip_box = {true, {-45, -45, -45}, {45, 45, 45}};
  EXPECT_EQ(limits.apply(about_tip(-50, 40), own), LimitsFault::kTipBeyond);
  EXPECT_EQ(limits.find_fault(own), LimitsFault::kNone);
  MachineModel model = own;
  shrink_travel(model, travel_under(limits, own));
  EXPECT_EQ(model.tip_box.max[2], 40);
  EXPECT_EQ(limits.apply({LimitsWord::kClearTip}, own), LimitsFault::kNone);
  EXPECT_TRUE(limits.empty());
  shrink_travel(model, travel_under(limits, own));
  EXPECT_EQ(model.tip_box, own.tip_box) << "the machine file's again";
  ASSERT_EQ(limits.apply(about_tip(-40, 40), own), LimitsFault::kNone);
  EXPECT_EQ(limits.apply({LimitsWord::kClear}, own), LimitsFault::kNone);
  EXPECT_TRUE(limits.empty()) << "clear alone clears it too";
  limits.put(TipBox{true, {-46, 0, 0}, {1, 1, 1}});
  EXPECT_EQ(limits.find_fault(own), LimitsFault::kTipBeyond);
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
