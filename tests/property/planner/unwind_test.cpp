// SPDX-License-Identifier: Apache-2.0

/// Programs that turn C farther than its travel: what comes out of the port stays inside travel and
/// limits, unwinds off the part alone, and cuts everything that is programmed.

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/draws.hpp"
#include "support/family_machines.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::unwind {
namespace {

constexpr double kLimit = 1 + 1e-6;

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
    const double least = how.passes_pole ? -0.35 : units::rad_from_deg(3);
    tilt = how.passes_pole ? 0.3 * std::cos(0.4 * turned + seed) : tilt + uniform(-0.3, 0.3) * step;
    tilt = std::clamp(tilt, least, units::rad_from_deg(40));
  }
  end_program(blocks);
  return blocks;
}

/// Judges what was made of `blocks`, the unwindings alone: off along the tool axis, C alone, back.
/// Returns their number.
int judge_unwindings(const MachineModel& model, const SmoothTrace& trace,
                     const std::vector<PlanSample>& setpoints) {
  const int free = free_joint(model);
  int count = 0;
  bool was_in = false;
  JointVector rest{};
  double farthest = 0;
  for (std::size_t n = 1; n < setpoints.size(); ++n) {
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    const bool is_in =
        trace.times[k].kind == TimeKind::kMove && trace.paths[k].motion == MotionKind::kUnwind;
    const double length = model.tool_length_mm;
    if (is_in && !was_in) {
      rest = setpoints[n - 1].q;
      farthest = 0;
      ++count;
    }
    const ToolPose begin = forward(model, length, rest);
    const ToolPose pose = forward(model, length, setpoints[n].q);
    const double off = (pose.tip - begin.tip).dot(begin.axis);
    if (is_in) {
      const double turned = std::abs(setpoints[n].q[free] - setpoints[n - 1].q[free]);
      // The setpoint before the first may be a cycle short of the rest: 1 µm.
      if (turned > 0 &&
          std::abs(std::remainder(setpoints[n].q[free] - rest[free], kTurn_rad)) > 1e-5) {
        EXPECT_NEAR(farthest, kRetract_mm, 1e-3) << "C turns beside the part";
        for (int i = 0; i < model.joint_count; ++i) {
          if (i == free) continue;
          EXPECT_NEAR(setpoints[n].q[i], setpoints[n - 1].q[i], 1e-9) << "with C, joint " << i;
        }
      } else {
        farthest = std::max(farthest, off);
        EXPECT_LT((pose.tip - begin.tip - off * begin.axis).norm(), 2e-3);
        EXPECT_LT(angle_between(pose.axis, begin.axis), 1e-4);
        EXPECT_GT(off, -1e-3);
      }
    } else if (was_in) {
      EXPECT_LT((pose.tip - begin.tip).norm(), 2e-2) << "not where it left";
      EXPECT_NEAR(farthest, kRetract_mm, 1e-3);
      EXPECT_GT(std::abs(setpoints[n].q[free] - rest[free]), 6);
    }
    was_in = is_in;
  }
  return count;
}

struct Found {
  int unwindings = 0;
  double v = 0, a = 0, j = 0, off = 0;
};

