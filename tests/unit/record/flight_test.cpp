// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "meridian/units.hpp"
#include "scratch.hpp"
#include "service/recording/record/flight/flight_picture.hpp"
#include "service/recording/record/flight/flight_report.hpp"
#include "service/recording/record/flight/flight_writer.hpp"
#include "support/machines.hpp"

namespace meridian::record {
namespace {

using test::Scratch;

constexpr std::uint16_t kEnabled = 0x1237, kFaultReaction = 0x021F;
constexpr std::uint64_t kBegin = 500, kStuck = 700, kAlarmed = 740, kRest = 790, kEnd = 850;

/// A cut along joint 1 whose shaft sticks in cycle kStuck: its feedback, two cycles old, stays.
FlightRow row_at(std::uint64_t cycle, const MachineModel& model) {
  FlightRow row;
  Setpoint& setpoint = row.record.setpoint;
  setpoint.cycle = cycle;
  setpoint.due_ns = static_cast<std::int64_t>(cycle) * model.cycle_ns;
  const auto position = [](std::uint64_t at) {
    return 0.05 * static_cast<double>(std::min(at, kRest));
  };
  setpoint.position = {1, position(cycle), 2, 0.1, 0.2};
  row.record.joints = setpoint.position;
  setpoint.velocity[1] = cycle < kRest ? 50 : 0;
  setpoint.flags = cycle < kRest ? kSetpointEnabled : 0;
  setpoint.line = 12;
  row.record.sequence = 9;
  row.record.lateness_ns = 1000;
  row.record.state = cycle < kAlarmed ? State::kRunning
                     : cycle < kRest  ? State::kFaultStop
                                      : State::kFault;
  row.drives.arrival_ns = setpoint.due_ns - 400'000;
  row.drives.cycle_seen = cycle - 2;
  row.drives.position = setpoint.position;
  row.drives.position[1] = position(std::min(cycle - 2, kStuck));
  row.drives.joint_mask = 0x1F;
  row.drives.statusword.fill(kEnabled);
  if (cycle >= kAlarmed + 3) {
    row.drives.statusword[1] = kFaultReaction;
    row.drives.error[1] = 0x8611;
  }
  row.drives.is_emergency_stop = cycle >= kAlarmed + 20;
  return row;
}

class Flight : public testing::Test {
 protected:
  Flight() { write(row_at); }
  void write(FlightRow (*row_of)(std::uint64_t, const MachineModel&)) const {
    const ReportedAlarm alarm{Alarm::kFollowingError, 1, 1.9, 12, kAlarmed};
    auto writer = FlightWriter::create(file_.path(), model_);
    EXPECT_TRUE(writer.has_value());
    for (std::uint64_t cycle = kBegin; cycle < kEnd; ++cycle) {
      EXPECT_TRUE(writer->write(row_of(cycle, model_), cycle < kAlarmed ? ReportedAlarm{} : alarm));
    }
    EXPECT_TRUE(writer->close());
  }
  [[nodiscard]] RecordingReader open() const {
    auto reader = RecordingReader::open(file_.path(), model_);
    EXPECT_TRUE(reader.has_value()) << reader.error().text();
    return std::move(*reader);
  }

