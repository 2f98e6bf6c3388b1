// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/look_ahead/smooth_run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/time_law.hpp"
#include "support/machines.hpp"
#include "unit/planner/look_ahead/ran_blocks.hpp"

namespace meridian::test::smooth_run {
namespace {

using ran_blocks::kTolerance_rad;
using ran_blocks::Ran;
using ran_blocks::Status;

TEST(SmoothRun, AShortPathIsOneWindowFromRestToRest) {
  Ran one;
  one.cut_straight(3, 2);
  EXPECT_EQ(one.status, Status::kNeedsBlocks);
  EXPECT_TRUE(one.times().empty()) << "more may come";
  EXPECT_EQ(one.finish(), Status::kDone);
  const auto times = one.times();
  ASSERT_FALSE(times.empty());
  EXPECT_EQ(state_at(times.front(), 0).ds, 0);
  EXPECT_NEAR(state_at(times.back(), times.back().duration).ds, 0, 1e-9);
  for (const TimePiece& piece : times) {
    EXPECT_FALSE(piece.is_tail);
    EXPECT_TRUE(piece.is_from_rest);
    EXPECT_EQ(piece.window, 11U);
    EXPECT_EQ(piece.epoch, 3);
  }
  EXPECT_EQ(one.run.next_window(), 12U);
}

TEST(SmoothRun, BeginsAnewWhereTheRunBeforeEnded) {
  Ran one;
  one.cut_straight(3, 2);
  ASSERT_EQ(one.finish(), Status::kDone);
  const std::vector<TimePiece> first = one.times();
  one.start.pose = one.start.programmed = one.pose;
  one.start.joints = one.run.joints();
  one.start.path_index = one.run.next_path_index();
  one.start.window = one.run.next_window();
  one.begin();
  one.cut_straight(3, 2);
  EXPECT_EQ(one.status, Status::kNeedsBlocks);
  ASSERT_EQ(one.finish(), Status::kDone);
  const std::vector<TimePiece> both = one.times();
  ASSERT_EQ(both.size(), 2 * first.size()) << "the same again";
  double first_s = 0, second_s = 0;
  for (const TimePiece& piece : both) {
    (piece.window == first.front().window ? first_s : second_s) += piece.duration;
  }
  EXPECT_NEAR(second_s, first_s, 1e-3);
}

TEST(SmoothRun, EndsWithTheJointsOfTheLastBlock) {
  Ran one;
  one.cut_straight(3, 2);
  const ToolPose end{one.pose.tip, Vector3(0.28, 0.21, 1).normalized()};
  one.cut(end);
  EXPECT_EQ(one.finish(), Status::kNoRoom) << "the cycle may still rest before";
  one.begin_newest_window();
  ASSERT_EQ(one.run.publish(one.writer), Status::kDone);
  const JointVector wanted = solve(one.model, one.model.tool_length_mm, end, 0, {}).q;
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(one.run.joints()[i], wanted[i], 1e-6) << i;
}

TEST(SmoothRun, NamesItsPathPiecesInOrderAndTheOneThatFollows) {
  Ran one;
  one.cut_straight(30, 2);
  one.finish();
  std::uint64_t next = 70;
  JointVector joints = one.start.joints;
  for (const PathPiece& piece : one.paths()) {
    EXPECT_EQ(piece.index, next++);
    EXPECT_EQ(piece.epoch, 3);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(piece.joints_begin[i], joints[i], 1e-9);
    joints = piece.joints_end;
  }
  EXPECT_EQ(one.run.next_path_index(), next);
  for (const TimePiece& piece : one.times()) {
    EXPECT_GE(piece.path_index, 70U);
    EXPECT_LT(piece.path_index, next);
  }
}

TEST(SmoothRun, SaysOnceWhereEveryBlockEnds) {
  Ran one;
  one.cut_straight(30, 2);
  one.finish();
  std::uint64_t next = 40;
  for (const PathPiece& piece : one.paths()) {
    for (std::uint32_t n = 0; n < piece.marks.count; ++n) {
      const BlockMark& mark = piece.marks.at[n];
      EXPECT_EQ(piece.sequence + mark.ahead, next);
      EXPECT_EQ(mark.line, next + 100);
      const double at = pose_on(piece.spline, mark.s).tip[0] / 2 + 40;  // blocks of 2 mm
      EXPECT_NEAR(at, static_cast<double>(next) + 1, 0.01);
      ++next;
    }
  }
  EXPECT_EQ(next, one.sequence);
}

TEST(SmoothRun, ALongPathIsPublishedWindowByWindowEachWithATailToRest) {
  Ran one;
  one.cut_straight(100, 2);
  EXPECT_GT(one.times().size(), 0U) << "before its end is known";
  one.finish();
  const auto times = one.times();
  std::uint32_t window = 11;
  for (std::size_t n = 0; n < times.size(); ++n) {
    const TimePiece& piece = times[n];
    const bool is_last = n + 1 == times.size() || times[n + 1].window != piece.window;
    EXPECT_EQ(piece.window, window);
    EXPECT_EQ(piece.is_from_rest, window == 11U);
    if (!is_last) continue;
    ++window;
    EXPECT_EQ(piece.is_tail, n + 1 < times.size()) << "the last window is the end";
    EXPECT_NEAR(state_at(piece, piece.duration).ds, 0, 1e-9);
  }
  EXPECT_GT(window, 13U);
  EXPECT_EQ(one.run.next_window(), window);
}

TEST(SmoothRun, IsDoneWhenTheCycleCanEndInNoTailAnyMore) {
  Ran one;
  one.cut_straight(100, 2);
  EXPECT_EQ(one.finish(), Status::kNoRoom);
  one.reader.set_epoch(3);
  while (one.run.publish(one.writer) != Status::kDone) {
    ASSERT_NE(one.reader.advance(), nullptr);
  }
  EXPECT_EQ(one.reader.piece()->window + 1, one.run.next_window()) << "it began the last window";
}

TEST(SmoothRun, GoesOnFromTheRestOfATailThatTheCycleEntered) {
  Ran one;
  one.cut_straight(120, 2);
  one.reader.set_epoch(3);
  TimePiece rest;
  while (const TimePiece* piece = one.reader.advance()) rest = *piece;
  ASSERT_TRUE(rest.is_tail);
  const std::uint32_t before = one.run.next_window();
  one.cut_straight(120, 2);
  one.finish();
  const auto times = one.times();
  const auto first = std::find_if(times.begin(), times.end(),
                                  [&](const TimePiece& piece) { return piece.window == before; });
  ASSERT_NE(first, times.end());
  EXPECT_TRUE(first->is_from_rest);
  EXPECT_EQ(state_at(*first, 0).ds, 0);
  EXPECT_EQ(first->path_index, rest.path_index);
  EXPECT_NEAR(first->s0, state_at(rest, rest.duration).s, 1e-9);
}

TEST(SmoothRun, WaitsForRoomAndThenPublishesTheSame) {
  Ran whole, narrow;
  narrow.writer.set_horizon(1e-3);
  narrow.reader.set_epoch(3);
  whole.cut_straight(120, 2);
  whole.finish();
  std::vector<TimePiece> read;
  const auto publish = [&] {
    while (narrow.run.publish(narrow.writer) == Status::kNoRoom) {
      const TimePiece* next = narrow.reader.look_ahead(1);
      if (next == nullptr || next->is_tail) break;
      read.push_back(*narrow.reader.advance());
    }
  };
  for (int n = 0; n < 120; ++n) {
    narrow.cut_straight(1, 2);
    publish();
  }
  narrow.run.finish();
  for (std::size_t n = 0; n < whole.times().size(); ++n) {
    publish();
    if (const TimePiece* next = narrow.reader.advance()) read.push_back(*next);
  }
  std::vector<TimePiece> wanted = whole.times();
  std::erase_if(wanted, [](const TimePiece& piece) { return piece.is_tail; });
  ASSERT_EQ(read.size(), wanted.size());
  for (std::size_t n = 0; n < read.size(); ++n) {
    EXPECT_EQ(read[n].duration, wanted[n].duration) << n;
    EXPECT_EQ(read[n].s0, wanted[n].s0) << n;
  }
}

TEST(SmoothRun, IsNoFasterThanTheFeedOfABlockOrOfTheMachine) {
  for (const double feed : {5.0, 500.0}) {
    MachineModel model = bench_machine();
    model.max_feed_mm_per_s = 20;
    Ran one(model);
    one.cut_straight(10, 2, feed);
    one.finish();
    double fastest = 0;
    for (const TimePiece& piece : one.times()) {
      fastest = std::max(fastest, state_at(piece, 0).ds);
      EXPECT_EQ(piece.feed_mm_per_s, std::min(feed, 20.0));
    }
    EXPECT_NEAR(fastest, std::min(feed, 20.0), 0.01 * feed);
  }
}

TEST(SmoothRun, ReportsWhereTheAxisIsRelaxedPastThePole) {
  const auto at = [](double x) {
    return ToolPose{Vector3(x, 0, 0), Vector3(0.0005, 0.004 * x, 1).normalized()};
  };
  Ran one(bench_machine(), at(-60));
  for (int n = 1; n <= 60; ++n) one.cut(at(-60 + 2 * n));
  one.finish();
  RelaxedAxis relaxed;
  ASSERT_TRUE(one.run.take_relaxed_axis(relaxed));
  EXPECT_LE(relaxed.first_sequence, 40U + 29);
  EXPECT_GE(relaxed.last_sequence, 40U + 30);
  EXPECT_GT(relaxed.first_sequence, 40U + 10);
  EXPECT_LT(relaxed.last_sequence, 40U + 50);
  EXPECT_EQ(relaxed.first_line, relaxed.first_sequence + 100);
  EXPECT_EQ(relaxed.last_line, relaxed.last_sequence + 100);
  EXPECT_GT(relaxed.deviation_rad, 1e-5);
  EXPECT_LE(relaxed.deviation_rad, kTolerance_rad);
  EXPECT_FALSE(one.run.take_relaxed_axis(relaxed)) << "once";
}

TEST(SmoothRun, RestsWhereTheRedundantJointRunsOutAndGoesOnAfterARewind) {
  constexpr std::size_t kFree = 3;
  const auto at = [](int n) {
    const double azimuth = 0.05 * n;
    const Vector3 axis(std::sin(0.3) * std::cos(azimuth), std::sin(0.3) * std::sin(azimuth),
                       std::cos(0.3));
    return ToolPose{Vector3(0.5 * n, 0, 0), axis};
  };
  MachineModel model = lai_machine();
  model.rewind_policy = RewindPolicy::kRetract;
  Ran one(model, at(0));
  for (int n = 1; n <= 400 && one.status == Status::kNeedsBlocks; ++n) one.cut(at(n));
  one.reader.set_epoch(3);
  for (int n = 0; n < 5000 && one.status != Status::kRewind; ++n) {
    if (one.status == Status::kNoRoom) {
      ASSERT_NE(one.reader.advance(), nullptr);
    }
    one.status = one.run.publish(one.writer);
  }
  ASSERT_EQ(one.status, Status::kRewind);
  EXPECT_EQ(one.run.rewind_at().joint, static_cast<int>(kFree));
  const double turned = one.run.joints()[kFree], side = std::copysign(1.0, turned);
  EXPECT_GT(std::abs(turned), 3.9 * std::numbers::pi);
  RewindTarget target{one.run.joints(), static_cast<int>(-side), 0};
  EXPECT_TRUE(one.run.fits(target));
  EXPECT_FALSE(one.run.fits({one.run.joints(), static_cast<int>(side), 0})) << "farther out";
  target.joints[kFree] -= side * 2 * std::numbers::pi;
  one.run.go_on(target, 5000, 900);
  EXPECT_EQ(one.run.joints(), target.joints);
  for (int n = 0; n < 20 && one.status != Status::kNeedsBlocks; ++n) {
    one.status = one.run.publish(one.writer);
  }
  one.finish();
  const auto paths = one.paths();
  const auto next = std::find_if(paths.begin(), paths.end(),
                                 [](const PathPiece& piece) { return piece.index == 5000; });
  ASSERT_NE(next, paths.end());
  EXPECT_NEAR(next->joints_begin[kFree], target.joints[kFree], 1e-6);
  EXPECT_EQ(one.times().back().window + 1, one.run.next_window());
  EXPECT_GT(one.run.next_window(), 900U);
}

}  // namespace
}  // namespace meridian::test::smooth_run