void judge(const MachineModel& model, const SmoothTrace& trace, const std::vector<ClBlock>& blocks,
           const JointVector& start, Found& found) {
  ASSERT_EQ(trace.last.status, PlanStatus::kOk)
      << "code " << static_cast<int>(trace.last.reject.code) << " joint " << trace.last.reject.joint
      << " block " << trace.last.reject.sequence << " at " << trace.last.reject.value;
  ASSERT_EQ(trace.times.back().kind, TimeKind::kEnd);
  const auto ways = programmed_ways(blocks);
  const auto setpoints = sample(model, trace, 1e-3, 0.37, start);
  const LimitUse use = measure_limits(model, setpoints, 1e-3);
  EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where;
  EXPECT_LE(measure_feed(model, trace, setpoints, 1e-3), 1.0001);
  for (std::size_t n = 3; n + 3 < setpoints.size(); ++n) {
    ASSERT_LT(first_joint_outside_travel(model, setpoints[n].q, 1e-9), 0) << "setpoint " << n;
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    const PathPiece& path = trace.paths[k];
    if (n % 11 != 0 || trace.times[k].kind != TimeKind::kMove) continue;
    if (path.motion == MotionKind::kApproach || path.motion == MotionKind::kUnwind) continue;
    const ToolPose pose = forward(model, path.tool_length_mm, setpoints[n].q);
    const double off = distance_from(ways, trace.times[k].sequence, pose, model.tolerances.tip_mm,
                                     model.tolerances.axis_rad);
    ASSERT_LE(off, kLimit) << "setpoint " << n << " block " << trace.times[k].sequence;
    found.off = std::max(found.off, off);
  }
  const int unwindings = judge_unwindings(model, trace, setpoints);
  EXPECT_EQ(unwindings, static_cast<int>(trace.unwindings.size()));
  found.unwindings += unwindings;
  found.v = std::max(found.v, use.v);
  found.a = std::max(found.a, use.a);
  found.j = std::max(found.j, use.j);
  const ToolPose end = forward(model, model.tool_length_mm, trace.joints);
  EXPECT_LE((end.tip - to_vector(blocks[blocks.size() - 2].tip_mm)).norm(), 2e-6);
}

constexpr std::uint32_t kPrograms = 1;  // longer runs: MERIDIAN_UNWIND_PROGRAMS

void run_spirals(Transition transition, Spiral how) {
  const auto programs = number_of("MERIDIAN_UNWIND_PROGRAMS", kPrograms);
  const auto first = number_of("MERIDIAN_UNWIND_SEED", 1U);
  std::uint32_t last = first + programs;
  int unwindings = 0;
  auto all = machines();
  if (!kIsTimed) all.resize(1);  // the slow build sees the same code
  for (const MachineModel& model : all) {
    const JointLimits& limits = model.joints[free_joint(model)].limits;
    how.turns = (limits.travel_max - limits.travel_min) / kTurn_rad + 1.4;
    Found found;
    for (std::uint32_t seed = last - programs; seed < last; ++seed) {
      SCOPED_TRACE(testing::Message() << model.name << " seed " << seed);
      how.turns_back = seed % 3 == 0;
      const auto blocks = spiral(seed, how);
      const JointVector start = joints_of(model, blocks[0]);
      const SmoothSettings settings{transition, 0, 0};
      judge(model, plan_smooth(model, blocks, start, settings, true), blocks, start, found);
      if (testing::Test::HasFatalFailure()) return;
    }
    std::printf("%s: %d unwindings, v %.4f a %.4f j %.4f of the limits, %.3f tolerances\n",
                model.name.c_str(), found.unwindings, found.v, found.a, found.j, found.off);
    unwindings += found.unwindings;
    last += programs;  // every machine its own
  }
  if (kIsTimed) {  // else so few are drawn that the look past the pole may spare them all
    EXPECT_GT(unwindings, 1);
  }
}

TEST(Unwinding, KeepsTravelAndLimitsOnSpiralsFromRestToRest) {
  run_spirals(Transition::kExactStop, {0, 25, false, false});
}

TEST(Unwinding, KeepsTravelAndLimitsOnSmoothSpirals) {
  run_spirals(Transition::kSmooth, {0, 6, false, false});
}

TEST(Unwinding, KeepsTravelAndLimitsWherePathsPassThePole) {
  run_spirals(Transition::kSmooth, {0, 6, false, true});
}

