// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/feed/legs/leg_feed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/build_piece.hpp"
#include "support/machines.hpp"
#include "unit/planner/feed/staged_motion.hpp"

namespace meridian::test::leg_feed {
namespace {

constexpr double kNever_s = std::numeric_limits<double>::infinity();

ToolPose pose_of(const Vector3& tip, double tilt, double azimuth) {
  return {tip,
          {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)}};
}

/// A leg, its cells, and what is staged of it.
struct Fed {
  Fed(const MachineModel& m, const ToolPose& begin, const ToolPose& end, double feed_mm_per_s)
      : model(m), feed(model) {
    leg.path = make_line(begin, end);
    leg.path.tool_length_mm = model.tool_length_mm;
    leg.feed_mm_per_s = feed_mm_per_s;
    leg.window = 7;
    start = solve(model, model.tool_length_mm, begin, 0, {}).q;
    staged->clear(40);
    measure();
  }
  void measure() {
    JointVector at = start;
    table->clear();
    EXPECT_FALSE(is_fault(table->append(model, leg.path, 0, leg.path.length, 60, at)));
  }
  double plan(double less_than_s = kNever_s) {
    joints = start;
    return feed.plan(leg, table->all(), less_than_s, *staged, joints);
  }

  MachineModel model;
  LegFeed feed;
  Leg leg;
  JointVector start{}, joints{};
  std::unique_ptr<CellTable> table = std::make_unique<CellTable>();
  std::unique_ptr<Staging> staged = std::make_unique<Staging>();
};

Fed turning(double feed_mm_per_s = 200) {
  return {bench_machine(), pose_of({0, 0, 0}, 0.5, 0), pose_of({150, 30, 0}, 0.06, 0.8),
          feed_mm_per_s};
}

TEST(LegFeed, IsOneMotionFromRestToRestInsideEveryLimit) {
  Fed one = turning();
  const double duration = one.plan();
  ASSERT_GT(duration, 0);
  EXPECT_NEAR(duration, duration_of(*one.staged), 1e-12);
  ASSERT_EQ(one.staged->path_count, 1);
  EXPECT_EQ(one.staged->paths[0].index, 40U);
  EXPECT_EQ(one.staged->paths[0].joints_begin, one.start);
  EXPECT_EQ(one.staged->paths[0].joints_end, one.joints);
  const ToolPose at = forward(one.model, one.model.tool_length_mm, one.joints);
  EXPECT_NEAR((at.tip - Vector3(150, 30, 0)).norm(), 0, 1e-9);
  EXPECT_LE(use_of_motion(one.model, *one.staged).worst(), 1);
  EXPECT_GT(use_of_motion(one.model, *one.staged).worst(), 0.97);
  for (int n = 0; n < one.staged->time_count; ++n) {
    EXPECT_EQ(one.staged->times[n].window, 7U);
    EXPECT_EQ(one.staged->times[n].path_index, 40U);
  }
}

TEST(LegFeed, GrantsStopsInsideEveryLimit) {
  Fed one = turning();
  ASSERT_GT(one.plan(), 0);
  double smallest = 1e300;
  for (int n = 2; n + 2 < one.staged->time_count; ++n) {
    smallest = std::min(smallest, one.staged->times[n].stop_jerk);
  }
  EXPECT_GT(smallest, 0);
  EXPECT_LE(use_of_stops(one.model, *one.staged, false).worst(), 1 + 1e-6);
  EXPECT_LE(use_of_stops(one.model, *one.staged, true).worst(), 1 + 1e-6);
}

TEST(LegFeed, KeepsTheFeedOfTheTip) {
  Fed one = turning(30);
  ASSERT_GT(one.plan(), 0);
  EXPECT_LE(tip_speed_of(*one.staged), 30);
  EXPECT_GT(tip_speed_of(*one.staged), 29.9);
  one.leg.feed_factor = 1.5;
  one.staged->clear(40);
  ASSERT_GT(one.plan(), 0);
  EXPECT_GT(tip_speed_of(*one.staged), 44.8);
}

TEST(LegFeed, KeepsTheShareOfALegInInverseTime) {
  Fed one = turning(0);
  one.leg.share_per_s = 0.2;
  ASSERT_GT(one.plan(), 0);
  double largest = 0;
  for (int n = 0; n < one.staged->time_count; ++n)
    largest = std::max(largest, one.staged->times[n].v);
  EXPECT_LE(largest, 0.2 * one.leg.path.length);
  EXPECT_GT(largest, 0.199 * one.leg.path.length);
}

TEST(LegFeed, TakesHardlyLongerThanFeedAndJointsDo) {
  Fed one(lai_machine(), pose_of({0, 0, 0}, 0.3, 0.2), pose_of({60, 20, 10}, 0.35, 0.3), 50);
  const double duration = one.plan();
  const double smallest = min_leg_time(one.leg, one.table->all(), planned_caps(one.model, 600));
  EXPECT_GT(duration, smallest);
  EXPECT_LT(duration, 1.06 * smallest);
}

TEST(LegFeed, StagesNothingThatTakesNoLessThanAskedFor) {
  Fed one = turning();
  const double duration = one.plan();
  one.staged->clear(40);
  EXPECT_EQ(one.plan(0.999 * duration), 0);
  EXPECT_EQ(one.staged->path_count, 0);
  EXPECT_EQ(one.staged->time_count, 0);
  EXPECT_EQ(one.joints, one.start);
  EXPECT_EQ(one.plan(1.001 * duration), duration) << "the same leg, the same bits";
}

TEST(LegFeed, StagesNothingWhereThereIsNoRoom) {
  Fed one = turning();
  one.staged->path_count = static_cast<int>(one.staged->paths.size());
  EXPECT_EQ(one.plan(), 0);
  one.staged->clear(40);
  one.staged->time_count = static_cast<int>(one.staged->times.size()) - 3;
  EXPECT_EQ(one.plan(), 0);
  EXPECT_EQ(one.staged->time_count, static_cast<int>(one.staged->times.size()) - 3);
}

TEST(LegFeed, HasNoMoreCellsHoweverLongTheLeg) {
  Fed one(lai_machine(), pose_of({-400, 0, 0}, 0.3, 0.2), pose_of({400, 0, 0}, 0.3, 0.25), 4);
  ASSERT_GT(one.plan(), 190);
  EXPECT_LT(one.staged->time_count, 700);
}

TEST(LegFeed, HasCellsThatShrinkTowardsBothEndsAlike) {
  const ToolPose here = pose_of({0, 0, 0}, 0.3, 0.2), there = pose_of({120, 0, 0}, 0.3, 0.25);
  for (const double feed_mm_per_s : {4.0, 10.0, 30.0}) {
    Fed forth(bench_machine(), here, there, feed_mm_per_s);
    Fed back(bench_machine(), there, here, feed_mm_per_s);
    const double duration = forth.plan();
    ASSERT_GT(duration, 120 / feed_mm_per_s);
    EXPECT_NEAR(back.plan(), duration, 1e-4 * duration);
    const auto last_of = [](const Fed& one) {
      return one.staged->times[static_cast<std::size_t>(one.staged->time_count - 1)].duration;
    };
    const double begin_s = forth.staged->times[0].duration, end_s = last_of(forth);
    EXPECT_NEAR(last_of(back), begin_s, 0.01 * begin_s);
    EXPECT_NEAR(back.staged->times[0].duration, end_s, 0.01 * end_s);
    EXPECT_LT(std::max(begin_s, end_s), 0.01) << "however slow the feed";
    EXPECT_LT(duration - 120 / feed_mm_per_s, 0.15) << "lost at both rests together";
  }
}

TEST(LegFeed, StagesNothingWhereTheFeedWouldCrawl) {
  // On 1 mm the axis passes the pole: C turns by half a turn in the middle of it.
  Fed one(bench_machine(), pose_of({0, 0, 0}, 0.3, 0.001), pose_of({1, 0, 0}, 0.3, 3.14), 30);
  EXPECT_EQ(one.plan(), 0);
  EXPECT_EQ(one.staged->path_count, 0);
  EXPECT_EQ(one.staged->time_count, 0);
  EXPECT_EQ(one.joints, one.start);
}

JointCell cell_of(double begin, double end, double d1, double share_rate) {
  JointCell cell;
  cell.begin = begin;
  cell.end = end;
  cell.d1[0] = d1;
  cell.share_rate = share_rate;
  return cell;
}

TEST(LegFeed, KnowsATimeThatNoMotionFallsBelow) {
  Leg leg;
  leg.path = make_line({{0, 0, 0}, Vector3::UnitZ()}, {{100, 0, 0}, Vector3::UnitZ()});
  leg.feed_mm_per_s = 20;
  JointCaps caps;
  caps.count = 1;
  caps.velocity[0] = 30;
  caps.acceleration[0] = 1000;
  caps.jerk[0] = 20000;
  // 60 mm at the feed, 40 mm where the joint goes five times as far.
  const std::array cells{cell_of(0, 60, 1, 0.01), cell_of(60, 100, 5, 0.01)};
  const double at_speed = 60 / (20 * (1 - 1e-7)) + 40.0 / 6;
  const PathLimits limits{100 / at_speed, 1000, 20000};
  const Profile fastest = rest_to_rest(100, limits);
  PathLimits left =
      limits_beside_rate(limits, fastest.peak_velocity(), fastest.peak_acceleration());
  left.jerk = 0.5 * (limits.jerk + left.jerk);
  const Profile easiest = rest_to_rest(100, left);
  const double smallest = min_leg_time(leg, cells, caps);
  EXPECT_NEAR(smallest, easiest.duration(), 1e-9);
  EXPECT_GT(smallest, fastest.duration());
  EXPECT_LT(smallest, rest_to_rest_with_reserve(100, limits).duration());
  caps.jerk[0] = 1e-3;  // no profile: velocity alone
  EXPECT_GE(min_leg_time(leg, cells, caps), at_speed);
}

}  // namespace
}  // namespace meridian::test::leg_feed
