// SPDX-License-Identifier: Apache-2.0
#include "service/core/planner/look_ahead/smooth_workspace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/planner/time_law.hpp"
#include "support/family_machines.hpp"
#include "support/machines.hpp"
#include "unit/planner/look_ahead/published.hpp"

/// How runs through blocks and motion from rest to rest take turns.
namespace meridian::test::smooth_workspace {
namespace {

const Vector3 kTilted(std::sin(0.3), 0, std::cos(0.3));

/// A program that begins at rest in the first pose, and what is published of it.
struct Planned : Published {
  explicit Planned(const SmoothSettings& settings = {Transition::kSmooth, 0, 0},
                   const Vector3& begin_axis = kTilted, const MachineModel& m = bench_machine())
      : model(m), tip(0, 0, 0), axis(begin_axis) {
    start = solve(model, model.tool_length_mm, ToolPose{tip, axis}, 0, {}).q;
    planner.begin(start, model.tool_length_mm, 2, settings);
    planner.look_no_further();
    cut({0, 0, 0});
  }
  void add(ClBlock block) {
    block.sequence = sequence++;
    block.tip_mm = to_array(tip);
    block.axis = to_array(axis);
    last = planner.plan(block, writer);
    if (last.status != PlanStatus::kNoRoom) return;
    begin_newest_window();
    last = planner.plan(block, writer);
  }
  void cut(const Vector3& by, const Vector3& to_axis) {
    ClBlock block;
    block.feed_meaning = FeedMeaning::kTip;
    block.feed = 50;
    tip += by;
    axis = to_axis;
    add(block);
  }
  void cut(const Vector3& by) { cut(by, axis); }
  void add(BlockKind kind, const Vector3& by = Vector3::Zero()) {
    ClBlock block;
    block.kind = kind;
    block.value = 0.5;
    tip += by;
    add(block);
  }
  /// How often the motion comes to rest.
  [[nodiscard]] int rests() const {
    const auto all = times();
    return static_cast<int>(std::count_if(all.begin(), all.end(), [](const TimePiece& piece) {
      return piece.kind == TimeKind::kMove && !piece.is_tail &&
             state_at(piece, piece.duration).ds < 1e-6;
    }));
  }
  /// How near the path of the tool comes to `point`.
  [[nodiscard]] double distance_to(const Vector3& point) const {
    double nearest = 1e9;
    for (const PathPiece& piece : paths()) {
      for (int k = 0; k <= 50; ++k) {
        nearest = std::min(nearest, (pose_at(piece, piece.length * k / 50).tip - point).norm());
      }
    }
    return nearest;
  }

