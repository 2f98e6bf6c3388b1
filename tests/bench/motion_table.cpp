// SPDX-License-Identifier: Apache-2.0

/// motion_table [MACHINE.toml FILE...]: time, limits, tolerance and throughput of smooth programs,
/// a line each; without files the throughput of dense data and of programs that are meant to hurt.
///
/// A file is simulated and its recording checked as `meridian check` does; shares of 1 are the
/// whole of a limit or a tolerance. One that does not say its unit is in mm; its tools are all as
/// long as the machine's. Throughput is the planner's alone: seconds of motion per second of CPU
/// time, and which share of the motion that a window yields it took (median, 99 %, most): from the
/// window before to this one, blocks taken, spline, plan and authority. Every run is done three
/// times, the least cost of a window counts: the plan is the same, what else the host does is not.

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/smooth_workload.hpp"
#include "service/analysis/simulate/simulate.hpp"
#include "service/host/probe/budgets.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/recording/record/check/check.hpp"
#include "service/recording/record/file/recording_reader.hpp"
#include "service/recording/record/file/recording_writer.hpp"

namespace meridian {
namespace {

void print_cost(const bench::SmoothTotal& total) {
  std::vector<double> shares;
  double cpu_s = 0, motion_s = 0;
  std::int64_t blocks = 0;
  for (const bench::WindowCost& window : total.windows) {
    shares.push_back(window.share());
    cpu_s += window.cpu_s;
    motion_s += window.motion_s;
    blocks += window.blocks;
  }
  if (shares.empty()) return;
  std::sort(shares.begin(), shares.end());
  std::printf(" %8.0f s/s %8.0f blocks/s   windows %6zu: %.3f %.3f %.3f%s\n", motion_s / cpu_s,
              static_cast<double>(blocks) / cpu_s, shares.size(), shares[shares.size() / 2],
              shares[shares.size() * 99 / 100], shares.back(), total.has_failed ? " FAILED" : "");
}

/// Runs all of `programs`, three times.
bench::SmoothTotal run(const MachineModel& model,
                       const std::vector<std::vector<ClBlock>>& programs) {
  bench::SmoothTotal min;
  for (int n = 0; n < 3; ++n) {
    const auto windows = std::make_unique<bench::SmoothWindows>(model);
    bench::SmoothTotal total;
    for (const auto& blocks : programs) windows->run(blocks, total);
    if (n == 0) {
      min = total;
    } else {
      min.keep_min(total);
    }
  }
  return min;
}

/// Onto the pole with the axis turning, then 2 m on it: it is not known for long where that ends.
std::vector<ClBlock> along_the_pole() {
  std::vector<ClBlock> blocks;
  for (int n = 0; n <= 1000; ++n) {
    ClBlock block;
    block.sequence = static_cast<std::uint64_t>(n);
    const double tilt = std::max(0.0, 0.2 - 0.01 * n);
    block.tip_mm = {2.0 * n, 20, 0};
    block.axis = {std::sin(tilt), 0, std::cos(tilt)};
    block.feed = 100;
    block.feed_meaning = FeedMeaning::kTip;
    blocks.push_back(block);
  }
  return blocks;
}

/// What the columns of the throughput are held against.
void print_budgets() {
  std::printf("budgets:");
  for (const char* const name : {"planner_motion", "planner_blocks", "planner_window"}) {
    const probe::Budget budget = probe::load_budget(name);
    std::printf(" %s %s%s", budget.what.c_str(), bound_text(budget).c_str(),
                std::string_view(name) == "planner_window" ? "\n" : ";");
  }
}

void print_made_up() {
  const MachineModel model = test::bench_machine();
  std::printf("along the pole    ");
  print_cost(run(model, {along_the_pole()}));
  for (const double step : {0.0001, 0.002, 0.05, 0.3}) {
    const double feed = step < 0.001 ? 5 : 50;  // mm/s
    const int blocks = static_cast<int>(std::min(1e6, 500 / step));
    const auto total = run(model, {bench::dense_blocks(blocks, step, feed)});
    std::printf("dense, %.4f mm    ", step);
    print_cost(total);
  }
  for (const bool is_at_pole : {false, true}) {
    std::vector<std::vector<ClBlock>> programs;
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
      auto path = is_at_pole ? test::HostilePath(seed, 0, 0.087) : test::HostilePath(seed);
      programs.push_back(path.make(8));
    }
    const auto total = run(model, programs);
    std::printf(is_at_pole ? "hostile, at a pole" : "hostile           ");
    print_cost(total);
  }
}

std::string read_file(const std::string& name) {
  std::ifstream in(name, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// A program that is read again and again.
struct Program {
  std::string text, name;

  [[nodiscard]] cl::ClReader reader() const {
    cl::ClReaderOptions options;
    options.unit = cl::LengthUnit::kMillimetre;
    return cl::ClReader(text, name, options);
  }
  [[nodiscard]] std::vector<ClBlock> blocks() const {
    std::vector<ClBlock> all;
    auto from = reader();
    for (auto block = from.next(); block && *block; block = from.next()) all.push_back(**block);
    return all;
  }
  /// A line for every tool that it calls.
  [[nodiscard]] ToolTable tools(double length_mm) const {
    std::map<int, Tool> all;
    for (const ClBlock& block : blocks()) {
      const int number = static_cast<int>(block.value);
      if (block.kind == BlockKind::kTool) all[number] = {number, length_mm, 5};
    }
    std::vector<Tool> lines;
    for (const auto& [number, tool] : all) lines.push_back(tool);
    return ToolTable(std::move(lines));
  }
};

/// Time, limits and tolerances of the simulated run. False: it did not come to its end.
bool print_run(const Program& program, const MachineModel& model) {
  const std::string& name = program.name;
  const auto recording = std::filesystem::temp_directory_path() /
                         ("meridian-motion-table-" + std::to_string(::getpid()) + ".csv");
  auto writer = record::RecordingWriter::create(recording, model);
  if (!writer) return false;
  cl::ClReader reader = program.reader();
  bool is_written = true;
  const auto report = simulate::simulate(
      reader, name, model, program.tools(model.tool_length_mm), {},
      [&](const CycleRecord& record) { is_written = writer->write(record) && is_written; });
  is_written = writer->close() && is_written;
  record::CheckedPath path(model.tool_length_mm, model.max_feed_mm_per_s);
  for (const ClBlock& block : program.blocks()) path.add(block, model.tool_length_mm);
  auto rows = record::RecordingReader::open(recording, model);
  if (report.outcome != simulate::Outcome::kDone || !is_written || !rows) {
    std::printf("%-18s %s\n", name.c_str(), report.reason.c_str());
    std::filesystem::remove(recording);
    return false;
  }
  const auto verdict = record::check(*rows, path, model, {});
  std::filesystem::remove(recording);
  if (!verdict) return false;
  double v = 0, a = 0, j = 0;
  for (const record::JointUse& joint : verdict->joints) {
    v = std::max(v, joint.velocity.value);
    a = std::max(a, joint.acceleration.value);
    j = std::max(j, joint.jerk.value);
  }
  std::printf(
      "%-18s %8.2f s  v %.3f a %.3f j %.3f feed %.4f  tip %.1f um axis %.3f deg %s", name.c_str(),
      report.program_s, v, a, j, verdict->feed.value, 1e3 * verdict->tip_between_mm.value,
      units::deg_from_rad(verdict->axis_between_rad.value), verdict->passed() ? "pass" : "FAIL");
  return true;
}

/// The cuts of the file in one run, tools and rapids left out, are planned again window by window.
void print_file(const std::string& file, const MachineModel& model) {
  const Program program{read_file(file), std::filesystem::path(file).stem()};
  if (!print_run(program, model)) return;
  std::vector<ClBlock> cuts = program.blocks();
  std::erase_if(cuts, [](const ClBlock& block) { return block.kind != BlockKind::kCut; });
  if (cuts.empty()) return;
  print_cost(run(model, {cuts}));
}

}  // namespace
}  // namespace meridian

int main(int argc, char** argv) {
  meridian::print_budgets();
  if (argc < 3) {
    meridian::print_made_up();
    return 0;
  }
  meridian::MachineModel model = meridian::config::load_machine(argv[1]);
  model.transition = meridian::Transition::kSmooth;
  for (int n = 2; n < argc; ++n) meridian::print_file(argv[n], model);
  return 0;
}
