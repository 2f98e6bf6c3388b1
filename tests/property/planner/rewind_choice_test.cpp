// SPDX-License-Identifier: Apache-2.0

/// Which solution a rewind leads to: the one that carries farthest through the blocks ahead, then
/// the nearest. The number of rewinds, and limits and travel of what comes out.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "property/planner/block_stream.hpp"
#include "property/planner/checked_rewinds.hpp"
#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/draws.hpp"
#include "support/family_machines.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::rewinds {
namespace {

constexpr double kTilt_rad = 0.3;

/// Round a cone: the azimuth goes from one of `corners_deg` to the next.
std::vector<Lean> round_a_cone(const std::vector<double>& corners_deg) {
  std::vector<Lean> corners;
  for (const double azimuth_deg : corners_deg) corners.push_back({azimuth_deg, kTilt_rad});
  return corners;
}

/// Such a program, on a machine where C comes to its end of travel 25° from the begin.
struct Case {
  MachineModel model;
  std::vector<ClBlock> blocks;
  JointVector start{};
};

/// Relative to where C begins, in the sense that it goes first: the corners.
Case at_the_end_of_travel(MachineModel model, double range_deg,
                          const std::vector<double>& corners_deg, double step_deg) {
  const int free = redundant_joint(model);
  std::vector<Lean> corners = round_a_cone(corners_deg);
  const JointVector start = solve_block(model, lean_along({corners[0]}, step_deg)[0], 0);
  turn_upwards(model, start, corners);
  Case out{model, lean_along(corners, step_deg), start};
  JointLimits& limits = out.model.joints[free].limits;
  limits.travel_max = start[free] + units::rad_from_deg(25);
  limits.travel_min = limits.travel_max - units::rad_from_deg(range_deg);
  return out;
}

/// The other rotary joint.
int tilt_joint(const MachineModel& model) { return redundant_joint(model) == 3 ? 4 : 3; }

/// The same with no travel of the tilt for the other branch.
Case one_sided(Case one) {
  const int tilt = tilt_joint(one.model);
  JointLimits& limits = one.model.joints[tilt].limits;
  (one.start[tilt] > 0 ? limits.travel_min : limits.travel_max) = 0;
  return one;
}

SmoothTrace checked_plan(const Case& one, Transition transition) {
  Found found;
  SmoothTrace trace = plan_smooth(one.model, one.blocks, one.start, {transition, 0, 0});
  check(one.model, trace, one.blocks, one.start, found);
  return trace;
}

TEST(RewindChoice, LeadsToTheNearestWindingThatCarriesAPathThatTurnsBack) {
  for (const MachineModel& machine : machines_with_two_solutions()) {
    for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
      SCOPED_TRACE(testing::Message() << machine.name << " " << static_cast<int>(transition));
      // Out of travel, then back by nearly two turns: C has most room three turns back, but not
      // there.
      const Case one =
          one_sided(at_the_end_of_travel(machine, 1440, {0, 40, -660}, step_of(transition)));
      const SmoothTrace trace = checked_plan(one, transition);
      if (HasFatalFailure()) return;
      ASSERT_EQ(trace.rewinds.size(), 1U);
      EXPECT_EQ(trace.rewinds[0].turns, -1);
    }
  }
}

TEST(RewindChoice, LeadsToTheWindingThatCarriesFarthestWhereNoneCarriesAll) {
  for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
    SCOPED_TRACE(static_cast<int>(transition));
    const Case one = one_sided(at_the_end_of_travel(limited(fork_machine(), -720, 720), 1440,
                                                    {0, 1800}, step_of(transition)));
    const SmoothTrace trace = checked_plan(one, transition);
    if (HasFatalFailure()) return;
    ASSERT_EQ(trace.rewinds.size(), 2U);
    EXPECT_EQ(trace.rewinds[0].turns, -3) << "no winding carries farther";
    EXPECT_EQ(trace.rewinds[1].turns, -2) << "the nearest that carries the rest";
  }
}

