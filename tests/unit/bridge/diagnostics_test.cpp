// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/bridge/diagnostics.hpp"

#include <gtest/gtest.h>

#include "support/machines.hpp"
#include "support/mcap_reading.hpp"

namespace meridian::bridge {
namespace {

class Diagnostics : public testing::Test {
 protected:
  Diagnostics() {
    status_.state = State::kRunning;
    status_.realtime_mode = dds::RealtimeMode::kEnforced;
    feedback_.joint_mask = 0x3F;
    feedback_.statusword.fill(0x1237);
  }
  [[nodiscard]] std::vector<Diagnosis> diagnose_now() {
    drives_.add(feedback_, 0);
    return diagnose(model_, &status_, drives_);
  }

  MachineModel model_ = test::lai_machine();
  dds::Status status_;
  dds::DriveFeedback feedback_;
  DrivePositions drives_{model_.joint_count};
};

TEST_F(Diagnostics, AMachineThatRunsIsFine) {
  const auto all = diagnose_now();
  ASSERT_EQ(all.size(), 3U);
  for (const Diagnosis& one : all) EXPECT_EQ(one.level, Level::kOk) << one.name;
  EXPECT_EQ(all[0].message, "running");
  EXPECT_EQ(all[1].message, "all report");
}

TEST_F(Diagnostics, AFaultOfADriveIsAnErrorThatNamesIt) {
  status_.state = State::kFault;
  status_.alarm = Alarm::kDriveFault;
  feedback_.statusword[3] = 0x0218;
  feedback_.error[3] = 0x8611;
  const auto all = diagnose_now();
  EXPECT_EQ(all[0].level, Level::kError);
  EXPECT_EQ(all[0].message, "fault: drive_fault");
  EXPECT_EQ(all[1].level, Level::kError);
  EXPECT_EQ(all[1].message, model_.joints[3].name + ": fault, 8611h");
}

TEST_F(Diagnostics, ASilentDriveAndBestEffortAreWarnings) {
  feedback_.joint_mask = 0b11101;
  status_.realtime_mode = dds::RealtimeMode::kBestEffort;
  const auto all = diagnose_now();
  EXPECT_EQ(all[1].level, Level::kWarning);
  EXPECT_EQ(all[1].message, model_.joints[1].name + ": silent");
  EXPECT_EQ(all[2].level, Level::kWarning);
}

TEST_F(Diagnostics, AServiceThatIsGoneIsStale) {
  const auto all = diagnose(model_, nullptr, drives_);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].level, Level::kStale);
}

TEST_F(Diagnostics, TheMessageIsWhatRosReads) {
  ros::Cdr message;
  put_diagnostics(message, 3'000'000'007, "lai",
                  {{Level::kWarning, "drives", "X: silent", {{"X", "silent"}}}});
  test::CdrParts parts(message.bytes());
  EXPECT_EQ(parts.number<std::int32_t>(), 3);
  EXPECT_EQ(parts.number<std::uint32_t>(), 7U);
  EXPECT_EQ(parts.text(), "");
  EXPECT_EQ(parts.number<std::uint32_t>(), 1U);
  EXPECT_EQ(parts.number<std::uint8_t>(), 1);
  EXPECT_EQ(parts.text(), "meridian: drives");
  EXPECT_EQ(parts.text(), "X: silent");
  EXPECT_EQ(parts.text(), "lai");
  EXPECT_EQ(parts.number<std::uint32_t>(), 1U);
  EXPECT_EQ(parts.text(), "X");
  EXPECT_EQ(parts.text(), "silent");
  EXPECT_TRUE(parts.is_over());
}

}  // namespace
}  // namespace meridian::bridge
