// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/csp/cia402.hpp"

#include <gtest/gtest.h>

namespace meridian::drive {
namespace {

constexpr std::uint16_t kDisableVoltage = 0x00, kQuickStop = 0x02, kShutdown = 0x06,
                        kSwitchOn = 0x07, kEnable = 0x0F, kFaultReset = 0x80;

TEST(Cia402, WalksUpByShutdownSwitchOnEnable) {
  DriveState state = DriveState::kSwitchOnDisabled;
  state = next_state(state, kShutdown, 0);
  EXPECT_EQ(state, DriveState::kReadyToSwitchOn);
  state = next_state(state, kSwitchOn, kShutdown);
  EXPECT_EQ(state, DriveState::kSwitchedOn);
  state = next_state(state, kEnable, kSwitchOn);
  EXPECT_EQ(state, DriveState::kOperationEnabled);
}

TEST(Cia402, WalksDownOneStepPerCommand) {
  EXPECT_EQ(next_state(DriveState::kOperationEnabled, kSwitchOn, kEnable), DriveState::kSwitchedOn);
  EXPECT_EQ(next_state(DriveState::kOperationEnabled, kShutdown, kEnable),
            DriveState::kReadyToSwitchOn);
  EXPECT_EQ(next_state(DriveState::kSwitchedOn, kShutdown, kSwitchOn),
            DriveState::kReadyToSwitchOn);
}

TEST(Cia402, NeverJumpsFromDisabledToEnabled) {
  EXPECT_EQ(next_state(DriveState::kSwitchOnDisabled, kEnable, 0), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(next_state(DriveState::kReadyToSwitchOn, kEnable, 0), DriveState::kSwitchedOn);
}

TEST(Cia402, DisableVoltageSwitchesOffFromEverywhereButFault) {
  for (const DriveState state : {DriveState::kReadyToSwitchOn, DriveState::kSwitchedOn,
                                 DriveState::kOperationEnabled, DriveState::kQuickStop}) {
    EXPECT_EQ(next_state(state, kDisableVoltage, kEnable), DriveState::kSwitchOnDisabled);
  }
  EXPECT_EQ(next_state(DriveState::kFault, kDisableVoltage, kEnable), DriveState::kFault);
}

TEST(Cia402, QuickStopIsHeldWhereTheDriveWasEnabled) {
  EXPECT_EQ(next_state(DriveState::kOperationEnabled, kQuickStop, kEnable), DriveState::kQuickStop);
  EXPECT_EQ(next_state(DriveState::kSwitchedOn, kQuickStop, kSwitchOn),
            DriveState::kSwitchOnDisabled);
}

TEST(Cia402, AFaultIsResetByTheRisingEdgeAlone) {
  EXPECT_EQ(next_state(DriveState::kFault, kFaultReset, 0), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(next_state(DriveState::kFault, kFaultReset, kFaultReset), DriveState::kFault);
  EXPECT_EQ(next_state(DriveState::kFaultReaction, kFaultReset, 0), DriveState::kFaultReaction);
}

TEST(Cia402, EveryCommandInEveryStateLeadsWhereTheTableSays) {
  using S = DriveState;
  struct Row {
    S from, disable, quick_stop, shutdown, switch_on, enable, reset;
  };
  const Row table[] = {
      {S::kNotReady, S::kSwitchOnDisabled, S::kSwitchOnDisabled, S::kNotReady, S::kNotReady,
       S::kNotReady, S::kSwitchOnDisabled},
      {S::kSwitchOnDisabled, S::kSwitchOnDisabled, S::kSwitchOnDisabled, S::kReadyToSwitchOn,
       S::kSwitchOnDisabled, S::kSwitchOnDisabled, S::kSwitchOnDisabled},
      {S::kReadyToSwitchOn, S::kSwitchOnDisabled, S::kSwitchOnDisabled, S::kReadyToSwitchOn,
       S::kSwitchedOn, S::kSwitchedOn, S::kSwitchOnDisabled},
      {S::kSwitchedOn, S::kSwitchOnDisabled, S::kSwitchOnDisabled, S::kReadyToSwitchOn,
       S::kSwitchedOn, S::kOperationEnabled, S::kSwitchOnDisabled},
      {S::kOperationEnabled, S::kSwitchOnDisabled, S::kQuickStop, S::kReadyToSwitchOn,
       S::kSwitchedOn, S::kOperationEnabled, S::kSwitchOnDisabled},
      {S::kQuickStop, S::kSwitchOnDisabled, S::kQuickStop, S::kQuickStop, S::kQuickStop,
       S::kQuickStop, S::kSwitchOnDisabled},
      {S::kFaultReaction, S::kFaultReaction, S::kFaultReaction, S::kFaultReaction,
       S::kFaultReaction, S::kFaultReaction, S::kFaultReaction},
      {S::kFault, S::kFault, S::kFault, S::kFault, S::kFault, S::kFault, S::kSwitchOnDisabled},
  };
  for (const Row& row : table) {
    EXPECT_EQ(next_state(row.from, kDisableVoltage, 0), row.disable) << name_of(row.from);
    EXPECT_EQ(next_state(row.from, kQuickStop, 0), row.quick_stop) << name_of(row.from);
    EXPECT_EQ(next_state(row.from, kShutdown, 0), row.shutdown) << name_of(row.from);
    EXPECT_EQ(next_state(row.from, kSwitchOn, 0), row.switch_on) << name_of(row.from);
    EXPECT_EQ(next_state(row.from, kEnable, 0), row.enable) << name_of(row.from);
    EXPECT_EQ(next_state(row.from, kFaultReset, 0), row.reset) << name_of(row.from);
  }
}

TEST(Cia402, StatuswordsSayWhatAControllerReads) {
  for (int n = 0; n <= static_cast<int>(DriveState::kFault); ++n) {
    const auto state = static_cast<DriveState>(n);
    EXPECT_EQ(drive_state(statusword(state)), state) << name_of(state);
  }
}

TEST(Cia402, StatuswordsAreThoseOfTheStandard) {
  constexpr std::uint16_t kMask = 0x6F;
  EXPECT_EQ(statusword(DriveState::kSwitchOnDisabled) & 0x4F, 0x40);
  EXPECT_EQ(statusword(DriveState::kReadyToSwitchOn) & kMask, 0x21);
  EXPECT_EQ(statusword(DriveState::kSwitchedOn) & kMask, 0x23);
  EXPECT_EQ(statusword(DriveState::kOperationEnabled) & kMask, 0x27);
  EXPECT_EQ(statusword(DriveState::kQuickStop) & kMask, 0x07);
  EXPECT_EQ(statusword(DriveState::kFaultReaction) & 0x4F, 0x0F);
  EXPECT_EQ(statusword(DriveState::kFault) & 0x4F, 0x08);
}

}  // namespace
}  // namespace meridian::drive
