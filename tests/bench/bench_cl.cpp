// SPDX-License-Identifier: Apache-2.0
//
// bench_cl [MEGABYTES [FILE]]: throughput of the CL reader on a generated dense five-axis file, or
// on FILE. Prints MB/s and blocks/s, the best of five runs.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "service/programs/cl/cl_reader.hpp"
#include "support/cpu_time.hpp"

namespace {

/// Ten decimals and continued lines, as Creo writes them: the longest lines that the field has.
std::string dense_program(std::size_t bytes) {
  std::string text = "UNITS / MM\nLOADTL / 1\nFEDRAT / 3000.0,  MMPM\n";
  text.reserve(bytes + 256);
  char line[256];
  for (std::size_t i = 0; text.size() < bytes; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    const double tilt = 0.5 + 0.2 * std::sin(0.7 * t);
    const int size = std::snprintf(
        line, sizeof line, "GOTO / %.10f, %.10f, %.10f,  $\n        %.10f, %.10f, %.10f\n",
        80 * std::sin(t), 80 * std::sin(1.3 * t), 20 * std::cos(t), std::sin(tilt) * std::cos(t),
        std::sin(tilt) * std::sin(t), std::cos(tilt));
    text.append(line, static_cast<std::size_t>(size));
  }
  return text + "FINI\n";
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t megabytes = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 64;
  std::string text;
  if (argc > 2) {
    std::ifstream file(argv[2], std::ios::binary);
    std::ostringstream all;
    all << file.rdbuf();
    text = all.str();
  } else {
    text = dense_program(megabytes * 1'000'000);
  }
  meridian::cl::ClReaderOptions options;
  options.unit = meridian::cl::LengthUnit::kMillimetre;
  std::istringstream stream(text);
  double best = 1e300;
  double best_cpu = 1e300;
  std::size_t blocks = 0;
  for (int run = 0; run < 5; ++run) {
    stream.clear();
    stream.seekg(0);
    const auto start = std::chrono::steady_clock::now();
    const double cpu_start = meridian::test::cpu_s();
    meridian::cl::ClReader reader(stream, "bench", options);
    for (blocks = 0;; ++blocks) {
      const auto block = reader.next();
      if (!block) {
        std::fprintf(stderr, "%s\n", block.error().text().c_str());
        return 1;
      }
      if (!*block) break;
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count());
    best_cpu = std::min(best_cpu, meridian::test::cpu_s() - cpu_start);
  }
  const double bytes = static_cast<double>(text.size());
  std::printf(
      "bench_cl: %.1f MB, %zu blocks, best of 5: %.1f MB/s, %.3g blocks/s; per CPU second %.1f MB, "
      "%.3g blocks\n",
      bytes / 1e6, blocks, bytes / 1e6 / best, static_cast<double>(blocks) / best,
      bytes / 1e6 / best_cpu, static_cast<double>(blocks) / best_cpu);
  return 0;
}
