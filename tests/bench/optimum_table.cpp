// SPDX-License-Identifier: Apache-2.0

/// optimum_table [FIRST_SEED [PROGRAMS]]: what smooth paths take over the least time that there is,
/// of the benchmark paths and of short drawn programs; and smooth over exact stop at sharp corners.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bench/optimum.hpp"
#include "property/planner/random_programs.hpp"
#include "property/planner/smooth_trace.hpp"
#include "service/analysis/bench/bench_paths.hpp"

namespace meridian::bench {
namespace {

/// A program of `count` blocks that wanders: curves, corners, blocks of all lengths.
std::vector<ClBlock> draw_program(std::uint64_t seed) {
  test::RandomPrograms draw(seed);
  const int count = static_cast<int>(draw.uniform(10, 100));
  const double feed = draw.log_uniform(10, 250), step = draw.log_uniform(0.1, 5);
  const double corner = draw.chance(0.5) ? 0.15 : 0;
  Vector3 tip(draw.uniform(-40, 40), draw.uniform(-40, 40), 20), direction(1, 0, 0);
  double tilt = draw.uniform(0.1, 0.5), azimuth = draw.uniform(-3, 3), bend = 0;
  const double swing = draw.log_uniform(1e-4, 2e-2);
  std::vector<ClBlock> blocks;
  for (int n = 0; n <= count; ++n) {
    ClBlock block = test::cut_block(n, {tip, test::tilted(tilt, azimuth)});
    block.feed = feed;
    blocks.push_back(block);
    bend = 0.8 * bend + draw.uniform(-0.06, 0.06);
    const double turn = draw.chance(corner) ? draw.uniform(-2, 2) : bend;
    direction = Eigen::AngleAxisd(turn, Vector3::UnitZ()) * direction;
    direction.z() = 0.3 * std::sin(0.2 * n);
    tip += step * direction.normalized();
    tilt = std::clamp(tilt + swing * std::sin(0.15 * n), 0.05, 0.8);
    azimuth += swing * std::cos(0.1 * n);
  }
  return blocks;
}

/// What the rolling planner takes over the optimum, and over the one that keeps room for the
/// override.
void print(const std::string& name, const MachineModel& model, const std::vector<ClBlock>& blocks) {
  const SpanPath path = spans_of(model, blocks);
  const FeedSettings settings = feed_settings(model);
  const RollingTime now = rolling_time(model, path, settings);
  const Optimum best = OptimumSearch(model, path, {}).find();
  OptimumTask reserved;
  reserved.reserve = settings.reserve;
  const Optimum with_room = OptimumSearch(model, path, reserved).find();
  if (!now.is_done || best.time_s == 0) {
    std::printf("%-22s no optimum was found\n", name.c_str());
    return;
  }
  const auto over = [&](double time) { return time > 0 ? 100 * (time / best.time_s - 1) : 0; };
  std::printf(
      "%-22s %4zu blocks %9.4f s, optimum %9.4f s: %+6.2f %%; the optimum with room for the "
      "override %+5.2f %%; windows kept %lld, stops %lld, crawls %lld\n",
      name.c_str(), blocks.size(), now.time_s, best.time_s, over(now.time_s),
      over(with_room.time_s), static_cast<long long>(now.count.kept),
      static_cast<long long>(now.count.stops), static_cast<long long>(now.count.crawls));
}

/// Sharp corners: 60 to 180 degrees between blocks of 0.05 to 20 mm, the axis turning here and
/// there.
std::vector<ClBlock> draw_corners(std::uint64_t seed) {
  test::RandomPrograms draw(seed);
  const int count = static_cast<int>(draw.uniform(5, 40));
  const double feed = draw.log_uniform(5, 300), size = draw.log_uniform(0.05, 10);
  const double swing = draw.chance(0.5) ? draw.log_uniform(1e-3, 0.2) : 0;
  Vector3 tip(draw.uniform(-40, 40), draw.uniform(-40, 40), 20), direction(1, 0, 0);
  double tilt = draw.uniform(0.15, 0.5), azimuth = draw.uniform(-3, 3);
  std::vector<ClBlock> blocks;
  for (int n = 0; n <= count; ++n) {
    ClBlock block = test::cut_block(n, {tip, test::tilted(tilt, azimuth)});
    block.feed = feed;
    blocks.push_back(block);
    const double turn = draw.uniform(1.05, 3.14) * (draw.chance(0.5) ? 1 : -1);
    direction =
        Eigen::AngleAxisd(turn, Vector3(0.3 * std::sin(1.0 * n), 0, 1).normalized()) * direction;
    tip += size * draw.log_uniform(0.3, 2) * direction;
    tilt = std::clamp(tilt + swing * draw.uniform(-1, 1), 0.1, 0.8);
    azimuth += swing * draw.uniform(-1, 1);
  }
  test::end_program(blocks);
  return blocks;
}

double time_of_cuts(const test::Trace& trace, std::uint64_t last) {
  double sum = 0;
  for (const TimePiece& piece : trace.times) {
    const bool is_cut = piece.sequence <= last;
    if (piece.kind == TimeKind::kMove && is_cut) sum += piece.duration;
  }
  return sum;
}

void print_corners(MachineModel model, int first, int programs) {
  double worst = 0, sum = 0;
  for (int seed = first; seed < first + programs; ++seed) {
    const auto blocks = draw_corners(static_cast<std::uint64_t>(seed));
    const JointVector start = start_at(model, blocks.front()).joints;
    const auto smooth = test::plan_smooth(model, blocks, start, {Transition::kSmooth});
    const auto exact = test::plan_smooth(model, blocks, start, {Transition::kExactStop});
    const std::uint64_t last = blocks.size() - 2;
    const double a = time_of_cuts(smooth, last), b = time_of_cuts(exact, last);
    worst = std::max(worst, a / b);
    sum += a / b;
    if (a > 0.97 * b) {
      std::printf("corners %d: %zu blocks, smooth %.4f s, exact stop %.4f s, %.4f\n", seed,
                  blocks.size(), a, b, a / b);
    }
  }
  std::printf("%d programs of corners: smooth over exact stop %.4f on average, worst %.4f\n",
              programs, sum / programs, worst);
}

void print_bench_paths(MachineModel model) {
  for (const std::string& name : path_names()) {
    const auto blocks = path(name, kFeed_mm_per_s);
    model.pole_policy = PolePolicy::kRelax;
    print(name, model, blocks);
    if (name.find("near_pole") != 0) continue;
    model.pole_policy = PolePolicy::kExact;
    print(name + ", exact", model, blocks);
  }
}

void print_drawn(const MachineModel& model, int first, int programs) {
  for (int seed = first; seed < first + programs; ++seed) {
    print("drawn " + std::to_string(seed), model, draw_program(static_cast<std::uint64_t>(seed)));
    print("hostile " + std::to_string(seed), model,
          test::HostilePath(static_cast<std::uint32_t>(seed)).make(2));
  }
}

}  // namespace
}  // namespace meridian::bench

int main(int argc, char** argv) {
  using namespace meridian;
  MachineModel model = test::bench_machine();
  model.tolerances.pole_axis_rad = units::rad_from_deg(0.12);
  const int first = argc > 1 ? std::atoi(argv[1]) : 1;
  const int programs = argc > 2 ? std::atoi(argv[2]) : 20;
  bench::print_bench_paths(model);
  bench::print_drawn(model, first, programs);
  bench::print_corners(model, first, programs);
  return 0;
}
