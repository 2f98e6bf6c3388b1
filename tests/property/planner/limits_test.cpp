// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "property/planner/plan_trace.hpp"
#include "property/planner/random_programs.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"

namespace meridian::test::limits {
namespace {

constexpr double kLimit = 1 + 1e-6;

/// Joints at plan time `t` of the time piece `n`.
JointVector joints_in(const MachineModel& model, const Trace& trace, std::size_t n, double t) {
  const TimePiece& time = trace.times[n];
  const PathPiece& path = trace.paths[n];
  const double s = state_at(time, t).s;
  JointVector reference{};
  for (int i = 0; i < kMaxJoints; ++i) {
    const double share = s / path.length;
    reference[i] = path.joints_begin[i] + share * (path.joints_end[i] - path.joints_begin[i]);
  }
  return joints_at(model, path, s, reference).q;
}

/// `count` setpoints from plan time `from` on.
std::vector<PlanSample> burst(const MachineModel& model, const Trace& trace,
                              const std::vector<double>& begins, double from, double cycle_s,
                              int count, const JointVector& start) {
  std::vector<PlanSample> out;
  std::size_t n = 0;
  for (int k = 0; k < count; ++k) {
    const double t = from + k * cycle_s;
    if (t < 0) {
      out.push_back({start, 0, 0});
      continue;
    }
    if (n == 0) {
      const auto at = std::upper_bound(begins.begin(), begins.end(), t);
      n = static_cast<std::size_t>(at - begins.begin());
    }
    while (n < begins.size() && begins[n] <= t) ++n;
    const double in = t - begins[n - 1];
    if (in >= trace.times[n - 1].duration) {
      out.push_back({trace.joints, static_cast<int>(n) - 1, 0});
    } else {
      out.push_back({joints_in(model, trace, n - 1, in), static_cast<int>(n) - 1, 0});
    }
  }
  return out;
}

struct Peaks {
  double v = 0, a = 0, j = 0, feed = 0, tip_mm = 0, axis_rad = 0;
  void take(const LimitUse& use) {
    v = std::max(v, use.v);
    a = std::max(a, use.a);
    j = std::max(j, use.j);
  }
  void take(const Deviation& d) {
    tip_mm = std::max(tip_mm, d.tip_mm);
    axis_rad = std::max(axis_rad, d.axis_rad);
  }
};

/// Checks a plan at the joints of its time pieces and at random places between.
void check(const MachineModel& model, const Trace& trace, const std::vector<ClBlock>& blocks,
           const JointVector& start, RandomPrograms& draw, Peaks& peaks) {
  std::vector<double> begins;
  double time = 0;
  for (const TimePiece& piece : trace.times) {
    begins.push_back(time);
    time += piece.duration;
  }
  const auto programmed = programmed_paths(blocks);
  for (std::size_t n = 0; n < begins.size(); ++n) {
    for (const double cycle : {1e-3, 250e-6}) {
      const bool at_joint = draw.chance(0.7);
      const double from = at_joint ? begins[n] - draw.uniform(0, 4) * cycle
                                   : begins[n] + draw.uniform(0, trace.times[n].duration);
      const auto setpoints = burst(model, trace, begins, from, cycle, 8, start);
      const LimitUse use = measure_limits(model, setpoints, cycle);
      ASSERT_LE(std::max({use.v, use.a, use.j}), kLimit)
          << use.where << " time piece " << n << " of sequence " << trace.times[n].sequence
          << " kind " << static_cast<int>(trace.paths[n].kind) << " v " << use.v << " a " << use.a
          << " j " << use.j << " cycle " << cycle;
      peaks.take(use);
      const double feed = measure_feed(model, trace, setpoints, cycle);
      ASSERT_LE(feed, kLimit) << "time piece " << n;
      peaks.feed = std::max(peaks.feed, feed);
      if (n % 8 == 0) peaks.take(measure_deviation(model, trace, setpoints, programmed, 8));
    }
  }
  ASSERT_LE(peaks.tip_mm, 1e-3);
  ASSERT_LE(units::deg_from_rad(peaks.axis_rad), 1e-3);
}

MachineModel draw_machine(RandomPrograms& draw) {
  MachineModel model = draw.chance(0.5) ? lai_machine() : bench_machine();
  if (draw.chance(0.4)) model.X_MW.rotation = draw.rotation(draw.chance(0.5) ? 0.3 : 3.0);
  if (draw.chance(0.5)) model.X_MW.origin_mm = {draw.uniform(-50, 50), draw.uniform(-50, 50), 20};
  if (draw.chance(0.5)) {  // other ratios of the limits make other terms the critical ones
    for (int group = 0; group < 2; ++group) {
      const double v = draw.log_uniform(0.3, 3), a = draw.log_uniform(0.2, 20),
                   j = draw.log_uniform(0.1, 30);
      for (int i = group == 0 ? 0 : 3; i < (group == 0 ? 3 : 5); ++i) {
        model.joints[i].limits.velocity *= v;
        model.joints[i].limits.acceleration *= a;
        model.joints[i].limits.jerk *= j;
      }
    }
  }
  return model;
}

/// A machine with any of the stages, whose drives are sometimes weaker than the joints.
MachineModel draw_hybrid(RandomPrograms& draw) {
  MachineModel model = hybrid_machine();
  if (draw.chance(0.3)) {
    model.stage.side2 = -1;  // scissor
    model.stage.rail_mm = 0;
    model.stage_drives[1].limits.travel_min = -400;
    model.stage_drives[1].limits.travel_max = 900;
  } else if (draw.chance(0.3)) {
    model.stage.kind = StageKind::kPinSlot;
  }
  for (JointSpec& drive : model.stage_drives) {
    drive.limits.velocity *= draw.log_uniform(0.3, 3);
    drive.limits.acceleration *= draw.log_uniform(0.2, 5);
    drive.limits.jerk *= draw.log_uniform(0.1, 10);
  }
  return model;
}

template <class DrawMachine>
void check_programs(int programs, std::uint64_t first_seed, DrawMachine draw_any) {
  int refusals = 0;
  Peaks peaks;
  std::size_t pieces = 0;
  double motion_s = 0;
  for (int n = 0; n < programs; ++n) {
    const auto seed = first_seed + static_cast<std::uint64_t>(n);
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomPrograms draw(seed);
    const MachineModel model = draw_any(draw);
    const auto blocks = draw.program(model, 4);
    const JointVector start = draw.start(model);
    const Trace trace = plan_program(model, blocks, start);
    if (trace.last.status == PlanStatus::kRefused) {
      ++refusals;
      ASSERT_TRUE(trace.last.reject.code == RejectCode::kTravelBetween ||
                  trace.last.reject.code == RejectCode::kTravel ||
                  trace.last.reject.code == RejectCode::kApproach ||
                  trace.last.reject.code == RejectCode::kAxisReversal)
          << static_cast<int>(trace.last.reject.code) << " joint " << trace.last.reject.joint
          << " value " << trace.last.reject.value << " sequence " << trace.last.reject.sequence;
    }
    pieces += trace.times.size();
    motion_s += trace.duration_s();
    check(model, trace, blocks, start, draw, peaks);
    if (testing::Test::HasFatalFailure()) return;
  }
  std::printf(
      "%d programs, %zu time pieces, %.0f s of motion; largest use v %.7f a %.7f j %.7f, feed "
      "%.7f, tip %.2e mm, axis %.2e deg; refused: %d\n",
      programs, pieces, motion_s, peaks.v, peaks.a, peaks.j, peaks.feed, peaks.tip_mm,
      units::deg_from_rad(peaks.axis_rad), refusals);
  EXPECT_LT(refusals, programs / 4) << "hardly anything was checked";
}

TEST(RestToRest, KeepsEveryLimitInTenThousandRandomPrograms) {
  check_programs(draws(10'000), 7000000, draw_machine);
}

TEST(RestToRest, KeepsEveryLimitOfJointsAndDrivesBehindAnyStage) {
  check_programs(draws(2000), 7200000, draw_hybrid);
}

}  // namespace
}  // namespace meridian::test::limits
