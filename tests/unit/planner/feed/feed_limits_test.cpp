// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/cells/feed_limits.hpp"

#include <gtest/gtest.h>

#include "support/machines.hpp"

namespace meridian::test::feed_limits {
namespace {

TEST(FeedLimits, LeaveTheRateFilterItsShareOfTheJerk) {
  const MachineModel model = bench_machine();
  const FeedLimits limits = make_feed_limits(model, {2, 4});
  ASSERT_EQ(limits.count, 5);
  EXPECT_EQ(limits.slope, 2);
  EXPECT_EQ(limits.curvature, 4);
  EXPECT_EQ(limits.full_jerk[0], 60000);
  EXPECT_EQ(limits.velocity[0], 300);
  EXPECT_EQ(limits.acceleration[0], 3000);
  EXPECT_EQ(limits.jerk[0], 60000 - 3 * 2 * 3000 - 4 * 300);
  const FeedLimits less = make_feed_limits(model, {1, 10});
  EXPECT_EQ(less.jerk[0], RateRoom::of_jerk(1, 10).within(60000 - 10 * 300, 3 * 3000));
  EXPECT_GT(less.jerk[0], 54000) << "little is asked of the jerk where the rate is near 1";
}

TEST(FeedLimits, UseLessOfVelocityAndAccelerationWhereHalfOfTheJerkWouldNotDo) {
  MachineModel model = bench_machine();
  model.joints[1].limits.jerk = 9600;  // the reserve asks for 19 200 beside full velocity
  const FeedLimits limits = make_feed_limits(model, {2, 4});
  EXPECT_DOUBLE_EQ(limits.velocity[1], 75);
  EXPECT_DOUBLE_EQ(limits.acceleration[1], 750);
  EXPECT_DOUBLE_EQ(limits.jerk[1], 4800);
  EXPECT_EQ(limits.velocity[0], 300) << "each joint by itself";
  const FeedLimits less =
      make_feed_limits(model, {2, 40});  // no less than half where |w'| is small
  EXPECT_GT(less.jerk[1], 4800);
  EXPECT_LT(less.velocity[1], 300);
}

TEST(FeedLimits, AreTheMachinesWhereNothingIsReserved) {
  const MachineModel model = bench_machine();
  const FeedLimits limits = make_feed_limits(model, {0, 0});
  EXPECT_EQ(limits.velocity[2], model.joints[2].limits.velocity);
  EXPECT_EQ(limits.acceleration[2], model.joints[2].limits.acceleration);
  EXPECT_EQ(limits.jerk[2], model.joints[2].limits.jerk);
}

TEST(FeedLimits, CoverTheDrivesOfAStage) {
  MachineModel model = hybrid_machine();
  model.stage_drives[1].limits.velocity = 123;
  const FeedLimits limits = make_feed_limits(model, {1, 10});
  EXPECT_EQ(limits.count, 7);
  EXPECT_EQ(limits.velocity[6], 123);
}

TEST(FeedLimits, AreScaledOneByOne) {
  FeedLimits limits = make_feed_limits(bench_machine(), {1, 10}).scaled(0.5, 0.25, 0.125);
  EXPECT_EQ(limits.velocity[4], 0.5 * bench_machine().joints[4].limits.velocity);
  EXPECT_EQ(limits.acceleration[4], 0.25 * bench_machine().joints[4].limits.acceleration);
  EXPECT_EQ(limits.jerk[0], 0.125 * make_feed_limits(bench_machine(), {1, 10}).jerk[0]);
  EXPECT_EQ(limits.full_jerk[0], 0.125 * 60000);
  EXPECT_EQ(limits.slope, 1);
  EXPECT_EQ(limits.count, 5);
}

}  // namespace
}  // namespace meridian::test::feed_limits
