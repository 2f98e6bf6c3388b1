// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "integration/plant.hpp"
#include "meridian/units.hpp"
#include "service/config/machine_file.hpp"
#include "service/record/compare.hpp"

namespace meridian::test {
namespace {

/// The small program as a CL file, with a dwell and an action in it.
void write_cl_file(const std::string& path, int blocks) {
  const auto program = small_program(blocks, 4000);
  const std::size_t half = program.size() / 2;
  const std::vector<ClBlock> first(program.begin(), program.begin() + static_cast<long>(half));
  std::ofstream file(path);
  file << "PARTNO SMALL PROGRAM\nUNITS/MM\nSPINDL/8000,RPM,CLW\nFEDRAT/4000,MMPM\n"
       << cl_text(first) << "DELAY/0.3\nCOOLNT/FLOOD\n"
       << cl_text(program, half) << "FINI\n";
}

/// What the programs of one live run are told beside the part.
struct LiveRun {
  std::vector<std::string> service;   ///< meridiand
  std::vector<std::string> reader;    ///< how the part is read: stream, simulate and check
  std::vector<std::string> simulate;  ///< machine and workpiece: simulate and check
  milliseconds patience{60'000};
};

std::vector<std::string> joined(std::vector<std::string> words,
                                const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Both recordings hold the same motion.
void expect_same(const Plant& plant, const std::string& simulated) {
  const MachineModel model = config::load_machine(machine_file());
  auto live = record::RecordingReader::open(plant.recording(), model);
  auto wanted = record::RecordingReader::open(simulated, model);
  ASSERT_TRUE(live && wanted);
  const auto report = record::compare(*live, *wanted, model);
  ASSERT_TRUE(report) << report.error().text();
  std::printf("%s\n", record::to_text(*report, "live", "simulated", model).c_str());
  EXPECT_TRUE(report->is_same());
}

/// Station, service, drives and operator as they are live; simulator and checker judge them.
void run_and_judge(Plant& plant, const std::string& part, const LiveRun& live) {
  const std::string simulated = (plant.folder() / "simulated.csv").string();
  const std::vector<std::string> judged =
      joined(joined({"--machine", machine_file()}, live.reader), live.simulate);
  Process simulate(joined({"meridian", "simulate", part, "--record", simulated}, judged),
                   plant.folder() / "simulate.log");
  ASSERT_EQ(simulate.wait(milliseconds(60'000)), 0) << simulate.said();

  plant.start_service(live.service);
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  Process station(
      joined({"meridian", "stream", part, "--domain", plant.domain(), "--wait-end"}, live.reader),
      plant.folder() / "station.log");
  ASSERT_TRUE(plant.wait_for(State::kLoaded)) << station.said();
  const auto start = plant.say(Verb::kStart);
  ASSERT_TRUE(start && start->is_accepted) << (start ? start->text : "no reply");
  ASSERT_EQ(station.wait(live.patience), 0) << station.said() << plant.service().said();
  plant.service().send_signal(SIGTERM);
  ASSERT_EQ(plant.service().wait(milliseconds(5000)), 0) << plant.service().said();

  ASSERT_NO_FATAL_FAILURE(expect_same(plant, simulated));
  Process check(
      joined({"meridian", "check", plant.recording(), part, "--max-missing", "1000000"}, judged),
      plant.folder() / "check.log");
  EXPECT_EQ(check.wait(milliseconds(60'000)), 0) << check.said();
  std::printf("%s\n", check.said().c_str());
}

TEST(Live, EqualsTheSimulationBitForBitOnEveryCycleThatWasSent) {
  Plant plant;
  const std::string part = (plant.folder() / "part.cls").string();
  write_cl_file(part, 16);
  run_and_judge(plant, part, {});
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
  const std::string simulated = (plant.folder() / "simulated.csv").string();
  std::ofstream(part) << "PARTNO LONG CUTS\nUNITS/MM\nFEDRAT/2000,MMPM\n"
                      << cl_text(small_program(20, 2000, 8)) << "FINI\n";
  plant.start_service();
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  Process station({"meridian", "stream", part, "--domain", plant.domain(), "--wait-end"},
                  plant.folder() / "station.log");
  ASSERT_TRUE(plant.wait_for(State::kLoaded)) << station.said();
  ASSERT_NO_FATAL_FAILURE(operate(plant));
  ASSERT_EQ(station.wait(milliseconds(60000)), 0) << station.said() << plant.service().said();
  plant.service().send_signal(SIGTERM);
  ASSERT_EQ(plant.service().wait(milliseconds(5000)), 0) << plant.service().said();

  const std::string events = (plant.folder() / "recording.events.csv").string();
  Process simulate({"meridian", "simulate", part, "--machine", machine_file(), "--events", events,
                    "--record", simulated},
                   plant.folder() / "simulate.log");
  ASSERT_EQ(simulate.wait(milliseconds(30000)), 0) << simulate.said();
  expect_same(plant, simulated);
}

}  // namespace
}  // namespace meridian::test
