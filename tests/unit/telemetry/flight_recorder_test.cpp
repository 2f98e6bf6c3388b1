// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/flight_recorder.hpp"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <thread>

#include "flown.hpp"
#include "service/host/probe/budgets.hpp"
#include "service/recording/record/file/recording_reader.hpp"
#include "service/recording/record/flight/flight_writer.hpp"
#include "support/machines.hpp"

namespace meridian::telemetry {
namespace {

namespace fs = std::filesystem;

class FlightFiles : public testing::Test {
 protected:
  FlightFiles()
      : folder_(fs::temp_directory_path() / ("meridian-flight-" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
    config_.folder = folder_;
    config_.seconds = 1;
  }
  ~FlightFiles() override { fs::remove_all(folder_); }

  /// A whole life of a recorder, in which `faults` faults come.
  void live(int faults, bool loses_folder = false, std::uint16_t flags = 0) {
    FlightRecorder recorder(config_, model_, log_);
    if (loses_folder) fs::remove_all(folder_);
    std::thread writer([&] { recorder.run(); });
    Flown run;
    run.flags = flags;
    for (int i = 0; i < faults; ++i) {
      run.cycles(recorder, 2000, State::kRunning);
      recorder.take(run.alarm(Alarm::kFollowingError, 2));
      run.cycles(recorder, 20, State::kFaultStop);
      run.cycles(recorder, 600, State::kFault);
      while (recorder.is_writing()) std::this_thread::yield();
      run.cycles(recorder, 10, State::kOff);
    }
    recorder.finish();
    recorder.stop();
    writer.join();
  }
  [[nodiscard]] std::set<fs::path> files(const char* ending) const {
    std::set<fs::path> out;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      if (entry.path().extension() == ending) out.insert(entry.path());
    }
    return out;
  }

