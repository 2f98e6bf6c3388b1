// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "property/cycle/stepped_program.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/draws.hpp"

/// Single block where the plan is made for more than the programmed feed, where it rests in
/// mid-block by itself, and where something stops the machine that brakes for a block's end.
namespace meridian::test::single_block {
namespace {

TEST(SingleBlock, RestsAtTheSamePlacesWhereTheFeedIsPlannedForMoreThan100Percent) {
  for (std::uint32_t seed = 51; seed < 51 + test::draws(2); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Job job(seed);
    Rests rests, raised;
    Stepped plain(job);
    ASSERT_TRUE(plain.is_started());
    ASSERT_EQ(step_through(plain, rests), every_block(job));
    job.machine.max_feed_override = 1.5;
    Stepped run(job);
    ASSERT_TRUE(run.is_started());
    run.command(Verb::kFeedOverride, 1.5);
    EXPECT_EQ(step_through(run, raised), every_block(job));
    for (const auto& [block, joints] : rests) expect_same_position(joints, raised[block], block);
    LimitShares worst;
    test::expect_within_limits(run.world, 0, false, worst);
    double max = 0;
    for (FeedMark mark; run.planner().take_feed_mark(mark);) max = std::max(max, mark.factor);
    EXPECT_EQ(max, 1.5);
  }
}

/// Round a dome by more than C's travel, onto the pole, and off it in another direction.
struct Dome {
  Dome() : machine(limited(lai_machine(), -200, 200)) {
    machine.transition = Transition::kSmooth;
    constexpr int kRound = 24, kOff = 3;
    const auto add = [this](double tilt, double azimuth) {
      const double at = 0.05 * static_cast<double>(blocks.size());
      blocks.push_back(
          leaning(tilt, azimuth, {20 * std::cos(azimuth), 20 * std::sin(azimuth), 20 - at}));
      blocks.back().sequence = blocks.size() - 1;
      blocks.back().line = static_cast<std::uint32_t>(blocks.size());
    };
    const double step = units::rad_from_deg(20);
    for (int n = 0; n < kRound; ++n) add(0.3, n * step);
    add(0, kRound * step);
    add(0, kRound * step);
    blocks.back().kind = BlockKind::kDwell;  // on the pole: C turns there behind it
    blocks.back().value = 0.05;
    for (int n = 0; n < kOff; ++n) add(0.1 * (n + 1), kRound * step + 2);
    end_program(blocks);
  }
  [[nodiscard]] JointVector start() const { return test::joints_of(machine, blocks[0]); }

