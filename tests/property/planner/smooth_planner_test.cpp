// SPDX-License-Identifier: Apache-2.0

/// Programs run on through their blocks: limits, tolerances and feed of what comes out of the port,
/// barriers at rest, running dry.

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "property/path/hostile_path.hpp"
#include "property/planner/smooth_trace.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::smooth_planner {
namespace {

constexpr double kLimit = 1 + 1e-6;

std::vector<ClBlock> hostile(std::uint32_t seed, int sections) {
  return HostilePath(seed).make_program(sections);
}

struct Peaks {
  double v = 0, a = 0, j = 0, feed = 0, off = 0, duration_s = 0;
};

/// Checks setpoints of `trace` by `blocks` alone.
void check(const MachineModel& model, const SmoothTrace& trace, const std::vector<ClBlock>& blocks,
           const JointVector& start, Peaks& peaks) {
  ASSERT_EQ(trace.last.status, PlanStatus::kOk)
      << "code " << static_cast<int>(trace.last.reject.code) << " joint " << trace.last.reject.joint
      << " block " << trace.last.reject.sequence;
  ASSERT_EQ(trace.times.back().kind, TimeKind::kEnd);
  const auto programmed = programmed_paths(blocks);
  for (const double cycle : {1e-3, 250e-6}) {
    const auto setpoints = sample(model, trace, cycle, 0.37, start);
    const LimitUse use = measure_limits(model, setpoints, cycle);
    ASSERT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where << " cycle " << cycle;
    const double feed = measure_feed(model, trace, setpoints, cycle);
    ASSERT_LE(feed, 1.0001);
    peaks.v = std::max(peaks.v, use.v);
    peaks.a = std::max(peaks.a, use.a);
    peaks.j = std::max(peaks.j, use.j);
    peaks.feed = std::max(peaks.feed, feed);
    if (cycle != 1e-3) continue;
    for (std::size_t n = 3; n + 3 < setpoints.size(); n += 7) {
      const auto k = static_cast<std::size_t>(setpoints[n].piece);
      if (trace.times[k].kind != TimeKind::kMove) continue;
      if (trace.paths[k].motion == MotionKind::kApproach) continue;
      const ToolPose pose = forward(model, trace.paths[k].tool_length_mm, setpoints[n].q);
      const double off = distance_from(programmed, trace.times[k].sequence, pose,
                                       model.tolerances.tip_mm, model.tolerances.axis_rad);
      ASSERT_LE(off, 1 + 1e-6) << "setpoint " << n << " block " << trace.times[k].sequence;
      peaks.off = std::max(peaks.off, off);
    }
  }
  peaks.duration_s += trace.duration_s();
  const ToolPose end = forward(model, model.tool_length_mm, trace.joints);
  EXPECT_LE((end.tip - to_vector(blocks[blocks.size() - 2].tip_mm)).norm(), 2e-6);
}

void print(const char* what, const Peaks& peaks) {
  std::printf("%s: %.0f s, v %.4f a %.4f j %.4f feed %.5f of the limits, %.3f tolerances\n", what,
              peaks.duration_s, peaks.v, peaks.a, peaks.j, peaks.feed, peaks.off);
}

constexpr std::uint32_t kPrograms = draws(4);

TEST(SmoothPlanner, KeepsLimitsFeedAndTolerancesOnHostilePrograms) {
  for (const MachineModel& model : {bench_machine(), lai_machine()}) {
    Peaks peaks;
    for (std::uint32_t seed = 1; seed <= kPrograms; ++seed) {
      SCOPED_TRACE(testing::Message() << model.name << " seed " << seed);
      const auto blocks = hostile(seed, 12);
      const JointVector start = joints_of(model, blocks[0]);
      check(model, plan_smooth(model, blocks, start), blocks, start, peaks);
    }
    print(model.name.c_str(), peaks);
  }
}

/// 60 mm straight, the axis in 1 deg steps to `distance` from the pole and on, bent there by
/// `bend`.
std::vector<ClBlock> past_the_pole(double distance_rad, double bend_rad) {
  std::vector<ClBlock> blocks;
  for (int n = 0; n <= 30; ++n) {
    const double along = units::rad_from_deg(n - 15.0), turn = n > 15 ? bend_rad : 0;
    const Vector3 flat(std::cos(turn) * std::sin(along) - std::sin(turn) * distance_rad,
                       std::sin(turn) * std::sin(along) + std::cos(turn) * distance_rad,
                       std::cos(along));
    ClBlock block;
    block.sequence = blocks.size();
    block.tip_mm = {2.0 * n - 30, 20, 30};
    block.axis = to_array(flat.normalized());
    block.feed = 100;
    block.feed_meaning = FeedMeaning::kTip;
    blocks.push_back(block);
  }
  end_program(blocks);
  return blocks;
}

TEST(SmoothPlanner, RunsThroughThePoleInsideTheTolerance) {
  for (const MachineModel& model : {bench_machine(), lai_machine()}) {
    for (const double bend_deg : {0.0, 60.0}) {
      double straight_s = 0;
      for (const double distance_deg : {0.0, 1e-6, 0.01, 0.05}) {
        SCOPED_TRACE(testing::Message() << model.name << " at " << distance_deg << " deg, bend "
                                        << bend_deg << " deg");
        const auto blocks =
            past_the_pole(units::rad_from_deg(distance_deg), units::rad_from_deg(bend_deg));
        const JointVector start = joints_of(model, blocks[0]);
        const SmoothTrace trace = plan_smooth(model, blocks, start);
        Peaks peaks;
        check(model, trace, blocks, start, peaks);
        if (HasFatalFailure()) return;
        std::printf("%s, bend %.0f deg, at %.0e deg: %.3f s, j %.4f, %.3f tolerances\n",
                    model.name.c_str(), bend_deg, distance_deg, peaks.duration_s, peaks.j,
                    peaks.off);
        if (distance_deg == 0) straight_s = peaks.duration_s;
        EXPECT_LT(peaks.duration_s, 1.15 * straight_s) << "the redundant joint was turned";
        for (std::size_t n = 1; n < trace.times.size(); ++n) {
          const bool is_inside = trace.times[n].sequence > 2 && trace.times[n].sequence < 29;
          EXPECT_FALSE(is_inside && trace.times[n].v == 0)
              << "rest at block " << trace.times[n].sequence;
        }
      }
    }
  }
}

TEST(SmoothPlanner, EasesTheAxisAsFarAsThePoleHasATolerance) {
  const auto blocks = past_the_pole(units::rad_from_deg(0.11), 0);
  MachineModel model = bench_machine();  // axis tolerance 0.1 deg: no way through
  const JointVector start = joints_of(model, blocks[0]);
  const double exact_s = plan_smooth(model, blocks, start).duration_s();
  model.tolerances.pole_axis_rad = units::rad_from_deg(0.12);
  const SmoothTrace relaxed = plan_smooth(model, blocks, start);
  const LimitUse use = measure_limits(model, sample(model, relaxed, 250e-6, 0.37, start), 250e-6);
  EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where;
  std::printf("at 0.11 deg: %.3f s exact, %.3f s relaxed\n", exact_s, relaxed.duration_s());
  EXPECT_GT(exact_s, 3);
  EXPECT_LT(relaxed.duration_s(), 1);
}

/// The hostile program with its axes drawn into what a stage reaches, and weak sliders.
TEST(SmoothPlanner, KeepsTheLimitsOfJointsAndDrivesBehindAStage) {
  MachineModel model = hybrid_machine();
  model.joints[4].limits.travel_max = 1.5;
  for (JointSpec& drive : model.stage_drives) {
    drive.limits.velocity = 60;
    drive.limits.acceleration = 500;
    drive.limits.jerk = 15000;
  }
  Peaks peaks;
  int splines = 0;
  for (std::uint32_t seed = 1; seed <= draws(3); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    auto blocks = hostile(seed, 8);
    for (ClBlock& block : blocks) {
      const Vector3 leaning = 0.25 * to_vector(block.axis) + Vector3(0.5, 0, 0.7);
      if (is_motion(block.kind)) block.axis = to_array(leaning.normalized());
    }
    const JointVector start = joints_of(model, blocks[0]);
    const auto trace = plan_smooth(model, blocks, start);
    check(model, trace, blocks, start, peaks);
    for (const PathPiece& path : trace.paths) splines += path.kind == PathKind::kSpline;
  }
  EXPECT_GT(splines, draws(200));
  print("behind a stage", peaks);
}

TEST(SmoothPlanner, GoesOnFromWhereTheMachineRanDry) {
  const MachineModel model = lai_machine();
  Peaks peaks;
  int tails = 0;
  for (std::uint32_t seed = 11; seed < 11 + draws(4); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto blocks = hostile(seed, 12);
    const JointVector start = joints_of(model, blocks[0]);
    std::mt19937 engine(seed);
    const auto trace = plan_smooth(
        model, blocks, start, {Transition::kSmooth, 0, 0},
        [&](std::size_t) { return engine() % 5 == 0; },
        [&](std::size_t) { return engine() % 4 == 0; });
    check(model, trace, blocks, start, peaks);
    tails += trace.tails;
  }
  EXPECT_GT(tails, draws(50));
  print("run dry", peaks);
}

TEST(SmoothPlanner, PublishesTheSameHoweverTheBlocksArrive) {
  const MachineModel model = lai_machine();
  for (std::uint32_t seed = 21; seed <= 21; ++seed) {
    const auto blocks = hostile(seed, 6);
    const JointVector start = joints_of(model, blocks[0]);
    const auto eager = plan_smooth(model, blocks, start);
    std::mt19937 engine(seed);
    const auto lazy = plan_smooth(
        model, blocks, start, {Transition::kSmooth, 0, 0},
        [&](std::size_t) { return engine() % 50 == 0; }, [](std::size_t) { return false; });
    ASSERT_EQ(eager.times.size(), lazy.times.size()) << "seed " << seed;
    for (std::size_t n = 0; n < eager.times.size(); ++n) {
      const TimePiece &a = eager.times[n], &b = lazy.times[n];
      ASSERT_TRUE(a.s0 == b.s0 && a.v == b.v && a.a == b.a && a.j == b.j && a.k == b.k &&
                  a.duration == b.duration && a.path_index == b.path_index &&
                  a.stop_accel == b.stop_accel && a.window == b.window)
          << "seed " << seed << " piece " << n;
      ASSERT_EQ(eager.paths[n].spline, lazy.paths[n].spline);
    }
  }
}

TEST(SmoothPlanner, RestsWhereRapidsDwellsAndActionsStand) {
  const MachineModel model = lai_machine();
  auto blocks = hostile(31, 8);
  blocks.pop_back();
  std::vector<ClBlock> program;
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    ClBlock block = blocks[n];
    if (n % 23 == 22) block.kind = BlockKind::kRapid;
    program.push_back(block);
    if (n % 31 == 30) {
      ClBlock dwell;
      dwell.kind = n % 2 == 0 ? BlockKind::kDwell : BlockKind::kAuxiliary;
      dwell.value = 0.01;
      program.push_back(dwell);
    }
  }
  program.emplace_back().kind = BlockKind::kEnd;
  for (std::size_t n = 0; n < program.size(); ++n) program[n].sequence = n;
  const JointVector start = joints_of(model, program[0]);
  const auto trace = plan_smooth(model, program, start);
  Peaks peaks;
  check(model, trace, program, start, peaks);
  int barriers = 0, splines = 0;
  for (std::size_t n = 1; n < trace.times.size(); ++n) {
    splines += trace.paths[n].kind == PathKind::kSpline ? 1 : 0;
    const bool is_barrier = trace.times[n].kind != TimeKind::kMove;
    const bool is_rapid = trace.paths[n].motion == MotionKind::kRapid;
    if (!is_barrier && !is_rapid) continue;
    ++barriers;
    const TimePiece& before = trace.times[n - 1];
    if (before.kind != TimeKind::kMove || trace.paths[n - 1].motion == MotionKind::kRapid) continue;
    EXPECT_LE(state_at(before, before.duration).ds, 1e-6) << n;
  }
  EXPECT_GT(barriers, 5);
  EXPECT_GT(splines, 100);
}

