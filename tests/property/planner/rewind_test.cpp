// SPDX-License-Identifier: Apache-2.0

/// Programs that turn C farther than its travel: what comes out of the port stays inside travel and
/// limits, rewinds off the part alone, and cuts everything that is programmed.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include "property/planner/checked_rewinds.hpp"
#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/draws.hpp"
#include "support/family_machines.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::rewinds {
namespace {

std::vector<MachineModel> machines() {
  return {limited(lai_machine(), -720, 720), limited(trunnion_machine(), -200, 340),
          limited(fork_machine(), -360, 360)};
}

struct Spiral {
  double turns = 0;          ///< in all
  double step_deg = 25;      ///< largest turn about z per block
  bool turns_back = false;   ///< now and then
  bool passes_pole = false;  ///< the axis swings to the other side, through the pole or nearly
};

/// Round a dome: the axis leans outwards and turns about z.
std::vector<ClBlock> spiral(std::uint32_t seed, const Spiral& how) {
  std::mt19937 engine(seed);
  const auto uniform = [&engine](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  std::vector<ClBlock> blocks;
  double azimuth = uniform(-3, 3), sign = uniform(0, 1) < 0.5 ? -1 : 1, turned = 0;
  double tilt = units::rad_from_deg(uniform(4, 35)), radius = uniform(5, 40);
  while (turned < how.turns * kTurn_rad) {
    ClBlock block;
    block.sequence = blocks.size();
    block.line = 10 * static_cast<std::uint32_t>(blocks.size()) + 7;
    block.tip_mm = {radius * std::cos(azimuth), radius * std::sin(azimuth), 20 - 0.2 * turned};
    block.axis = {std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth),
                  std::cos(tilt)};
    block.feed = uniform(20, 200);
    block.feed_meaning = FeedMeaning::kTip;
    blocks.push_back(block);
    const double step = units::rad_from_deg(uniform(0.2, 1) * how.step_deg);
    if (how.turns_back && uniform(0, 1) < 0.01) sign = -sign;
    azimuth += sign * step;
    turned += step;
    const double smallest = how.passes_pole ? -0.35 : units::rad_from_deg(3);
    tilt = how.passes_pole ? 0.3 * std::cos(0.4 * turned + seed) : tilt + uniform(-0.3, 0.3) * step;
    tilt = std::clamp(tilt, smallest, units::rad_from_deg(40));
  }
  end_program(blocks);
  return blocks;
}

constexpr std::uint32_t kPrograms = 1;  // longer runs: MERIDIAN_REWIND_PROGRAMS
/// Beside the pole few programs are left that need a rewind.
constexpr std::uint32_t kProgramsAtThePole = kIsTimed ? 3 : 1;

void run_spirals(Transition transition, Spiral how) {
  const auto programs =
      number_of("MERIDIAN_REWIND_PROGRAMS", how.passes_pole ? kProgramsAtThePole : kPrograms);
  const auto first = number_of("MERIDIAN_REWIND_SEED", 1U);
  std::uint32_t last = first + programs;
  int rewinds = 0;
  auto all = machines();
  if (!kIsTimed) all.resize(1);  // the slow build sees the same code
  for (const MachineModel& model : all) {
    const JointLimits& limits = model.joints[redundant_joint(model)].limits;
    how.turns = (limits.travel_max - limits.travel_min) / kTurn_rad + 1.4;
    Found found;
    for (std::uint32_t seed = last - programs; seed < last; ++seed) {
      SCOPED_TRACE(testing::Message() << model.name << " seed " << seed);
      how.turns_back = seed % 3 == 0;
      const auto blocks = spiral(seed, how);
      const JointVector start = joints_of(model, blocks[0]);
      const SmoothSettings settings{transition, 0, 0};
      check(model, plan_smooth(model, blocks, start, settings, true), blocks, start, found);
      if (testing::Test::HasFatalFailure()) return;
    }
    std::printf("%s: %d rewinds, v %.4f a %.4f j %.4f of the limits, %.3f tolerances\n",
                model.name.c_str(), found.rewinds, found.v, found.a, found.j, found.off);
    rewinds += found.rewinds;
    last += programs;  // every machine its own
  }
  if (kIsTimed) {  // else so few are drawn that the look past the pole may spare them all
    EXPECT_GT(rewinds, 1);
  }
}

TEST(Rewind, KeepsTravelAndLimitsOnSpiralsFromRestToRest) {
  run_spirals(Transition::kExactStop, {0, 25, false, false});
}

TEST(Rewind, KeepsTravelAndLimitsOnSmoothSpirals) {
  run_spirals(Transition::kSmooth, {0, 6, false, false});
}

TEST(Rewind, KeepsTravelAndLimitsWherePathsPassThePole) {
  run_spirals(Transition::kSmooth, {0, 6, false, true});
}

TEST(Rewind, IsTheSameHoweverTheBlocksArriveAndThePortIsRead) {
  const MachineModel model = limited(lai_machine(), -200, 340);
  for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
    const auto blocks =
        spiral(3, {2.2, transition == Transition::kSmooth ? 6.0 : 25.0, true, false});
    const JointVector start = joints_of(model, blocks[0]);
    const SmoothSettings settings{transition, 0, 0};
    const SmoothTrace once = plan_smooth(model, blocks, start, settings, true);
    ASSERT_EQ(once.last.status, PlanStatus::kOk);
    EXPECT_FALSE(once.rewinds.empty());
    for (const std::size_t every : {7U, 100000U}) {
      const SmoothTrace again = plan_smooth(
          model, blocks, start, settings, [every](std::size_t n) { return n % every == 0; },
          [](std::size_t) { return false; }, true);
      EXPECT_TRUE(are_same(once, again)) << "read every " << every << " blocks";
    }
  }
}

