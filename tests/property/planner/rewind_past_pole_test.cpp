// SPDX-License-Identifier: Apache-2.0

/// C comes to its end of travel on the way past the pole: a rewind only where none of the ways
/// past it does without.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "property/planner/checked_rewinds.hpp"
#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::rewinds {
namespace {

TEST(Rewind, FindsTheWayPastThePoleBehindItOnTheWindingThatHoldsThere) {
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
    EXPECT_EQ(trace.rewinds.size(), 1U);
    EXPECT_FALSE(trace.relaxed_axes.empty());
    for (const RelaxedAxis& relaxed_axis : trace.relaxed_axes)
      EXPECT_LE(relaxed_axis.deviation_rad, model.tolerances.axis_rad);
    EXPECT_LT(trace.duration_s(), 20);
    std::printf("%.0f: %.3f s, %zu rewinds, %zu relaxed\n", side, trace.duration_s(),
                trace.rewinds.size(), trace.relaxed_axes.size());
  }
}

/// Wherever C comes to its end of travel on the way past the pole: also so that the closest place
/// is just behind the rewind.
TEST(Rewind, CutsOnWhereverItComesOnTheWayPastThePole) {
  const MachineModel model = limited(lai_machine(), -200, 200);
  const double tilt = units::rad_from_deg(8);
  int rewinds = 0;
  for (const PolePolicy policy : {PolePolicy::kExact, PolePolicy::kRelax}) {
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
        rewinds += static_cast<int>(trace.rewinds.size());
      }
    }
  }
  EXPECT_GT(rewinds, 5);
}

TEST(Rewind, IsNotAskedForWhereTheTurnOfCFits) {
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
TEST(Rewind, IsNotNeededWhereTheOtherBranchLeadsOffThePole) {
  const auto lean = [](double tilt_deg, double azimuth_deg, double x) {
    return leaning(units::rad_from_deg(tilt_deg), units::rad_from_deg(azimuth_deg), {x, 20, 0});
  };
  for (MachineModel model :
       {limited(lai_machine(), -400, 400), limited(fork_machine(), -400, 400)}) {
    for (const RewindPolicy policy : {RewindPolicy::kRefuse, RewindPolicy::kRetract}) {
      for (const double farther_deg : {70.0, -70.0}) {
        SCOPED_TRACE(testing::Message() << model.name << " by " << farther_deg);
        std::vector<ClBlock> blocks;
        for (int n = 12; n >= 1; --n) blocks.push_back(lean(n, 80, 12 - n));
        blocks.push_back(lean(0.01, 80, 12));
        blocks.emplace_back().kind = BlockKind::kDwell;
        for (int n = 1; n <= 12; ++n) blocks.push_back(lean(n, 80 + farther_deg, 12 + n));
        number_and_end(blocks);
        const int free = redundant_joint(model);
        const JointVector start = solve_block(model, blocks[0], 0);
        const double sign =
            solve_block(model, lean(12, 81, 0), 0, start)[free] > start[free] ? 1 : -1;
        const double end = start[free] + std::copysign(units::rad_from_deg(20), sign * farther_deg);
        const double other = end - std::copysign(units::rad_from_deg(200), sign * farther_deg);
        MachineModel turned = model;
        turned.rewind_policy = policy;
        turned.joints[free].limits.travel_min = std::min(end, other);
        turned.joints[free].limits.travel_max = std::max(end, other);
        const SmoothTrace trace = plan_smooth(turned, blocks, start, {Transition::kSmooth, 0, 0},
                                              policy == RewindPolicy::kRefuse);
        Found found;
        check(turned, trace, blocks, start, found);
        if (HasFatalFailure()) return;
        EXPECT_EQ(found.rewinds, 0);
        double reported = 0;
        for (const RelaxedAxis& relaxed_axis : trace.relaxed_axes)
          reported = std::max(reported, relaxed_axis.deviation_rad);
        EXPECT_GE(reported, units::rad_from_deg(0.0099)) << "C was turned beside the pole";
      }
    }
  }
}

}  // namespace
}  // namespace meridian::test::rewinds
