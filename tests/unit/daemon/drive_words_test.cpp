// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/ports/drive_words.hpp"

#include <gtest/gtest.h>

namespace meridian::interpolator {
namespace {

TEST(DriveWords, WalksFromSwitchOnDisabledToOperationEnabled) {
  EXPECT_EQ(next_controlword(DriveState::kSwitchOnDisabled, true), 0x06);
  EXPECT_EQ(next_controlword(DriveState::kReadyToSwitchOn, true), 0x07);
  EXPECT_EQ(next_controlword(DriveState::kSwitchedOn, true), 0x0F);
  EXPECT_EQ(next_controlword(DriveState::kOperationEnabled, true), 0x0F);
}

TEST(DriveWords, SwitchesOffWhereOperationIsNotWanted) {
  EXPECT_EQ(next_controlword(DriveState::kOperationEnabled, false), 0x06);
  EXPECT_EQ(next_controlword(DriveState::kSwitchedOn, false), 0x06);
  EXPECT_EQ(next_controlword(DriveState::kReadyToSwitchOn, false), 0x06);
}

TEST(DriveWords, NeverResetsAFaultByItself) {
  for (const bool is_wanted : {true, false}) {
    EXPECT_EQ(next_controlword(DriveState::kFault, is_wanted) & 0x80, 0);
    EXPECT_EQ(next_controlword(DriveState::kFaultReaction, is_wanted) & 0x80, 0);
  }
}

TEST(DriveWords, ResetAFaultWhereTheOperatorSaidSo) {
  const DriveTask task{.is_enabled = true, .is_reset = true};
  EXPECT_EQ(next_order(true, 0x0208, task).controlword, 0x80);
  EXPECT_EQ(next_order(true, 0x020F, task).controlword, 0x00) << "still reacting";
  EXPECT_EQ(next_order(true, 0x0223, task).controlword, 0x0F) << "no fault";
  EXPECT_EQ(next_order(false, 0x0208, task).controlword, 0x06) << "not heard";
}

TEST(DriveWords, BeginASearchInOperationEnabledAlone) {
  const DriveTask task{.is_enabled = true, .work = DriveWork::kSearch};
  EXPECT_EQ(next_order(true, 0x0223, task).controlword, 0x0F);
  EXPECT_EQ(next_order(true, 0x0223, task).mode, dds::kHomingMode);
  EXPECT_EQ(next_order(true, 0x0227, task).controlword, 0x1F);
  EXPECT_EQ(next_order(true, 0x0227, {}).mode, dds::kCyclicPositionMode);
}

TEST(DriveWords, AskADriveForOneWork) {
  EXPECT_EQ(drive_work(0, 0, 1), DriveWork::kFollow);
  EXPECT_EQ(drive_work(0b10, 0, 1), DriveWork::kHome);
  EXPECT_EQ(drive_work(0b10, 0b10, 1), DriveWork::kSearch);
  EXPECT_EQ(drive_work(0b01, 0b11, 1), DriveWork::kFollow) << "no search outside of homing mode";
  const DriveTask task{.is_enabled = true, .work = DriveWork::kHome};
  EXPECT_EQ(next_order(true, 0x0227, task).controlword, 0x0F);
  EXPECT_EQ(next_order(true, 0x0227, task).mode, dds::kHomingMode);
}

TEST(DriveWords, ReadsWhatADriveSaysInHomingMode) {
  EXPECT_TRUE(homing_word(0x0627).is_still) << "not begun, or interrupted";
  EXPECT_FALSE(homing_word(0x0627).is_attained);
  EXPECT_FALSE(homing_word(0x0227).is_still) << "searching";
  EXPECT_FALSE(homing_word(0x1227).is_attained) << "found, and still moving";
  EXPECT_TRUE(homing_word(0x1627).is_attained);
  EXPECT_TRUE(homing_word(0x2227).has_failed);
  EXPECT_TRUE(homing_word(0x3627).has_failed);
  EXPECT_FALSE(homing_word(0x3627).is_attained);
}

}  // namespace
}  // namespace meridian::interpolator