TEST(Rewind, IsRefusedWhereNoWindingCarriesTheBlock) {
  const MachineModel model =
      limited(lai_machine(), -80, 80);  // no other winding or branch inside travel
  for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
    const auto blocks =
        spiral(5, {3, transition == Transition::kSmooth ? 6.0 : 25.0, false, false});
    const JointVector start = joints_of(model, blocks[0]);
    const SmoothTrace trace = plan_smooth(model, blocks, start, {transition, 0, 0}, true);
    EXPECT_EQ(trace.last.status, PlanStatus::kRefused);
    EXPECT_EQ(trace.last.reject.code, RejectCode::kTravelBetween);
    EXPECT_EQ(trace.last.reject.joint, redundant_joint(model));
    EXPECT_TRUE(trace.rewinds.empty());
  }
}

TEST(Rewind, IsNotMadeWhereTheMachineFileDoesNotSayHow) {
  MachineModel model = limited(lai_machine(), -720, 720);
  model.rewind_policy = RewindPolicy::kRefuse;
  const auto blocks = spiral(1, {7, 25, false, false});
  const JointVector start = joints_of(model, blocks[0]);
  const SmoothTrace trace = plan_smooth(model, blocks, start, {Transition::kExactStop, 0, 0}, true);
  EXPECT_EQ(trace.last.status, PlanStatus::kRefused);
  EXPECT_EQ(trace.last.reject.code, RejectCode::kTravelBetween);
  EXPECT_EQ(trace.last.reject.joint, redundant_joint(model));
}

TEST(Rewind, IsRefusedWhereTheToolCannotLeaveThePartSoFar) {
  MachineModel model = limited(fork_machine(), -360, 360);
  model.rewind_retract_mm = 1e4;  // farther than any slide goes
  const auto blocks = spiral(1, {7, 25, false, false});
  const JointVector start = joints_of(model, blocks[0]);
  const SmoothTrace trace = plan_smooth(model, blocks, start, {Transition::kExactStop, 0, 0}, true);
  EXPECT_EQ(trace.last.status, PlanStatus::kRefused);
  EXPECT_EQ(trace.last.reject.code, RejectCode::kTravelBetween);
  for (const PathPiece& path : trace.paths) EXPECT_NE(path.motion, MotionKind::kRewind);
}

}  // namespace
}  // namespace meridian::test::rewinds
