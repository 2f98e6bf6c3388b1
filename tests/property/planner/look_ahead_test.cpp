// SPDX-License-Identifier: Apache-2.0

/// Branch, winding and way past the pole follow from the blocks that are to come.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "meridian/kinematics/tip_over_base.hpp"
#include "property/planner/block_stream.hpp"
#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::look_ahead {
namespace {

TEST(LookAhead, BeginsOnTheWindingThatCarriesTheWholeProgram) {
  MachineModel model = limited(fork_machine(), -360, 360);
  model.rewind_policy = RewindPolicy::kRefuse;
  for (const double sign : {-1.0, 1.0}) {
    for (const double first_tilt : {0.3, 0.003, 0.0}) {  // beside the pole, and on it
      SCOPED_TRACE(testing::Message() << sign << ", begins " << first_tilt << " from the pole");
      std::vector<ClBlock> blocks;  // a turn and a half from where C stands at 0 or nearly
      for (int n = -1; n <= 108; ++n) {
        const double azimuth = n < 0 ? 0 : sign * units::rad_from_deg(5.0 * n);
        blocks.push_back(
            leaning(n < 0 ? first_tilt : 0.3, azimuth,
                    {30 * std::cos(azimuth), 30 * std::sin(azimuth), n < 0 ? 1.0 : 0}));
        blocks.back().sequence = blocks.size() - 1;
      }
      end_program(blocks);
      const JointVector start = joints_of(model, blocks[0]);
      for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
        const SmoothTrace trace = plan_smooth(model, blocks, start, {transition, 0, 0}, true);
        EXPECT_EQ(trace.last.status, PlanStatus::kOk) << "block " << trace.last.reject.sequence;
        EXPECT_EQ(trace.times.back().kind, TimeKind::kEnd);
        EXPECT_TRUE(trace.rewinds.empty());
      }
    }
  }
}

/// Plans straight lines through `blocks` with a look ahead, from `start`.
PlanResult plan_with_look(const MachineModel& model, std::vector<ClBlock> blocks,
                          const JointVector& start, Transition transition) {
  number_and_end(blocks);
  return plan_smooth(model, blocks, start, {transition, 0, 0}, true).last;
}

TEST(LookAhead, TakesTheBranchOnWhichNoJointLeavesItsTravelLater) {
  for (const bool is_slide : {false, true}) {
    MachineModel model = is_slide ? lai_machine() : bench_machine();  // C with travel, and endless
    const std::vector<ClBlock> blocks{leaning(0.17, 0, {5, 0, 0}), leaning(0.17, 0, {100, 0, 0}),
                                      leaning(is_slide ? 0.17 : 0.6, 0, {250, 0, 0})};
    for (int branch = 0; branch < branch_count(model); ++branch) {
      // The machine stands on `branch`, which leaves travel of one joint at the end.
      const JointVector begin = solve_block(model, blocks[0], branch);
      const JointVector out = solve_block(model, blocks[2], branch);
      const JointVector in = solve_block(model, blocks[2], 1 - branch);
      int joint = is_slide ? 0 : 4;
      for (int i = 0; is_slide && i < 3; ++i) {
        if (std::abs(out[i] - in[i]) > std::abs(out[joint] - in[joint])) joint = i;
      }
      ASSERT_GT(std::abs(out[joint] - in[joint]), 0.5);
      MachineModel limited = model;
      JointLimits& limits = limited.joints[joint].limits;
      const double room = is_slide ? 50 : 0.2;
      (out[joint] < in[joint] ? limits.travel_min : limits.travel_max) =
          out[joint] + (out[joint] < in[joint] ? room : -room);
      ASSERT_LT(first_joint_outside_travel(limited, begin, 0), 0);
      for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
        const PlanResult last = plan_with_look(limited, blocks, begin, transition);
        EXPECT_EQ(last.status, PlanStatus::kOk)
            << "joint " << joint << " branch " << branch << " block " << last.reject.sequence;
      }
    }
  }
}

