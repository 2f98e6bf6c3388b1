// SPDX-License-Identifier: Apache-2.0
#include "service/panel/status/history.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "service/recording/telemetry/audit_log.hpp"
#include "support/scratch.hpp"

namespace meridian::panel {
namespace {

[[nodiscard]] telemetry::AuditEntry entry_of(telemetry::AuditKind kind) {
  telemetry::AuditEntry entry;
  entry.time_ns = 1'790'000'000'123'000'000;
  entry.kind = kind;
  return entry;
}

[[nodiscard]] std::string command_line(Verb verb, double argument, bool is_accepted) {
  telemetry::AuditEntry entry = entry_of(telemetry::AuditKind::kCommand);
  entry.operator_name = "anna";
  entry.verb = verb;
  entry.argument = argument;
  entry.is_accepted = is_accepted;
  if (!is_accepted) entry.text = "no program is loaded";
  return to_line(entry);
}

TEST(History, ReadsWhatTheServiceWrites) {
  const auto hold = parse_history_line(command_line(Verb::kHold, 0, true));
  ASSERT_TRUE(hold);
  EXPECT_EQ(hold->text, "anna: hold");
  EXPECT_EQ(hold->source, NewsSource::kOperator);
  EXPECT_EQ(std::chrono::duration_cast<std::chrono::milliseconds>(hold->time.time_since_epoch()),
            std::chrono::milliseconds(1'790'000'000'123));
  EXPECT_EQ(parse_history_line(command_line(Verb::kFeedOverride, 0.8, true))->text,
            "anna: feed_override 80 %");
  EXPECT_TRUE(parse_history_line(command_line(Verb::kFeedOverride, 1e300, false)));
  const auto refused = parse_history_line(command_line(Verb::kStart, 0, false));
  EXPECT_EQ(refused->text, "anna: start, refused: no program is loaded");
  EXPECT_EQ(refused->severity, Severity::kWarning);
}

TEST(History, KnowsStationsAndFaults) {
  telemetry::AuditEntry session = entry_of(telemetry::AuditKind::kSession);
  session.operator_name = "cam 3";
  session.text = "blade.apt";
  EXPECT_EQ(parse_history_line(to_line(session))->text, "cam 3 streams blade.apt");
  EXPECT_EQ(parse_history_line(to_line(session))->source, NewsSource::kStation);
  telemetry::AuditEntry fault = entry_of(telemetry::AuditKind::kFault);
  fault.text = "emergency stop input is open";
  EXPECT_EQ(parse_history_line(to_line(fault))->severity, Severity::kAlarm);
  EXPECT_EQ(parse_history_line(to_line(fault))->source, NewsSource::kMachine);
}

TEST(History, PassesOverWhatIsNoLineOfTheLog) {
  for (const char* text :
       {"", "{", "[]", "{\"event\":\"command\"}", "3", R"({"time":"yesterday","event":"start"})",
        R"({"time":7,"event":"start"})"}) {
    EXPECT_FALSE(parse_history_line(text)) << text;
  }
  EXPECT_TRUE(parse_history_line(R"({"time":"2026-09-21T14:13:20.123Z","event":"command"})"));
  const auto late =
      parse_history_line(R"({"time":"2026-09-21T14:13:20.99999999999999999999Z","event":"start"})");
  const auto next = parse_history_line(R"({"time":"2026-09-21T14:13:21.000Z","event":"start"})");
  EXPECT_LT(late->time, next->time);
}

class HistoryFile : public ::testing::Test {
 protected:
  void write(const std::string& text) const {
    std::ofstream(file_, std::ios::app | std::ios::binary) << text;
  }
  test::Scratch scratch_{".audit.log"};
  std::filesystem::path file_ = scratch_.path();
};

TEST_F(HistoryFile, IsReadAsItGrowsAndALineIsReadWhenItIsWhole) {
  History history(file_);
  EXPECT_TRUE(history.take().empty()) << "there is no file yet";
  const std::string line = command_line(Verb::kHold, 0, true);
  write(line + line.substr(0, 20));
  EXPECT_EQ(history.take().size(), 1U);
  EXPECT_TRUE(history.take().empty());
  write(line.substr(20) + line);
  EXPECT_EQ(history.take().size(), 2U);
}

TEST_F(HistoryFile, GoesOnWhereTheLogWasPutAside) {
  History history(file_);
  const std::string line = command_line(Verb::kHold, 0, true);
  write(line + line);
  EXPECT_EQ(history.take().size(), 2U);
  std::filesystem::remove(file_);
  write(line);
  EXPECT_EQ(history.take().size(), 1U);
}

TEST_F(HistoryFile, OfALongLogTheEndIsRead) {
  const std::string line = command_line(Verb::kHold, 0, true);
  const std::size_t fits = History::kMaxRead / line.size();
  std::string text;
  for (std::size_t i = 0; i < 3 * fits; ++i) text += line;
  write(text);
  History history(file_);
  const std::size_t count = history.take().size();
  EXPECT_GE(count, fits - 1);
  EXPECT_LE(count, fits);
}

}  // namespace
}  // namespace meridian::panel
