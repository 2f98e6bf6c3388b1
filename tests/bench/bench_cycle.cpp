// SPDX-License-Identifier: Apache-2.0
// Time of one cycle while the machine cuts, and of a setpoint on a smooth path:
// bench_cycle --benchmark_repetitions=9
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "bench/cycle_workload.hpp"
#include "bench/setpoint_workload.hpp"
#include "service/host/probe/budgets.hpp"

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
  state.SetLabel("p50 " + bound_text(probe::load_budget("cycle_computation_p50")) + ", p99.9 " +
                 bound_text(probe::load_budget("cycle_computation_p999")));
}
BENCHMARK(CyclePercentiles)->Unit(benchmark::kMillisecond);

/// Medians over batches that take turns: a setpoint on a smooth path (time law, spline, joints and
/// velocities), the bare inverse kinematics of its pose, and what the one takes on top of the
/// other.
void SetpointOnTopOfInverse(benchmark::State& state, bench::SetpointsOf what) {
  using Clock = std::chrono::steady_clock;
  constexpr int kBatch = 500;
  const bench::Setpoints setpoints(what);
  if (setpoints.size() < 100) return state.SkipWithError("no setpoints");
  std::vector<double> whole_ns, inverse_ns, on_top_ns;
  for (auto _ : state) {
    const auto begin = Clock::now();
    benchmark::DoNotOptimize(setpoints.evaluate(kBatch));
    const auto middle = Clock::now();
    benchmark::DoNotOptimize(setpoints.solve_poses(kBatch));
    const std::chrono::duration<double, std::nano> whole = middle - begin,
                                                   inverse = Clock::now() - middle;
    whole_ns.push_back(whole.count() / kBatch);
    inverse_ns.push_back(inverse.count() / kBatch);
    on_top_ns.push_back((whole - inverse).count() / kBatch);
  }
  const auto median = [](std::vector<double>& times) {
    std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2),
                     times.end());
    return times[times.size() / 2];
  };
  state.counters["setpoint_ns"] = median(whole_ns);
  state.counters["inverse_ns"] = median(inverse_ns);
  state.counters["on_top_ns"] = median(on_top_ns);
  state.SetLabel("on top " + bound_text(probe::load_budget("setpoint_evaluation")));
}
BENCHMARK_CAPTURE(SetpointOnTopOfInverse, Spline, bench::SetpointsOf::kSpline);
BENCHMARK_CAPTURE(SetpointOnTopOfInverse, BesideThePole, bench::SetpointsOf::kPole);

}  // namespace
}  // namespace meridian

BENCHMARK_MAIN();