TEST(SmoothPlanner, StopsAtEveryBlockWhereAskedTo) {
  const MachineModel model = lai_machine();
  const auto blocks = hostile(41, 6);
  const JointVector start = joints_of(model, blocks[0]);
  SmoothSettings settings;
  settings.transition = Transition::kExactStop;
  const auto trace = plan_smooth(model, blocks, start, settings);
  const Trace plain = plan_program(model, blocks, start);
  ASSERT_EQ(trace.times.size(), plain.times.size());
  for (std::size_t n = 0; n < trace.times.size(); ++n) {
    EXPECT_EQ(trace.times[n].duration, plain.times[n].duration);
    EXPECT_NE(trace.paths[n].kind, PathKind::kSpline);
  }
  EXPECT_LT(plan_smooth(model, blocks, start).duration_s(), 0.95 * plain.duration_s());
}

TEST(SmoothPlanner, RefusesWhatLeavesTravelAndRestsAheadOfIt) {
  MachineModel model = lai_machine();
  std::vector<ClBlock> blocks;
  for (int n = 0; n < 400; ++n) {
    ClBlock block;
    block.sequence = static_cast<std::uint64_t>(n);
    block.tip_mm = {0.5 * n, 3 * std::sin(0.05 * n), 0};
    block.axis = {std::sin(0.3), 0, std::cos(0.3)};
    block.feed = 30;
    block.feed_meaning = FeedMeaning::kTip;
    blocks.push_back(block);
  }
  const JointVector start = joints_of(model, blocks[0]);
  const JointVector at = joints_of(model, blocks[300]);
  int joint = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(at[i] - start[i]) > std::abs(at[joint] - start[joint])) joint = i;
  }
  JointLimits& limits = model.joints[joint].limits;
  (at[joint] > start[joint] ? limits.travel_max : limits.travel_min) = at[joint];
  const auto trace = plan_smooth(model, blocks, start);
  ASSERT_EQ(trace.last.status, PlanStatus::kRefused);
  EXPECT_EQ(trace.last.reject.code, RejectCode::kTravelBetween);
  EXPECT_EQ(trace.last.reject.joint, joint);
  EXPECT_NEAR(static_cast<double>(trace.last.reject.sequence), 300, 4);
  // Behind the last good block, not in a tail on the way there.
  const TimePiece& last = trace.times.back();
  const PathState end = state_at(last, last.duration);
  const ClBlock& good = blocks[trace.last.reject.sequence - 1];
  EXPECT_LE(end.ds, 1e-6);
  EXPECT_LE((pose_at(trace.paths.back(), end.s).tip - to_vector(good.tip_mm)).norm(),
            model.tolerances.tip_mm);
}

