// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "property/cycle/program_run.hpp"
#include "property/cycle/stop_oracle.hpp"
#include "property/planner/plan_trace.hpp"
#include "service/host/probe/budgets.hpp"
#include "support/draws.hpp"

/// Holds at any instant of random programs against the least time that the path allows.
namespace meridian::test::stopping_time {
namespace {

using test::Draw;
using test::ProgramRun;

constexpr std::uint64_t kSeed = 20240620;
constexpr int kPrograms = test::draws(60);  // or as many as MERIDIAN_HOLD_PROGRAMS says
constexpr double kMaxSeconds = 40;          // of motion per program

TEST(StoppingTime, IsWithinAQuarterOfTheLeastTime) {
  const std::uint64_t seed = test::number_of("MERIDIAN_HOLD_SEED", kSeed + 1000);
  const auto programs = static_cast<int>(test::number_of("MERIDIAN_HOLD_PROGRAMS", kPrograms));
  std::cout << "seed " << seed << "\n";
  const probe::Budget budget = probe::load_budget("stop_time");             // in cycles
  const probe::Budget late_share = probe::load_budget("smooth_stop_late");  // in percent
  const probe::Budget late_by = probe::load_budget("smooth_stop_late_by");  // in s
  std::vector<double> ratios, shaped;  // shaped by the feed planner: time beyond the budget
  for (int n = 0; n < programs; ++n) {
    Draw draw(seed + static_cast<std::uint64_t>(n));
    ProgramRun run(draw.machine, draw.blocks, draw.start());
    if (!run.is_started()) continue;
    const double dt = run.world.dt();
    double next = draw.random.uniform(0, 0.2);
    for (double t = 0; t < kMaxSeconds && !run.is_over(); t += dt) {
      if (t < next || !is_on_path(run.world.now()) || run.world.reader.path() == nullptr) {
        run.run();
        continue;
      }
      next = t + draw.random.log_uniform(0.02, 0.5);
      const PathPiece path = *run.world.reader.path();
      const bool is_by_feed = test::is_by_feed_planner(*run.world.reader.piece());
      const PathState begin = run.world.state.on_path;
      const JointVector joints = run.world.state.joints;
      run.command(Verb::kHold);
      ASSERT_TRUE(run.world.run_until(State::kHeld, 10));
      const double taken = static_cast<double>(run.world.last(EventCode::kStopped).a) * 1e-9;
      run.command(Verb::kResume);
      if (begin.ds <= 1e-3 || path.kind == PathKind::kJoint) continue;
      const double min = test::min_stopping_time(draw.machine, path, begin, joints);
      if (is_by_feed) {
        shaped.push_back(taken - budget.plus * dt - budget.factor * min);
        continue;
      }
      ratios.push_back((taken - budget.plus * dt) / min);
      if (ratios.back() > budget.factor) {
        std::printf("program %d: %.4f s, least %.4f s, v %.3f a %.1f s %.3f of %.3f kind %d\n", n,
                    taken, min, begin.ds, begin.dds, begin.s, path.length,
                    static_cast<int>(path.kind));
      }
    }
  }
  std::sort(ratios.begin(), ratios.end());
  ASSERT_GT(ratios.size(), 100u);
  std::printf("%zu stops, (time - 2 cycles)/least: median %.3f, 99 %% %.3f, worst %.3f\n",
              ratios.size(), ratios[ratios.size() / 2], ratios[ratios.size() * 99 / 100],
              ratios.back());
  EXPECT_LE(ratios.back(), budget.factor);
  // Where limits change along a leg the plan brakes with all that they give at each point: a hold
  // of constant jerk may follow it first, as on smooth plans, and has their budgets.
  std::sort(shaped.begin(), shaped.end());
  ASSERT_GT(shaped.size(), 100u);
  const auto late = shaped.end() - std::upper_bound(shaped.begin(), shaped.end(), 0.0);
  const double late_percent =
      100.0 * static_cast<double>(late) / static_cast<double>(shaped.size());
  std::printf("%zu stops on legs of the feed planner: %.1f %% late, by %.3f s at most\n",
              shaped.size(), late_percent, shaped.back());
  EXPECT_TRUE(late_share.is_kept(late_percent));
  EXPECT_TRUE(late_by.is_kept(shaped.back()));
}

}  // namespace
}  // namespace meridian::test::stopping_time
