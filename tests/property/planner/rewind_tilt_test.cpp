// SPDX-License-Identifier: Apache-2.0

/// Rewinds where the tilt leaves its travel, alone or with C: the other branch carries on.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "property/planner/block_stream.hpp"
#include "property/planner/checked_rewinds.hpp"
#include "property/planner/random_programs.hpp"
#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::rewinds {
namespace {

struct TiltCase {
  MachineModel model;
  std::vector<ClBlock> blocks;
  JointVector start{};
  int tilt = 0;
};

/// C has `room_deg` left where the program begins, in the sense that it goes, of `range_deg` in
/// all. The tilt has 0.4 rad on the side that it begins on, and 1 rad on the other.
TiltCase short_of_tilt(MachineModel model, double room_deg, double range_deg,
                       std::vector<Lean> corners, double step_deg) {
  const int free = redundant_joint(model);
  TiltCase out{model, {}, {}, free == 3 ? 4 : 3};
  out.start = solve_block(model, lean_along({corners[0]}, step_deg)[0], 0);
  turn_upwards(model, out.start, corners);
  out.blocks = lean_along(corners, step_deg);
  JointLimits& c = out.model.joints[free].limits;
  c.travel_max = out.start[free] + units::rad_from_deg(room_deg);
  c.travel_min = c.travel_max - units::rad_from_deg(range_deg);
  JointLimits& tilt = out.model.joints[out.tilt].limits;
  const bool is_up = out.start[out.tilt] > 0;
  tilt.travel_max = is_up ? 0.4 : 1;
  tilt.travel_min = is_up ? -1 : -0.4;
  return out;
}

constexpr Transition kModes[] = {Transition::kExactStop, Transition::kSmooth};
/// The other branch has no C for the first 60° of the way, and the tilt is short behind 90°.
TiltCase tilt_runs_out(const MachineModel& machine, Transition transition) {
  return short_of_tilt(machine, 150, 290, {{0, 0.3}, {70, 0.3}, {110, 0.7}, {130, 0.7}},
                       step_of(transition));
}

TEST(RewindTilt, LeadsToTheOtherBranchWhereTheTiltLeavesItsTravel) {
  for (const MachineModel& machine : machines_with_two_solutions()) {
    for (const Transition transition : kModes) {
      SCOPED_TRACE(testing::Message() << machine.name << " " << static_cast<int>(transition));
      const TiltCase one = tilt_runs_out(machine, transition);
      Found found;
      const auto trace = plan_smooth(one.model, one.blocks, one.start, {transition, 0, 0});
      check(one.model, trace, one.blocks, one.start, found);
      if (HasFatalFailure()) return;
      ASSERT_EQ(trace.rewinds.size(), 1U);
      EXPECT_TRUE(trace.rewinds[0].is_other_branch());
      EXPECT_EQ(trace.rewinds[0].joint, one.tilt);
      EXPECT_NEAR(std::abs(trace.joints[one.tilt]), 0.7, 1e-3);
    }
  }
}

TEST(RewindTilt, IsRefusedAsBeforeWhereTheFileAllowsNoRewind) {
  for (const Transition transition : kModes) {
    TiltCase one = tilt_runs_out(limited(fork_machine(), -720, 720), transition);
    one.model.rewind_policy = RewindPolicy::kRefuse;
    const auto trace = plan_smooth(one.model, one.blocks, one.start, {transition, 0, 0});
    EXPECT_EQ(trace.last.status, PlanStatus::kRefused);
    EXPECT_EQ(trace.last.reject.joint, one.tilt);
  }
}

TEST(RewindTilt, IsRefusedByNameWhereTheOtherBranchHasNoTravelEither) {
  for (const Transition transition : kModes) {
    TiltCase one = tilt_runs_out(limited(fork_machine(), -720, 720), transition);
    JointLimits& tilt = one.model.joints[one.tilt].limits;
    tilt.travel_max = std::min(tilt.travel_max, 0.4);
    tilt.travel_min = std::max(tilt.travel_min, -0.4);
    const auto trace = plan_smooth(one.model, one.blocks, one.start, {transition, 0, 0});
    EXPECT_EQ(trace.last.status, PlanStatus::kRefused);
    EXPECT_EQ(trace.last.reject.joint, one.tilt);
  }
}

TEST(RewindTilt, GoesToTheOtherBranchAndTurnsCBackWhereBothRunOut) {
  for (const MachineModel& machine : machines_with_two_solutions()) {
    for (const Transition transition : kModes) {
      SCOPED_TRACE(testing::Message() << machine.name << " " << static_cast<int>(transition));
      // C runs out first; where it goes then has to carry the tilt, and runs out of C again.
      const TiltCase one = short_of_tilt(
          machine, 150, 400, {{0, 0.3}, {200, 0.3}, {240, 0.7}, {560, 0.7}}, step_of(transition));
      Found found;
      const auto trace = plan_smooth(one.model, one.blocks, one.start, {transition, 0, 0});
      check(one.model, trace, one.blocks, one.start, found);
      if (HasFatalFailure()) return;
      ASSERT_GE(trace.rewinds.size(), 2U);
      EXPECT_TRUE(std::any_of(trace.rewinds.begin(), trace.rewinds.end(),
                              [](const Rewind& made) { return made.is_other_branch(); }));
      EXPECT_NEAR(std::abs(trace.joints[one.tilt]), 0.7, 1e-3);
    }
  }
}

TEST(RewindTilt, GoesOnWhereAnEndlessCBeganOnTheBranchWhoseTiltIsShortBehindTheLookAhead) {
  for (const Transition transition : kModes) {
    SCOPED_TRACE(static_cast<int>(transition));
    // 2600 blocks of 0.15° fit both branches: the nearer one is taken. Behind them the tilt grows.
    TiltCase one = short_of_tilt(limited(trunnion_machine(), -720, 720), 150, 290,
                                 {{0, 0.3}, {390, 0.3}, {396, 0.7}}, 0.15);
    one.model.joints[redundant_joint(one.model)].is_endless = true;
    const auto trace = plan_smooth(one.model, one.blocks, one.start, {transition, 0, 0});
    ASSERT_EQ(trace.last.status, PlanStatus::kOk);
    ASSERT_EQ(trace.rewinds.size(), 1U);
    EXPECT_TRUE(trace.rewinds[0].is_other_branch());
    EXPECT_GT(trace.rewinds[0].sequence, 2500U);
    EXPECT_NEAR(std::abs(trace.joints[one.tilt]), 0.7, 1e-3);
  }
}

/// Whether one branch and winding keeps all joints inside travel, not just so, over the block at
/// `n` and over as many as `beside` before it and behind.
bool is_kept_by_one(const TiltCase& one, std::size_t n, std::size_t beside) {
  constexpr int kSteps = 100, kTurns = 3;
  constexpr double kRoom = 2e-3;
  const auto pose_of = [&](std::size_t k) {
    return ToolPose{to_vector(one.blocks[k].tip_mm), to_vector(one.blocks[k].axis)};
  };
  const std::size_t first = std::max<std::size_t>(n - beside, 1);
  const std::size_t last = std::min(n + beside, one.blocks.size() - 2);
  for (const int branch : {0, 1}) {
    for (int turns = -kTurns; turns <= kTurns; ++turns) {
      JointVector q{};
      bool is_inside = true;
      for (std::size_t k = first; k <= last; ++k) {
        const PathPiece path = make_line(pose_of(k - 1), pose_of(k));
        for (int step = 0; step <= kSteps && is_inside; ++step) {
          const ToolPose pose = pose_at(path, path.length * step / kSteps);
          q = solve(one.model, one.model.tool_length_mm, pose, branch, q).q;
          JointVector wound = q;
          wound[redundant_joint(one.model)] += turns * kTurn_rad;
          is_inside = first_joint_outside_travel(one.model, wound, -kRoom) < 0;
        }
      }
      if (is_inside) return true;
    }
  }
  return false;
}

/// A program that turns and leans at random, on a machine that it may leave.
TiltCase draw_case(const MachineModel& machine, Transition transition, std::uint32_t seed) {
  RandomPrograms draw(seed);
  std::vector<Lean> corners{{0, draw.uniform(0.15, 0.35)}};
  for (int n = 0; n < 5; ++n) {
    corners.push_back(
        {corners.back().azimuth_deg + draw.uniform(-150, 250), draw.uniform(0.15, 0.9)});
  }
  return short_of_tilt(machine, draw.uniform(20, 300), draw.uniform(320, 700), corners,
                       step_of(transition));
}

TEST(RewindTilt, KeepsLimitsTravelAndPathOfDrawnProgramsThatRun) {
  const std::uint32_t first = number_of("MERIDIAN_TILT_SEED", 1);
  const std::uint32_t programs =
      number_of("MERIDIAN_TILT_PROGRAMS", static_cast<std::uint32_t>(draws(8)));
  int run = 0, of_tilt = 0, refused = 0;
  Found found;
  for (std::uint32_t seed = first; seed < first + programs; ++seed) {
    for (const MachineModel& machine : machines_with_two_solutions()) {
      for (const Transition transition : kModes) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << " " << machine.name << " "
                                        << static_cast<int>(transition));
        const TiltCase one = draw_case(machine, transition, seed);
        const auto trace = plan_smooth(one.model, one.blocks, one.start, {transition, 0, 0});
        if (trace.last.status != PlanStatus::kOk) {
          ++refused;
          const BlockReject& reject = trace.last.reject;
          const std::size_t at = reject.sequence - one.blocks[0].sequence;
          // A span of the spline lies on several blocks.
          EXPECT_FALSE(is_kept_by_one(one, at, transition == Transition::kSmooth ? 1 : 0))
              << "joint " << reject.joint << " at " << reject.value << ", block " << reject.sequence
              << " of " << one.blocks.size();
          continue;
        }
        check(one.model, trace, one.blocks, one.start, found);
        if (HasFatalFailure()) return;
        ++run;
        for (const Rewind& rewind : trace.rewinds) of_tilt += rewind.joint == one.tilt;
      }
    }
  }
  EXPECT_GT(of_tilt, 0);
  EXPECT_GT(run, 2 * refused);
  std::printf(
      "%d run, %d refused, %d rewinds, %d of them for the tilt; v %.4f a %.4f j %.4f, "
      "off %.3f\n",
      run, refused, found.rewinds, of_tilt, found.v, found.a, found.j, found.off);
}

}  // namespace
}  // namespace meridian::test::rewinds
