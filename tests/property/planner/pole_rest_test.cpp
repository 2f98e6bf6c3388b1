// SPDX-License-Identifier: Apache-2.0

/// From rest to rest beside the pole: what lies inside the axis tolerance about it takes no turn of
/// the redundant joint.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "property/planner/smooth_trace.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"
#include "support/program_end.hpp"

namespace meridian::test::pole_rest {
namespace {

constexpr double kLimit = 1 + 1e-6;

/// Cuts of 0.5 mm straight along x to the axes of which x and y are given.
class Program {
 public:
  void to(double x, double y) {
    const int n = static_cast<int>(blocks_.size());
    blocks_.push_back(cut_block(n, {{0.5 * n, 20, 30}, Vector3(x, y, 1).normalized()}));
  }
  void to_deg(double x_deg, double y_deg) {
    to(std::tan(units::rad_from_deg(x_deg)), std::tan(units::rad_from_deg(y_deg)));
  }
  [[nodiscard]] std::vector<ClBlock> whole() const {
    auto out = blocks_;
    end_program(out);
    return out;
  }

 private:
  std::vector<ClBlock> blocks_;
};

/// Axes drawn within `most_deg` of the pole.
std::vector<ClBlock> waver(int count, double max_deg) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> share(-1, 1);
  const double largest = units::rad_from_deg(max_deg) / std::sqrt(2.0);
  Program out;
  for (int n = 0; n < count; ++n) {
    const double x = largest * share(engine);
    out.to(x, largest * share(engine));
  }
  return out.whole();
}

/// Past the pole at `off_deg`, no block of it beside the pole.
std::vector<ClBlock> pass(double off_deg) {
  Program out;
  for (int n = -5; n <= 6; ++n) out.to_deg(n - 0.5, off_deg);
  return out.whole();
}

struct Cut {
  double time_s = 0, turn_rad = 0, off = 0;  ///< off: in tolerances
};

Cut cut(const MachineModel& model, const std::vector<ClBlock>& blocks) {
  const JointVector start = joints_of(model, blocks[0]);
  const SmoothTrace trace = plan_smooth(model, blocks, start, {Transition::kExactStop, 0, 0});
  EXPECT_EQ(trace.last.status, PlanStatus::kOk) << "block " << trace.last.reject.sequence;
  if (trace.times.empty()) return {};
  const auto setpoints = sample(model, trace, 1e-3, 0.37, start);
  const LimitUse use = measure_limits(model, setpoints, 1e-3);
  EXPECT_LE(std::max({use.v, use.a, use.j}), kLimit) << use.where;
  const auto paths = programmed_paths(blocks);
  const auto redundant = static_cast<std::size_t>(redundant_joint(model));
  Cut out;
  out.time_s = trace.duration_s();
  for (std::size_t n = 1; n < setpoints.size(); ++n) {
    out.turn_rad += std::abs(setpoints[n].q[redundant] - setpoints[n - 1].q[redundant]);
    const auto k = static_cast<std::size_t>(setpoints[n].piece);
    const bool is_cut =
        trace.times[k].kind == TimeKind::kMove && trace.paths[k].motion != MotionKind::kApproach;
    if (n % 7 != 0 || !is_cut) continue;
    const ToolPose pose = forward(model, trace.paths[k].tool_length_mm, setpoints[n].q);
    out.off = std::max(out.off, distance_from(paths, trace.times[k].sequence, pose,
                                              model.tolerances.tip_mm, model.tolerances.axis_rad));
  }
  return out;
}

TEST(PoleRest, AWaveringAxisTurnsTheRedundantJointNowhere) {
  for (const MachineModel& model : {bench_machine(), lai_machine()}) {
    const Cut at = cut(model, waver(kIsTimed ? 120 : 30, 0.09));
    std::printf("%s: %.3f s, C turns %.4f rad, %.3f tolerances\n", model.name.c_str(), at.time_s,
                at.turn_rad, at.off);
    EXPECT_LT(at.turn_rad, 1e-9);
    EXPECT_LE(at.off, kLimit);
  }
}

TEST(PoleRest, ABlockThatPassesInsideTheToleranceRunsThrough) {
  const MachineModel model = lai_machine();
  MachineModel exact = model;
  exact.pole_policy = PolePolicy::kExact;
  const Cut relaxed = cut(model, pass(0.05)), whole = cut(exact, pass(0.05));
  std::printf("past at 0.05 deg: %.3f s, C turns %.3f rad; exact %.3f s, %.3f rad\n",
              relaxed.time_s, relaxed.turn_rad, whole.time_s, whole.turn_rad);
  EXPECT_LT(relaxed.turn_rad, 0.5);
  EXPECT_LE(relaxed.off, kLimit);
  EXPECT_GT(whole.turn_rad, 2.5);
  EXPECT_LT(whole.off, 0.01);
  EXPECT_LT(relaxed.time_s, whole.time_s - 1);
}

TEST(PoleRest, WhatPassesFartherOffStaysExact) {
  EXPECT_LT(cut(lai_machine(), pass(0.12)).off, 0.01);
}

TEST(PoleRest, ATighterToleranceThanSmoothRunsHaveIsKept) {
  MachineModel model = lai_machine();
  model.tolerances.axis_rad = 0.2 * kMinAxisTolerance_rad;
  const double off_deg = units::deg_from_rad(0.5 * kMinAxisTolerance_rad);
  EXPECT_LT(cut(model, pass(off_deg)).off, 0.5);
}

TEST(PoleRest, WhereThePoleIsOutOfTravelTheProgrammedAxisIsFollowed) {
  MachineModel model = lai_machine();
  model.joints[4].limits.travel_min = units::rad_from_deg(0.02);
  Program blocks;
  for (int n = 0; n <= 40; ++n) blocks.to_deg(0.05 + 0.002 * n, 0.001 * n);
  const Cut at = cut(model, blocks.whole());
  EXPECT_GT(at.turn_rad, 0.1);
  EXPECT_LT(at.off, 0.01);
}

}  // namespace
}  // namespace meridian::test::pole_rest