  fs::path folder_;
  config::FlightConfig config_;
  MachineModel model_ = test::lai_machine();
  std::ostringstream said_;
  std::shared_ptr<spdlog::logger> log_ = std::make_shared<spdlog::logger>(
      "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(said_));
};

TEST_F(FlightFiles, NameTheAlarmAndHoldTheCyclesBeforeAndBehindIt) {
  live(1);
  ASSERT_EQ(files(".csv").size(), 1U) << said_.str();
  const fs::path file = *files(".csv").begin();
  EXPECT_NE(file.string().find("-following_error-" + model_.joints[2].name + ".csv"),
            std::string::npos)
      << file;
  EXPECT_NE(said_.str().find(file.string()), std::string::npos) << said_.str();
  EXPECT_TRUE(files(".part").empty());
  auto reader = record::RecordingReader::open(file.string(), model_);
  ASSERT_TRUE(reader.has_value()) << reader.error().text();
  record::RecordingRow row;
  int before = 0, after = 0;
  while (*reader->next(row)) {
    EXPECT_EQ(row.feedback[0], static_cast<double>(row.cycle));
    EXPECT_EQ(row.alarm, row.cycle < 2001 ? Alarm::kNone : Alarm::kFollowingError);
    ++(row.cycle < 2001 ? before : after);
  }
  EXPECT_EQ(before + after, 1000);
  EXPECT_GE(before, 475);
  EXPECT_GE(after, 500);
  std::ifstream words(*files(".txt").begin());
  const std::string text{std::istreambuf_iterator<char>(words), {}};
  EXPECT_NE(text.find("lags by 2.5"), std::string::npos) << text;
  EXPECT_NE(text.find("line 17"), std::string::npos) << text;
}

TEST_F(FlightFiles, SayInWordsThatTheFaultWasOfADryRun) {
  for (const bool is_dry : {false, true}) {
    live(1, false, is_dry ? kSetpointDry : 0);
    std::ifstream words(*files(".txt").begin());
    const std::string text{std::istreambuf_iterator<char>(words), {}};
    EXPECT_EQ(text.find("dry run: no drive followed\n") != std::string::npos, is_dry) << text;
    fs::remove_all(folder_);
  }
}

TEST_F(FlightFiles, OfOldFaultsGoWhereThereAreMoreThanAskedFor) {
  config_.faults = 2;
  fs::create_directories(folder_);
  for (const char* name :
       {"fault-20200101T000000.000Z-travel-b3", "fault-20210101T000000.000Z-x"}) {
    std::ofstream(folder_ / (std::string(name) + ".csv")) << "old\n";
    std::ofstream(folder_ / (std::string(name) + ".txt")) << "old\n";
  }
  const auto others = {"part.csv", "fault-report.csv", "fault-20200101.csv", "fault-1.csv.part"};
  for (const char* name : others) std::ofstream(folder_ / name) << "not ours\n";
  live(1);
  EXPECT_EQ(files(".csv").size(), 5U);
  for (const char* name : others) EXPECT_TRUE(fs::exists(folder_ / name)) << name;
  EXPECT_FALSE(fs::exists(folder_ / "fault-20200101T000000.000Z-travel-b3.txt"));
  EXPECT_TRUE(fs::exists(folder_ / "fault-20210101T000000.000Z-x.csv"));
}

TEST_F(FlightFiles, ThatAKilledServiceLeftHalfWrittenGo) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "fault-20200101T000000.000Z-travel-b3.csv.part") << "torn";
  live(0);
  EXPECT_TRUE(files(".part").empty());
}

TEST_F(FlightFiles, AreNotWrittenThroughALinkThatLiesInTheirWay) {
  fs::create_directories(folder_);
  const fs::path other = folder_ / "other", part = folder_ / "fault.csv.part";
  std::ofstream(other) << "not ours";
  fs::create_symlink(other, part);
  auto writer = record::FlightWriter::create(part, model_);
  ASSERT_TRUE(writer.has_value()) << writer.error().text();
  EXPECT_TRUE(writer->close());
  EXPECT_EQ(fs::file_size(other), 8U);
  EXPECT_FALSE(fs::is_symlink(part));
}

TEST_F(FlightFiles, OfMoreSecondsThanFitAreCutToThoseAndTheLogSaysHowMany) {
  model_.cycle_ns = 125'000;
  config_.seconds = 60;
  const FlightRecorder recorder(config_, model_, log_);
  const auto memory_mib = static_cast<double>(recorder.memory_bytes()) / (1 << 20U);
  const probe::Budget budget = probe::load_budget("flight_recorder_memory");
  EXPECT_TRUE(budget.is_kept(memory_mib)) << memory_mib;
  EXPECT_GT(memory_mib, budget.allowed() - 1) << "it takes what it is granted";
  EXPECT_NE(said_.str().find(" s, not 60 s"), std::string::npos) << said_.str();
  said_.str("");
  config_.seconds = 1;
  EXPECT_EQ(FlightRecorder(config_, model_, log_).memory_bytes(), 8000 * sizeof(record::FlightRow));
  EXPECT_EQ(said_.str(), "");
}

TEST_F(FlightFiles, ThatAreMissingForWantOfTimeAreReportedOnce) {
  FlightRecorder recorder(config_, model_, log_);
  Flown run;
  run.cycles(recorder, 2000, State::kRunning);
  run.cycles(recorder, 1000, State::kFault);
  recorder.report_missed();
  EXPECT_EQ(said_.str(), "");
  for (int i = 0; i < 2; ++i) {
    run.cycles(recorder, 10, State::kOff);
    run.cycles(recorder, 10, State::kFault);
  }
  recorder.report_missed();
  EXPECT_NE(said_.str().find("2 faults have no record"), std::string::npos) << said_.str();
  said_.str("");
  recorder.report_missed();
  EXPECT_EQ(said_.str(), "");
}

TEST_F(FlightFiles, OfTwoMachinesAreInTwoFolders) {
  EXPECT_EQ(default_fault_folder("/state", "lai"), "/state/faults/lai");
  EXPECT_EQ(default_fault_folder("/state", "../a b"), "/state/faults/___a_b");
  EXPECT_EQ(default_fault_folder("", "lai"), "");
}

TEST_F(FlightFiles, OfEveryFaultHaveTheirOwnNames) {
  live(2);
  EXPECT_EQ(files(".csv").size(), 2U) << said_.str();
}

TEST_F(FlightFiles, ThatCannotBeWrittenAreReportedInTheLog) {
  live(1, true);
  EXPECT_NE(said_.str().find("cannot be created"), std::string::npos) << said_.str();
}

TEST_F(FlightFiles, AreNoneWhereTheirFolderCannotBeMadeWhichIsReportedAtTheStart) {
  config_.folder = "/proc/nowhere";
  live(1);
  EXPECT_NE(said_.str().find("cannot write to /proc/nowhere"), std::string::npos) << said_.str();
  FlightRecorder recorder(config_, model_, log_);
  EXPECT_EQ(recorder.memory_bytes(), 0U);
  Flown run;
  for (int i = 0; i < 3; ++i) {
    run.cycles(recorder, 1000, State::kFault);
    run.cycles(recorder, 1000, State::kOff);
  }
  EXPECT_EQ(recorder.faults_missed(), 0U);
}

TEST_F(FlightFiles, AreNoneWithoutAFolder) {
  config_.folder.clear();
  live(1);
  EXPECT_FALSE(fs::exists(folder_));
}

}  // namespace
}  // namespace meridian::telemetry