TEST(RewindChoice, LeadsToTheOtherBranchWhereThatIsNearer) {
  for (const MachineModel& machine : machines_with_two_solutions()) {
    for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
      SCOPED_TRACE(testing::Message() << machine.name << " " << static_cast<int>(transition));
      const Case one = at_the_end_of_travel(machine, 400, {0, 125}, step_of(transition));
      const SmoothTrace trace = checked_plan(one, transition);
      if (HasFatalFailure()) return;
      ASSERT_EQ(trace.rewinds.size(), 1U);
      EXPECT_TRUE(trace.rewinds[0].is_other_branch());
      EXPECT_NEAR(std::abs(trace.rewinds[0].turn_rad), kTurn_rad / 2, 1e-6);
      const int tilt = tilt_joint(one.model);
      EXPECT_NEAR(trace.joints[tilt], -one.start[tilt], 1e-6);
    }
  }
}

TEST(RewindChoice, StaysOnTheBranchWhereTheTiltHasNoTravelOnTheOther) {
  for (const MachineModel& machine : machines_with_two_solutions()) {
    for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
      SCOPED_TRACE(testing::Message() << machine.name << " " << static_cast<int>(transition));
      const Case one = one_sided(at_the_end_of_travel(machine, 400, {0, 125}, step_of(transition)));
      const SmoothTrace trace = checked_plan(one, transition);
      if (HasFatalFailure()) return;
      ASSERT_EQ(trace.rewinds.size(), 1U);
      EXPECT_EQ(trace.rewinds[0].turns, -1);
    }
  }
}

/// All of `blocks`, read every so many; where `stalls_behind` blocks have come and the planner
/// waits for more it goes on without.
StreamOutcome stream(const Case& one, Transition transition, std::size_t every,
                     std::size_t stalls_after, const std::vector<FeedMark>* replayed = nullptr) {
  BlockStream out(one.model, one.start, transition, replayed);
  for (std::size_t n = 0; n < one.blocks.size(); ++n) {
    if (replayed == nullptr && n == 1) out.stall();  // begins with a block
    if (!out.offer(one.blocks[n])) break;
    if (n % every == 0) out.read();
    if (n >= stalls_after && out.planner.look() > 0) out.stall();
  }
  return out.end();
}

constexpr std::size_t kNeverStalls = 1000000;

TEST(RewindChoice, IsTheSameHoweverTheBlocksArrive) {
  for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
    const Case one = one_sided(at_the_end_of_travel(limited(fork_machine(), -720, 720), 1440,
                                                    {0, 40, -660}, step_of(transition)));
    const StreamOutcome once = stream(one, transition, 1, kNeverStalls);
    ASSERT_EQ(once.trace.last.status, PlanStatus::kOk);
    ASSERT_EQ(once.stuck_at, 0U);
    ASSERT_EQ(once.trace.rewinds.size(), 1U);
    EXPECT_EQ(once.trace.rewinds[0].turns, -1);
    for (const std::size_t every : {7U, 100000U}) {
      const StreamOutcome again = stream(one, transition, every, kNeverStalls);
      EXPECT_TRUE(are_same(once.trace, again.trace)) << "read every " << every << " blocks";
    }
  }
}

TEST(RewindChoice, GoesOnWithTheBlocksThatAreThereWhereTheStreamStallsAndIsReplayed) {
  for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
    const Case one = one_sided(at_the_end_of_travel(limited(fork_machine(), -720, 720), 1440,
                                                    {0, 40, -660}, step_of(transition)));
    const StreamOutcome live = stream(one, transition, 1, 0);
    ASSERT_EQ(live.trace.last.status, PlanStatus::kOk);
    ASSERT_EQ(live.trace.rewinds.size(), 2U) << "one more than where the blocks are known";
    EXPECT_EQ(live.trace.rewinds[0].turns, -3) << "most room where C was going";
    const StreamOutcome again = stream(one, transition, 1, kNeverStalls, &live.marks);
    EXPECT_TRUE(are_same(live.trace, again.trace));
  }
}

}  // namespace
}  // namespace meridian::test::rewinds