TEST(LookAhead, TakesTheBranchThatPassesNoBoxLater) {
  const MachineModel model = lai_machine();
  const std::vector<ClBlock> blocks{leaning(0.17, 0, {5, 0, 0}), leaning(0.17, 0, {100, 0, 0}),
                                    leaning(0.17, 0, {250, 0, 0})};
  for (int branch = 0; branch < branch_count(model); ++branch) {
    const JointVector begin = solve_block(model, blocks[0], branch);
    const JointVector at = solve_block(model, blocks[2], branch);
    const double tip = tip_over_base(model, model.tool_length_mm, at)[0];
    MachineModel kept_out = model, tipped = model;
    KeepOutBox box;
    box.joints = 0b001;
    box.min[0] = at[0] - 20;
    box.max[0] = at[0] + 20;
    ASSERT_TRUE(kept_out.keep_out.add(box));
    tipped.tip_box = {true, {-2e3, -2e3, -2e3}, {2e3, 2e3, 2e3}};
    (tip > 0 ? tipped.tip_box.max : tipped.tip_box.min)[0] = tip > 0 ? tip - 50 : tip + 50;
    for (const MachineModel& boxed : {kept_out, tipped}) {
      for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
        const PlanResult last = plan_with_look(boxed, blocks, begin, transition);
        EXPECT_EQ(last.status, PlanStatus::kOk)
            << "branch " << branch << " block " << last.reject.sequence << " tip box "
            << boxed.tip_box.is_set;
      }
    }
  }
}

/// The stream stalls behind `blocks_before_stall` blocks; `replayed`: marks of another run.
StreamOutcome plan_with_stall(const MachineModel& model, const std::vector<ClBlock>& blocks,
                              const JointVector& start, std::size_t blocks_before_stall,
                              const std::vector<FeedMark>* replayed = nullptr) {
  BlockStream stream(model, start, Transition::kSmooth, replayed);
  for (std::size_t n = 0; n < blocks.size(); ++n) {
    if (n == blocks_before_stall) stream.planner.look_no_further();
    stream.offer(blocks[n]);
  }
  EXPECT_EQ(stream.outcome.stuck_at, 0U);
  return stream.end();
}

TEST(LookAhead, IsReplayedBitForBitWhereAStreamStalledInIt) {
  const MachineModel model = limited(fork_machine(), -360, 360);
  std::vector<ClBlock> blocks;  // a turn and a half, from where C stands at 0
  for (int n = 0; n <= 108; ++n) {
    const double azimuth = units::rad_from_deg(5.0 * n);
    blocks.push_back(leaning(0.3, azimuth, {30 * std::cos(azimuth), 30 * std::sin(azimuth), 0}));
    blocks.back().sequence = blocks.size() - 1;
  }
  end_program(blocks);
  const JointVector start = joints_of(model, blocks[0]);
  const StreamOutcome stalled = plan_with_stall(model, blocks, start, 20);
  ASSERT_EQ(stalled.marks.size(), 2U);
  EXPECT_TRUE(stalled.marks[0].is_begin);
  EXPECT_EQ(stalled.marks[1].looked_at, 20U);
  EXPECT_TRUE(stalled.marks[1].is_late);
  const StreamOutcome whole = plan_with_stall(model, blocks, start, ~std::size_t{0});
  ASSERT_EQ(whole.marks.size(), 2U);
  EXPECT_EQ(whole.marks[1].looked_at, blocks.size() - 1);
  EXPECT_FALSE(whole.marks[1].is_late);
  EXPECT_NE(whole.trace.duration_s(), stalled.trace.duration_s()) << "both begin on one winding";
  const auto replay = [&](const std::vector<FeedMark>& marks) {
    return plan_with_stall(model, blocks, start, ~std::size_t{0}, &marks).trace;
  };
  EXPECT_TRUE(are_same(replay(stalled.marks), stalled.trace));
  EXPECT_TRUE(are_same(replay(whole.marks), whole.trace));
}

/// Leans by 0.3 and turns from azimuth 0 to `turn` and back, in steps of 2 deg.
std::vector<ClBlock> there_and_back(double turn) {
  std::vector<ClBlock> blocks;
  const int steps = static_cast<int>(std::ceil(turn / units::rad_from_deg(2)));
  for (int n = -steps; n <= steps; ++n) {
    const double azimuth = turn * (1 - std::abs(n) / static_cast<double>(steps));
    blocks.push_back(
        leaning(0.3, azimuth, {30 * std::cos(azimuth), 30 * std::sin(azimuth), 0.1 * n}));
    blocks.back().line = 100 + static_cast<std::uint32_t>(blocks.size());
  }
  return blocks;
}

