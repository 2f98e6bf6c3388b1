// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/look_ahead/block_window.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "meridian/kinematics/kinematics.hpp"
#include "support/machines.hpp"

namespace meridian::test::block_window {
namespace {

Vector3 leaning(double tilt, double azimuth) {
  return {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), std::cos(tilt)};
}

/// The axis turns round by `step_rad` from block to block.
ClBlock round(std::uint64_t sequence, double step_rad = 0.1) {
  ClBlock block;
  block.sequence = sequence;
  block.line = static_cast<std::uint32_t>(sequence) + 100;
  block.tip_mm = {0.1 * static_cast<double>(sequence), 0, 0};
  block.axis = to_array(leaning(0.3, 0.5 + step_rad * static_cast<double>(sequence)));
  block.feed_meaning = FeedMeaning::kTip;
  block.feed = 50;
  return block;
}

/// A machine whose C goes to ±400 degrees, and the two windings of one branch at block 0.
struct Asked {
  explicit Asked(bool is_used = true) : window(model, is_used) { window.begin({}); }
  void push(std::uint64_t first, std::uint64_t end, double step_rad = 0.1) {
    for (std::uint64_t n = first; n < end; ++n) window.push(round(n, step_rad));
  }
  void ask(std::uint64_t sequence = 0, bool is_on_path = false, double step_rad = 0.1) {
    const ClBlock at = round(sequence, step_rad);
    start.sequence = sequence;
    start.is_on_path = is_on_path;
    start.pose = {to_vector(at.tip_mm), to_vector(at.axis)};
    start.tool_length_mm = model.tool_length_mm;
    const JointVector q = solve(model, model.tool_length_mm, start.pose, 0, {}).q;
    const double low = q[3] > 0 ? q[3] - 2 * std::numbers::pi : q[3];
    routes = {RouteAhead{0, low}, RouteAhead{0, low + 2 * std::numbers::pi}};
    window.ask(start, routes);
  }