TEST(Unwinding, IsTheSameHoweverTheBlocksArriveAndThePortIsRead) {
  const MachineModel model = limited(lai_machine(), -200, 340);
  for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
    const auto blocks =
        spiral(3, {2.2, transition == Transition::kSmooth ? 6.0 : 25.0, true, false});
    const JointVector start = joints_of(model, blocks[0]);
    const SmoothSettings settings{transition, 0, 0};
    const SmoothTrace once = plan_smooth(model, blocks, start, settings, true);
    ASSERT_EQ(once.last.status, PlanStatus::kOk);
    EXPECT_FALSE(once.unwindings.empty());
    for (const std::size_t every : {7U, 100000U}) {
      const SmoothTrace again = plan_smooth(
          model, blocks, start, settings, [every](std::size_t n) { return n % every == 0; },
          [](std::size_t) { return false; }, true);
      EXPECT_TRUE(are_same(once, again)) << "read every " << every << " blocks";
    }
  }
}

TEST(Unwinding, FindsTheWayPastThePoleBehindItOnTheWindingThatHoldsThere) {
  const MachineModel model = limited(lai_machine(), -200, 200);
  const double tilt = units::rad_from_deg(8), offset = units::rad_from_deg(0.05);
  for (const double side : {-1.0, 1.0}) {
    SCOPED_TRACE(side);
    std::vector<ClBlock> blocks;
    const auto add = [&](double lean, double azimuth, const Vector3& tip) {
      blocks.push_back(leaning(lean, azimuth, tip));
      blocks.back().sequence = blocks.size() - 1;
    };
    // C turns out of its travel, then the axis passes the pole inside the tolerance.
    for (int n = 0; n <= 15; ++n) {
      add(tilt, units::rad_from_deg(n - 15.0), Vector3(0.2 * n, 0, 0));
    }
    for (int n = 1; n <= 16; ++n) {
      const double x = tilt * (1 - n / 8.0);
      blocks.push_back(
          leaning(std::hypot(x, offset), std::atan2(side * offset, x), Vector3(3 + n, 0, 0)));
      blocks.back().sequence = blocks.size() - 1;
    }
    for (int n = 1; n <= 6; ++n) {
      add(tilt, std::numbers::pi, Vector3(19 + 10 * n, 0, 0));
    }
    end_program(blocks);
    // So that C is 10° inside its travel at the begin, turning to its end.
    MachineModel turned = model;
    const JointVector start = solve_block(model, blocks[0], 0);
    const double by = solve_block(model, blocks[15], 0, start)[3] - start[3];
    JointLimits& limits = turned.joints[3].limits;
    limits.travel_max = start[3] + (by > 0 ? units::rad_from_deg(10) : 400 * units::kDegree_rad);
    limits.travel_min = limits.travel_max - units::rad_from_deg(410);
    const SmoothTrace trace = plan_smooth(turned, blocks, start);
    ASSERT_EQ(trace.last.status, PlanStatus::kOk) << trace.last.reject.sequence;
    EXPECT_EQ(trace.unwindings.size(), 1U);
    EXPECT_FALSE(trace.eases.empty());
    for (const PoleEase& ease : trace.eases)
      EXPECT_LE(ease.deviation_rad, model.tolerances.axis_rad);
    EXPECT_LT(trace.duration_s(), 20);
    std::printf("%.0f: %.3f s, %zu unwindings, %zu eases\n", side, trace.duration_s(),
                trace.unwindings.size(), trace.eases.size());
  }
}

