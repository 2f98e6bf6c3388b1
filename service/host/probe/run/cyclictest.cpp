// SPDX-License-Identifier: Apache-2.0
#include "service/host/probe/run/cyclictest.hpp"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <vector>

#include "service/host/probe/run/waiting.hpp"
#include "service/host/process/child_process.hpp"
#include "service/host/process/programs.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::probe {
namespace {

constexpr std::int64_t kMax_us = 20'000;  ///< what is longer is counted there

}  // namespace

std::optional<Histogram> parse_cyclictest(const std::string& text) {
  Histogram histogram;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    if (line.starts_with("# Histogram Overflows:")) {
      std::uint64_t count = 0;
      words.ignore(22) >> count;
      for (std::uint64_t i = 0; i < count; ++i) histogram.record(kMax_us * 1000);
      continue;
    }
    std::int64_t us = 0;
    std::uint64_t count = 0;
    if (line.starts_with('#') || !(words >> us >> count)) continue;
    for (std::uint64_t i = 0; i < count; ++i) histogram.record(us * 1000);
  }
  if (histogram.count() == 0) return std::nullopt;
  return histogram;
}

std::optional<Histogram> run_cyclictest(int cpu, std::int64_t period_ns, double seconds,
                                        const std::atomic<bool>& is_stopping) {
  const char* const kPath = "/usr/bin/cyclictest";
  if (!std::filesystem::exists(kPath)) return std::nullopt;
  const process::ScratchFolder folder;
  const std::string output = (folder.path() / "cyclictest.txt").string();
  const auto loops = std::llround(seconds * 1e9 / static_cast<double>(period_ns));
  process::ChildProcess cyclictest(
      {kPath, "-q", "-m", "-p80", "--policy=fifo", "-t1", "-a" + std::to_string(cpu),
       "-i" + std::to_string(period_ns / 1000), "-l" + std::to_string(loops),
       "-h" + std::to_string(kMax_us)},
      {.error_file = "/dev/null", .output_file = output, .has_own_group = true});
  const auto patience = std::chrono::milliseconds(std::llround(seconds * 1000) + 20'000);
  if (wait_for_exit(cyclictest, patience, is_stopping) != 0) return std::nullopt;
  return parse_cyclictest(text::read_whole(output).value_or(""));
}

}  // namespace meridian::probe
