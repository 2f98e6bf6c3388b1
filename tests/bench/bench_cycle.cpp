// SPDX-License-Identifier: Apache-2.0
// Time of one cycle while the machine cuts: bench_cycle --benchmark_repetitions=9
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "bench/cycle_workload.hpp"

namespace meridian {
namespace {

/// The mean of one cycle: evaluate, inverse kinematics, guard, record.
void OneCycle(benchmark::State& state) {
  bench::RunningCycle cycle;
  int until_look = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(cycle.run());
    if (++until_look == 1000) {
      until_look = 0;
      if (cycle.needs_plan()) {
        state.PauseTiming();
        cycle.plan();
        state.ResumeTiming();
      }
    }
  }
  if (cycle.state() != State::kRunning) {
    state.SkipWithError("the machine does not cut");
  }
}
BENCHMARK(OneCycle);

/// Percentiles of single cycles, clock included (about 20 ns).
void CyclePercentiles(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  bench::RunningCycle cycle;
  std::vector<double> times_ns;
  for (auto _ : state) {
    for (int i = 0; i < 20000; ++i) {
      const auto begin = Clock::now();
      benchmark::DoNotOptimize(cycle.run());
      times_ns.push_back(std::chrono::duration<double, std::nano>(Clock::now() - begin).count());
      if (cycle.needs_plan()) {
        cycle.plan();
      }
    }
  }
  std::sort(times_ns.begin(), times_ns.end());
  const auto at = [&](double share) {
    return times_ns[static_cast<std::size_t>(share * static_cast<double>(times_ns.size() - 1))];
  };
  state.counters["p50_ns"] = at(0.5);
  state.counters["p99_ns"] = at(0.99);
  state.counters["p99.9_ns"] = at(0.999);
  state.counters["samples"] = static_cast<double>(times_ns.size());
}
BENCHMARK(CyclePercentiles)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace meridian

BENCHMARK_MAIN();
