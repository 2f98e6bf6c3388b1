// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <random>

#include "scratch.hpp"
#include "service/recording/record/words.hpp"
#include "support/machines.hpp"

namespace meridian::record {
namespace {

using test::Scratch;
using test::write_and_open;
using test::write_text;

template <class Enum>
void expect_words(int count, std::optional<Enum> (*find)(std::string_view) noexcept) {
  for (int n = 0; n < count; ++n) {
    const auto value = static_cast<Enum>(n);
    EXPECT_FALSE(word(value).empty()) << n;
    EXPECT_EQ(find(word(value)), value) << n;
  }
  EXPECT_EQ(word(static_cast<Enum>(count)), "unknown");
  EXPECT_FALSE(find(""));
}

TEST(Recording, HasAWordForEveryStateMotionAndAlarm) {
  expect_words<State>(kStateCount, find_state);
  expect_words<MotionKind>(static_cast<int>(MotionKind::kRewind) + 1, find_motion_kind);
  expect_words<Alarm>(static_cast<int>(Alarm::kFeedbackTooFast) + 1, find_alarm);
}

TEST(Recording, GivesBackEveryDoubleBitForBit) {
  const MachineModel model = test::lai_machine();
  constexpr std::uint64_t kSeed = 20240607;
  std::mt19937_64 random(kSeed);
  std::printf("seed %llu\n", static_cast<unsigned long long>(kSeed));
  std::vector<CycleRecord> records(2000);
  for (std::size_t i = 0; i < records.size(); ++i) {
    CycleRecord& record = records[i];
    record.setpoint.cycle = i;
    record.setpoint.due_ns = static_cast<std::int64_t>(random() >> 1U);
    for (int j = 0; j < 5; ++j) {
      double value;
      do {
        value = std::bit_cast<double>(random());
      } while (!std::isfinite(value));
      record.joints[j] = i == 0 ? -0.0 : value;
      record.setpoint.velocity[j] = value / 3;
    }
    record.plan_time_s = std::ldexp(static_cast<double>(random()), -60);
    record.state = static_cast<State>(random() % kStateCount);
    record.motion = static_cast<MotionKind>(random() % 4);
    record.lateness_ns = static_cast<std::int32_t>(random());
    record.sequence = random();
    record.setpoint.flags = static_cast<std::uint16_t>(random());
  }
  const Scratch file(".csv");
  RecordingReader reader = write_and_open(file.path(), model, records);
  RecordingRow row;
  for (const CycleRecord& record : records) {
    const auto read = reader.next(row);
    ASSERT_TRUE(read.has_value()) << read.error().text();
    ASSERT_TRUE(*read);
    for (int j = 0; j < 5; ++j) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(row.joints[j]),
                std::bit_cast<std::uint64_t>(record.joints[j]));
      ASSERT_EQ(row.velocity[j], record.setpoint.velocity[j]);
    }
    ASSERT_EQ(row.due_ns, record.setpoint.due_ns);
    ASSERT_EQ(row.plan_time_s, record.plan_time_s);
    ASSERT_EQ(row.state, record.state);
    ASSERT_EQ(row.kind, record.motion);
    ASSERT_EQ(row.lateness_ns, record.lateness_ns);
    ASSERT_EQ(row.sequence, record.sequence);
    ASSERT_EQ(row.flags, record.setpoint.flags);
  }
  EXPECT_FALSE(*reader.next(row));
  reader.rewind();
  EXPECT_TRUE(*reader.next(row));
  EXPECT_EQ(row.cycle, 0U);
}

TEST(Recording, HasTheColumnsThatOutsideToolsRead) {
  const Scratch file(".csv");
  CycleRecord record;
  record.setpoint.cycle = 7;
  record.setpoint.due_ns = 1000;
  record.setpoint.line = 3;
  record.joints = {0.1, -2, 0, 1, 0.5};
  record.state = State::kRunning;
  record.motion = MotionKind::kPoleTurn;
  (void)write_and_open(file.path(), test::lai_machine(), {record});
  EXPECT_EQ(test::read_text(file.path()),
            "cycle,due_ns,line,kind,b3_mm,b2_mm,b4_mm,theta1_rad,theta2_rad,b3_mm_per_s,"
            "b2_mm_per_s,b4_mm_per_s,theta1_rad_per_s,theta2_rad_per_s,sequence,state,plan_time_s,"
            "rate,epoch,flags,lateness_ns,computation_ns\n"
            "7,1000,3,pole_turn,0.10000000000000001,-2,0,1,0.5,0,0,0,0,0,0,running,0,1,0,0,0,0\n");
}

