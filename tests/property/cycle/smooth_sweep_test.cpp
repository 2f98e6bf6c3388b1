// SPDX-License-Identifier: Apache-2.0

/// Seeded programs that look for trouble, run smoothly through planner, port and cycle while an
/// operator turns the override, holds and resumes, blocks come late and drives fault: every limit,
/// the feed times the override in force and the tolerances, from every setpoint to the path and
/// from its vertices to the way of the tool, by the setpoints alone. CI runs a few; all of them:
///
///     MERIDIAN_SWEEP_PROGRAMS=2000 rt_motion_test --gtest_filter='SmoothSweep*'
///
/// MERIDIAN_SWEEP_SEED is the first seed (1).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "property/cycle/feed_in_force.hpp"
#include "property/cycle/operated_run.hpp"
#include "property/cycle/passed_vertices.hpp"
#include "property/path/hostile_path.hpp"
#include "property/planner/drawn_machine.hpp"
#include "property/planner/smooth_trace.hpp"
#include "support/draws.hpp"

namespace meridian::test::smooth_sweep {
namespace {

using SmoothRunning = PlannedRun<SmoothPlanner>;

constexpr double kLimit = 1 + 1e-6;
constexpr double kFeedLimit = 1.0001;
constexpr double kMaxSeconds = 4;  // of motion per program
constexpr int kPrograms = 24;

double rounded(double x, double to) { return std::round(x / to) * to; }

/// Rapids and dwells between the cuts.
void mix_kinds(RandomPrograms& random, std::vector<ClBlock>& blocks) {
  for (std::size_t n = 1; n + 1 < blocks.size(); ++n) {
    ClBlock& block = blocks[n];
    if (random.chance(0.05)) {
      block.kind = BlockKind::kRapid;
      block.feed_meaning = FeedMeaning::kNone;
    } else if (random.chance(0.02)) {
      const ClBlock motion = block;
      block = {};
      block.sequence = motion.sequence;
      block.line = motion.line;
      block.kind = BlockKind::kDwell;
      block.value = 0.02;
    }
  }
}

/// Corners, reversals, blocks of 0.0001 mm and less; every third program about the pole, at 0 to 5
/// deg; every fourth as a CAM system rounds it; every seventh with rapids and dwells; one feed of 1
/// to 60 000 mm/min.
std::vector<ClBlock> draw_blocks(RandomPrograms& random, std::uint32_t seed, int sections) {
  const bool is_at_pole = seed % 3 == 0, is_rounded = seed % 4 == 1;
  HostilePath path = is_at_pole ? HostilePath(seed, 0, units::rad_from_deg(5)) : HostilePath(seed);
  auto blocks = path.make_program(sections);
  const double feed = random.log_uniform(1.0 / 60, 1000);
  for (ClBlock& block : blocks) {
    block.feed = feed;
    if (!is_rounded) continue;
    for (double& x : block.tip_mm) x = rounded(x, 1e-3);
    for (double& x : block.axis) x = rounded(x, 1e-5);
    if (is_motion(block.kind)) block.axis = to_array(to_vector(block.axis).normalized());
  }
  if (seed % 7 == 0) mix_kinds(random, blocks);
  return blocks;
}

struct Sweep {
  LimitShares worst, worst_fault;
  double feed = 0, off = 0, missed = 0, seconds = 0;
  int programs = 0, refused = 0, faults = 0, bad = 0;
  std::uint64_t dry = 0;
  Operator random_operator{.min_override = 0, .turns_rapids = true, .raise_share = 0.3};
};

/// A run whose blocks come late, one now and then.
struct LateRun {
  SmoothRunning& run_;
  RandomPrograms& random;
  CycleWorld& world = run_.world;