/// Wherever C comes to its end of travel on the way past the pole: also so that the closest place
/// is just behind the unwinding.
TEST(Unwinding, CutsOnWhereverItComesOnTheWayPastThePole) {
  const MachineModel model = limited(lai_machine(), -200, 200);
  const double tilt = units::rad_from_deg(8);
  int unwindings = 0;
  for (const PolePolicy policy : {PolePolicy::kExact, PolePolicy::kEase}) {
    for (const double offset_deg : {0.05, 0.3, 1.0}) {
      const double offset = units::rad_from_deg(offset_deg);
      std::vector<ClBlock> blocks;
      for (int n = 0; n <= 16; ++n) {
        const double x = tilt * (1 - n / 8.0);
        blocks.push_back(
            leaning(std::hypot(x, offset), std::atan2(offset, x), Vector3(1.0 * n, 0, 0)));
        blocks.back().sequence = blocks.size() - 1;
      }
      end_program(blocks);
      const JointVector start = solve_block(model, blocks[0], 0);
      const double sign = solve_block(model, blocks[7], 0, start)[3] > start[3] ? 1 : -1;
      for (int degrees = 2; degrees < 180; degrees += kIsTimed ? 19 : 88) {
        SCOPED_TRACE(testing::Message()
                     << offset_deg << " deg beside the pole, C ends at " << degrees);
        MachineModel turned = model;
        turned.pole_policy = policy;
        JointLimits& limits = turned.joints[3].limits;
        const double end = start[3] + sign * units::rad_from_deg(degrees);
        const double other = end - sign * units::rad_from_deg(540);
        limits.travel_min = std::min(end, other);
        limits.travel_max = std::max(end, other);
        const SmoothTrace trace = plan_smooth(turned, blocks, start);
        ASSERT_EQ(trace.last.status, PlanStatus::kOk)
            << "joint " << trace.last.reject.joint << " block " << trace.last.reject.sequence;
        ASSERT_EQ(trace.times.back().kind, TimeKind::kEnd);
        const auto setpoints = sample(turned, trace, 1e-3, 0.37, start);
        const LimitUse use = measure_limits(turned, setpoints, 1e-3);
        EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where;
        for (const PlanSample& one : setpoints)
          ASSERT_LT(first_joint_outside_travel(turned, one.q, 1e-9), 0);
        unwindings += static_cast<int>(trace.unwindings.size());
      }
    }
  }
  EXPECT_GT(unwindings, 5);
}

TEST(Unwinding, IsNotAskedForWhereTheTurnOfCFits) {
  MachineModel model = limited(lai_machine(), -720, 720);
  model.pole_policy = PolePolicy::kExact;
  const double offset = units::rad_from_deg(1), tilt = units::rad_from_deg(15);
  std::vector<ClBlock> blocks;  // past the pole, and to a rest where C still turns fast
  for (int n = 0; n <= 18; ++n) {
    const double x = tilt * (1 - n / 17.5);
    blocks.push_back(leaning(std::hypot(x, offset), std::atan2(offset, x), Vector3(2.0 * n, 0, 0)));
    blocks.back().sequence = blocks.size() - 1;
  }
  const JointVector start = joints_of(model, blocks[0]);
  JointVector at = start;
  const double off = std::abs(solve_block(model, blocks[0], 0, start)[4] - start[4]);
  const int branch = off < 1e-9 ? 0 : 1;
  double low = start[3], high = start[3];
  for (const ClBlock& block : blocks) {
    at = solve_block(model, block, branch, at);
    low = std::min(low, at[3]);
    high = std::max(high, at[3]);
  }
  EXPECT_GT(high - low, 1.5);
  end_program(blocks);
  model.joints[3].limits.travel_min = low - units::rad_from_deg(0.3);
  model.joints[3].limits.travel_max = high + units::rad_from_deg(0.3);
  const SmoothTrace trace = plan_smooth(model, blocks, start);
  EXPECT_EQ(trace.last.status, PlanStatus::kOk) << trace.last.reject.value;
}

