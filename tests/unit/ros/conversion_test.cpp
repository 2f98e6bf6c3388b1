// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/conversion.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "service/recording/record/file/recording_writer.hpp"
#include "service/recording/record/file/wire_recording.hpp"
#include "service/recording/record/flight/flight_writer.hpp"
#include "support/machines.hpp"
#include "support/mcap_reading.hpp"
#include "support/text_file.hpp"

namespace meridian::ros {
namespace {

using test::read_mcap;
using test::read_text;

class Conversion : public testing::Test {
 protected:
  Conversion() { std::filesystem::create_directory(folder_); }
  ~Conversion() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string in(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] CycleRecord record_at(std::uint64_t cycle) const {
    CycleRecord record;
    record.setpoint.cycle = cycle;
    record.setpoint.due_ns = static_cast<std::int64_t>(cycle) * model_.cycle_ns;
    record.setpoint.position[0] = 1e-3 * static_cast<double>(cycle);
    record.joints = record.setpoint.position;
    record.setpoint.flags = kSetpointEnabled;
    record.state = State::kRunning;
    return record;
  }
  void write_run(std::uint64_t first, std::uint64_t end) const {
    auto writer = record::RecordingWriter::create(in("run.csv"), model_);
    ASSERT_TRUE(writer.has_value());
    for (std::uint64_t cycle = first; cycle < end; ++cycle) {
      EXPECT_TRUE(writer->write(record_at(cycle)));
    }
    EXPECT_TRUE(writer->close());
  }
  void add_text(const std::string& name, const std::string& text) const {
    std::ofstream(in(name), std::ios::app | std::ios::binary) << text;
  }
  [[nodiscard]] std::string refusal(const std::string& out = "run.mcap") const {
    const auto report = convert(in("run.csv"), in(out), model_);
    return report ? "" : report.error().text();
  }
  [[nodiscard]] std::size_t count(const std::string& topic) const {
    std::size_t out = 0;
    for (const auto& message : read_mcap(read_text(in("run.mcap"))).messages) {
      out += message.topic == topic ? 1U : 0U;
    }
    return out;
  }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      ("meridian-conversion-" + std::to_string(::getpid()) + "-" +
       testing::UnitTest::GetInstance()->current_test_info()->name());
  MachineModel model_ = test::lai_machine();
};

TEST_F(Conversion, AccountsForEveryRowAndEveryEvent) {
  write_run(100, 1100);
  add_text("run.events.csv",
           "cycle,verb,argument,block,span\n90,enable,0\n500,hold,0\n"
           "500,feed_override,0.5\n1200,disable,0\nincomplete\n");
  const auto report = convert(in("run.csv"), in("run.mcap"), model_);
  ASSERT_TRUE(report.has_value()) << report.error().text();
  EXPECT_EQ(report->rows, 1000U);
  EXPECT_EQ(report->events, 6U) << "and the state of the first row";
  EXPECT_NEAR(report->length_s, 0.999, 1e-9);
  EXPECT_EQ(report->bytes, std::filesystem::file_size(in("run.mcap")));
  EXPECT_EQ(count("/cycle"), 1000U);
  std::vector<std::uint64_t> times;
  for (const auto& message : read_mcap(read_text(in("run.mcap"))).messages) {
    if (message.topic == "/events") times.push_back(message.time_ns / 1'000'000);
  }
  EXPECT_EQ(times, (std::vector<std::uint64_t>{90, 100, 500, 500, 1200, 1099}));
  EXPECT_NE(to_text(*report, "x.mcap").find("x.mcap: 1000 rows of 0.999 s, 6 events"),
            std::string::npos);
}

TEST_F(Conversion, TakesFilesOfTheFlightRecorder) {
  auto writer = record::FlightWriter::create(in("run.csv"), model_);
  ASSERT_TRUE(writer.has_value());
  for (std::uint64_t cycle = 1; cycle <= 50; ++cycle) {
    record::FlightRow row{record_at(cycle), {}};
    row.drives.cycle_seen = cycle - 1;
    row.drives.joint_mask = 0x1F;
    row.drives.statusword.fill(0x1237);
    const record::ReportedAlarm alarm{Alarm::kFollowingError, 0, 1.9, 12, 40};
    EXPECT_TRUE(writer->write(row, cycle < 40 ? record::ReportedAlarm{} : alarm));
  }
  EXPECT_TRUE(writer->close());
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(count("/cycle"), 50U);
  EXPECT_EQ(count("/drives"), 50U);
  EXPECT_EQ(count("/events"), 2U) << "running, and the alarm";
}

TEST_F(Conversion, TakesRecordingsOfTheWire) {
  auto writer = record::WireWriter::create(in("run.csv"), model_);
  ASSERT_TRUE(writer.has_value());
  for (std::uint64_t cycle = 1; cycle <= 50; ++cycle) {
    record::WireRow row;
    row.setpoint = record_at(cycle).setpoint;
    row.feedback_cycle = cycle;
    EXPECT_TRUE(writer->write(row));
  }
  EXPECT_TRUE(writer->close());
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(count("/cycle"), 50U);
  EXPECT_EQ(count("/drives"), 2U);
  EXPECT_EQ(count("/events"), 0U) << "the wire has no state";
}

TEST_F(Conversion, RefusesWhatIsNoRecording) {
  EXPECT_NE(refusal().find("run.csv: cannot be read"), std::string::npos);
  add_text("run.csv", "a,b\n1,2\n");
  EXPECT_NE(refusal().find("run.csv:1: no recording"), std::string::npos) << refusal();
  EXPECT_FALSE(std::filesystem::exists(in("run.mcap"))) << "nothing was made";
}

TEST_F(Conversion, RefusesARecordingWithoutRows) {
  write_run(0, 0);
  EXPECT_NE(refusal().find("no cycle is in it"), std::string::npos);
}

TEST_F(Conversion, RefusesToWriteOverWhatItReads) {
  write_run(1, 5);
  add_text("run.events.csv", "cycle,verb,argument\n");
  const std::string before = read_text(in("run.csv"));
  EXPECT_NE(refusal("run.csv").find("is what is to be converted"), std::string::npos);
  EXPECT_NE(refusal("run.events.csv").find("is what is to be converted"), std::string::npos);
  EXPECT_EQ(read_text(in("run.csv")), before);
}

TEST_F(Conversion, RefusesAFolderThatIsNotThere) {
  write_run(1, 5);
  EXPECT_NE(refusal("none/run.mcap").find("cannot be created"), std::string::npos);
}

TEST_F(Conversion, KeepsTheRowsInFrontOfADamagedOne) {
  write_run(1, 31);
  add_text("run.csv", "31,broken\n");
  EXPECT_NE(refusal().find("run.csv:32: "), std::string::npos) << refusal();
  EXPECT_EQ(count("/cycle"), 30U);
  EXPECT_TRUE(read_mcap(read_text(in("run.mcap"))).has_end);
}

TEST_F(Conversion, RefusesATimeBeforeTheClocksBegin) {
  add_text("run.csv", "cycle,due_ns,b3_mm,b2_mm,b4_mm,theta1_rad,theta2_rad\n1,-5,0,0,0,0,0\n");
  EXPECT_NE(refusal().find("run.csv:2: column 'due_ns' holds -5"), std::string::npos) << refusal();
}

TEST_F(Conversion, RefusesADamagedRowOfEvents) {
  write_run(1, 31);
  add_text("run.events.csv", "cycle,verb,argument\nhold,5\n");
  EXPECT_NE(refusal().find("run.events.csv:2: "), std::string::npos) << refusal();
}

TEST_F(Conversion, SaysThatTheDiskIsFull) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  write_run(1, 31);
  const auto report = convert(in("run.csv"), "/dev/full", model_);
  ASSERT_FALSE(report.has_value());
  EXPECT_NE(report.error().text().find("No space left"), std::string::npos);
}

}  // namespace
}  // namespace meridian::ros
