// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "integration/live_run.hpp"
#include "support/shared_folder.hpp"

namespace meridian::test {
namespace {

/// Cuts a file of the corpus live, and checks it by simulation and checker.
void cut(Plant& plant, const std::filesystem::path& part) {
  const std::string tools = (plant.folder() / "tools.toml").string();
  std::ofstream(tools) << "[[tool]]\nnumber = 1\nlength_mm = 110\nradius_mm = 5\n"
                          "[[tool]]\nnumber = 45\nlength_mm = 110\nradius_mm = 5\n";
  const std::string frame = "--frame=20,-30,50";
  LiveRun live;
  live.service = {frame};
  live.settings = "tools = \"tools.toml\"\n";
  live.reader = {"--units", "mm"};
  live.simulate = {frame, "--tools", tools};
  live.patience = std::chrono::hours(1);
  run_and_check(plant, part.string(), live);
}

/// Its head: the first two lines of a five-axis part with its tool and its rapids, 25 s.
std::filesystem::path write_head(const std::filesystem::path& file, const Plant& plant) {
  const auto head = plant.folder() / "head.apt";
  std::ifstream in(file, std::ios::binary);
  std::ofstream out(head, std::ios::binary);
  std::string line;
  for (int n = 0; n < 40 && std::getline(in, line); ++n) out << line << "\n";
  out << "FINI\n";
  return head;
}

/// A whole file takes three minutes and more: for whoever names one in MERIDIAN_LIVE_CORPUS.
TEST(LiveCorpus, IsCutAsTheSimulationDoes) {
  const char* const whole = std::getenv("MERIDIAN_LIVE_CORPUS");
  const std::string name = whole != nullptr ? whole : "ramsai_1-3_plan_5x_depincage_double.apt";
  const auto file = shared_folder() / "cl_corpus" / name;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  Plant plant;
  cut(plant, whole != nullptr ? file : write_head(file, plant));
}

}  // namespace
}  // namespace meridian::test