TEST(LookAhead, RefusesBeforeItStartsWhatNoWindingCarries) {
  const auto blocks = there_and_back(units::rad_from_deg(150));
  for (const RewindPolicy policy : {RewindPolicy::kRefuse, RewindPolicy::kRetract}) {
    // C turns by 150 deg; no whole turn fits into its travel either, so rewind does not help.
    MachineModel model = limited(lai_machine(), -70, 70);
    model.rewind_policy = policy;
    const JointVector start = joints_of(model, blocks[0]);
    for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
      auto program = blocks;
      number_and_end(program);
      const SmoothTrace trace = plan_smooth(model, program, start, {transition, 0, 0}, true);
      ASSERT_EQ(trace.last.status, PlanStatus::kRefused);
      EXPECT_TRUE(trace.times.empty()) << "it moves";
      const BlockReject& reject = trace.last.reject;
      EXPECT_EQ(reject.code, RejectCode::kTravelBetween);
      EXPECT_EQ(reject.joint, redundant_joint(model));
      EXPECT_EQ(reject.line, program[reject.sequence].line);
      // The same as is found on the way where nothing was looked at.
      const SmoothTrace cut = plan_smooth(model, program, start, {transition, 0, 0});
      ASSERT_EQ(cut.last.status, PlanStatus::kRefused);
      EXPECT_FALSE(cut.times.empty());
      EXPECT_GE(reject.sequence + 3, cut.last.reject.sequence) << "another winding carries farther";
      EXPECT_LE(reject.sequence, program.size() / 2) << "C comes back from there";
    }
  }
}

TEST(LookAhead, RefusesNothingThatRoundingMayKeepInsideTravel) {
  const double turn = units::rad_from_deg(100);
  const auto blocks = there_and_back(turn);
  MachineModel model = limited(fork_machine(), -360, 360);
  model.rewind_policy = RewindPolicy::kRefuse;
  const JointVector start = joints_of(model, blocks[0]);
  JointVector at = start, largest = start;
  for (std::size_t n = 0; n <= blocks.size() / 2; ++n) {
    const int branch = std::abs(solve_block(model, blocks[n], 0, at)[4] - at[4]) < 0.1 ? 0 : 1;
    at = largest = solve_block(model, blocks[n], branch, at);
  }
  // The corner is 0.02 deg outside of travel, on a way that is rounded there by more.
  const double sign = largest[3] > start[3] ? 1 : -1;
  const double end = largest[3] - sign * units::rad_from_deg(0.02);
  const double other = end - sign * units::rad_from_deg(200);
  model.joints[3].limits.travel_min = std::min(end, other);
  model.joints[3].limits.travel_max = std::max(end, other);
  EXPECT_EQ(plan_with_look(model, blocks, start, Transition::kSmooth).status, PlanStatus::kOk);
  EXPECT_EQ(plan_with_look(model, blocks, start, Transition::kExactStop).status,
            PlanStatus::kRefused);
}

/// Over the pole at `offset_deg` beside it, from `from_deg` to 10 degrees behind it.
std::vector<ClBlock> past_the_pole(double from_deg, double offset_deg) {
  std::vector<ClBlock> blocks;
  for (const double x_deg : {from_deg, -0.5, -1.0, -2.0, -5.0, -10.0}) {
    const double x = units::rad_from_deg(x_deg), y = units::rad_from_deg(offset_deg);
    blocks.push_back(leaning(std::hypot(x, y), std::atan2(y, x), {50 - 5 * x_deg, 0, 0}));
    blocks.back().sequence = blocks.size() - 1;
  }
  end_program(blocks);
  return blocks;
}

/// On the programmed great circle C would turn by half a turn, for which it has no travel; the cut
/// is relaxed over the pole, where C nearly stands.
TEST(LookAhead, RefusesNothingThatIsEasedPastThePole) {
  const MachineModel model = limited(bench_machine(), -60, 60);
  const double tolerance_deg = units::deg_from_rad(axis_tolerance_beside_pole(model));
  const double asked = units::rad_from_deg(5 * tolerance_deg);
  const struct {
    double from_deg, offset_deg;
    SmoothSettings settings;
  } cuts[] = {{tolerance_deg, tolerance_deg / 5, {Transition::kSmooth, 0, 0}},
              {10, tolerance_deg * 3, {Transition::kSmooth, 0, asked}},
              {0.5, tolerance_deg * 3, {Transition::kSmooth, 0, asked}}};
  for (const auto& cut : cuts) {
    SCOPED_TRACE(testing::Message() << "from " << cut.from_deg << " at " << cut.offset_deg);
    const auto blocks = past_the_pole(cut.from_deg, cut.offset_deg);
    const SmoothTrace trace =
        plan_smooth(model, blocks, joints_of(model, blocks[0]), cut.settings, true);
    EXPECT_EQ(trace.last.status, PlanStatus::kOk) << "block " << trace.last.reject.sequence;
  }
}