  [[nodiscard]] bool is_over() const { return run_.is_over(); }
  const CycleRecord& run() { return random.chance(0.004) ? run_.run() : run_.run_unplanned(); }
  const CycleRecord& command(Verb verb, double argument = 0) {
    return run_.command(verb, argument);
  }
};

/// Runs with blocks that come late, as far as `max_s` of motion; every other program with an
/// operator beside.
double operate_late(SmoothRunning& run, RandomPrograms& random, Operator& by, bool is_operated,
                    double max_s) {
  run.max_blocks = 1;
  LateRun late{run, random};
  if (is_operated) return by.operate(late, random, max_s);
  double t = 0;
  for (; t < max_s && !late.is_over(); t += run.world.dt()) late.run();
  return t;
}

/// What a run makes of its path: largest tip speed of cuts over the feed times the override in
/// force, distance from the programmed path and of a vertex from the tool's way, both in
/// tolerances.
struct PathShares {
  double feed = 0, off = 0, missed = 0;
};

PathShares check_path(const MachineModel& machine, const std::vector<ClBlock>& blocks,
                      const SmoothRunning& run) {
  PathShares shares;
  const auto paths = programmed_paths(blocks);
  const auto& records = run.world.records;
  shares.feed = largest_feed(run, std::min(blocks.front().feed, machine.max_feed_mm_per_s));
  std::uint64_t before = 0;
  const double tip_mm = machine.tolerances.tip_mm;
  const double axis_rad = machine.tolerances.axis_beside_pole_rad();
  PassedVertices vertices(blocks, tip_mm, axis_rad);
  for_each_cut(machine, records, 0, 1, [&](const CycleRecord& record, const ToolPose& pose) {
    if (record.motion == MotionKind::kRewind) return;  // off the part
    vertices.add(record.sequence, pose, record.setpoint.cycle == before + 1);
    before = record.setpoint.cycle;
    const double off = distance_from(paths, record.sequence, pose, tip_mm, axis_rad, shares.off);
    shares.off = std::max(shares.off, off);
  });
  // Of a program that was refused on the way what lies behind is not missed.
  shares.missed = vertices.worst(run.world.now() == State::kReady);
  return shares;
}

/// Of a program whose blocks come late one part of `parts` is there before the start.
void run_program(MachineModel machine, std::uint32_t seed, Sweep& sweep, std::size_t parts = 3) {
  RandomPrograms random(seed);
  machine.transition = Transition::kSmooth;
  machine.starve_auto_resume_s = 100;
  if (seed % 5 == 0) machine.max_feed_override = 1.5;
  const bool comes_late = random.chance(0.3);
  const auto blocks = draw_blocks(random, seed, comes_late ? 16 : 4);
  SmoothRunning run(machine, blocks, joints_of(machine, blocks[0]),
                    comes_late ? blocks.size() / parts : blocks.size());
  ++sweep.programs;
  if (!run.is_started()) {
    ++sweep.refused;
    return;
  }
  sweep.seconds +=
      comes_late ? operate_late(run, random, sweep.random_operator, seed % 2 == 1, 2 * kMaxSeconds)
                 : sweep.random_operator.operate(run, random, kMaxSeconds);
  if (run.world.now() == State::kHeld) run.command(Verb::kResume);
  LimitShares shares = shares_of_limits(run.world, 0, false);
  const PathShares path = check_path(machine, blocks, run);
  sweep.feed = std::max(sweep.feed, path.feed);
  sweep.off = std::max(sweep.off, path.off);
  sweep.missed = std::max(sweep.missed, path.missed);
  sweep.worst.take(shares);
  sweep.dry += run.world.state.starvations;
  bool is_bad = std::max({shares.v, shares.a, shares.j}) > kLimit || path.feed > kFeedLimit ||
                path.off > kLimit || path.missed > kLimit ||
                run.world.count(EventCode::kAlarm) != 0;
  const std::size_t first = run.world.records.size();
  if (run_into_fault(run, random.uniform(0, 0.5)) && run.world.run_until(State::kFault, 10)) {
    const LimitShares by_fault = shares_of_limits(run.world, first, true);
    sweep.worst_fault.take(by_fault);
    is_bad = is_bad || std::max({by_fault.v, by_fault.a, by_fault.j}) > kLimit;
    ++sweep.faults;
  }
  if (!is_bad) return;
  ++sweep.bad;
  ADD_FAILURE() << "seed " << seed << ": v " << shares.v << " a " << shares.a << " j " << shares.j
                << " feed " << path.feed << " tolerances " << path.off << ", vertices missed by "
                << path.missed << ", FaultStops so far v " << sweep.worst_fault.v << " a "
                << sweep.worst_fault.a << " j " << sweep.worst_fault.j << ", alarms "
                << run.world.count(EventCode::kAlarm) << ", the last of code "
                << run.world.last(EventCode::kAlarm).a;
}

void run_program(std::uint32_t seed, Sweep& sweep, std::size_t parts = 3) {
  run_program(seed % 2 == 0 ? bench_machine() : lai_machine(), seed, sweep, parts);
}

/// Programs that rest exactly on the pole where the run before came from its side.
TEST(SmoothSweep, GoesOnFromARestOnThePoleWithoutAStepOfC) {
  Sweep sweep;
  for (const std::uint32_t seed : {573U, 1551U}) run_program(seed, sweep, 1);
  EXPECT_EQ(sweep.refused, 0);
}

/// Programs whose redundant joint turns by more than half a turn between the reach of a zone and
/// its begin.
TEST(SmoothSweep, KnowsTheWindingWhereAZoneBegins) {
  Sweep sweep;
  for (const std::uint32_t seed : {507U, 996U}) run_program(seed, sweep, 1);
  EXPECT_EQ(sweep.refused, 0);
}

/// A program with a corner of the axis between two of the places along a zone.
TEST(SmoothSweep, EasesNoCornerOutOfTheTolerance) {
  Sweep sweep;
  run_program(1434, sweep);
  EXPECT_EQ(sweep.refused, 0);
}

void print(const Sweep& sweep) {
  std::printf(
      "%d programs (%d refused), %.0f s, %d holds, %llu times dry, %d FaultStops: v %.6f a %.6f j "
      "%.6f feed %.6f of the limits, %.4f tolerances, vertices %.4f; FaultStops v %.4f a %.4f j "
      "%.4f; %d bad\n",
      sweep.programs, sweep.refused, sweep.seconds, sweep.random_operator.holds,
      static_cast<unsigned long long>(sweep.dry), sweep.faults, sweep.worst.v, sweep.worst.a,
      sweep.worst.j, sweep.feed, sweep.off, sweep.missed, sweep.worst_fault.v, sweep.worst_fault.a,
      sweep.worst_fault.j, sweep.bad);
}

struct Seeds {
  std::uint32_t first = number_of("MERIDIAN_SWEEP_SEED", 1);
  std::uint32_t programs =
      number_of("MERIDIAN_SWEEP_PROGRAMS", static_cast<std::uint32_t>(draws(kPrograms)));
};

TEST(SmoothSweep, KeepsEveryLimitFeedAndToleranceUnderAnyOperation) {
  const Seeds seeds;
  Sweep sweep;
  for (std::uint32_t n = 0; n < seeds.programs; ++n) run_program(seeds.first + n, sweep);
  print(sweep);
  EXPECT_LT(sweep.refused, sweep.programs / 4 + 1);
  EXPECT_GT(sweep.seconds, sweep.programs);
}

/// Programs that leave the travel of a drawn machine do not start.
TEST(SmoothSweep, KeepsThemOnMachinesThatNobodyShippedToo) {
  const Seeds seeds;
  Sweep sweep;
  for (std::uint32_t n = 0; n < seeds.programs; ++n) {
    const std::uint32_t seed = seeds.first + n;
    if (const auto machine = drawn_machine(seed)) run_program(*machine, seed, sweep);
  }
  print(sweep);
  EXPECT_LT(sweep.refused, sweep.programs);
}

}  // namespace
}  // namespace meridian::test::smooth_sweep
