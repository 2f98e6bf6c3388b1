// SPDX-License-Identifier: Apache-2.0

/// Branch and winding past the pole follow from blocks far behind it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "property/planner/block_stream.hpp"
#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::pole_look_ahead {
namespace {

constexpr double kStep_mm = 1;
constexpr int kHalf = 600;  // blocks from either end to the pole

/// Straight over the pole or `offset_deg` beside it, leaning by 15 degrees at either end, so gently
/// that the tilt is 5 degrees off 200 mm behind it; ahead of that `before` blocks to and fro.
std::vector<ClBlock> gently_over_the_pole(double offset_deg, int before = 0) {
  constexpr int kStroke = 100;
  const double largest = units::rad_from_deg(15), offset = units::rad_from_deg(offset_deg);
  std::vector<ClBlock> blocks;
  for (int n = -kHalf - before; n <= kHalf; ++n) {
    const int ahead = std::max(0, -kHalf - n) % (2 * kStroke);
    const int at = std::max(-kHalf, n) - std::min(ahead, 2 * kStroke - ahead);
    const double x = largest * std::max(-1.0, n / static_cast<double>(kHalf));
    blocks.push_back(
        leaning(std::hypot(x, offset), std::atan2(offset, x), Vector3(kStep_mm * at, 0, 0)));
  }
  number_and_end(blocks);
  return blocks;
}

/// A machine whose tilt has its travel on one side, and stands there at the begin of `blocks`.
struct OneSided {
  explicit OneSided(const std::vector<ClBlock>& blocks, double side) : model(bench_machine()) {
    const int branch = solve_block(model, blocks[0], 0)[4] * side > 0 ? 0 : 1;
    start = solve_block(model, blocks[0], branch);
    JointLimits& limits = model.joints[4].limits;
    limits.travel_min = units::rad_from_deg(side > 0 ? -5 : -60);
    limits.travel_max = units::rad_from_deg(side > 0 ? 60 : 5);
  }
  MachineModel model;
  JointVector start{};
};

void expect_whole(const MachineModel& model, const SmoothTrace& trace, const JointVector& start) {
  ASSERT_EQ(trace.last.status, PlanStatus::kOk)
      << "block " << trace.last.reject.sequence << " joint " << trace.last.reject.joint << " at "
      << trace.last.reject.value;
  EXPECT_EQ(trace.times.back().kind, TimeKind::kEnd);
  EXPECT_TRUE(trace.rewinds.empty());
  for (const PlanSample& one : sample(model, trace, 0.02, 0.37, start)) {
    ASSERT_LT(first_joint_outside_travel(model, one.q, 1e-9), 0);
  }
}

TEST(PoleLookAhead, TakesTheBranchOnWhichTheTiltHasTravelFarBehindThePole) {
  const struct {
    double offset_deg, side;
    int before;  // blocks: none, and more than the look at the program's begin goes over
    Transition transition;
  } cases[] = {{0, -1, 0, Transition::kSmooth},
               {0, 1, 0, Transition::kSmooth},
               {0.05, -1, 0, Transition::kSmooth},
               {0.05, 1, 2500, Transition::kSmooth},
               {0, 1, 2500, Transition::kExactStop}};
  for (const auto& entry : cases) {
    if (!kIsTimed && entry.before == 0) continue;  // the longest say the most
    SCOPED_TRACE(testing::Message() << entry.before << " blocks before, " << entry.offset_deg
                                    << " deg beside it, tilt on side " << entry.side);
    const auto blocks = gently_over_the_pole(entry.offset_deg, entry.before);
    const OneSided machine(blocks, entry.side);
    const SmoothTrace trace =
        plan_smooth(machine.model, blocks, machine.start, {entry.transition, 0, 0}, true);
    expect_whole(machine.model, trace, machine.start);
    EXPECT_EQ(trace.tails, 0);
  }
}

/// Over the pole, then round it at 17 degrees by `turn_deg`.
std::vector<ClBlock> over_and_round(double turn_deg) {
  const double largest = units::rad_from_deg(17);
  std::vector<ClBlock> blocks;
  for (int n = -60; n <= 60; ++n) {
    const double x = largest * n / 60.0;
    blocks.push_back(leaning(std::abs(x), x < 0 ? 0 : units::rad_from_deg(180), Vector3(n, 0, 0)));
  }
  const int steps = static_cast<int>(std::abs(turn_deg) / 3);
  for (int n = 1; n <= steps; ++n) {
    blocks.push_back(leaning(largest, units::rad_from_deg(180 + turn_deg * n / steps),
                             Vector3(60 + 0.5 * n, 0, 0)));
  }
  number_and_end(blocks);
  return blocks;
}

TEST(PoleLookAhead, TurnsCPastThePoleToTheWindingThatCarriesThePath) {
  for (const double turn_deg : {-280.0, -250.0, 250.0, 280.0}) {
    SCOPED_TRACE(turn_deg);
    // From where C is at the pole either way is too far without another winding or branch.
    const MachineModel model = limited(fork_machine(), -200, 200);
    const auto blocks = over_and_round(turn_deg);
    const SmoothTrace trace =
        plan_smooth(model, blocks, joints_of(model, blocks[0]), {Transition::kSmooth, 0, 0}, true);
    expect_whole(model, trace, joints_of(model, blocks[0]));
  }
}

struct Stalled : StreamOutcome {
  std::size_t at = 0;  ///< block that came late
};

/// Plans `blocks`; `stalls`: the stream stalls where the planner first waits for blocks behind its
/// look at the begin.
Stalled plan_with_stall(const MachineModel& model, const std::vector<ClBlock>& blocks,
                        const JointVector& start, bool stalls,
                        const std::vector<FeedMark>* replayed = nullptr) {
  BlockStream stream(model, start, Transition::kSmooth, replayed);
  std::size_t late = 0;
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    if (stalls && late == 0 && n > SmoothPlanner::kLookAhead && stream.planner.look() > 0) {
      late = n;
      stream.planner.look_no_further();
      EXPECT_EQ(stream.planner.look(), 0U);
      (void)stream.planner.advance(stream.writer);
    }
    if (!stream.offer(blocks[n])) break;
    stream.read();
  }
  return {stream.end(), late};
}

