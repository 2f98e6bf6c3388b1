// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "meridian/cycle/rate_filter.hpp"
#include "meridian/planner/rate_limits.hpp"
#include "property/planner/plan_trace.hpp"
#include "property/planner/random_programs.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"

/// The reserve that every plan keeps for the rate at which the cycle runs through it.
namespace meridian::test::override {
namespace {

TEST(RateReserve, HoldsEveryLimitUnderRandomOverrides) {
  constexpr int kPrograms = draws(250);
  LimitUse peaks;
  double motion_s = 0;
  for (int n = 0; n < kPrograms; ++n) {
    const auto seed = static_cast<std::uint64_t>(6100000 + n);
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomPrograms draw(seed);
    const MachineModel model = draw.chance(0.5) ? lai_machine() : bench_machine();
    auto blocks = draw.program(model, 4);
    for (ClBlock& block : blocks) {
      if (block.feed_meaning == FeedMeaning::kTip) block.feed = draw.log_uniform(5, 300);
    }
    const JointVector start = draw.start(model);
    const Trace trace = plan_program(model, blocks, start);
    const double cycle = draw.chance(0.5) ? 1e-3 : 250e-6;
    RateFilter filter({kRateSlope_per_s, kRateCurvature_per_s2});
    filter.reset(1);
    std::vector<PlanSample> setpoints(3, PlanSample{start, 0, 0});
    JointVector reference = start;
    double t = 0;
    std::size_t k = 0;
    for (int c = 0; k < trace.times.size() && c < 12000; ++c) {
      while (k < trace.times.size() && t >= trace.times[k].duration) {
        const double end = state_at(trace.times[k], trace.times[k].duration).s;
        reference = joints_at(model, trace.paths[k], end, reference).q;
        t -= trace.times[k++].duration;
      }
      if (k == trace.times.size()) break;
      const double s = state_at(trace.times[k], t).s;
      reference = joints_at(model, trace.paths[k], s, reference).q;
      setpoints.push_back({reference, static_cast<int>(k), s});
      if (draw.chance(0.004)) filter.aim(draw.chance(0.3) ? 0.0 : draw.uniform(0, 1));
      if (filter.is_settled() && filter.rate() == 0) filter.aim(1);
      t += filter.advance(cycle);
    }
    const LimitUse use = measure_limits(model, setpoints, cycle);
    ASSERT_LE(std::max({use.v, use.a, use.j}), 1 + 1e-6) << use.where;
    peaks.v = std::max(peaks.v, use.v);
    peaks.a = std::max(peaks.a, use.a);
    peaks.j = std::max(peaks.j, use.j);
    motion_s += static_cast<double>(setpoints.size()) * cycle;
  }
  std::printf("%d programs, %.0f s under override: largest use v %.5f a %.5f j %.5f\n", kPrograms,
              motion_s, peaks.v, peaks.a, peaks.j);
}

}  // namespace
}  // namespace meridian::test::override
