// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/singular/robot/robot_passes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/planner/joints_at.hpp"
#include "support/machines.hpp"
#include "unit/planner/singular/wrist_path.hpp"

namespace meridian::test::robot_passes_spans {
namespace {

using wrist_path::WristPath;

constexpr double kAxisTolerance_rad = 0.002, kTipTolerance_mm = 0.01;

/// The straight path of `path` in spans of 1 mm, whose singularity is at u = `nearest`, and what
/// comes of them.
struct Passed {
  Passed(const WristPath& of, int count, double nearest) : path(of), passes(path.model) {
    for (int n = 0; n < count; ++n) {
      JointSpan span;
      span.band = part_of_span(path.span, n - nearest + 10, 1);
      span.band.u0 = n;
      span.band.sequence = static_cast<std::uint64_t>(n);
      spans.push_back(span);
    }
    start.pose = pose(0);
    start.branch = path.branch;
    start.tool_length_mm = path.model.tool_length_mm;
    start.axis_tolerance_rad = kAxisTolerance_rad;
    start.tip_tolerance_mm = kTipTolerance_mm;
    JointVector joints = path.middle;  // along the path from where its joints are known
    for (int k = 0; k <= 400; ++k) joints = exact(nearest * (1 - k / 400.0), joints);
    start.joints = joints;
  }
  [[nodiscard]] ToolPose pose(double u) const {
    const auto n = std::min(static_cast<std::size_t>(u), spans.size() - 1);
    return pose_on(spans[n].band.c, u - spans[n].band.u0);
  }
  [[nodiscard]] JointVector exact(double u, const JointVector& near) const {
    return solve(path.model, path.model.tool_length_mm, pose(u), path.branch, near).q;
  }
  void take_all() {
    while (const JointSpan* span = passes.next()) out.push_back(*span);
  }
  /// All of the path; what is ready is taken after every span, or where it has to be.
  void run() {
    passes.begin(start);
    for (const JointSpan& span : spans) {
      const double end = span.band.u0 + 1;
      passes.mark({end, to_array(pose(end).tip), to_array(pose(end).axis)});
      passes.push(span);
      take_all();
      handed.push_back(out.empty() ? 0 : out.back().band.u0 + out.back().band.length);
    }
    passes.finish();
    take_all();
  }
  [[nodiscard]] std::vector<JointSpan> driven() const {
    std::vector<JointSpan> some;
    std::copy_if(out.begin(), out.end(), std::back_inserter(some),
                 [](const JointSpan& span) { return span.is_free_driven; });
    return some;
  }