  MachineModel machine;
  std::vector<ClBlock> blocks;
};

TEST(SingleBlock, GoesThroughTheRestsOfARewindAndOfThePoleToTheEndOfTheBlock) {
  const Dome dome;
  Stepped run(dome);
  ASSERT_TRUE(run.is_started());
  Rests rests;
  std::vector<std::uint64_t> every;
  for (std::uint64_t n = 1; n + 1 < dome.blocks.size(); ++n) every.push_back(n);
  EXPECT_EQ(step_through(run, rests), every);
  EXPECT_TRUE(run.is_over());
  EXPECT_EQ(run.world.count(EventCode::kAlarm), 0);
  int rewound = 0, turned = 0;
  for (const CycleRecord& record : run.world.records) {
    rewound += record.motion == MotionKind::kRewind;
    turned += record.motion == MotionKind::kPoleTurn;
  }
  EXPECT_GT(rewound, 1000) << "cycles";
  EXPECT_GT(turned, 100) << "cycles";
  LimitShares worst;
  test::expect_within_limits(run.world, 0, false, worst);
  for (const auto& [block, joints] : rests) {
    if (dome.blocks[block].kind == BlockKind::kDwell) continue;  // names no place
    const ToolPose at = forward(dome.machine, dome.machine.tool_length_mm, joints);
    EXPECT_LE((at.tip - to_vector(dome.blocks[block].tip_mm)).norm(),
              dome.machine.tolerances.tip_mm * (1 + 1e-6))
        << block;
  }
}

/// What happens to a machine that brakes for a block's end.
enum class Mishap { kAbort, kDriveFault, kTooManyLost, kAll };

/// A machine that has been braking for `cycles` or more, behind some blocks; false: none did.
bool run_to_brake(Stepped& run, int blocks, int cycles) {
  for (int braked = 0; !run.is_over() && run.world.records.size() < 60'000;) {
    if (run.world.now() == State::kStepping) {
      --blocks;
      run.command(Verb::kResume);
    } else {
      run.run();
    }
    braked = run.world.state.single_block.is_braking() ? braked + 1 : 0;
    if (blocks <= 0 && braked > cycles) return true;
  }
  return false;
}

/// `mishap` comes; the machine comes to rest in Ready or Fault. Returns the record behind which.
std::size_t suffer(Stepped& run, Mishap mishap) {
  const std::size_t first = run.world.records.size();
  const std::uint64_t block = run.world.state.single_block.sequence;
  switch (mishap) {
    case Mishap::kAbort:
      run.command(Verb::kAbort);
      break;
    case Mishap::kDriveFault:
      run.world.in.feedback.fault_mask = 1;
      run.run();
      break;
    default:
      run.world.run(static_cast<std::uint32_t>(run.world.machine.bridge_cycles) + 1);
      break;
  }
  while (run.world.now() == State::kAborting) {
    EXPECT_EQ(next_end(run, block), block) << "it went past the end that was braked for";
    run.world.run();
  }
  EXPECT_TRUE(run.world.run_until(mishap == Mishap::kAbort ? State::kReady : State::kFault, 5));
  return first;
}

TEST(SingleBlock, MayBeAbortedAndMayFaultWhileItBrakesForAnEndThatAnAbortNeverPasses) {
  LimitShares worst, worst_fault;
  int tried = 0;
  RandomPrograms random(7);
  for (std::uint32_t seed = 61; seed < 61 + test::draws(18); ++seed) {
    const auto mishap = static_cast<Mishap>(seed % static_cast<std::uint32_t>(Mishap::kAll));
    SCOPED_TRACE(testing::Message() << "seed " << seed << " mishap " << static_cast<int>(mishap));
    const Job job(seed, 8);
    Stepped run(job);
    ASSERT_TRUE(run.is_started());
    if (!run_to_brake(run, 1 + static_cast<int>(seed % 4),
                      static_cast<int>(random.log_uniform(1, 300)))) {
      continue;
    }
    ++tried;
    const std::size_t first = suffer(run, mishap);
    const bool is_abort = mishap == Mishap::kAbort;
    if (mishap != Mishap::kTooManyLost) {  // that one begins where the drives are
      test::expect_within_limits(run.world, first, !is_abort, is_abort ? worst : worst_fault);
    }
    EXPECT_FALSE(run.world.state.single_block.is_braking());
    EXPECT_FALSE(run.world.state.single_block.is_resting());
    EXPECT_TRUE(run.world.state.single_block.is_on) << "the operator said nothing else";
  }
  std::printf("%d stops; abort: worst v %.6f a %.6f j %.6f; FaultStop: v %.6f a %.6f j %.6f\n",
              tried, worst.v, worst.a, worst.j, worst_fault.v, worst_fault.a, worst_fault.j);
  EXPECT_GE(tried, test::draws(12));
}

/// Periods that drives bridge, all of them lost in the very cycles of the brake.
TEST(SingleBlock, BrakesToTheSamePlaceWherePeriodsAreLostWhileItBrakes) {
  const Job job(5, 14);
  Rests rests, same;
  Stepped plain(job);
  ASSERT_TRUE(plain.is_started());
  ASSERT_EQ(step_through(plain, rests), every_block(job));
  Stepped run(job);
  ASSERT_TRUE(run.is_started());
  const auto bridged = static_cast<std::uint32_t>(job.machine.bridge_cycles);
  int lost = 0;
  for (double t = 0; t < kMaxSeconds && !run.is_over(); t += run.world.dt()) {
    if (run.world.now() == State::kStepping) {
      const CycleRecord& record = run.world.records.back();
      same[record.sequence] = record.joints;
      run.command(Verb::kResume);
    } else if (run.world.state.single_block.is_braking()) {
      run.world.run(bridged);
      ++lost;
    } else {
      run.run();
    }
  }
  EXPECT_EQ(same.size(), rests.size());
  for (const auto& [block, joints] : rests) expect_same_position(joints, same[block], block);
  EXPECT_GT(lost, 100);
}

}  // namespace
}  // namespace meridian::test::single_block