/// What is known carries either way, the shorter is taken, which ends at the tilt's travel. It is
/// told, and the same again where it is replayed.
TEST(PoleLookAhead, GoesOnWithWhatIsThereWhereTheStreamStallsAndIsReplayed) {
  const auto blocks = gently_over_the_pole(0.05, 2000);
  const OneSided machine(blocks, 1);
  const std::uint64_t pole = 2000 + kHalf;
  const Stalled stalled = plan_with_stall(machine.model, blocks, machine.start, true);
  ASSERT_GT(stalled.at, pole);
  EXPECT_EQ(stalled.trace.last.status, PlanStatus::kRefused);
  const auto late = std::find_if(stalled.marks.begin(), stalled.marks.end(),
                                 [](const FeedMark& mark) { return mark.is_late; });
  ASSERT_NE(late, stalled.marks.end());
  EXPECT_GT(late->sequence, pole);
  EXPECT_EQ(late->sequence + late->looked_at, stalled.at);
  const Stalled whole = plan_with_stall(machine.model, blocks, machine.start, false);
  EXPECT_EQ(whole.trace.last.status, PlanStatus::kOk);
  EXPECT_FALSE(are_same(whole.trace, stalled.trace));
  const Stalled replayed =
      plan_with_stall(machine.model, blocks, machine.start, false, &stalled.marks);
  EXPECT_EQ(replayed.trace.last.reject.sequence, stalled.trace.last.reject.sequence);
  EXPECT_TRUE(are_same(replayed.trace, stalled.trace));
}

TEST(PoleLookAhead, IsTheSameHoweverTheBlocksArrive) {
  const auto blocks = gently_over_the_pole(0.05);
  const OneSided machine(blocks, -1);
  const auto plan = [&](std::size_t every) {
    return plan_smooth(
        machine.model, blocks, machine.start, {Transition::kSmooth, 0, 0},
        [every](std::size_t n) { return n % every == 0; }, [](std::size_t) { return false; }, true);
  };
  const SmoothTrace one = plan(1);
  EXPECT_GT(one.times.size(), 10U);
  for (const std::size_t every : {7, 50, 1000}) EXPECT_TRUE(are_same(one, plan(every)));
}

/// What lies ahead of the place is run meanwhile, to a rest.
TEST(PoleLookAhead, RestsAheadOfThePoleUntilTheBlocksAreThere) {
  const auto blocks = gently_over_the_pole(0.0, 2000);
  const OneSided machine(blocks, 1);
  const std::size_t missing = plan_with_stall(machine.model, blocks, machine.start, true).at + 10;
  const SmoothTrace trace = plan_smooth(
      machine.model, blocks, machine.start, {Transition::kSmooth, 0, 0},
      [](std::size_t) { return true; }, [&](std::size_t n) { return n == missing; }, true);
  expect_whole(machine.model, trace, machine.start);
  EXPECT_GT(trace.tails, 0);
}

}  // namespace
}  // namespace meridian::test::pole_look_ahead