/// Half a turn from `begin` about the origin, through +y.
ClBlock half_turn(const ClBlock& begin) {
  ClBlock arc = begin;
  arc.tip_mm[0] = -begin.tip_mm[0];
  arc.is_arc = true;
  arc.sweep_rad = std::numbers::pi;
  return arc;
}

TEST(LookAhead, FollowsAnArcThatTheProgramBeginsWith) {
  const MachineModel model = lai_machine();
  const ClBlock begin = leaning(0.17, 0, {100, 0, 0}), middle = leaning(0.17, 0, {0, 100, 0});
  const ClBlock arc = half_turn(begin);
  for (int branch = 0; branch < branch_count(model); ++branch) {
    // The machine stands on `branch`, on which a slide leaves its travel in the middle of the arc.
    const JointVector from = solve_block(model, begin, branch);
    const JointVector there = solve_block(model, middle, branch, from);
    MachineModel limited = model;
    int limits = 0;
    for (int i = 0; i < 3; ++i) {
      const double sign = there[i] > from[i] ? 1 : -1;
      double inside = std::max(sign * from[i], sign * solve_block(model, arc, branch, from)[i]);
      for (const ClBlock& block : {begin, middle, arc})
        inside = std::max(inside, sign * solve_block(model, block, 1 - branch)[i]);
      if (sign * there[i] < inside + 50) continue;
      JointLimits& travel = limited.joints[i].limits;
      (sign > 0 ? travel.travel_max : travel.travel_min) = sign * (inside + 25);
      ++limits;
    }
    ASSERT_EQ(limits, 1);
    for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
      ClBlock on = arc;
      on.is_arc = false;
      on.tip_mm[0] -= 10;
      const PlanResult last = plan_with_look(limited, {arc, on}, from, transition);
      EXPECT_EQ(last.status, PlanStatus::kOk)
          << "joint " << last.reject.joint << " branch " << branch;
    }
  }
}

/// Straight through the pole the tilt would come to the other side, where it has no travel: C turns
/// on the pole or beside it instead.
TEST(LookAhead, TakesNoWayPastThePoleOnWhichAJointLeavesItsTravelBehindIt) {
  MachineModel model = bench_machine();
  const double tilt = units::rad_from_deg(15);
  for (const double offset_deg : {0.0, 0.05}) {
    SCOPED_TRACE(offset_deg);
    const double offset = units::rad_from_deg(offset_deg);
    std::vector<ClBlock> blocks;
    for (int n = 0; n <= 20; ++n) {
      const double x = tilt * (1 - n / 10.0);
      blocks.push_back(
          leaning(std::hypot(x, offset), std::atan2(offset, x), Vector3(2.0 * n, 0, 0)));
      blocks.back().sequence = blocks.size() - 1;
    }
    end_program(blocks);
    for (const double side : {-1.0, 1.0}) {
      const int branch = solve_block(model, blocks[0], 0)[4] * side > 0 ? 0 : 1;
      const JointVector start = solve_block(model, blocks[0], branch);
      JointLimits& limits = model.joints[4].limits;
      limits.travel_min = units::rad_from_deg(side > 0 ? -5 : -60);
      limits.travel_max = units::rad_from_deg(side > 0 ? 60 : 5);
      const SmoothTrace trace = plan_smooth(model, blocks, start);
      EXPECT_EQ(trace.last.status, PlanStatus::kOk)
          << "joint " << trace.last.reject.joint << " at " << trace.last.reject.value;
      for (const PlanSample& one : sample(model, trace, 1e-3, 0.37, start)) {
        ASSERT_LT(first_joint_outside_travel(model, one.q, 1e-9), 0);
      }
    }
  }
}

}  // namespace
}  // namespace meridian::test::look_ahead
