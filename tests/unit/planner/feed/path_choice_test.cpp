// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/legs/path_choice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "meridian/planner/stop_product.hpp"
#include "support/machines.hpp"

namespace meridian::test::path_choice {
namespace {

JointCaps caps_of(double velocity, double acceleration, double jerk) {
  JointCaps out;
  out.count = 2;
  for (int i = 0; i < 2; ++i) {
    out.velocity[i] = velocity;
    out.acceleration[i] = acceleration;
    out.jerk[i] = jerk;
  }
  return out;
}

JointCell cell_of(double d1, double d2, double d3) {
  JointCell out;
  out.end = 1;
  out.d1[0] = d1;
  out.d2[0] = d2;
  out.d3[0] = d3;
  return out;
}

TEST(PathChoice, PlansWithNinetyNinePercentOfTheLimits) {
  const MachineModel model = hybrid_machine();
  const JointCaps caps = planned_caps(model, 500);
  ASSERT_EQ(caps.count, 7);
  EXPECT_EQ(caps.velocity[2], 0.99 * 300);
  EXPECT_EQ(caps.acceleration[2], 0.99 * 3000);
  EXPECT_EQ(caps.jerk[6], 0.99 * model.stage_drives[1].limits.jerk);
  const JointCaps fault = fault_caps(model, 500);
  EXPECT_EQ(fault.velocity[2], 0.99 * 300);
  EXPECT_EQ(fault.acceleration[2], 0.99 * 6000);
  EXPECT_EQ(fault.jerk[2], 0.99 * 240000);
}

TEST(PathChoice, StopsInAFaultNoSofterThanInAHold) {
  MachineModel model = bench_machine();
  model.joints[0].limits.fault_acceleration = 100;
  model.joints[0].limits.fault_jerk = 100;
  const JointCaps fault = fault_caps(model, 500);
  EXPECT_EQ(fault.acceleration[0], 0.99 * 3000);
  EXPECT_EQ(fault.jerk[0], 0.99 * 60000);
}

TEST(PathChoice, KnowsHowMuchJerkRoundingShowsAs) {
  MachineModel model = hybrid_machine();
  model.cycle_ns = 1'000'000;
  const double gain = 8 / std::pow(250e-6, 3);
  const JointCaps caps = planned_caps(model, 500);
  EXPECT_NEAR(caps.noise_gain[0], 500 * gain, 1);
  EXPECT_NEAR(caps.noise_gain[3], gain, 1e-3) << "the redundant joint";
  EXPECT_EQ(caps.noise_gain[4], 0) << "the tilt follows the axis smoothly";
  EXPECT_NEAR(caps.noise_gain[5], (500 + stage::lever_mm(model.stage)) * gain, 1);
  model.cycle_ns = 125'000;
  EXPECT_NEAR(planned_caps(model, 500).noise_gain[3], 8 * gain, 1e-2);
}

TEST(PathChoice, AcceleratesAsTheHardestCellAllowsBesideItsCurvature) {
  const JointCaps caps = caps_of(100, 1000, 20000);
  const std::array cells{cell_of(2, 0.1, 0), cell_of(4, 0.05, 0), cell_of(1, 0.3, 0)};
  EXPECT_DOUBLE_EQ(find_acceleration(cells, caps, 0), 250);
  EXPECT_DOUBLE_EQ(find_acceleration(cells, caps, 50), std::min((1000 - 0.05 * 2500) / 4, 250.0));
  EXPECT_LT(find_acceleration(cells, caps, 60), 0) << "the third cell bends too sharply";
  EXPECT_GT(find_acceleration(std::array{cell_of(0, 0, 0)}, caps, 50), 1e11);
}

TEST(PathChoice, FindsTheJerkThatCurvatureAndRoundingLeave) {
  JointCaps caps = caps_of(100, 1000, 20000);
  JointCell cell = cell_of(2, 0.1, 0.01);
  EXPECT_DOUBLE_EQ(find_jerk(std::array{cell}, caps, 0, 0), 10000);
  EXPECT_DOUBLE_EQ(find_jerk(std::array{cell}, caps, 50, 100),
                   (20000 - 0.01 * 125000 - 3 * 0.1 * 5000) / 2);
  EXPECT_DOUBLE_EQ(find_jerk_beside(std::array{cell}, caps, 50, 7000),
                   (20000 - 0.01 * 125000 - 3 * 0.1 * 7000) / 2);
  caps.noise_gain[0] = 1e12;
  cell.noise_rad = 1e-9;
  EXPECT_DOUBLE_EQ(find_jerk(std::array{cell}, caps, 0, 0), 9500);
  cell.d3[0] = 1;
  EXPECT_LT(find_jerk(std::array{cell}, caps, 50, 0), 0);
}

TEST(PathChoice, IsTheFastestMotionWhereThePathIsStraight) {
  const MotionChoice choice =
      choose_motion(std::array{cell_of(2, 0, 0)}, caps_of(100, 1000, 20000), 200, 1e9);
  const Profile best = rest_to_rest_with_reserve(200, {50, 500, 10000});
  EXPECT_NEAR(choice.profile.duration(), best.duration(), 1e-3 * best.duration());
  EXPECT_NEAR(choice.profile.length(), 200, 1e-9);
  EXPECT_LE(choice.limits.velocity, 50);
}

TEST(PathChoice, KeepsTheProgrammedFeed) {
  const MotionChoice choice =
      choose_motion(std::array{cell_of(2, 0, 0)}, caps_of(100, 1000, 20000), 200, 20);
  EXPECT_LE(choice.profile.peak_velocity(), 20 * (1 + 1e-15));
  EXPECT_GT(choice.profile.peak_velocity(), 19.99);
}

/// Of every joint: q' V <= v, q'' V² + q' A <= a, q''' V³ + 3 q'' V A + q' J <= j, and nine tenths
/// of acceleration and jerk are left to a stop.
TEST(PathChoice, LeavesAStopNineTenthsOfAccelerationAndJerk) {
  const JointCaps caps = caps_of(100, 1000, 20000);
  const std::array cells{cell_of(1, 0.2, 0.02), cell_of(1.5, 0.1, 0.05)};
  const MotionChoice choice = choose_motion(cells, caps, 200, 1e9);
  ASSERT_GT(choice.profile.jerk, 0);
  const auto [v, a, j] = choice.limits;
  for (const JointCell& cell : cells) {
    EXPECT_LE(cell.d1[0] * v, 100);
    EXPECT_LE(cell.d2[0] * v * v + cell.d1[0] * a, 1000 * (1 + 1e-12));
    EXPECT_LE(cell.d3[0] * v * v * v + 3 * cell.d2[0] * v * a + cell.d1[0] * j,
              20000 * (1 + 1e-12));
  }
  EXPECT_LE(choice.profile.peak_velocity(), v * (1 + 1e-12));
  EXPECT_LE(choice.profile.peak_acceleration() + choice.profile.peak_velocity(), a * (1 + 1e-9));
  EXPECT_GE(find_acceleration(cells, caps, v), 0.9 * find_acceleration(cells, caps, 0));
  const double used = std::min(find_acceleration(cells, caps, v), std::sqrt(v * 20000 / 1.5));
  const double left = find_jerk(cells, caps, v, used), rest = find_jerk(cells, caps, 0, 0);
  EXPECT_GE(left, 0.9 * rest);
  EXPECT_LT(left, 0.905 * rest) << "no slower than that needs";
}

TEST(PathChoice, UsesLessVelocityOnAShortWayThatDoesNotReachIt) {
  const JointCaps caps = caps_of(1000, 1000, 20000);
  const std::array cells{cell_of(1, 0.02, 0.0004)};
  const MotionChoice choice = choose_motion(cells, caps, 1, 1e9);
  EXPECT_LT(choice.limits.velocity, 1.05 * choice.profile.peak_velocity());
  const Profile straight = rest_to_rest_with_reserve(1, {1000, 1000, 20000});
  EXPECT_GT(choice.profile.duration(), straight.duration());
  EXPECT_LT(choice.profile.duration(), 1.03 * straight.duration());
}

TEST(PathChoice, IsHardlySlowerThanAtAnyLowerFeed) {
  struct Case {
    double d1, d2, d3, velocity, acceleration, jerk, length;
  };
  // Joints that bend, on lengths over which acceleration and velocity are both used.
  for (const Case& c : {Case{1.9576, 8.38e-3, 3.65e-4, 167, 165, 1e5, 12},
                        Case{0.7039, 7.89e-4, 1.196e-3, 204, 164, 1.4e5, 31.2},
                        Case{1.1973, 2.71e-3, 1.13e-6, 113, 185, 3.39e4, 18.3}}) {
    const JointCaps caps = caps_of(c.velocity, c.acceleration, c.jerk);
    const std::array cells{cell_of(c.d1, c.d2, c.d3)};
    const MotionChoice choice = choose_motion(cells, caps, c.length, 1e9);
    for (const double share : {0.9, 0.75, 0.6, 0.5, 0.4}) {
      const double feed = share * c.velocity / c.d1;
      const MotionChoice lower = choose_motion(cells, caps, c.length, feed);
      EXPECT_LT(choice.profile.duration(), 1.005 * lower.profile.duration()) << share;
    }
  }
}

TEST(PathChoice, HasNoMotionWhereRoundingTakesAllJerk) {
  JointCaps caps = caps_of(100, 1000, 20000);
  caps.noise_gain[0] = 1e12;
  JointCell cell = cell_of(2, 0, 0);
  cell.noise_rad = 1e-7;
  EXPECT_EQ(choose_motion(std::array{cell}, caps, 10, 1e9).profile.jerk, 0);
}

TEST(PathChoice, GrantsAStopWhatItsDeepestDecelerationNeeds) {
  const JointCaps caps = caps_of(100, 1000, 20000);
  const std::array cells{cell_of(2, 0.05, 0.001)};
  const StopRange range{.velocity = 20, .top = 21, .acceleration = 100, .fall = 80};
  const PathLimits got = find_authority(cells, caps, range);
  const double rest_jerk = (20000 - 0.001 * 8000) / 2;
  const double needed = 1.01 * std::sqrt(20 * rest_jerk + 0.5 * 80 * 80);
  EXPECT_EQ(got.velocity, 20);
  EXPECT_DOUBLE_EQ(got.acceleration, std::min(needed, (1000 - 0.05 * 400) / 2));
  EXPECT_DOUBLE_EQ(
      got.jerk,
      find_jerk_beside(cells, caps, 20, largest_stop_product(21, got.acceleration, rest_jerk)));
  const StopRange slow{.velocity = 0.1, .top = 0.1, .acceleration = 100, .fall = 20};
  EXPECT_DOUBLE_EQ(find_authority(cells, caps, slow).acceleration, 100)
      << "no less than what there is";
}

}  // namespace
}  // namespace meridian::test::path_choice
