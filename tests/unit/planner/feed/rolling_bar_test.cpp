// SPDX-License-Identifier: Apache-2.0

/// Where the jerk of a window is linearised: when one programme is enough, and what a second gains.

#include <gtest/gtest.h>

#include "unit/planner/feed/rolled_feed.hpp"

namespace meridian::test::rolling_bar {
namespace {

TEST(RollingBar, OneProgrammeIsEnoughWhereAWindowGoesOnAsTheOneBefore) {
  Rolled straight, bent;
  straight.add_straight(150, 3.2, 10, 80);
  bent.add_bent(40, 20);
  for (Rolled* one : {&straight, &bent}) {
    one->run();
    const FeedCount& count = one->feed.count();
    EXPECT_EQ(count.solves, count.windows + 2) << "twice from rest, where there is none before, "
                                                  "and of the last window, all of which stands";
    EXPECT_EQ(count.tightened + count.kept, 0);
  }
}

TEST(RollingBar, OneProgrammeIsEnoughWhereTheLimitsAreFarThoughThePlanBeforeComesToRest) {
  // Braking takes thirty of these cells: the window goes on fast where the one before rests.
  Rolled one;
  one.add_straight(60, 1.0, 10, 80);
  one.run();
  const FeedCount& count = one.feed.count();
  EXPECT_GT(count.windows, 8);
  EXPECT_LE(count.solves, count.windows + 3);
}

TEST(RollingBar, ASecondProgrammeGainsWhereTheFirstLeadsAway) {
  const auto swing_s = [](int refinements, int max_commit_cells = 60) {
    MachineModel model = bench_machine();
    model.joints[1].limits.jerk = 300;
    FeedSettings settings = without_reserve();
    settings.refinements = refinements;
    settings.max_commit_cells = max_commit_cells;
    settings.more_from_rest = 0;
    Rolled one(settings, model);
    add_swing(one);
    one.run();
    EXPECT_LE(one.use(one.pieces()).worst(), 1 + 1e-6);
    return one.duration();
  };
  const double once = swing_s(1), twice = swing_s(2), thrice = swing_s(3);
  EXPECT_LT(twice, 0.94 * once);
  EXPECT_LT(swing_s(1, 40), 1.09 * twice)
      << "the first one is made around the plan of the window before";
  EXPECT_LE(thrice, twice);
  EXPECT_GT(thrice, 0.99 * twice) << "more of them hardly gain";
}

TEST(RollingBar, IsMadeAnewWhereLimitsBindAwayFromTheTangent) {
  struct Case {
    double accel, jerk, max_s;
  };
  // Seconds: 1.0500 and 0.5289; with a programme less 1.0526 and 0.5313.
  for (const Case& c : {Case{100, 627, 1.0515}, {1000, 6270, 0.53}}) {
    MachineModel model = bench_machine();
    model.joints[1].limits.acceleration = c.accel;
    model.joints[1].limits.jerk = c.jerk;
    Rolled one(without_reserve(), model);
    add_swing(one);
    one.run();
    EXPECT_LT(one.duration(), c.max_s);
    EXPECT_LE(one.use(one.pieces()).worst(), 1 + 1e-6);
  }
}

/// A swing under `accel` and `jerk` of the swinging joint, with room for the rate filter.
FeedCount swing_with_room(double accel, double jerk, double longest_s) {
  MachineModel model = bench_machine();
  model.joints[1].limits.acceleration = accel;
  model.joints[1].limits.jerk = jerk;
  FeedSettings settings;
  settings.reserve = {1.2, 0};
  settings.refinements = 1;
  Rolled one(settings, model);
  add_swing(one);
  one.run();
  EXPECT_LT(one.duration(), longest_s);
  EXPECT_LE(one.use(one.pieces()).worst(), 1 + 1e-6);
  return one.feed.count();
}

TEST(RollingBar, AWindowGoesOnAroundThePlanBeforeWhereASwingAsksForAllOfTheJerk) {
  struct Case {
    double accel, longest_s;  // what it takes, and a hundredth or less
  };
  for (const Case& c : {Case{30, 1.89}, {100, 1.18}, {600, 0.637}, {1000, 0.535}}) {
    const FeedCount count = swing_with_room(c.accel, 6.27 * c.accel, c.longest_s);
    EXPECT_EQ(count.kept + count.crawls, 0) << c.accel << ": every window has a plan of its own";
  }
}

TEST(RollingBar, OnlyTheFirstResultsFarFromTheirTangentAreTriedAnewAsTheyAre) {
  struct Case {
    double accel, jerk, longest_s;
    int max_tightened;  // one and two less than where no result is tried anew as it is: 3, 3, 2
  };
  for (const Case& c : {Case{8.55, 171, 3.135, 2}, {8.55, 53.6, 3.625, 1}, {30, 188, 1.885, 1}}) {
    const FeedCount count = swing_with_room(c.accel, c.jerk, c.longest_s);
    EXPECT_LE(count.tightened, c.max_tightened) << c.accel << ": behind them cells are tightened";
    EXPECT_LT(count.max_rounds, 100);
  }
}

}  // namespace
}  // namespace meridian::test::rolling_bar