  WristPath path;
  RobotPasses passes;
  RobotPasses::Start start;
  std::vector<JointSpan> spans, out;
  std::vector<double> handed;  ///< u that was handed out after each span
};

/// What the joints do on the spans that came out.
struct Followed {
  explicit Followed(const Passed& one) {
    const MachineModel& model = one.path.model;
    joints = one.start.joints;
    for (const JointSpan& span : one.out) {
      PathPiece piece = make_spline(span);
      piece.tool_length_mm = model.tool_length_mm;
      for (int k = 0; k <= 20; ++k) {
        const double x = span.band.length * k / 20;
        const JointVector before = joints;
        joints = joints_at(model, piece, x, before).q;
        if (k == 0) {
          for (std::size_t i = 0; i < 6; ++i)
            jump = std::max(jump, std::abs(joints[i] - before[i]));
        }
        const ToolPose there = forward(model, model.tool_length_mm, joints);
        const ToolPose wanted = pose_on(span.band.c, x);
        off_mm = std::max(off_mm, (there.tip - wanted.tip).norm());
        off_rad = std::max(off_rad, angle_between(there.axis, wanted.axis));
      }
    }
  }
  JointVector joints{};
  double jump = 0, off_mm = 0, off_rad = 0;
};

void expect_whole(const Passed& one) {
  ASSERT_FALSE(one.out.empty());
  double u = 0;
  for (const JointSpan& span : one.out) {
    EXPECT_NEAR(span.band.u0, u, 1e-9);
    EXPECT_GT(span.band.length, 0);
    u = span.band.u0 + span.band.length;
    EXPECT_EQ(static_cast<double>(span.band.sequence), std::floor(span.band.u0 + 1e-9));
  }
  EXPECT_NEAR(u, static_cast<double>(one.spans.size()), 1e-9);
}

TEST(RobotPassesSpans, LeadThroughTheWristAndKeepTheRestOfThePathExact) {
  Passed one(WristPath(1e-4), 80, 40);
  one.run();
  expect_whole(one);
  const auto driven = one.driven();
  ASSERT_FALSE(driven.empty());
  EXPECT_LT(driven.front().band.u0, 40);
  EXPECT_GT(driven.back().band.u0 + driven.back().band.length, 40);
  EXPECT_GE(driven.front().band.u0, 40 - kPassReach_mm);
  EXPECT_LE(driven.back().band.u0 + driven.back().band.length, 40 + kPassReach_mm);
  for (const JointSpan& span : driven) {
    EXPECT_EQ(span.reason, RelaxedReason::kThroughWrist);
    EXPECT_LE(span.axis_deviation_rad, kAxisTolerance_rad);
  }
  EXPECT_EQ(one.out.front().branch, one.path.branch);
  EXPECT_EQ(one.out.back().branch, one.path.branch ^ robot::kFlip);
  const Followed followed(one);
  EXPECT_LT(followed.jump, 1e-5);
  EXPECT_LT(followed.off_mm, 1e-6);
  EXPECT_LE(followed.off_rad, kAxisTolerance_rad);
  EXPECT_LT(std::abs(followed.joints[robot::kRoll] - one.start.joints[robot::kRoll]), 0.2);
}

TEST(RobotPassesSpans, LieAboutTheNearestPointOfTheSingularityAsFarToEitherSide) {
  for (const double nearest : {40.0, 40.06, 40.5}) {
    Passed one(WristPath(1e-4), 80, nearest);
    one.run();
    const auto driven = one.driven();
    ASSERT_FALSE(driven.empty());
    const BandSpan& last = driven.back().band;
    const double before = nearest - driven.front().band.u0;
    EXPECT_NEAR(last.u0 + last.length - nearest, before, 0.125) << "the distance of two measures";
  }
}

TEST(RobotPassesSpans, ReachAsFarAsAPassMayWhereTheRollHasToTurnAndTheToleranceIsWide) {
  WristPath path(1e-4);
  path.model.joints[robot::kBend].limits.travel_min = -1e-3;  // the bend stays on its side
  Passed one(path, 120, 60);
  one.start.axis_tolerance_rad = 0.1;
  one.run();
  expect_whole(one);
  const auto driven = one.driven();
  ASSERT_FALSE(driven.empty());
  const BandSpan& last = driven.back().band;
  EXPECT_NEAR(driven.front().band.u0, 60 - kPassReach_mm, 0.125);
  EXPECT_NEAR(last.u0 + last.length - driven.front().band.u0, 2 * kPassReach_mm, 1e-9);
}

TEST(RobotPassesSpans, AreThePathItselfWhereItStaysOutOfTheTolerance) {
  for (const double beside_rad : {0.004, 0.05}) {
    Passed one(WristPath(beside_rad), 60, 30);
    one.run();
    ASSERT_EQ(one.out.size(), one.spans.size());
    for (std::size_t n = 0; n < one.out.size(); ++n) {
      EXPECT_FALSE(one.out[n].is_free_driven);
      EXPECT_EQ(one.out[n].band.c, one.spans[n].band.c);
      EXPECT_EQ(one.out[n].branch, one.path.branch);
    }
    EXPECT_LT(Followed(one).off_rad, 1e-7);
  }
}

TEST(RobotPassesSpans, WaitOnlyAsLongAsAPassMayReachBack) {
  Passed far(WristPath(0.9), 60, 30);
  far.run();
  for (std::size_t n = 2; n < far.handed.size(); ++n) {
    EXPECT_GE(far.handed[n], static_cast<double>(n) - 1) << "nothing singular is near";
  }
  Passed near(WristPath(0.05), 60, 30);
  near.run();
  for (std::size_t n = 0; n < near.handed.size(); ++n) {
    const double end = static_cast<double>(n) + 1;
    EXPECT_GE(near.handed[n], end - kPassReach_mm - 3);
    EXPECT_LE(near.handed[n], std::max(0.0, end - kPassReach_mm));
  }
}

TEST(RobotPassesSpans, DependOnThePathAndNotOnThePathBefore) {
  Passed one(WristPath(1e-4), 80, 40), again(WristPath(1e-4), 80, 40);
  one.run();
  again.run();
  const auto first = again.out;
  again.out.clear();
  again.run();
  ASSERT_EQ(again.out.size(), first.size());
  for (std::size_t n = 0; n < first.size(); ++n) {
    EXPECT_EQ(again.out[n].band.u0, first[n].band.u0);
    EXPECT_EQ(again.out[n].free, first[n].free);
    EXPECT_EQ(one.out[n].free, first[n].free);
  }
}

TEST(RobotPassesSpans, PassTheWristTwiceAndComeBackToTheFirstBranch) {
  Passed one(WristPath(1e-4), 120, 30);
  for (std::size_t n = 60; n < one.spans.size(); ++n) {  // the way back
    BandSpan& span = one.spans[n].band;
    span = part_of_span(one.path.span, 10 + 90 - static_cast<double>(n), 1);
    for (auto& c : span.c) c[1] = -c[1];
    span.u0 = static_cast<double>(n);
    span.sequence = n;
  }
  one.run();
  expect_whole(one);
  const Followed followed(one);
  EXPECT_LT(followed.jump, 1e-5);
  EXPECT_LE(followed.off_rad, kAxisTolerance_rad);
  EXPECT_EQ(one.out.back().branch, one.path.branch);
  EXPECT_EQ(one.out[one.out.size() / 2].branch, one.path.branch ^ robot::kFlip);
}

TEST(RobotPassesSpans, DriveTheRollFromTheBeginOfAPathThatStartsOnTheWrist) {
  Passed one(WristPath(1e-4), 60, 0);
  one.run();
  expect_whole(one);
  EXPECT_TRUE(one.out.front().is_free_driven);
  EXPECT_EQ(one.out.front().free.front(), one.start.joints[robot::kRoll]) << "as it stands";
  const Followed followed(one);
  EXPECT_LT(followed.jump, 1e-5);
  EXPECT_LE(followed.off_rad, kAxisTolerance_rad);
}

TEST(RobotPassesSpans, RestTheRollAtTheEndOfAPathThatEndsOnTheWrist) {
  Passed one(WristPath(1e-4), 30, 30);
  one.run();
  expect_whole(one);
  ASSERT_TRUE(one.out.back().is_free_driven);
  EXPECT_EQ(one.out.back().free[4], one.out.back().free[5]);
  EXPECT_EQ(one.out.back().branch, one.path.branch);
  EXPECT_LT(Followed(one).jump, 1e-5);
}

TEST(RobotPassesSpans, PassBothSingularitiesInsideBothTolerances) {
  Passed one(wrist_path::path_past_both(1e-4, 0.005), 80, 40);
  one.run();
  expect_whole(one);
  const Followed followed(one);
  EXPECT_LT(followed.jump, 1e-4);
  EXPECT_LE(followed.off_rad, kAxisTolerance_rad);
  EXPECT_LE(followed.off_mm, kTipTolerance_mm);
  EXPECT_FALSE(one.driven().empty());
}

TEST(RobotPassesSpans, MoveTheAxisHardlyWhereNothingMayGive) {
  WristPath path(1e-6);
  path.model.pole_policy = PolePolicy::kExact;
  for (const double nearest : {30.0, 30.03, 30.06}) {  // spans are measured every 0.125 mm
    Passed one(path, 60, nearest);
    one.run();
    expect_whole(one);
    EXPECT_FALSE(one.driven().empty()) << nearest;
    EXPECT_LT(Followed(one).off_rad, 1e-5);
  }
}

TEST(RobotPassesSpans, AreThePathItselfWhereThereIsNoPass) {
  WristPath path(1e-4);
  path.model.joints[robot::kElbow].limits.travel_max = path.middle[robot::kElbow] - 0.1;
  Passed one(path, 60, 30);
  one.run();
  EXPECT_EQ(one.out.size(), one.spans.size());
  EXPECT_TRUE(one.driven().empty());
}

TEST(RobotPassesSpans, AreThoseOfThePathOnAnyOtherMachine) {
  const MachineModel model = bench_machine();
  RobotPasses passes(model);
  passes.begin({});
  EXPECT_EQ(passes.next(), nullptr);
  for (int n = 0; n < 3; ++n) {
    JointSpan span;
    span.band.u0 = n;
    span.is_free_driven = n == 1;
    passes.mark({n + 1.0, {}, {0, 0, 1}});
    passes.push(span);
    const JointSpan* got = passes.next();
    ASSERT_NE(got, nullptr);
    EXPECT_EQ(got->band.u0, n);
    EXPECT_EQ(got->is_free_driven, n == 1);
    EXPECT_EQ(passes.next(), nullptr) << "once";
  }
}

}  // namespace
}  // namespace meridian::test::robot_passes_spans
