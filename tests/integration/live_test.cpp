// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "integration/live_run.hpp"

namespace meridian::test {
namespace {

TEST(Live, EqualsTheSimulationBitForBitOnEveryCycleThatWasSent) {
  Plant plant;
  const std::string part = (plant.folder() / "part.cls").string();
  write_cl_file(part, 16);
  LiveRun live;
  live.wire = (plant.folder() / "wire.csv").string();
  run_and_judge(plant, part, live);
  expect_on_wire(plant, live);
}

/// A session that asks for what the machine's file does not have: on through blocks, other
/// tolerances. Corners are rounded and the pole is passed; a dwell and an action part the runs.
TEST(Live, RunsOnThroughBlocksAsItsSessionAsksAndEqualsTheSimulation) {
  Plant plant;
  const std::string part = (plant.folder() / "part.cls").string();
  write_cl_file(part, 24);
  LiveRun live;
  live.reader = {"--tip-tolerance-mm", "0.02", "--axis-tolerance-deg", "0.2"};
  live.station = {"--transition", "smooth"};
  const std::string simulated = simulate_part(plant, part, live, live.station);
  ASSERT_NO_FATAL_FAILURE(run_live(plant, part, live));
  ASSERT_NO_FATAL_FAILURE(expect_same(plant, simulated, live));
  expect_checked(plant, part, live);
  const auto smooth_size = std::filesystem::file_size(simulated);
  EXPECT_LT(smooth_size, std::filesystem::file_size(simulate_part(plant, part, live)))
      << "it stopped at every block";
}

/// The shortest file of the corpus takes nearly three minutes: for whoever asks for it.
TEST(Live, CutsAWholeFileOfTheCorpusAsTheSimulationDoes) {
  const char* const name = std::getenv("MERIDIAN_LIVE_CORPUS");
  if (name == nullptr) GTEST_SKIP() << "MERIDIAN_LIVE_CORPUS names no file of ../shared/cl_corpus";
  const auto file =
      std::filesystem::path(MERIDIAN_SOURCE_DIR).parent_path() / "shared" / "cl_corpus" / name;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  Plant plant;
  const std::string tools = (plant.folder() / "tools.toml").string();
  const std::string service = (plant.folder() / "service.toml").string();
  std::ofstream(tools) << "[[tool]]\nnumber = 1\nlength_mm = 110\nradius_mm = 5\n"
                          "[[tool]]\nnumber = 45\nlength_mm = 110\nradius_mm = 5\n";
  std::ofstream(service) << "[service]\nmachine = \"" << machine_file()
                         << "\"\ntools = \"tools.toml\"\n";
  const std::string frame = "--frame=20,-30,50";
  LiveRun live;
  live.service = {"--service", service, frame};
  live.reader = {"--units", "mm"};
  live.simulate = {frame, "--tools", tools};
  live.patience = std::chrono::hours(1);
  run_and_judge(plant, file, live);
}

/// An operator who holds, resumes and turns the override while the program runs.
void operate(Plant& plant) {
  const auto say = [&plant](Verb verb, double argument = 0) {
    const auto reply = plant.say(verb, argument);
    ASSERT_TRUE(reply && reply->is_accepted) << (reply ? reply->text : "no reply");
  };
  say(Verb::kStart);
  ASSERT_TRUE(plant.wait_for(State::kRunning)) << plant.service().said();
  say(Verb::kFeedOverride, 0.45);
  std::this_thread::sleep_for(milliseconds(400));
  say(Verb::kHold);
  ASSERT_TRUE(plant.wait_for(State::kHeld));
  say(Verb::kFeedOverride, 1.3);
  say(Verb::kResume);
  std::this_thread::sleep_for(milliseconds(350));
  say(Verb::kFeedOverride, 0.8);
  say(Verb::kHold);
  ASSERT_TRUE(plant.wait_for(State::kHeld));
  say(Verb::kRapidOverride, 0.5);
  say(Verb::kResume);
}

TEST(Live, IsReplayedBitForBitFromTheOperatorEventsBesideItsRecording) {
  Plant plant;
  const std::string part = (plant.folder() / "part.cls").string();
  std::ofstream(part) << "PARTNO LONG CUTS\nUNITS/MM\nFEDRAT/2000,MMPM\n"
                      << cl_text(small_program(20, 2000, 8)) << "FINI\n";
  LiveRun live;
  live.operate = [&plant] { operate(plant); };
  ASSERT_NO_FATAL_FAILURE(run_live(plant, part, live));
  const std::string events = plant.folder() / "recording.events.csv";
  expect_same(plant, simulate_part(plant, part, live, {"--events", events}), live);
}

}  // namespace
}  // namespace meridian::test
