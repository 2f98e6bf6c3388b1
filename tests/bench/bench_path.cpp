// SPDX-License-Identifier: Apache-2.0
// Cost of the band spline per block and per control point: bench_path --benchmark_repetitions=5
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "meridian/path/band_spline.hpp"

namespace meridian {
namespace {

/// Five-axis blocks `step_mm` long along a curved pass.
std::vector<ClBlock> make_pass(std::size_t count, double step_mm) {
  std::vector<ClBlock> blocks(count);
  for (std::size_t n = 0; n < count; ++n) {
    const double x = step_mm * static_cast<double>(n);
    const double tilt = 0.35 + 0.14 * std::sin(x / 9), turn = 0.7 + 0.35 * std::sin(x / 11);
    ClBlock& block = blocks[n];
    block.sequence = n;
    block.tip_mm = {30 * std::sin(x / 30), -30 * std::cos(x / 30), 3 * std::sin(x / 8)};
    block.axis = {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)};
    block.feed = 50;
    block.feed_meaning = FeedMeaning::kTip;
  }
  return blocks;
}

/// Argument: length of the blocks, µm.
void BandSplineBlocks(benchmark::State& state) {
  const auto blocks = make_pass(20000, 1e-3 * static_cast<double>(state.range(0)));
  BandSpline spline;
  for (auto _ : state) {
    spline.begin({to_vector(blocks[0].tip_mm), to_vector(blocks[0].axis)}, {});
    std::size_t spans = 0;
    for (std::size_t n = 1; n < blocks.size(); ++n) {
      if (!spline.push(blocks[n])) return state.SkipWithError("no room");
      while (spline.next() != nullptr) ++spans;
    }
    spline.finish();
    while (spline.next() != nullptr) ++spans;
    benchmark::DoNotOptimize(spans);
  }
  using benchmark::Counter;
  const double points = static_cast<double>(spline.statistics().control_points);
  const auto time_per = Counter::kIsRate | Counter::kInvert;
  state.counters["s_per_block"] = Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(blocks.size()), time_per);
  state.counters["s_per_control_point"] = Counter(points, time_per);
}
BENCHMARK(BandSplineBlocks)->Arg(2)->Arg(20)->Arg(300)->Arg(2000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace meridian

BENCHMARK_MAIN();
