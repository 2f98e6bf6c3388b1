// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/recorder.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>

#include "support/machines.hpp"

namespace meridian::telemetry {
namespace {

std::filesystem::path temporary_file() {
  return std::filesystem::temp_directory_path() /
         ("meridian-recorder-" + std::to_string(::getpid()) + ".csv");
}

std::string last_line(const std::string& name) {
  std::ifstream file(name);
  std::string line, last;
  while (std::getline(file, line)) last = line;
  return last;
}

TEST(Recorder, WritesEveryRowThatItTookBeforeItEnds) {
  const auto path = temporary_file();
  {
    Recorder recorder(path.string(), test::lai_machine());
    std::thread writer([&] { recorder.run(); });
    CycleRecord record;
    for (std::uint64_t cycle = 1; cycle <= 3000; ++cycle) {
      record.setpoint.cycle = cycle;
      ASSERT_TRUE(recorder.take(record));
    }
    recorder.stop();
    writer.join();
    EXPECT_EQ(recorder.rows_lost(), 0U);
  }
  std::ifstream file(path);
  std::string line;
  int lines = 0;
  while (std::getline(file, line)) ++lines;
  EXPECT_EQ(lines, 3001);
  std::filesystem::remove(path);
}

TEST(Recorder, HasOnDiskWhatIsHalfASecondOldWhoeverKillsIt) {
  const auto path = temporary_file();
  {
    Recorder recorder(path.string(), test::lai_machine());
    std::thread writer([&] { recorder.run(); });
    CycleRecord record;
    record.setpoint.cycle = 4711;
    ASSERT_TRUE(recorder.take(record));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_EQ(last_line(path.string()).rfind("4711,", 0), 0U) << last_line(path.string());
    recorder.stop();
    writer.join();
  }
  std::filesystem::remove(path);
  std::filesystem::remove(record::operator_events_path(path.string()));
}

TEST(Recorder, FollowsNoLink) {
  const auto path = temporary_file();
  const std::filesystem::path other = path.string() + ".other";
  for (const std::string& name : {path.string(), record::operator_events_path(path.string())}) {
    std::ofstream(other) << "not ours";
    std::filesystem::create_symlink(other, name);
    try {
      const Recorder recorder(path.string(), test::lai_machine());
      ADD_FAILURE() << name << " is followed";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).rfind(name + ": is a symbolic link", 0), 0U)
          << error.what();
    }
    std::ifstream file(other);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "not ours");
    std::filesystem::remove(path);
    std::filesystem::remove(name);
    std::filesystem::remove(other);
  }
}

TEST(Recorder, LosesRowsAndCountsThemWhereTheDiskIsFull) {
  Recorder recorder("/dev/full", test::lai_machine());
  std::thread writer([&] { recorder.run(); });
  CycleRecord record;
  for (int i = 0; i < 8000; ++i) (void)recorder.take(record);
  recorder.stop();
  writer.join();
  EXPECT_GT(recorder.rows_lost(), 0U);
  EXPECT_NE(recorder.complaint().find("No space left on device"), std::string::npos);
}

TEST(Recorder, SaysInTheEventsFileAndInWordsThatEventsWereLost) {
  const auto path = temporary_file();
  const std::string events = record::operator_events_path(path.string());
  {
    Recorder recorder(path.string(), test::lai_machine());
    Event event;
    event.code = EventCode::kAccepted;
    for (int i = 0; i < 256; ++i) recorder.take(event);
    EXPECT_EQ(recorder.events_lost(), 0U);
    recorder.take(event);
    EXPECT_EQ(recorder.events_lost(), 1U);
    recorder.stop();
    recorder.run();
    EXPECT_NE(recorder.complaint().find(events + " lacks 1 events"), std::string::npos)
        << recorder.complaint();
  }
  EXPECT_EQ(last_line(events), "incomplete");
  std::filesystem::remove(path);
  std::filesystem::remove(events);
}

TEST(Recorder, SaysInTheEventsFileThatEventsWereLostBeforeTheyCame) {
  const auto path = temporary_file();
  const std::string events = record::operator_events_path(path.string());
  {
    Recorder recorder(path.string(), test::lai_machine());
    recorder.miss_events(3);
    EXPECT_EQ(recorder.events_lost(), 0U) << "counted by whoever lost them";
    recorder.stop();
    recorder.run();
    EXPECT_NE(recorder.complaint().find(events + " lacks 3 events"), std::string::npos)
        << recorder.complaint();
  }
  EXPECT_EQ(last_line(events), "incomplete");
  std::filesystem::remove(path);
  std::filesystem::remove(events);
}

TEST(Recorder, HasNothingToComplainOfWhereEverythingIsOnDisk) {
  const auto path = temporary_file();
  Recorder recorder(path.string(), test::lai_machine());
  ASSERT_TRUE(recorder.take(CycleRecord{}));
  recorder.stop();
  recorder.run();
  EXPECT_EQ(recorder.complaint(), "");
  std::filesystem::remove(path);
  std::filesystem::remove(record::operator_events_path(path.string()));
}

TEST(Recorder, TakesEverythingForNothingWithoutAPath) {
  Recorder recorder("", test::lai_machine());
  for (int i = 0; i < 20000; ++i) ASSERT_TRUE(recorder.take(CycleRecord{}));
  EXPECT_EQ(recorder.rows_lost(), 0U);
}

TEST(Recorder, RefusesAFileThatCannotBeMade) {
  EXPECT_THROW(Recorder("/nowhere/at/all.csv", test::lai_machine()), std::runtime_error);
}

}  // namespace
}  // namespace meridian::telemetry