  static MachineModel machine() {
    MachineModel model = lai_machine();
    model.joints[3].limits.travel_min = units::rad_from_deg(-400);
    model.joints[3].limits.travel_max = units::rad_from_deg(400);
    return model;
  }
  MachineModel model = machine();
  BlockWindow window;
  PoleLookAhead::Start start;
  std::array<RouteAhead, 2> routes;
};

TEST(BlockWindow, HandsBlocksOutInTheirOrder) {
  Asked asked;
  EXPECT_EQ(asked.window.waiting(), 0U);
  asked.push(0, 5);
  EXPECT_EQ(asked.window.waiting(), 5U);
  EXPECT_EQ(asked.window.front().sequence, 0U);
  asked.window.pop();
  EXPECT_EQ(asked.window.front().sequence, 1U);
  EXPECT_EQ(asked.window.waiting(), 4U);
  EXPECT_EQ(asked.window.first(3).size(), 3U);
  EXPECT_EQ(asked.window.first(3)[2].sequence, 2U);
  EXPECT_TRUE(asked.window.first(1).empty()) << "it is planned";
  asked.window.keep(round(9));
  EXPECT_EQ(asked.window.waiting(), 4U);
  asked.window.begin({});
  EXPECT_EQ(asked.window.waiting(), 0U);
  EXPECT_EQ(asked.window.questions(), 0U);
}

TEST(BlockWindow, HandsBlocksOutAnewFromOneThatItGoesBackTo) {
  Asked asked;
  for (int n = 0; n < 6; ++n) asked.window.keep(round(n));
  EXPECT_EQ(asked.window.waiting(), 0U);
  ASSERT_NE(asked.window.find(3), nullptr);
  EXPECT_EQ(asked.window.find(3)->sequence, 3U);
  EXPECT_EQ(asked.window.find(6), nullptr) << "not there";
  ASSERT_NE(asked.window.find_motion_ahead(3), nullptr);
  EXPECT_EQ(asked.window.find_motion_ahead(3)->sequence, 2U);
  EXPECT_EQ(asked.window.find_motion_ahead(0), nullptr);
  asked.window.go_back_to(3);
  EXPECT_EQ(asked.window.waiting(), 3U);
  EXPECT_EQ(asked.window.front().sequence, 3U);
  asked.window.go_back_to(5);
  EXPECT_EQ(asked.window.front().sequence, 3U) << "back, never on";
}

TEST(BlockWindow, GoesBackOverNoMoreBlocksThanMayWait) {
  Asked asked;
  for (int n = 0; n < 2100; ++n) asked.window.keep(round(n));
  EXPECT_EQ(asked.window.find(40), nullptr);
  EXPECT_EQ(asked.window.find(2100 - BlockWindow::kWaiting), nullptr);
  EXPECT_NE(asked.window.find(2100 - BlockWindow::kWaiting + 1), nullptr);
}

TEST(BlockWindow, AnswersOnceOnlyOneWayGoesOn) {
  Asked asked;
  asked.push(0, 5);
  asked.ask();
  EXPECT_EQ(asked.window.questions(), 1U);
  EXPECT_FALSE(asked.window.look()) << "both windings go on";
  EXPECT_TRUE(asked.window.is_missing());
  asked.push(5, 90);
  EXPECT_TRUE(asked.window.look());
  EXPECT_FALSE(asked.window.is_missing());
  const auto routes = asked.window.routes();
  ASSERT_EQ(routes.size(), 2U);
  EXPECT_NE(routes[0].carries, routes[1].carries);
  EXPECT_FALSE(asked.window.is_cut_short()) << "it is settled";
}

TEST(BlockWindow, NothingIsMissingWhereNothingWasAsked) {
  Asked asked;
  asked.push(0, 5);
  EXPECT_FALSE(asked.window.is_missing());
}

TEST(BlockWindow, AnswersWhereNoBlockComesAnyMore) {
  Asked asked;
  asked.push(0, 5);
  asked.ask();
  EXPECT_FALSE(asked.window.look());
  asked.window.end();
  EXPECT_TRUE(asked.window.look());
  EXPECT_EQ(asked.window.routes()[0].carries, 4) << "those behind block 0";
  EXPECT_FALSE(asked.window.is_cut_short()) << "the program is at its end";
}

TEST(BlockWindow, AnswersWhateverHasBeenPlannedMeanwhile) {
  Asked one, other;
  one.push(0, 100);
  one.ask(20);
  EXPECT_TRUE(one.window.look());
  other.push(0, 100);
  for (int n = 0; n < 60; ++n) other.window.pop();
  other.ask(20);
  EXPECT_TRUE(other.window.look());
  for (int n = 0; n < 2; ++n) {
    EXPECT_EQ(one.window.routes()[n].carries, other.window.routes()[n].carries);
  }
}

TEST(BlockWindow, BeginsOnTheWayOfABlockWithItself) {
  Asked at_end, on_path;
  at_end.push(0, 30, 0);
  at_end.ask(10, false, 0);
  at_end.window.end();
  EXPECT_TRUE(at_end.window.look());
  on_path.push(0, 30, 0);
  on_path.ask(10, true, 0);
  on_path.window.end();
  EXPECT_TRUE(on_path.window.look());
  EXPECT_EQ(at_end.window.routes()[0].carries, 19);
  EXPECT_EQ(on_path.window.routes()[0].carries, 20);
}

TEST(BlockWindow, LooksNoFartherThanItHasRoomFor) {
  Asked asked;
  asked.push(0, BlockWindow::kWaiting, 0);
  asked.ask(0, false, 0);
  EXPECT_TRUE(asked.window.look());
  EXPECT_EQ(asked.window.routes()[0].carries, static_cast<int>(BlockWindow::kWaiting) - 1);
  EXPECT_TRUE(asked.window.is_cut_short());
}

TEST(BlockWindow, ReportsALookThatWasCutShortAndAnswersItAgainTheSame) {
  Asked asked;
  EXPECT_FALSE(asked.window.look_no_further()) << "nothing was asked";
  asked.push(0, 11);
  asked.window.pop();
  asked.ask(3);
  const auto mark = asked.window.look_no_further();
  ASSERT_TRUE(mark);
  EXPECT_EQ(mark->sequence, 3U);
  EXPECT_EQ(mark->looked_at, 8U) << "blocks 4 to 10, and its own";
  EXPECT_TRUE(mark->is_late);
  EXPECT_FALSE(asked.window.is_missing());
  EXPECT_FALSE(asked.window.look_no_further()) << "once";
  asked.push(11, 90);
  asked.ask(3);
  EXPECT_TRUE(asked.window.look());
  EXPECT_EQ(asked.window.routes()[0].carries, 7);
}

TEST(BlockWindow, ReplaysLooksThatWereCutShort) {
  const std::array marks{FeedMark{.sequence = 3, .looked_at = 8},
                         FeedMark{.sequence = 5, .looked_at = 2}};
  Asked asked;
  asked.window.replay(marks);
  asked.push(0, 90);
  asked.ask(3);
  EXPECT_TRUE(asked.window.look());
  EXPECT_EQ(asked.window.routes()[0].carries, 7);
  asked.ask(5);
  EXPECT_TRUE(asked.window.look());
  EXPECT_EQ(asked.window.routes()[0].carries, 1);
  asked.ask(3, true);
  EXPECT_TRUE(asked.window.look());
  EXPECT_EQ(asked.window.routes()[0].carries, 8);
}

/// Of an arc that a way starts on, what is left is followed.
TEST(BlockWindow, FollowsTheRestOfAnArc) {
  for (const bool is_behind : {false, true}) {
    Asked asked;
    ClBlock arc = round(10, 0);
    arc.is_arc = true;
    arc.centre_mm = {0, 0, 0};
    arc.normal = {0, 0, 1};
    arc.tip_mm = {0, 20, 0};
    arc.sweep_rad = std::numbers::pi / 2;  // from (20, 0, 0)
    asked.window.push(arc);
    asked.ask(10, true, 0);
    const double angle = is_behind ? 1.6 : 0.5;
    asked.start.pose.tip = {20 * std::cos(angle), 20 * std::sin(angle), 0};
    asked.window.ask(asked.start, asked.routes);
    asked.window.end();
    EXPECT_TRUE(asked.window.look());
    EXPECT_EQ(asked.window.routes()[0].carries, 1);
    const double left_mm =
        is_behind ? 20 * 2 * std::sin(0.0146) : 20 * (std::numbers::pi / 2 - 0.5);
    EXPECT_NEAR(asked.window.routes()[0].time_s, left_mm / 50, 0.02);
  }
}

TEST(BlockWindow, HasNoRoomWhereNothingIsAsked) {
  Asked asked(false);
  asked.window.keep(round(0));
  EXPECT_EQ(asked.window.waiting(), 0U);
}

}  // namespace
}  // namespace meridian::test::block_window
