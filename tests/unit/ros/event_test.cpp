// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "service/neighbours/ros/event_rows.hpp"
#include "service/neighbours/ros/events_file.hpp"
#include "support/machines.hpp"
#include "support/mcap_reading.hpp"
#include "support/text_file.hpp"

namespace meridian::ros {
namespace {

using test::TextFile;

/// Rows go in, the words of their events come out.
class Events : public testing::Test {
 protected:
  Events() {
    auto writer = mcap::Writer::create(file_.path(), {});
    EXPECT_TRUE(writer.has_value());
    writer_ = std::move(*writer);
    topic_.emplace(*writer_);
    rows_.emplace(*topic_, model_, contents_);
    row_.cycle = 10;
    row_.line = 7;
  }
  void add() {
    row_.due_ns = static_cast<std::int64_t>(row_.cycle) * 1'000'000;
    rows_->write(row_);
    ++row_.cycle;
  }
  /// "level source: text" of every event so far.
  [[nodiscard]] std::vector<std::string> words() {
    EXPECT_TRUE(writer_->close());
    std::vector<std::string> out;
    for (const auto& message : test::read_mcap(test::read_text(file_.path())).messages) {
      test::CdrParts parts(message.data);
      (void)parts.number<std::int32_t>();
      (void)parts.number<std::uint32_t>();
      const int level = parts.number<std::uint8_t>();
      const std::string source = parts.text();
      out.push_back(std::to_string(level) + " " + source + ": " + parts.text());
      EXPECT_EQ(parts.text() + parts.text(), "");
      EXPECT_EQ(parts.number<std::uint32_t>(), 7U);
      EXPECT_TRUE(parts.is_over());
    }
    return out;
  }

  TextFile file_{"", ".mcap"};
  MachineModel model_ = test::lai_machine();
  Contents contents_{.has_alarm = true, .has_feedback = true, .has_statuswords = true};
  std::unique_ptr<mcap::Writer> writer_;
  std::optional<EventTopic> topic_;
  std::optional<EventRows> rows_;
  record::RecordingRow row_;
};

TEST_F(Events, ReportStatesAlarmsAndTheEmergencyStopWhenTheyChange) {
  add();
  add();
  row_.state = State::kFaultStop;
  row_.alarm = Alarm::kFollowingError;
  row_.alarm_joint = 1;
  row_.is_emergency_stop = true;
  add();
  add();
  row_.state = State::kOff;
  row_.alarm = Alarm::kNone;
  row_.alarm_joint = -1;
  row_.is_emergency_stop = false;
  add();
  EXPECT_EQ(words(), (std::vector<std::string>{
                         "20 state: running", "40 state: fault_stop", "40 drives: emergency stop",
                         "40 alarm: following_error of " + model_.joints[1].name, "20 state: off",
                         "20 drives: emergency stop over", "20 alarm: none"}));
}

TEST_F(Events, ReportMissingCyclesNewOnesAndPrograms) {
  add();
  row_.cycle += 3;
  add();
  row_.cycle = 2;
  row_.epoch = 5;
  add();
  EXPECT_EQ(words(),
            (std::vector<std::string>{"20 state: running", "30 cycle: 3 cycles missing",
                                      "30 cycle: cycles begin anew", "20 cycle: epoch 5"}));
}

TEST_F(Events, ReportWhatADriveSaysWhenItSaysSomethingElse) {
  row_.statusword.fill(0x1237);
  add();
  row_.statusword[2] = 0x1637;  // a bit that is no state
  add();
  row_.statusword[2] = 0x021F;
  row_.drive_error[2] = 0x8611;
  add();
  row_.drive_error[2] = 0;
  add();
  const std::string name = model_.joints[2].name;
  EXPECT_EQ(words(), (std::vector<std::string>{
                         "20 state: running", "40 drives: " + name + " fault reaction, error 8611h",
                         "20 drives: " + name + " fault reaction"}));
}

TEST(EventsFile, ReadsRowsOfAllShapes) {
  const TextFile file(
      "cycle,verb,argument,block,span\n5,start,0\n9,feed_planned,1.5,12,3\r\nincomplete\n", ".csv");
  EventsFile events(file.path());
  auto row = events.next();
  ASSERT_TRUE(row && *row);
  EXPECT_EQ((*row)->cycle, 5U);
  EXPECT_EQ((*row)->text, "start 0");
  row = events.next();
  ASSERT_TRUE(row && *row);
  EXPECT_EQ((*row)->text, "feed_planned 1.5 12 3");
  row = events.next();
  ASSERT_TRUE(row && *row);
  EXPECT_TRUE((*row)->is_incomplete);
  row = events.next();
  EXPECT_TRUE(row && !*row);
}

TEST(EventsFile, IsEmptyWhereThereIsNone) {
  EventsFile events("/nowhere/run.events.csv");
  const auto row = events.next();
  EXPECT_TRUE(row && !*row);
}

TEST(EventsFile, RefusesARowWithoutCycleOrVerb) {
  for (const char* const bad : {"start,5", "5", "5,", "", "5start"}) {
    const TextFile file("cycle,verb,argument\n" + std::string(bad) + "\n", ".csv");
    const auto row = EventsFile(file.path()).next();
    ASSERT_FALSE(row.has_value()) << bad;
    EXPECT_EQ(row.error().line, 2U);
    EXPECT_NE(row.error().text().find("is no row cycle,verb,argument"), std::string::npos);
  }
}

}  // namespace
}  // namespace meridian::ros
