// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/wire_recording.hpp"

#include <gtest/gtest.h>

#include "scratch.hpp"
#include "support/machines.hpp"

namespace meridian::record {
namespace {

using test::Scratch;

[[nodiscard]] WireRow row_at(std::uint64_t cycle) {
  WireRow row;
  row.setpoint.cycle = cycle;
  row.setpoint.due_ns = static_cast<std::int64_t>(cycle) * 1'000'000;
  row.setpoint.flags = kSetpointEnabled;
  row.setpoint.line = 12;
  row.setpoint.position = {0.1 * static_cast<double>(cycle), 2, 3, 4, 5, 0};
  row.arrival_ns = row.setpoint.due_ns + 120'000;
  return row;
}

TEST(WireRecording, IsReadAsARecording) {
  const MachineModel model = test::lai_machine();
  const Scratch file(".csv");
  auto writer = WireWriter::create(file.path(), model);
  ASSERT_TRUE(writer.has_value());
  for (std::uint64_t cycle = 5; cycle < 9; ++cycle) EXPECT_TRUE(writer->write(row_at(cycle)));
  ASSERT_TRUE(writer->close());
  auto reader = RecordingReader::open(file.path(), model);
  ASSERT_TRUE(reader.has_value()) << reader.error().text();
  EXPECT_TRUE(reader->has_velocity());
  EXPECT_FALSE(reader->has_plan_time());
  RecordingRow row;
  for (std::uint64_t cycle = 5; cycle < 9; ++cycle) {
    ASSERT_TRUE(*reader->next(row));
    EXPECT_EQ(row.cycle, cycle);
    EXPECT_EQ(row.joints, row_at(cycle).setpoint.position);
    EXPECT_EQ(row.flags, kSetpointEnabled);
    EXPECT_EQ(row.line, 12U);
  }
  EXPECT_FALSE(*reader->next(row));
}

TEST(WireBook, CountsGapsDoublesAndRestarts) {
  const MachineModel model = test::lai_machine();
  WireBook book(model);
  for (const std::uint64_t cycle : {5000, 5001, 5004, 5004, 5003, 5005, 5015, 3, 4, 6}) {
    book.add(row_at(cycle));
  }
  EXPECT_EQ(book.received(), 10U);
  EXPECT_EQ(book.missing(), 2U + 9U + 1U);
  EXPECT_EQ(book.restarts(), 1U);
  const std::string text = book.to_text();
  EXPECT_NE(text.find("12 missing in 3 gaps (longest 9), 2 doubles"), std::string::npos) << text;
  EXPECT_NE(text.find("2 missing after cycle 5001"), std::string::npos) << text;
  EXPECT_EQ(text.find("off the grid"), std::string::npos) << text;
}

TEST(WireBook, HoldsNoDriveAgainstTheSetpointsOfADryRun) {
  const MachineModel model = test::lai_machine();
  for (const bool is_dry : {false, true}) {
    WireBook book(model);
    WireRow row = row_at(1);
    if (is_dry) row.setpoint.flags = kSetpointDry | kSetpointDryEnabled;
    book.add(row);
    row.setpoint.cycle = 2;
    row.feedback_cycle = 1;
    row.feedback[0] = row.setpoint.position[0] + 4;
    book.add(row);
    const std::string text = book.to_text();
    EXPECT_EQ(text.find("b3 4.0") == std::string::npos, is_dry) << text;
    EXPECT_EQ(text.find("dry run    2 of them") != std::string::npos, is_dry) << text;
  }
}

TEST(WireBook, CountsDueTimesOffTheGrid) {
  const MachineModel model = test::lai_machine();
  WireBook book(model);
  book.add(row_at(1));
  WireRow row = row_at(2);
  row.setpoint.due_ns += 7;
  book.add(row);
  EXPECT_NE(book.to_text().find("1 due times off the grid"), std::string::npos) << book.to_text();
}

TEST(WireBook, ReportsAgesAndFollowingError) {
  const MachineModel model = test::lai_machine();
  WireBook book(model);
  for (std::uint64_t cycle = 1; cycle <= 100; ++cycle) {
    WireRow row = row_at(cycle);
    if (cycle == 50) row.arrival_ns += 3'000'000;
    if (cycle > 2) {
      row.feedback_cycle = cycle - 2;
      row.feedback = row_at(cycle - 2).setpoint.position;
      row.feedback[1] += cycle == 70 ? -0.25 : 0.1;
    }
    book.add(row);
  }
  const std::string text = book.to_text();
  EXPECT_NE(text.find("half below 128 us"), std::string::npos) << text;
  EXPECT_NE(text.find("the last after 3120 us"), std::string::npos) << text;
  EXPECT_NE(text.find("b2 0.250000 mm"), std::string::npos) << text;
  EXPECT_NE(text.find("b3 0.000000 mm"), std::string::npos) << text;
}

}  // namespace
}  // namespace meridian::record
