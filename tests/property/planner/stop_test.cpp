// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "meridian/cycle/stop/stop_law.hpp"
#include "meridian/cycle/stop/stop_margin.hpp"
#include "property/cycle/stop_oracle.hpp"
#include "property/planner/plan_trace.hpp"
#include "property/planner/random_programs.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"

/// The authority that the planner grants a stop: never more than the joints have, hardly less.
namespace meridian::test::stop {
namespace {

constexpr double kLimit = 1 + 1e-6;

JointVector reference_at(const PathPiece& path, double s) {
  JointVector out{};
  for (int i = 0; i < kMaxJoints; ++i) {
    out[i] = path.joints_begin[i] + s / path.length * (path.joints_end[i] - path.joints_begin[i]);
  }
  return out;
}

/// Setpoints of the plan up to the stop at `t` of time piece `n`, then of the stop.
std::vector<PlanSample> stop_samples(const MachineModel& model, const Trace& trace, std::size_t n,
                                     double t, const StopLaw& law, double cycle_s, double phase) {
  const PathPiece& path = trace.paths[n];
  std::vector<PlanSample> out;
  const auto add = [&](double s) {
    out.push_back({joints_at(model, path, s, reference_at(path, s)).q, static_cast<int>(n), s});
  };
  for (int k = 4; k >= 1; --k) {
    double before = t - (k - phase) * cycle_s;
    std::size_t m = n;
    while (before < 0 && m > 0 && trace.times[m - 1].kind == TimeKind::kMove &&
           trace.times[m - 1].path_index == trace.times[n].path_index) {
      before += trace.times[--m].duration;
    }
    add(before < 0 ? 0.0 : state_at(trace.times[m], before).s);
  }
  for (int k = 0; (k + phase) * cycle_s < law.duration() + 4 * cycle_s && k < 4000; ++k) {
    add(std::min(law.at((k + phase) * cycle_s).s, path.length));
  }
  return out;
}

ClBlock cut(std::uint64_t sequence, const Vector3& tip, const Vector3& axis) {
  ClBlock block;
  block.sequence = sequence;
  block.tip_mm = to_array(tip);
  block.axis = to_array(axis);
  block.feed = 50;
  block.feed_meaning = FeedMeaning::kTip;
  return block;
}

TEST(StopMargin, LeavesRoomForRoundingBesideThePole) {
  // From just outside the axis deviation, where C is made of the last digits of the axis, at 8 kHz.
  constexpr std::uint64_t kSeed = 4711;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  RandomPrograms draw(kSeed);
  constexpr double kCycle_s = 125e-6;
  double largest = 0;
  for (int n = 0; n < 60; ++n) {
    MachineModel model = lai_machine();
    model.cycle_ns = 125'000;
    model.X_MW.rotation = draw.rotation(1.0);
    const double distance = draw.log_uniform(8.01e-6, 1e-4);
    const double from = draw.chance(0.5) ? -draw.log_uniform(1e-5, 0.3) : draw.uniform(-1e-4, 1e-4);
    const double azimuth = draw.uniform(-3, 3);
    const auto beside = [&](double along) {
      const Vector3 axis = Vector3(std::sin(along), distance, std::cos(along)).normalized();
      const double c = std::cos(azimuth), s = std::sin(azimuth);
      const Vector3 turned(c * axis[0] - s * axis[1], s * axis[0] + c * axis[1], axis[2]);
      return Vector3(model.X_MW.rotation.transpose() * turned);
    };
    const Vector3 at(draw.uniform(-150, 150), draw.uniform(-150, 150), 20);
    const std::vector<ClBlock> blocks = {
        cut(0, at, beside(from)), cut(1, at + Vector3(3, 1, 0), beside(draw.uniform(0.01, 0.2)))};
    const JointVector start{0, 0, 0, 0.1, 0.2, 0};
    const Trace trace = plan_program(model, blocks, start);
    ASSERT_EQ(trace.last.status, PlanStatus::kOk);
    for (std::size_t k = 0; k < trace.times.size(); ++k) {
      const TimePiece& time = trace.times[k];
      if (time.sequence != 1 || trace.paths[k].kind == PathKind::kJoint) continue;
      const double t = draw.uniform(0, time.duration);
      const StopMargin authority = authority_of(time, StopKind::kHold, state_at(time, t));
      if (!(authority.jerk > 0)) continue;  // along the plan
      const StopLaw law(state_at(time, t), authority);
      const LimitUse use =
          measure_limits(model, stop_samples(model, trace, k, t, law, kCycle_s, 0.5), kCycle_s);
      ASSERT_LE(std::max({use.v, use.a, use.j}), kLimit) << n << ": " << use.where;
      largest = std::max(largest, use.j);
    }
  }
  std::printf("largest use of jerk %.4f\n", largest);
}

TEST(StopMargin, KeepsTheLimitsAndWastesLittleFromAnywhere) {
  constexpr int kPrograms = draws(1500);
  constexpr double kBetween_s = 0.1;  // instants, about
  double largest_use = 0, largest_ratio = 0, sum_ratio = 0;
  int stops = 0, slow = 0;
  for (int n = 0; n < kPrograms; ++n) {
    const auto seed = static_cast<std::uint64_t>(5200000 + n);
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomPrograms draw(seed);
    MachineModel model = draw.chance(0.5) ? lai_machine() : bench_machine();
    if (draw.chance(0.3)) model.X_MW.rotation = draw.rotation(0.5);
    const auto blocks = draw.program(model, 3);
    const Trace trace = plan_program(model, blocks, draw.start(model));
    for (std::size_t k = 0; k < trace.times.size(); ++k) {
      const TimePiece& time = trace.times[k];
      if (time.kind != TimeKind::kMove || !draw.chance(time.duration / kBetween_s)) continue;
      const double t = draw.uniform(0, time.duration);
      const PathState state = state_at(time, t);
      if (state.ds <= 0) continue;
      const StopMargin authority = authority_of(time, StopKind::kHold, state);
      const bool is_by_feed = is_by_feed_planner(time);   // its times: SmoothStop
      if (is_by_feed && !(authority.jerk > 0)) continue;  // along the plan
      const StopLaw law(state, authority);
      const PathPiece& path = trace.paths[k];
      ASSERT_LE(state.s + law.distance(), path.length * (1 + 1e-9) + 1e-12);
      const double cycle = draw.chance(0.5) ? 1e-3 : 250e-6;
      const auto setpoints = stop_samples(model, trace, k, t, law, cycle, draw.uniform(0, 1));
      const LimitUse use = measure_limits(model, setpoints, cycle);
      ASSERT_LE(std::max({use.v, use.a, use.j}), kLimit)
          << use.where << " time piece " << k << " of " << trace.times.size() << " v " << use.v
          << " a " << use.a << " j " << use.j << " cycle " << cycle;
      largest_use = std::max({largest_use, use.v, use.a, use.j});
      if (is_by_feed || path.motion == MotionKind::kApproach) continue;
      const double smallest = min_stopping_time(model, path, state, reference_at(path, state.s));
      const double ratio = std::max(0.0, law.duration() - 2e-3) / smallest;
      largest_ratio = std::max(largest_ratio, ratio);
      sum_ratio += law.duration() / smallest;
      ++stops;
      if (ratio > 1.25) ++slow;
    }
  }
  std::printf(
      "%d stops: largest use of a limit %.6f; time over the least time: mean %.3f, largest %.3f, "
      "%d above 1.25\n",
      stops, largest_use, sum_ratio / stops, largest_ratio, slow);
  // The oracle takes every curvature term as a help, which a stop of constant jerk cannot.
  EXPECT_LT(sum_ratio / stops, 1.06);
  EXPECT_LT(slow, stops / 500);
  EXPECT_LT(largest_ratio, 1.75);
}

}  // namespace
}  // namespace meridian::test::stop