  MachineModel model_ = test::lai_machine();
  Scratch file_{".csv"};
};

TEST_F(Flight, FileGivesBackWhatWasSentAndReported) {
  RecordingReader reader = open();
  EXPECT_TRUE(reader.has_feedback());
  RecordingRow row;
  for (std::uint64_t cycle = kBegin; cycle < kEnd; ++cycle) {
    const auto read = reader.next(row);
    ASSERT_TRUE(read.has_value() && *read);
    const FlightRow written = row_at(cycle, model_);
    ASSERT_EQ(row.cycle, cycle);
    ASSERT_EQ(row.joints, written.record.joints);
    ASSERT_EQ(row.state, written.record.state);
    ASSERT_EQ(row.feedback, written.drives.position);
    ASSERT_EQ(row.feedback_cycle, cycle - 2);
    ASSERT_EQ(row.feedback_age_ns, 401'000);
    ASSERT_EQ(row.statusword[1], written.drives.statusword[1]);
    ASSERT_EQ(row.drive_error[1], written.drives.error[1]);
    ASSERT_EQ(row.is_emergency_stop, written.drives.is_emergency_stop);
    ASSERT_EQ(row.alarm, cycle < kAlarmed ? Alarm::kNone : Alarm::kFollowingError);
    ASSERT_EQ(row.alarm_joint, cycle < kAlarmed ? -1 : 1);
  }
  EXPECT_FALSE(*reader.next(row));
}

TEST_F(Flight, FileKeepsWhatDrivesSaidEvenIfItIsNoNumber) {
  FlightRow row = row_at(600, model_);
  row.drives.position[3] = std::numeric_limits<double>::quiet_NaN();
  row.drives.arrival_ns = 0;
  row.drives.joint_mask = 0x17;
  const Scratch file(".csv");
  auto writer = FlightWriter::create(file.path(), model_);
  ASSERT_TRUE(writer && writer->write(row, {}) && writer->close());
  auto reader = RecordingReader::open(file.path(), model_);
  ASSERT_TRUE(reader);
  RecordingRow read;
  ASSERT_TRUE(*reader->next(read));
  EXPECT_TRUE(std::isnan(read.feedback[3]));
  EXPECT_EQ(read.feedback_age_ns, -1);
  EXPECT_EQ(read.statusword[3], 0) << "silent";
  EXPECT_EQ(read.statusword[4], kEnabled);
}

TEST_F(Flight, ReportHoldsAlarmStopFollowingErrorsAndDrives) {
  RecordingReader reader = open();
  const auto report = read_flight(reader, model_);
  ASSERT_TRUE(report.has_value()) << report.error().text();
  EXPECT_EQ(report->alarm, Alarm::kFollowingError);
  EXPECT_EQ(report->joint, 1);
  EXPECT_EQ(report->cycle, kAlarmed);
  EXPECT_EQ(report->block, 9U);
  EXPECT_EQ(report->state, State::kRunning);
  EXPECT_EQ(report->missing, 0U);
  EXPECT_NEAR(report->before_s, 0.240, 1e-9);
  EXPECT_NEAR(report->after_s, 0.109, 1e-9);
  EXPECT_NEAR(report->stop_s, 0.050, 1e-9);
  EXPECT_NEAR(report->following[1].before, -0.05 * 37, 1e-9);
  EXPECT_NEAR(report->following[1].at_alarm, -0.05 * 38, 1e-9);
  EXPECT_NEAR(report->following[1].after, -0.05 * 87, 1e-9) << "checked while drives follow";
  EXPECT_EQ(report->following[0].after, 0);
  EXPECT_TRUE(report->is_emergency);
  EXPECT_NEAR(report->emergency_at_s, 0.020, 1e-9);
  ASSERT_EQ(report->turns.size(), 1U);
  EXPECT_EQ(report->turns[0].drive, 1);
  EXPECT_NEAR(report->turns[0].at_s, 0.003, 1e-9);
  const std::string text = to_text(*report, model_);
  EXPECT_NE(text.find("following_error of " + model_.joints[1].name), std::string::npos) << text;
  EXPECT_NE(text.find("operation enabled -> fault reaction (021Fh, error 8611h)"),
            std::string::npos)
      << text;
}

TEST_F(Flight, ReportCallsADryRunWhatTheAlarmIsOfWhateverWasBefore) {
  for (const bool is_dry : {false, true}) {
    write(is_dry ? [](std::uint64_t cycle, const MachineModel& model) {
      FlightRow row = row_at(cycle, model);
      if (cycle >= kAlarmed - 5) row.record.setpoint.flags = kSetpointDry;
      return row;
    } : [](std::uint64_t cycle, const MachineModel& model) {
      FlightRow row = row_at(cycle, model);
      if (cycle < kAlarmed - 5) row.record.setpoint.flags = kSetpointDry | kSetpointDryEnabled;
      return row;
    });
    RecordingReader reader = open();
    const auto report = read_flight(reader, model_);
    ASSERT_TRUE(report.has_value()) << report.error().text();
    const std::string text = to_text(*report, model_);
    EXPECT_EQ(text.find("dry run    no drive followed") != std::string::npos, is_dry) << text;
  }
}

TEST_F(Flight, ReportHoldsTheLargestErrorAlthoughADriveReportedNoNumberAfterIt) {
  write([](std::uint64_t cycle, const MachineModel& model) {
    FlightRow row = row_at(cycle, model);
    if (cycle == kAlarmed - 1) row.drives.position[1] = std::nan("");
    return row;
  });
  RecordingReader reader = open();
  const auto report = read_flight(reader, model_);
  ASSERT_TRUE(report.has_value()) << report.error().text();
  EXPECT_NEAR(report->following[1].before, -0.05 * 36, 1e-9);
  EXPECT_NEAR(report->following[1].after, -0.05 * 87, 1e-9);
}

TEST_F(Flight, PictureShowsTheDriveOfTheAlarm) {
  RecordingReader reader = open();
  const auto report = read_flight(reader, model_);
  ASSERT_TRUE(report.has_value());
  const Scratch picture(".svg");
  const auto error = draw_flight(reader, *report, model_, picture.path());
  ASSERT_FALSE(error.has_value()) << error->text();
  const std::string svg = test::read_text(picture.path());
  EXPECT_NE(svg.find(model_.joints[1].name + ", "), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
}

TEST_F(Flight, ReportRefusesARecordingWithoutFeedback) {
  const Scratch file(".csv");
  RecordingReader reader =
      test::write_and_open(file.path(), model_, {row_at(kBegin, model_).record});
  const auto report = read_flight(reader, model_);
  ASSERT_FALSE(report.has_value());
  EXPECT_NE(report.error().text().find("no feedback"), std::string::npos);
}

}  // namespace
}  // namespace meridian::record