/// 60 mm while the axis passes the pole at 0.1 deg and turns by 170 deg about it: C is what takes
/// the time, and a path from rest to rest takes twice as long.
/// A slide turns round between the places that a cell knows: 1e-7 mm beyond its travel is seen.
/// On the spline by 1e-7 between two samples, and on the lines by far more.
TEST(SmoothPlanner, LetsNoJointTurnRoundBeyondItsTravel) {
  for (const double phase : {0.0, 1.0, 2.0, 3.0}) {
    std::vector<ClBlock> blocks;
    for (int n = 0; n <= 60; ++n) {
      ClBlock block;
      block.sequence = blocks.size();
      block.tip_mm = {n - 30.0, 20, 30 + 4 * std::sin((n + 0.1 * phase) / 20)};
      block.axis = {std::sin(0.35), 0, std::cos(0.35)};
      block.feed = 50;
      block.feed_meaning = FeedMeaning::kTip;
      blocks.push_back(block);
    }
    end_program(blocks);
    MachineModel model = bench_machine();
    const JointVector start = joints_of(model, blocks[0]);
    const SmoothTrace whole = plan_smooth(model, blocks, start);
    ASSERT_EQ(whole.last.status, PlanStatus::kOk);
    const auto setpoints = sample(model, whole, 250e-6, 0.37, start);
    int turning = -1;
    for (int i = 0; i < 3; ++i) {
      double low = setpoints.front().q[i], high = low;
      for (const auto& setpoint : setpoints) {
        low = std::min(low, setpoint.q[i]);
        high = std::max(high, setpoint.q[i]);
      }
      const double first = setpoints.front().q[i], last = setpoints.back().q[i];
      JointLimits& limits = model.joints[i].limits;
      if (high > std::max(first, last) + 0.1)
        limits.travel_max = high - 1e-7;
      else if (low < std::min(first, last) - 0.1)
        limits.travel_min = low + 1e-7;
      else
        continue;
      turning = i;
      break;
    }
    ASSERT_GE(turning, 0);
    const SmoothTrace kept = plan_smooth(model, blocks, start);
    EXPECT_EQ(kept.last.status, PlanStatus::kOk) << "from rest to rest, phase " << phase;
    for (const PlanSample& setpoint : sample(model, kept, 250e-6, 0.37, start)) {
      ASSERT_LT(first_joint_outside_travel(model, setpoint.q, 1e-9), 0);
    }
    JointLimits& limits = model.joints[turning].limits;
    limits.travel_max -= 0.01;
    limits.travel_min += 0.01;
    const SmoothTrace cut = plan_smooth(model, blocks, start);
    EXPECT_EQ(cut.last.status, PlanStatus::kRefused) << "phase " << phase;
    EXPECT_EQ(cut.last.reject.joint, turning);
  }
}

TEST(SmoothPlanner, PassesBesideThePoleInNearlyTheLeastTime) {
  const MachineModel model = bench_machine();
  std::vector<ClBlock> blocks;
  for (int n = 0; n <= 60; ++n) {
    const double s = n / 30.0 - 1;
    const double tilt = units::rad_from_deg(std::hypot(0.1, std::sqrt(15 * 15 - 0.01) * s));
    const double turn = units::rad_from_deg(90 - 85 * std::atan(150 * s) / std::atan(150));
    ClBlock block;
    block.sequence = static_cast<std::uint64_t>(n);
    block.tip_mm = {30 * s, 20, 30};
    block.axis = {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)};
    block.feed = 50;
    block.feed_meaning = FeedMeaning::kTip;
    blocks.push_back(block);
  }
  blocks.emplace_back().kind = BlockKind::kEnd;
  blocks.back().sequence = 61;
  const JointVector start = joints_of(model, blocks[0]);
  const auto trace = plan_smooth(model, blocks, start);
  Peaks peaks;
  check(model, trace, blocks, start, peaks);
  print("beside the pole", peaks);
  EXPECT_LE(trace.duration_s(), 4.15);
}

}  // namespace
}  // namespace meridian::test::smooth_planner
