// SPDX-License-Identifier: Apache-2.0
// Throughput of the planner: bench_planner --benchmark_repetitions=5
#include <benchmark/benchmark.h>

#include "bench/planner_workload.hpp"
#include "bench/smooth_workload.hpp"
#include "service/host/probe/budgets.hpp"

namespace meridian {
namespace {

/// Blocks per second of CPU, and motion planned per second of CPU, on 3 mm cuts from rest to rest.
void RestToRestBlocks(benchmark::State& state) {
  constexpr int kBlocks = 2000;
  double planned_s = 0;
  for (auto _ : state) {
    const std::uint64_t planned_us = bench::run_planner(kBlocks);
    if (planned_us == 0) {
      state.SkipWithError("a block was refused");
      return;
    }
    planned_s += 1e-6 * static_cast<double>(planned_us);
  }
  state.SetItemsProcessed(state.iterations() * kBlocks);
  state.counters["motion_s_per_s"] = benchmark::Counter(planned_s, benchmark::Counter::kIsRate);
  state.SetLabel("motion " + bound_text(probe::load_budget("planner_motion")));
}
BENCHMARK(RestToRestBlocks)->Unit(benchmark::kMillisecond);

/// Dense five-axis data run on smoothly; argument: length of the blocks, µm.
void SmoothBlocks(benchmark::State& state) {
  const double step = 1e-3 * static_cast<double>(state.range(0));
  const auto blocks = bench::dense_blocks(static_cast<int>(120 / step), step, 50);
  const auto windows = std::make_unique<bench::SmoothWindows>(test::bench_machine());
  double motion_s = 0;
  for (auto _ : state) {
    bench::SmoothTotal total;
    windows->run(blocks, total);
    if (total.has_failed) return state.SkipWithError("a block was refused");
    for (const auto& window : total.windows) motion_s += window.motion_s;
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(blocks.size()));
  state.counters["motion_s_per_s"] = benchmark::Counter(motion_s, benchmark::Counter::kIsRate);
  constexpr double kDense_mm = 0.05;  // up to there the budget counts blocks, else motion
  state.SetLabel(step <= kDense_mm ? "items " + bound_text(probe::load_budget("planner_blocks"))
                                   : "motion " + bound_text(probe::load_budget("planner_motion")));
}
BENCHMARK(SmoothBlocks)->Arg(2)->Arg(50)->Arg(300)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace meridian

BENCHMARK_MAIN();