TEST(Recording, TakesForeignColumnsInAnyOrder) {
  const Scratch file(".csv");
  write_text(file.path(),
             "note,theta2_rad,theta1_rad,b4_mm,b2_mm,b3_mm,due_ns,cycle\r\n"
             "x,5,4,3,2,1,20,10\r\n");
  auto reader = RecordingReader::open(file.path(), test::lai_machine());
  ASSERT_TRUE(reader.has_value());
  RecordingRow row;
  ASSERT_TRUE(*reader->next(row));
  EXPECT_EQ(row.joints, (JointVector{1, 2, 3, 4, 5, 0}));
  EXPECT_EQ(row.cycle, 10U);
  EXPECT_FALSE(reader->has_velocity());
  EXPECT_FALSE(reader->has_plan_time());
  EXPECT_FALSE(*reader->next(row));
}

TEST(Recording, RefusesWhatIsNoRecordingWithPlaceAndRemedy) {
  struct Case {
    const char* text;
    const char* message;
  };
  const Case cases[] = {
      {"", "no column 'cycle' or 'due_ns'"},
      {"GOTO/1,2,3\n", "no column 'cycle' or 'due_ns'"},
      {"cycle,due_ns,b3_mm,b2_mm,b4_mm,theta1_rad\n", "no column 'theta2_rad'"},
      {"cycle,due_ns,b3_mm,b2_mm,b4_mm,theta1_rad,theta2_rad\n1,2,3,4,5,6\n", "not as many"},
      {"cycle,due_ns,b3_mm,b2_mm,b4_mm,theta1_rad,theta2_rad\n1,2,3,4,5,6,7,8\n", "not as many"},
      {"cycle,due_ns,b3_mm,b2_mm,b4_mm,theta1_rad,theta2_rad\n1,2,3,4,nan,6,7\n", "'b4_mm'"},
      {"cycle,due_ns,b3_mm,b2_mm,b4_mm,theta1_rad,theta2_rad\n1,2,3,4,5,6,7x\n", "'theta2_rad'"},
      {"cycle,due_ns,state,b3_mm,b2_mm,b4_mm,theta1_rad,theta2_rad\n1,2,on,3,4,5,6,7\n",
       "'state' holds 'on'"},
  };
  for (const Case& c : cases) {
    const Scratch file(".csv");
    write_text(file.path(), c.text);
    auto reader = RecordingReader::open(file.path(), test::lai_machine());
    RecordingRow row;
    const std::string message =
        reader.has_value() ? reader->next(row).error().text() : reader.error().text();
    EXPECT_NE(message.find(c.message), std::string::npos) << message;
    EXPECT_NE(message.find(file.path()), std::string::npos) << message;
  }
  const auto missing = RecordingReader::open("/nonexistent/run.csv", test::lai_machine());
  ASSERT_FALSE(missing.has_value());
  EXPECT_NE(missing.error().text().find("cannot be read"), std::string::npos);
}

TEST(Recording, EndsWithAnErrorWhereTheDiskIsFull) {
  auto writer = RecordingWriter::create("/dev/full", test::lai_machine());
  ASSERT_TRUE(writer.has_value());
  bool is_fine = true;
  for (int i = 0; i < 10000 && is_fine; ++i) is_fine = writer->write(CycleRecord{});
  EXPECT_FALSE(is_fine);
  EXPECT_EQ(writer->error_number(), ENOSPC);
  EXPECT_FALSE(writer->close());
  EXPECT_FALSE(RecordingWriter::create("/nonexistent/run.csv", test::lai_machine()).has_value());
}

}  // namespace
}  // namespace meridian::record
