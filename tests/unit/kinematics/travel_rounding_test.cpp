// SPDX-License-Identifier: Apache-2.0
#include "meridian/kinematics/travel_rounding.hpp"

#include <gtest/gtest.h>

#include "support/machines.hpp"

namespace meridian {
namespace {

constexpr double kRoundedTool_mm = 100;

JointVector home_of(const MachineModel& model) {
  JointVector q{};
  for (int i = 0; i < model.joint_count; ++i) q[i] = model.joints[i].home;
  return q;
}

/// Joint `joint` beyond the upper end of its travel.
JointVector beyond(const MachineModel& model, int joint, double by) {
  JointVector q = home_of(model);
  q[joint] = model.joints[joint].limits.travel_max + by;
  return q;
}

TEST(TravelRounding, TakesAJointThatIsOutsideByItToTheEndOfItsTravel) {
  const MachineModel model = test::lai_machine();
  const double max = model.joints[0].limits.travel_max;
  const auto taken = taken_into_travel(model, kRoundedTool_mm, beyond(model, 0, 9e-4));
  ASSERT_TRUE(taken);
  const ToolPose want = forward(model, kRoundedTool_mm, beyond(model, 0, -1e-9));
  EXPECT_LE((taken->tip - want.tip).norm(), 1e-12);
  const auto found = solve(model, kRoundedTool_mm, *taken, 0, home_of(model));
  EXPECT_LE(found.q[0], max);
  EXPECT_NEAR(found.q[0], max, 2e-9);
}

TEST(TravelRounding, LeavesJointsInsideAloneAndRefusesThoseFartherOut) {
  const MachineModel model = test::lai_machine();
  EXPECT_FALSE(taken_into_travel(model, kRoundedTool_mm, home_of(model)));
  EXPECT_FALSE(taken_into_travel(model, kRoundedTool_mm, beyond(model, 0, -1e-3)));
  EXPECT_FALSE(taken_into_travel(model, kRoundedTool_mm, beyond(model, 0, 1.1e-3)));
}

TEST(TravelRounding, OfARotaryJointIsATenThousandthOfADegree) {
  const MachineModel model = test::lai_machine();
  int rotary = 0;
  while (!model.joints[rotary].is_rotary || model.joints[rotary].is_endless) ++rotary;
  constexpr double kTenThousandth = units::rad_from_deg(1e-4);
  EXPECT_TRUE(
      taken_into_travel(model, kRoundedTool_mm, beyond(model, rotary, .9 * kTenThousandth)));
  EXPECT_FALSE(
      taken_into_travel(model, kRoundedTool_mm, beyond(model, rotary, 1.1 * kTenThousandth)));
}

TEST(TravelRounding, OfAPoseIsThatOfItsJoints) {
  const MachineModel model = test::lai_machine();
  const JointVector out = beyond(model, 0, 5e-4);
  const ToolPose pose = forward(model, kRoundedTool_mm, out);
  const auto taken = taken_into_travel(model, kRoundedTool_mm, pose, home_of(model));
  ASSERT_TRUE(taken);
  EXPECT_GT((taken->tip - pose.tip).norm(), 1e-5);
  EXPECT_LT((taken->tip - pose.tip).norm(), 2e-3);
  EXPECT_FALSE(taken_into_travel(model, kRoundedTool_mm, *taken, home_of(model)));
}

}  // namespace
}  // namespace meridian
