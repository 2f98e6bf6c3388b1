// SPDX-License-Identifier: Apache-2.0

/// What relaxing beside the pole costs and gains: the tables of docs/motion.md, section 10.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "property/planner/smooth_trace.hpp"
#include "property/planner/winding_programs.hpp"
#include "support/family_machines.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::pole_table {
namespace {

constexpr double kLimit = 1 + 1e-6;

/// 60 mm straight at 100 mm/s, the axis in 1 deg steps on a great circle past the pole at
/// `distance_deg`.
std::vector<ClBlock> pass_at(double distance_deg) {
  std::vector<ClBlock> blocks;
  for (int n = 0; n <= 30; ++n) {
    const double along = units::rad_from_deg(n - 15.0), off = units::rad_from_deg(distance_deg);
    ClBlock block;
    block.sequence = blocks.size();
    block.line = 100 + static_cast<std::uint32_t>(n);
    block.tip_mm = {2.0 * n - 30, 20, 30};
    const Vector3 axis(std::sin(along) * std::cos(off), std::sin(off),
                       std::cos(along) * std::cos(off));
    block.axis = to_array(axis);
    block.feed = 100;
    block.feed_meaning = FeedMeaning::kTip;
    blocks.push_back(block);
  }
  end_program(blocks);
  return blocks;
}

struct Pass {
  double time_s = 0, peak_deg_per_s = 0;
  double off_deg = 0;       ///< of the axis across its programmed way, at the setpoints
  double reported_deg = 0;  ///< by the planner, smoothing included
  std::vector<RelaxedAxis> relaxed_axes;
};

/// Plans, checks the limits, and measures.
Pass pass(const MachineModel& model, double distance_deg) {
  constexpr double kCycle = 250e-6;
  const auto blocks = pass_at(distance_deg);
  const JointVector start = joints_of(model, blocks[0]);
  const SmoothTrace trace = plan_smooth(model, blocks, start);
  EXPECT_EQ(trace.last.status, PlanStatus::kOk);
  const auto setpoints = sample(model, trace, kCycle, 0.37, start);
  const LimitUse use = measure_limits(model, setpoints, kCycle);
  EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where;
  Pass out;
  out.time_s = trace.duration_s();
  out.relaxed_axes = trace.relaxed_axes;
  for (const RelaxedAxis& relaxed_axis : trace.relaxed_axes) {
    out.reported_deg = std::max(out.reported_deg, units::deg_from_rad(relaxed_axis.deviation_rad));
  }
  const auto programmed = programmed_paths(blocks);
  const int free = redundant_joint(model);
  for (std::size_t n = 1; n < setpoints.size(); ++n) {
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    if (trace.times[k].kind != TimeKind::kMove) continue;
    const double rate = std::abs(setpoints[n].q[free] - setpoints[n - 1].q[free]) / kCycle;
    out.peak_deg_per_s = std::max(out.peak_deg_per_s, units::deg_from_rad(rate));
    if (n % 5 != 0) continue;
    const ToolPose pose = forward(model, trace.paths[k].tool_length_mm, setpoints[n].q);
    const double off = distance_from(programmed, trace.times[k].sequence, pose, 1e9, 1);
    out.off_deg = std::max(out.off_deg, units::deg_from_rad(off));
  }
  return out;
}

/// As CAM writes it: an axis of nine decimals.
Vector3 printed(const Vector3& axis) {
  return Vector3(std::round(axis.x() * 1e9), std::round(axis.y() * 1e9),
                 std::round(axis.z() * 1e9)) /
         1e9;
}

TEST(PoleTable, DenseBlocksOverThePoleAreCutWhateverTheirStep) {
  for (const MachineModel& model :
       {bench_machine(), lai_machine(), limited(trunnion_machine(), -720, 720),
        limited(fork_machine(), -720, 720)}) {
    for (const double step_deg : {0.0005, 0.003, 0.005, 0.01, 0.05}) {
      for (const double offset_deg : {0.0, 0.005}) {
        SCOPED_TRACE(testing::Message() << model.name << " " << step_deg << " " << offset_deg);
        const double largest = 12 * step_deg, off = units::rad_from_deg(offset_deg);
        std::vector<double> along{-1};
        for (double at = -largest; at < largest; at += step_deg) along.push_back(at + 0.0001);
        along.push_back(1);
        std::vector<ClBlock> blocks;
        for (const double at_deg : along) {
          const double at = units::rad_from_deg(at_deg);
          const Vector3 across(0.6, 0.8, 0), side(-0.8, 0.6, 0);
          ClBlock block;
          block.sequence = blocks.size();
          block.tip_mm = {0.3 * static_cast<double>(blocks.size()), 20, 30};
          block.axis = to_array(
              printed(std::cos(off) * (std::sin(at) * across + std::cos(at) * Vector3::UnitZ()) +
                      std::sin(off) * side));
          block.feed = 100;
          block.feed_meaning = FeedMeaning::kTip;
          blocks.push_back(block);
        }
        end_program(blocks);
        const JointVector start = joints_of(model, blocks[0]);
        const SmoothTrace trace = plan_smooth(model, blocks, start);
        EXPECT_EQ(trace.last.status, PlanStatus::kOk)
            << "block " << trace.last.reject.sequence << " joint " << trace.last.reject.joint
            << " by " << trace.last.reject.value;
      }
    }
  }
}

/// What relaxes the axis leaves the tip where the smoothed path has it: to rounding.
TEST(PoleTable, TheTipIsOnTheSmoothedPathEasedOrNot) {
  constexpr double kRounding_mm = 1e-9;
  for (const MachineModel& model :
       {bench_machine(), lai_machine(), limited(trunnion_machine(), -720, 720),
        limited(fork_machine(), -720, 720)}) {
    int relaxed = 0, exact = 0;
    double farthest_mm = 0;
    for (const double distance_deg : {0.0, 0.05, 0.5}) {
      const auto blocks = pass_at(distance_deg);
      const JointVector start = joints_of(model, blocks[0]);
      const SmoothTrace trace = plan_smooth(model, blocks, start);
      ASSERT_EQ(trace.last.status, PlanStatus::kOk);
      for (const PlanSample& one : sample(model, trace, 1e-3, 0.37, start)) {
        const auto k = static_cast<std::size_t>(one.piece);
        const PathPiece& path = trace.paths[k];
        if (trace.times[k].kind != TimeKind::kMove || path.kind != PathKind::kSpline) continue;
        const Vector3 tip = forward(model, path.tool_length_mm, one.q).tip;
        farthest_mm = std::max(farthest_mm, (tip - pose_at(path, one.s).tip).norm());
        ++(path.is_free_driven ? relaxed : exact);
      }
    }
    EXPECT_LT(farthest_mm, kRounding_mm) << model.name;
    EXPECT_GT(std::min(relaxed, exact), 50) << model.name;
    std::printf(
        "%s: tip at most %.1e mm off the smoothed path at %d setpoints, %d of them relaxed\n",
        model.name.c_str(), farthest_mm, relaxed + exact, relaxed);
  }
}

TEST(PoleTable, TheToleranceThatAProgramAsksForHoldsBesideThePole) {
  MachineModel model = bench_machine();
  model.tolerances.pole_axis_rad = units::rad_from_deg(0.12);
  const auto blocks = pass_at(0.05);
  const double asked = units::rad_from_deg(0.02);
  const SmoothTrace trace =
      plan_smooth(model, blocks, joints_of(model, blocks[0]), {Transition::kSmooth, 0, asked});
  EXPECT_EQ(trace.last.status, PlanStatus::kOk);
  for (const RelaxedAxis& relaxed_axis : trace.relaxed_axes)
    EXPECT_LE(relaxed_axis.deviation_rad, asked * kLimit);
}

TEST(PoleTable, PassesInsideTheToleranceTakeTheSameTimeAndEaseByTheirDistance) {
  for (const MachineModel& model : {bench_machine(), lai_machine()}) {
    double straight_s = 0;
    for (const double distance_deg : {0.0, 1e-6, 0.01, 0.05, 0.099}) {
      SCOPED_TRACE(testing::Message() << model.name << " at " << distance_deg << " deg");
      const Pass at = pass(model, distance_deg);
      std::printf("%s, passed at %.6f deg: %.3f s, C %.1f deg/s, axis %.4f deg off (told %.4f)\n",
                  model.name.c_str(), distance_deg, at.time_s, at.peak_deg_per_s, at.off_deg,
                  at.reported_deg);
      if (distance_deg == 0) straight_s = at.time_s;
      EXPECT_LT(at.time_s, 1.1 * straight_s);
      EXPECT_LE(at.off_deg, distance_deg + 1e-3);
      ASSERT_EQ(at.relaxed_axes.size(), 1U);
      EXPECT_GE(at.reported_deg, at.off_deg - 1e-6);
      EXPECT_LE(at.reported_deg, 0.1);
      EXPECT_EQ(at.relaxed_axes[0].reason, RelaxedReason::kThrough);
      EXPECT_LE(at.relaxed_axes[0].first_line, 115U);  // the pole is at the end of line 115
      EXPECT_GE(at.relaxed_axes[0].last_line, 115U);
    }
  }
}

/// The exact policy keeps the joints on the path, whatever it costs.
TEST(PoleTable, TheExactPolicyNeverEasesAndKeepsEveryLimit) {
  MachineModel model = bench_machine();
  model.pole_policy = PolePolicy::kExact;
  for (const double distance_deg : {0.0, 1e-6, 0.01, 0.05, 0.099, 1.0}) {
    SCOPED_TRACE(testing::Message() << "at " << distance_deg << " deg");
    const Pass at = pass(model, distance_deg);
    std::printf("exact, passed at %.6f deg: %.3f s, C %.1f deg/s, axis %.6f deg off\n",
                distance_deg, at.time_s, at.peak_deg_per_s, at.off_deg);
    EXPECT_LE(at.reported_deg, units::deg_from_rad(kPoleDeviation_rad));
    EXPECT_LT(at.off_deg, 1e-3);  // of a straight way smoothing leaves that
    EXPECT_GT(at.peak_deg_per_s, distance_deg > 1e-3 ? 50 : -1);
  }
}

TEST(PoleTable, ShowsWhatAToleranceGains) {
  double before_s = 1e9;
  for (const double tolerance_deg : {0.0, 0.05, 0.1, 0.5}) {
    MachineModel model = bench_machine();
    if (tolerance_deg == 0) {
      model.pole_policy = PolePolicy::kExact;
    } else {
      model.tolerances.axis_rad = units::rad_from_deg(tolerance_deg);
    }
    for (const double distance_deg : {0.049, 0.2}) {
      const Pass at = pass(model, distance_deg);
      std::printf("tolerance %.2f deg, passed at %.3f deg: C %.1f deg/s, %.4f deg off, %.3f s\n",
                  tolerance_deg, distance_deg, at.peak_deg_per_s, at.off_deg, at.time_s);
      EXPECT_LE(at.off_deg, std::max(tolerance_deg, 1e-3));
      if (distance_deg > 0.1) continue;
      EXPECT_LE(at.time_s, 1.02 * before_s);
      before_s = at.time_s;
    }
  }
}

}  // namespace
}  // namespace meridian::test::pole_table