  MachineModel model;
  SmoothPlanner planner{model};
  JointVector start{};
  Vector3 tip, axis;
  std::uint64_t sequence = 0;
  PlanResult last;
};

TEST(SmoothWorkspace, RunsOnThroughCutsToTheEndOfTheProgram) {
  Planned one;
  for (int n = 0; n < 10; ++n) one.cut({2, 0, 0});
  one.add(BlockKind::kEnd);
  EXPECT_EQ(one.last.status, PlanStatus::kOk);
  EXPECT_EQ(one.rests(), 1);
  const JointVector end = solve(one.model, 100, ToolPose{one.tip, one.axis}, 0, one.start).q;
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(one.planner.joints()[i], end[i], 1e-6) << i;
}

TEST(SmoothWorkspace, RestsForARapidAndForADwell) {
  for (const BlockKind kind : {BlockKind::kRapid, BlockKind::kDwell}) {
    Planned one;
    for (int n = 0; n < 5; ++n) one.cut({2, 0, 0});
    one.add(kind, kind == BlockKind::kRapid ? Vector3(0, 5, 0) : Vector3(0, 0, 0));
    for (int n = 0; n < 5; ++n) one.cut({2, 0, 0});
    one.add(BlockKind::kEnd);
    EXPECT_EQ(one.rests(), kind == BlockKind::kRapid ? 3 : 2);
  }
}

TEST(SmoothWorkspace, NamesGoOnFromRunsToMotionAtRestAndBack) {
  Planned one;
  for (int n = 0; n < 3; ++n) {
    one.cut({2, 0, 0});
    one.cut({2, 0, 0});
    one.add(BlockKind::kRapid, {0, 5, 0});
  }
  one.add(BlockKind::kEnd);
  std::uint64_t next = one.paths().front().index;
  JointVector joints = one.start;
  for (const PathPiece& piece : one.paths()) {
    EXPECT_EQ(piece.index, next++);
    EXPECT_EQ(piece.epoch, 2);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(piece.joints_begin[i], joints[i], 1e-7);
    joints = piece.joints_end;
  }
  std::uint32_t window = one.times().front().window;
  for (const TimePiece& piece : one.times()) {
    EXPECT_TRUE(piece.window == window || piece.window == window + 1);
    window = piece.window;
  }
}

TEST(SmoothWorkspace, RestsAtEveryBlockWhereTheProgramAsksForExactStop) {
  Planned one({Transition::kExactStop, 0, 0});
  for (int n = 0; n < 4; ++n) one.cut({2, 0, 0});
  one.add(BlockKind::kEnd);
  EXPECT_EQ(one.rests(), 4);
}

TEST(SmoothWorkspace, RoundsACornerByTheToleranceAskedForOrTheMachines) {
  struct Case {
    double asked_mm, kept_mm;
  };
  constexpr double kMin_mm = 0.001;  // BandTolerance
  for (const Case& c : {Case{0, 0.01}, {0.1, 0.1}, {0.003, 0.003}, {1e-9, kMin_mm}}) {
    Planned one({Transition::kSmooth, c.asked_mm, 0});
    one.cut({5, 0, 0});
    const Vector3 corner = one.tip;
    one.cut({0, 5, 0});
    one.add(BlockKind::kEnd);
    EXPECT_EQ(one.rests(), 1);
    EXPECT_LE(one.distance_to(corner), c.kept_mm) << c.asked_mm;
    EXPECT_GT(one.distance_to(corner), 0.2 * c.kept_mm) << c.asked_mm;
  }
}

TEST(SmoothWorkspace, RunsAlongThePoleWhereTheAxisStaysOnIt) {
  Planned one({Transition::kSmooth, 0, 0}, Vector3::UnitZ());
  one.cut({5, 0, 0});
  one.cut({0, 5, 0});
  one.cut({5, 0, 0});
  one.add(BlockKind::kEnd);
  EXPECT_EQ(one.rests(), 1);
}

TEST(SmoothWorkspace, RunsOntoThePoleAlongItAndOffAgain) {
  Planned one;
  one.cut({20, 0, 0}, Vector3::UnitZ());
  one.cut({10, 0, 0});
  one.cut({20, 0, 0}, kTilted);
  one.add(BlockKind::kEnd);
  EXPECT_EQ(one.rests(), 1);
}

TEST(SmoothWorkspace, AnAxisThatRoundingAloneKeepsOffThePoleIsOnIt) {
  const auto planned = [](double off) {
    auto one =
        std::make_unique<Planned>(SmoothSettings{Transition::kSmooth, 0, 0}, Vector3::UnitZ());
    const Vector3 rounded = Vector3(off, -off, 1).normalized();
    one->cut({5, 0, 0}, rounded);
    one->cut({0, 5, 0}, rounded);
    one->cut({5, 0, 0}, rounded);
    one->add(BlockKind::kEnd);
    return one;
  };
  const auto exact = planned(0)->paths(), rounded = planned(1e-11)->paths();
  ASSERT_EQ(rounded.size(), exact.size());
  for (std::size_t n = 0; n < exact.size(); ++n) {
    EXPECT_EQ(rounded[n].joints_begin, exact[n].joints_begin) << n;
    EXPECT_EQ(rounded[n].joints_end, exact[n].joints_end) << n;
    EXPECT_EQ(rounded[n].is_free_driven, exact[n].is_free_driven) << n;
  }
}

TEST(SmoothWorkspace, KeepsHalfOfTheAxisToleranceForThePoleBesideIt) {
  const auto leaning = [](double x, double y) { return Vector3(x, y, 1).normalized(); };
  for (const PolePolicy policy : {PolePolicy::kRelax, PolePolicy::kExact}) {
    MachineModel model = bench_machine();
    model.pole_policy = policy;
    Planned one({Transition::kSmooth, 0, 0}, leaning(0.01, -0.1), model);
    one.cut({20, 0, 0}, leaning(0.01, 0));
    one.cut({20, 0, 0}, leaning(0.11, 0));
    one.add(BlockKind::kEnd);
    double nearest = 1;  // of the corner, in tolerances
    for (const PathPiece& piece : one.paths()) {
      for (int k = 0; k <= 50; ++k) {
        const Vector3 at = pose_at(piece, piece.length * k / 50).axis;
        nearest = std::min(nearest, (at - leaning(0.01, 0)).norm() / model.tolerances.axis_rad);
      }
    }
    EXPECT_EQ(nearest <= 0.5, policy == PolePolicy::kRelax) << nearest;
  }
}

TEST(SmoothWorkspace, LeadsOffThePoleFromRestAndRunsOnBehind) {
  Planned one({Transition::kSmooth, 0, 0}, Vector3::UnitZ());
  one.cut({5, 0, 0}, kTilted);
  one.cut({5, 0, 0});
  one.cut({5, 0, 0});
  one.add(BlockKind::kEnd);
  EXPECT_EQ(one.rests(), 2) << "behind the block that leads off, and at the end";
}

TEST(SmoothWorkspace, RefusesABlockThatLeavesTravelAndRestsAheadOfIt) {
  MachineModel model = bench_machine();
  for (std::size_t i = 0; i < 3; ++i) model.joints[i].limits.travel_max = 500;
  Planned one({Transition::kSmooth, 0, 0}, kTilted, model);
  one.cut({20, 0, 0});
  one.cut({0, 20, 0});
  one.cut({5000, 5000, 5000});
  one.add(BlockKind::kEnd);
  EXPECT_EQ(one.last.status, PlanStatus::kRefused);
  EXPECT_EQ(one.last.reject.sequence, 3U);
  EXPECT_EQ(one.planner.plan({}, one.writer).status, PlanStatus::kRefused) << "for good";
  const auto times = one.times();
  ASSERT_FALSE(times.empty());
  EXPECT_NEAR(state_at(times.back(), times.back().duration).ds, 0, 1e-9);
}

/// Every path piece that was published, the cycle going on wherever there is no room.
struct Followed : Planned {
  explicit Followed(const MachineModel& m) : Planned({Transition::kSmooth, 0, 0}, kTilted, m) {
    reader.set_epoch(2);
  }
  void plan(ClBlock block) {
    block.sequence = sequence++;
    for (;;) {
      last = planner.plan(block, writer);
      for (const PathPiece& piece : paths()) all[piece.index] = piece;
      if (last.status != PlanStatus::kNoRoom || reader.advance() == nullptr) return;
    }
  }
  MotionReader reader{*port};
  std::map<std::uint64_t, PathPiece> all;
};

TEST(SmoothWorkspace, ARewindBeginsWithTheJointsOfTheRunAndTheRunGoesOnWithItsOwn) {
  MachineModel model = lai_machine();
  model.rewind_policy = RewindPolicy::kRetract;
  Followed one(model);
  ClBlock block;
  block.feed_meaning = FeedMeaning::kTip;
  block.feed = 50;
  for (int n = 1; n <= 400; ++n) {
    const double azimuth = 0.05 * n;
    block.tip_mm = {0.5 * n, 0, 0};
    block.axis = {std::sin(0.3) * std::cos(azimuth), std::sin(0.3) * std::sin(azimuth),
                  std::cos(0.3)};
    one.plan(block);
  }
  block.kind = BlockKind::kEnd;
  one.plan(block);
  ASSERT_EQ(one.last.status, PlanStatus::kOk);
  int rewinds = 0;
  const PathPiece* before = nullptr;
  for (const auto& [index, piece] : one.all) {
    rewinds += piece.motion == MotionKind::kRewind;
    for (std::size_t i = 0; i < 5 && before != nullptr; ++i) {
      EXPECT_NEAR(piece.joints_begin[i], before->joints_end[i], 1e-6) << index << " " << i;
    }
    before = &piece;
  }
  EXPECT_GT(rewinds, 0);
}

TEST(SmoothWorkspace, BranchesAreForMachinesWithARedundantJointAndForRobots) {
  EXPECT_TRUE(has_branches(bench_machine()));
  EXPECT_TRUE(has_branches(robot_machine(true)));
}

}  // namespace
}  // namespace meridian::test::smooth_workspace
