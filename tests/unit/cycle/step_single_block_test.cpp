// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <utility>

#include "unit/cycle/program.hpp"

/// Single block where the plan rests by itself: after cuts, dwells and actions.
namespace meridian::test::step_single_block {
namespace {

constexpr double kLong_s = 10;

/// Two cuts, a dwell, a cut.
struct Stepped : test::Program {
  Stepped() {
    plan.cut({5, 0, 0}, kLimits);
    plan.cut_over_two_paths({20, 0, 0}, kLimits);
    plan.barrier(TimeKind::kDwell, 0.1);
    plan.cut({0, 5, 0}, kLimits);
    plan.barrier(TimeKind::kEnd);
    world.command(Verb::kSingleBlock, 1);
    run(0);
  }
  [[nodiscard]] double tip_x() const {
    return forward(machine, machine.tool_length_mm, world.records.back().joints).tip.x();
  }
};

/// On the way to rest in mid-cut, at a block's end at 60 mm and `by`.
struct Braking : test::Program {
  Braking(double by, double stop_share) {
    plan.block_end_s = 60 + by;
    plan.stop_share = stop_share;
    plan.cut({80, 0, 0}, kLimits);
    plan.barrier(TimeKind::kEnd);
    world.command(Verb::kSingleBlock, 1);
    run(0);
    while (!world.state.single_block.is_braking()) world.run();
  }
  /// Held after so many cycles more, and sent on: whether it rests at the end all the same.
  [[nodiscard]] bool rests_there_after_hold(int cycles) {
    for (int n = 0; n < cycles; ++n) world.run();
    if (world.now() != State::kRunning) return true;  // it rests already
    world.command(Verb::kHold);
    EXPECT_TRUE(world.run_until(State::kHeld, kLong_s));
    world.command(Verb::kResume);
    while (world.now() == State::kRunning) world.run();
    return world.now() == State::kStepping && std::abs(tip_x() - plan.block_end_s) < 1e-9;
  }
  [[nodiscard]] double tip_x() const {
    return forward(machine, machine.tool_length_mm, world.records.back().joints).tip.x();
  }
};

/// Where the tail of a cut over 200 mm begins that cruises for a second, and its length.
std::pair<double, double> tail_of_long_cut() {
  Program p;
  p.plan.cut_with_tail({200, 0, 0}, kLimits, 1);
  double begin = 0, end = 0;
  for (std::size_t i = 0; const TimePiece* piece = p.world.port->times.peek(i); ++i) {
    if (piece->is_tail && begin == 0) begin = piece->s0;
    end = state_at(*piece, piece->duration).s;
  }
  return {begin, end - begin};
}

TEST(StepSingleBlock, RestsBehindEveryBlockUntilTheOperatorSendsItOn) {
  Stepped p;
  for (const std::uint64_t block : {0U, 1U, 2U, 3U}) {
    ASSERT_TRUE(p.world.run_until(State::kStepping, kLong_s)) << block;
    EXPECT_EQ(p.world.records.back().sequence, block);
    EXPECT_EQ(p.world.last(EventCode::kBlockDone).a, block);
    const JointVector there = p.world.records.back().joints;
    p.world.run_for(0.3);
    EXPECT_EQ(p.world.now(), State::kStepping);
    EXPECT_EQ(p.world.records.back().joints, there);
    p.world.command(block % 2 == 0 ? Verb::kResume : Verb::kStart);
  }
  EXPECT_TRUE(p.world.run_until(State::kReady, 1));
  EXPECT_EQ(p.world.count(EventCode::kBlockStarted), 4);
  EXPECT_EQ(p.world.count(EventCode::kBlockDone), 4);
}

TEST(StepSingleBlock, RunsTheBlockUpToItsEndAtTheFullRateWhereThePlanRestsThere) {
  Stepped p;
  ASSERT_TRUE(p.world.run_until(State::kStepping, kLong_s));
  EXPECT_NEAR(p.tip_x(), 5, 1e-9);
  for (const CycleRecord& record : p.world.records) {
    if ((record.setpoint.flags & kSetpointMoving) == 0) continue;
    EXPECT_EQ(record.rate, 1);
  }
}

TEST(StepSingleBlock, GoesOnThroughWhereItWasSwitchedOff) {
  Stepped p;
  ASSERT_TRUE(p.world.run_until(State::kStepping, kLong_s));
  p.world.command(Verb::kSingleBlock, 0);
  EXPECT_EQ(p.world.now(), State::kStepping);
  p.world.command(Verb::kResume);
  ASSERT_TRUE(p.world.run_until(State::kReady, kLong_s));
  EXPECT_EQ(p.world.count(EventCode::kBlockDone), 4);
}

TEST(StepSingleBlock, RestsBehindABlockThatIsTheLastToBeThere) {
  Program p;
  p.plan.cut({5, 0, 0}, kLimits);
  p.world.command(Verb::kSingleBlock, 1);
  p.run(5);
  EXPECT_EQ(p.world.now(), State::kStepping);
  EXPECT_EQ(p.world.state.starvations, 0U);
  p.world.command(Verb::kResume);
  EXPECT_EQ(p.world.now(), State::kStepping);
  EXPECT_EQ(test::refusal_of(p.world), Refusal::kNoProgram);
  p.plan.cut({5, 0, 0}, kLimits);
  p.world.run_for(1);
  EXPECT_EQ(p.world.now(), State::kStepping);
  p.world.command(Verb::kResume);
  ASSERT_EQ(p.world.now(), State::kRunning);
  ASSERT_TRUE(p.world.run_until(State::kStepping, kLong_s));
  EXPECT_EQ(p.world.records.back().sequence, 1U);
}

TEST(StepSingleBlock, IsHeldBehindABlockAndGoesOnBehindIt) {
  Stepped p;
  ASSERT_TRUE(p.world.run_until(State::kStepping, kLong_s));
  p.world.command(Verb::kHold);
  EXPECT_EQ(p.world.now(), State::kHeld);
  p.world.command(Verb::kResume);
  ASSERT_TRUE(p.world.run_until(State::kStepping, kLong_s));
  EXPECT_EQ(p.world.records.back().sequence, 1U);
}

TEST(StepSingleBlock, IsRefusedWhereTheOverrideRampIsTooLong) {
  MachineModel machine = lai_machine();
  machine.override_ramp_s = 2.5;
  CycleWorld world(machine);
  world.command(Verb::kSingleBlock, 1);
  EXPECT_EQ(test::refusal_of(world), Refusal::kSlowRamp);
  EXPECT_FALSE(world.state.single_block.is_on);
}

/// The end lies behind what is known; what comes late is not taken up at a speed that passes it.
TEST(StepSingleBlock, RunsTheTailRatherThanIntoWhatItCouldNotRestIn) {
  const auto [begin, length] = tail_of_long_cut();
  Program p;
  p.plan.block_end_s = begin + 1.5 * length;
  p.plan.cut_with_tail({200, 0, 0}, kLimits, 1);
  p.world.command(Verb::kSingleBlock, 1);
  p.run(0);
  ASSERT_EQ(p.world.state.rate.rate(), 1);
  p.world.run_for(0.9);
  ASSERT_FALSE(p.world.reader.piece()->is_tail);
  p.plan.continue_cut();
  ASSERT_TRUE(p.world.run_until(State::kStarved, kLong_s));
  const JointVector& joints = p.world.records.back().joints;
  EXPECT_LT(forward(p.machine, p.machine.tool_length_mm, joints).tip.x(), p.plan.block_end_s);
}

TEST(StepSingleBlock, RestsBehindAnActionThatIsDoneAndNotBefore) {
  Program p;
  p.plan.barrier(TimeKind::kAction);
  p.plan.barrier(TimeKind::kEnd);
  p.world.command(Verb::kSingleBlock, 1);
  p.run(0.5);
  EXPECT_EQ(p.world.now(), State::kApproaching);
  p.world.in.action = {0, true, true};
  p.world.run_for(0.1);
  EXPECT_EQ(p.world.now(), State::kStepping);
  p.world.command(Verb::kResume);
  EXPECT_TRUE(p.world.run_until(State::kReady, 1));
  EXPECT_EQ(p.world.count(EventCode::kActionDue), 1);
}

TEST(StepSingleBlock, PassesOptionalStopsThatAreOffAndIsHeldAtThoseThatAreOn) {
  for (const bool is_on : {false, true}) {
    Program p;
    p.plan.cut({5, 0, 0}, kLimits);
    p.plan.barrier(TimeKind::kOptionalStop);
    p.plan.cut({5, 0, 0}, kLimits);
    p.world.command(Verb::kSingleBlock, 1);
    p.world.command(Verb::kOptionalStop, is_on ? 1 : 0);
    p.run(3);
    ASSERT_EQ(p.world.now(), State::kStepping);
    p.world.command(Verb::kResume);
    p.world.run_for(3);
    EXPECT_EQ(p.world.now(), is_on ? State::kHeld : State::kStepping);
    EXPECT_EQ(p.world.records.back().sequence, is_on ? 1U : 2U);
  }
}

TEST(StepSingleBlock, SaidInMotionRestsAtTheEndOfTheBlockThatIsCut) {
  Program p;
  p.plan.cut({50, 0, 0}, kLimits);
  p.plan.cut({50, 0, 0}, kLimits);
  p.run(0.2);
  p.world.command(Verb::kSingleBlock, 1);
  ASSERT_TRUE(p.world.run_until(State::kStepping, kLong_s));
  EXPECT_EQ(p.world.records.back().sequence, 0U);
}

TEST(StepSingleBlock, RestsInATailThatItBrakesForWhateverIsPublishedMeanwhile) {
  const auto [begin, length] = tail_of_long_cut();
  Program p;
  p.plan.block_end_s = begin + 0.5 * length;
  p.plan.cut_with_tail({200, 0, 0}, kLimits, 1);
  p.world.command(Verb::kSingleBlock, 1);
  p.run(0);
  while (!p.world.state.single_block.is_braking() && p.world.now() != State::kReady) p.world.run();
  ASSERT_FALSE(p.world.reader.piece()->is_tail);
  p.plan.continue_cut();
  ASSERT_TRUE(p.world.run_until(State::kStepping, kLong_s));
  const JointVector& joints = p.world.records.back().joints;
  EXPECT_NEAR(forward(p.machine, p.machine.tool_length_mm, joints).tip.x(), p.plan.block_end_s,
              1e-9);
  p.world.command(Verb::kResume);
  EXPECT_TRUE(p.world.run_until(State::kStarved, kLong_s));
}

/// Along the plan, which has no authority for a law of the hold: it rests at the end but for
/// rounding, and never behind it.
TEST(StepSingleBlock, LeavesNoEndOutBehindAHoldThatGoesAlongThePlan) {
  int left_out = 0;
  for (int cycles = 0; cycles < 1110; cycles += 7) {
    left_out += !Braking(0.01 * cycles, 0).rests_there_after_hold(cycles);
  }
  EXPECT_EQ(left_out, 0);
}

TEST(StepSingleBlock, LeavesNoEndOutBehindAHoldWhoseLawWouldEndJustBehindIt) {
  constexpr int kCycles = 700;
  Braking p(0, 1);
  for (int n = 0; n < kCycles; ++n) p.world.run();
  const PathState& at = p.world.state.on_path;
  double longer = 0.03, shorter = 0.07;  // shares of the limits that the hold may use
  double beyond = 0;
  for (int n = 0; n < 50 && !(beyond > 1e-7 && beyond < 4e-7); ++n) {
    const double share = 0.5 * (longer + shorter);
    const StopLaw law(at, {share * kLimits.acceleration, share * kLimits.jerk});
    beyond = at.s + law.distance() - p.plan.block_end_s;
    (beyond > 0 ? longer : shorter) = share;
  }
  ASSERT_TRUE(beyond > 1e-7 && beyond < 4e-7) << beyond;
  EXPECT_TRUE(Braking(0, longer).rests_there_after_hold(kCycles));
}

TEST(StepSingleBlock, MayBeAbortedAndSwitchedOffBehindABlock) {
  for (const Verb verb : {Verb::kAbort, Verb::kDisable}) {
    Stepped p;
    ASSERT_TRUE(p.world.run_until(State::kStepping, kLong_s));
    p.world.command(verb);
    const bool is_abort = verb == Verb::kAbort;
    EXPECT_TRUE(p.world.run_until(is_abort ? State::kReady : State::kOff, 2));
  }
}

TEST(StepSingleBlock, AReferenceThatIsLostBehindABlockIsAFault) {
  Stepped p;
  ASSERT_TRUE(p.world.run_until(State::kStepping, kLong_s));
  p.world.in.feedback.referenced_mask &= ~1U;
  p.world.run();
  EXPECT_EQ(test::alarm_of(p.world), Alarm::kReferenceLost);
}

}  // namespace
}  // namespace meridian::test::step_single_block