/// Onto 0.01 deg beside the pole, a rest there, and off again farther round, where C has no travel
/// left on the branch that it came on.
TEST(Unwinding, IsNotNeededWhereTheOtherBranchLeadsOffThePole) {
  const auto lean = [](double tilt_deg, double azimuth_deg, double x) {
    return leaning(units::rad_from_deg(tilt_deg), units::rad_from_deg(azimuth_deg), {x, 20, 0});
  };
  for (MachineModel model :
       {limited(lai_machine(), -400, 400), limited(fork_machine(), -400, 400)}) {
    for (const UnwindPolicy policy : {UnwindPolicy::kRefuse, UnwindPolicy::kRetract}) {
      for (const double farther_deg : {70.0, -70.0}) {
        SCOPED_TRACE(testing::Message() << model.name << " by " << farther_deg);
        std::vector<ClBlock> blocks;
        for (int n = 12; n >= 1; --n) blocks.push_back(lean(n, 80, 12 - n));
        blocks.push_back(lean(0.01, 80, 12));
        blocks.emplace_back().kind = BlockKind::kDwell;
        for (int n = 1; n <= 12; ++n) blocks.push_back(lean(n, 80 + farther_deg, 12 + n));
        for (std::size_t n = 0; n < blocks.size(); ++n) blocks[n].sequence = n;
        end_program(blocks);
        const int free = free_joint(model);
        const JointVector start = solve_block(model, blocks[0], 0);
        const double sign =
            solve_block(model, lean(12, 81, 0), 0, start)[free] > start[free] ? 1 : -1;
        const double end = start[free] + std::copysign(units::rad_from_deg(20), sign * farther_deg);
        const double other = end - std::copysign(units::rad_from_deg(200), sign * farther_deg);
        MachineModel turned = model;
        turned.unwind_policy = policy;
        turned.joints[free].limits.travel_min = std::min(end, other);
        turned.joints[free].limits.travel_max = std::max(end, other);
        const SmoothTrace trace = plan_smooth(turned, blocks, start, {Transition::kSmooth, 0, 0},
                                              policy == UnwindPolicy::kRefuse);
        Found found;
        judge(turned, trace, blocks, start, found);
        if (HasFatalFailure()) return;
        EXPECT_EQ(found.unwindings, 0);
        double told = 0;
        for (const PoleEase& ease : trace.eases) told = std::max(told, ease.deviation_rad);
        EXPECT_GE(told, units::rad_from_deg(0.0099)) << "C was turned beside the pole";
      }
    }
  }
}

TEST(Unwinding, IsRefusedWhereNoWindingCarriesTheBlock) {
  const MachineModel model = limited(lai_machine(), -100, 100);  // no whole turn inside travel
  for (const Transition transition : {Transition::kExactStop, Transition::kSmooth}) {
    const auto blocks =
        spiral(5, {3, transition == Transition::kSmooth ? 6.0 : 25.0, false, false});
    const JointVector start = joints_of(model, blocks[0]);
    const SmoothTrace trace = plan_smooth(model, blocks, start, {transition, 0, 0}, true);
    EXPECT_EQ(trace.last.status, PlanStatus::kRefused);
    EXPECT_EQ(trace.last.reject.code, RejectCode::kTravelBetween);
    EXPECT_EQ(trace.last.reject.joint, free_joint(model));
    EXPECT_TRUE(trace.unwindings.empty());
  }
}

TEST(Unwinding, IsNotMadeWhereTheMachineFileDoesNotSayHow) {
  MachineModel model = limited(lai_machine(), -720, 720);
  model.unwind_policy = UnwindPolicy::kRefuse;
  const auto blocks = spiral(1, {7, 25, false, false});
  const JointVector start = joints_of(model, blocks[0]);
  const SmoothTrace trace = plan_smooth(model, blocks, start, {Transition::kExactStop, 0, 0}, true);
  EXPECT_EQ(trace.last.status, PlanStatus::kRefused);
  EXPECT_EQ(trace.last.reject.code, RejectCode::kTravelBetween);
  EXPECT_EQ(trace.last.reject.joint, free_joint(model));
}

TEST(Unwinding, IsRefusedWhereTheToolCannotLeaveThePartSoFar) {
  MachineModel model = limited(fork_machine(), -360, 360);
  model.unwind_retract_mm = 1e4;  // farther than any slide goes
  const auto blocks = spiral(1, {7, 25, false, false});
  const JointVector start = joints_of(model, blocks[0]);
  const SmoothTrace trace = plan_smooth(model, blocks, start, {Transition::kExactStop, 0, 0}, true);
  EXPECT_EQ(trace.last.status, PlanStatus::kRefused);
  EXPECT_EQ(trace.last.reject.code, RejectCode::kTravelBetween);
  for (const PathPiece& path : trace.paths) EXPECT_NE(path.motion, MotionKind::kUnwind);
}

}  // namespace
}  // namespace meridian::test::unwind
