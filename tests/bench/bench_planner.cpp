// SPDX-License-Identifier: Apache-2.0
// Throughput of the planner: bench_planner --benchmark_repetitions=5
#include <benchmark/benchmark.h>

#include "bench/planner_workload.hpp"

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
}
BENCHMARK(RestToRestBlocks)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace meridian

BENCHMARK_MAIN();
