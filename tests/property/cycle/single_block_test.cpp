// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "property/cycle/stepped_program.hpp"
#include "support/draws.hpp"

/// Single block on smooth plans: the machine rests exactly at the ends of blocks, in order,
/// whatever the operator does meanwhile, and leaves none out once it has rested.
namespace meridian::test::single_block {
namespace {

/// Sequences of the events with that code, in order.
std::vector<std::uint64_t> sequences_of(const CycleWorld& world, EventCode code) {
  std::vector<std::uint64_t> out;
  for (const Event& event : world.events) {
    if (event.code == code) out.push_back(event.a);
  }
  return out;
}

TEST(SingleBlock, RestsBehindEveryBlockInOrderWithinTolerance) {
  LimitShares worst;
  double worst_off = 0;
  int rests_made = 0;
  for (std::uint32_t seed = 1; seed <= test::draws(4); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Job job(seed);
    Stepped run(job);
    ASSERT_TRUE(run.is_started());
    Rests rests;
    EXPECT_EQ(step_through(run, rests), every_block(job));
    EXPECT_TRUE(run.is_over());
    EXPECT_EQ(run.world.count(EventCode::kAlarm), 0);
    EXPECT_EQ(run.world.state.starvations, 0u);
    EXPECT_EQ(sequences_of(run.world, EventCode::kBlockStarted), every_block(job));
    EXPECT_EQ(sequences_of(run.world, EventCode::kBlockDone), every_block(job));
    test::expect_within_limits(run.world, 0, false, worst);
    for (const auto& [sequence, joints] : rests) {
      const ToolPose at = forward(job.machine, job.machine.tool_length_mm, joints);
      const double off = (at.tip - to_vector(job.blocks[sequence].tip_mm)).norm();
      worst_off = std::max(worst_off, off / job.machine.tolerances.tip_mm);
      ++rests_made;
    }
  }
  std::printf("%d rests; worst v %.6f a %.6f j %.6f; %.3f tip tolerances off\n", rests_made,
              worst.v, worst.a, worst.j, worst_off);
  EXPECT_LE(worst_off, 1 + 1e-6);
}

TEST(SingleBlock, SaidAgainKeepsTheBrakeThatIsOn) {
  const Job job(3);
  Stepped once(job);
  Stepped often(job);
  ASSERT_TRUE(once.is_started() && often.is_started());
  Rests rests, same;
  EXPECT_EQ(step_through(once, rests), step_through(often, same, 3));
  for (const auto& [block, joints] : rests) expect_same_position(joints, same[block], block);
}

/// The rate goes up and comes down once between two rests.
TEST(SingleBlock, NeverChattersOnTheWayToARest) {
  const Job job(2);
  Stepped run(job);
  ASSERT_TRUE(run.is_started());
  Rests rests;
  (void)step_through(run, rests);
  int rises = 0;
  bool is_falling = false;
  double before = 0;
  for (const CycleRecord& record : run.world.records) {
    if (record.rate == 0) is_falling = false;
    rises += is_falling && record.rate > before;
    is_falling = record.rate > 0 && (is_falling || record.rate < before);
    before = record.rate;
  }
  EXPECT_EQ(rises, 0);
}

TEST(SingleBlock, LeavesNoEndOutBehindAHold) {
  int holds_tried = 0, holds_while_braking = 0;
  for (std::uint32_t seed = 1; seed <= test::draws(4); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Job job(seed);
    RandomPrograms random(seed);
    Stepped run(job);
    ASSERT_TRUE(run.is_started());
    double hold_s = random.log_uniform(0.01, 1);
    std::optional<std::uint64_t> expected, braked;
    std::uint64_t after = 1;
    for (double t = 0, run_s = 0; t < kMaxSeconds && !run.is_over(); t += run.world.dt()) {
      const State state = run.world.now();
      if (state == State::kStepping) {
        const std::uint64_t block = run.world.records.back().sequence;
        EXPECT_EQ(block, expected.value_or(block));
        after = block + 1;
      }
      if (state == State::kStepping || state == State::kHeld) {
        expected = next_end(run, after);
        if (state == State::kHeld && braked) {
          EXPECT_EQ(*braked, expected.value_or(0)) << "the hold passed it";
          ++holds_while_braking;
        }
        braked = std::nullopt;
        run.command(Verb::kResume);
        hold_s = random.log_uniform(0.01, 1);
        run_s = 0;
      } else if (state == State::kRunning && run_s >= hold_s) {
        const SingleBlock& single = run.world.state.single_block;
        if (single.is_braking()) braked = single.sequence;
        run.command(Verb::kHold);
        ++holds_tried;
        run_s = -1e9;
      } else {
        run.run();
        run_s += run.world.dt();
      }
    }
    EXPECT_TRUE(run.is_over());
  }
  EXPECT_GT(holds_tried, test::draws(40));
  EXPECT_GT(holds_while_braking, test::draws(20));
}

/// On and off, holds and overrides at any instant: where it rests it rests at the same positions as
/// ever, and after every rest at the very next end, as long as it is on.
TEST(SingleBlock, RestsExactlyAtEndsWhateverTheOperatorDoes) {
  LimitShares worst;
  int rests_made = 0, ons = 0;
  for (std::uint32_t seed = 11; seed < 11 + test::draws(6); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Job job(seed);
    Rests rests;
    Stepped plain(job);
    ASSERT_TRUE(plain.is_started());
    ASSERT_EQ(step_through(plain, rests), every_block(job));
    RandomPrograms random(seed);
    Stepped run(job);
    ASSERT_TRUE(run.is_started());
    bool is_on = true, was_rested_on = true;
    std::uint64_t after = 1;
    std::optional<std::uint64_t> expected;
    double next = 0;
    for (double t = 0; t < kMaxSeconds && !run.is_over(); t += run.world.dt()) {
      const State state = run.world.now();
      const CycleRecord& record = run.world.records.back();
      if (state == State::kStepping) {
        ASSERT_TRUE(rests.contains(record.sequence)) << record.sequence;
        expect_same_position(record.joints, rests[record.sequence], record.sequence);
        EXPECT_EQ(record.sequence, was_rested_on && expected ? *expected : record.sequence);
        EXPECT_GE(record.sequence, after);
        after = record.sequence + 1;
        ++rests_made;
      }
      if (state == State::kStepping || state == State::kHeld) {
        was_rested_on = is_on;
        expected = next_end(run, after);
        run.command(Verb::kResume);
      } else if (t < next) {
        run.run();
      } else {
        next = t + random.log_uniform(0.002, 0.5);
        const double what = random.uniform(0, 1);
        if (what < 0.4) {
          is_on = random.chance(0.7);
          was_rested_on = was_rested_on && is_on;
          ons += is_on;
          run.command(Verb::kSingleBlock, is_on ? 1 : 0);
        } else if (what < 0.6) {
          run.command(Verb::kHold);
        } else {
          run.command(Verb::kFeedOverride, random.uniform(0.2, 1));
        }
      }
    }
    EXPECT_TRUE(run.is_over());
    EXPECT_EQ(run.world.count(EventCode::kAlarm), 0);
    test::expect_within_limits(run.world, 0, false, worst);
  }
  std::printf("%d rests, %d times on; worst v %.6f a %.6f j %.6f\n", rests_made, ons, worst.v,
              worst.a, worst.j);
  EXPECT_GT(rests_made, test::draws(60));
}

/// Blocks that come one by one, some of them seconds long: ends come into sight late.
TEST(SingleBlock, LeavesNoEndOutWhereBlocksComeTooLate) {
  std::uint64_t dry = 0;
  LimitShares worst;
  for (std::uint32_t seed = 31; seed < 31 + test::draws(6); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Job job(seed, 36, seed % 2 == 0 ? 20 : 80);
    job.machine.override_ramp_s = seed % 3 == 0 ? 2 : 1;
    RandomPrograms random(seed);
    const double chance = random.log_uniform(0.0001, 0.002);
    Stepped run(job, job.blocks.size() / 2);
    ASSERT_TRUE(run.is_started());
    run.max_blocks = 1;
    std::vector<std::uint64_t> order;
    for (double t = 0; t < kMaxSeconds && !run.is_over(); t += run.world.dt()) {
      const bool is_resting = run.world.now() == State::kStepping;
      const std::uint64_t block = run.world.records.back().sequence;
      if (is_resting && (order.empty() || order.back() != block)) order.push_back(block);
      if (random.chance(chance)) {
        run.run();
      } else if (is_resting) {
        run.world.command(Verb::kResume);
      } else {
        run.run_unplanned();
      }
    }
    EXPECT_TRUE(run.is_over());
    EXPECT_EQ(order, every_block(job));
    dry += run.world.state.starvations;
    test::expect_within_limits(run.world, 0, false, worst);
  }
  std::printf("%llu times dry; worst v %.6f a %.6f j %.6f\n", static_cast<unsigned long long>(dry),
              worst.v, worst.a, worst.j);
  EXPECT_GT(dry, 0u);
}

TEST(SingleBlock, RestsAtTheSamePlacesWherePeriodsAreLost) {
  const Job job(5);
  Rests rests;
  Stepped plain(job);
  ASSERT_TRUE(plain.is_started());
  ASSERT_EQ(step_through(plain, rests), every_block(job));
  RandomPrograms random(5);
  Stepped run(job);
  ASSERT_TRUE(run.is_started());
  std::vector<std::uint64_t> order;
  for (double t = 0; t < kMaxSeconds && !run.is_over(); t += run.world.dt()) {
    if (run.world.now() == State::kStepping) {
      order.push_back(run.world.records.back().sequence);
      expect_same_position(run.world.records.back().joints, rests[order.back()], order.back());
      run.command(Verb::kResume);
    } else if (random.chance(0.05)) {
      run.world.run(random.chance(0.5) ? 1 : 2);
    } else {
      run.run();
    }
  }
  EXPECT_EQ(order, every_block(job));
}

}  // namespace
}  // namespace meridian::test::single_block
