// SPDX-License-Identifier: Apache-2.0
// Time of the kinematics per pose: bench_kinematics --benchmark_repetitions=9
#include <benchmark/benchmark.h>

#include "bench/ik_workload.hpp"
#include "service/host/probe/budgets.hpp"

namespace meridian {
namespace {

constexpr double kTool_mm = 110.0;

/// A budget's figure: one pose, branch and winding chosen, each solve following the one before.
void inverse_of_the_path(benchmark::State& state, std::uint64_t (*run)(int) noexcept,
                         const char* budget) {
  for (auto _ : state) benchmark::DoNotOptimize(run(bench::kPoses));
  state.SetItemsProcessed(state.iterations() * bench::kPoses);
  state.counters["ns_per_pose"] = benchmark::Counter(
      static_cast<double>(bench::kPoses),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.SetLabel("ns_per_pose " + bound_text(probe::load_budget(budget)));
}
BENCHMARK_CAPTURE(inverse_of_the_path, Lai, bench::run_inverse_kinematics,
                  "inverse_kinematics_lai");
BENCHMARK_CAPTURE(inverse_of_the_path, AnyChain, bench::run_chain, "inverse_kinematics_family");
BENCHMARK_CAPTURE(inverse_of_the_path, Robot5R, bench::run_robot_5r, "inverse_kinematics_robot");
BENCHMARK_CAPTURE(inverse_of_the_path, Robot6R, bench::run_robot_6r, "inverse_kinematics_robot");

void Forward(benchmark::State& state) {
  const MachineModel model = test::lai_machine();
  JointVector q{10, 20, 30, 0.4, 0.5};
  for (auto _ : state) {
    benchmark::DoNotOptimize(q);
    benchmark::DoNotOptimize(forward(model, kTool_mm, q));
  }
}
BENCHMARK(Forward);

/// The inverse with its first N derivatives along the path, as cycle (1) and planner (3) call it.
template <int N>
void InverseInJets(benchmark::State& state) {
  const MachineModel model = test::lai_machine();
  const ToolPose a = bench::pose_on_path(3);
  Pose<Jet<N>> pose;
  for (int k = 0; k < 3; ++k) {
    pose.tip[k] = Jet<N>::with_derivative(a.tip[k], 0.3 + k);
    pose.axis[k] = Jet<N>::with_derivative(a.axis[k], 0.01 * k);
  }
  const JointVector reference{};
  for (auto _ : state) {
    benchmark::DoNotOptimize(pose);
    benchmark::DoNotOptimize(solve(model, kTool_mm, pose, 0, reference));
  }
}
BENCHMARK_TEMPLATE(InverseInJets, 1);
BENCHMARK_TEMPLATE(InverseInJets, 3);

void OnThePole(benchmark::State& state) {
  const MachineModel model = test::lai_machine();
  ToolPose pose{{10, 20, 30}, {0, 0, 1}};
  JointVector reference{0, 0, 0, 1.3, 0};
  for (auto _ : state) {
    benchmark::DoNotOptimize(pose);
    benchmark::DoNotOptimize(solve(model, kTool_mm, pose, 0, reference));
  }
}
BENCHMARK(OnThePole);

}  // namespace
}  // namespace meridian

BENCHMARK_MAIN();
