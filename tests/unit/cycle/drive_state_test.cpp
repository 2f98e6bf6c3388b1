// SPDX-License-Identifier: Apache-2.0
#include "meridian/cycle/drive_state.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace meridian {
namespace {

struct Statusword {
  std::uint16_t word;
  DriveState state;
};

TEST(DriveState, IsReadFromAStatuswordWhateverTheOtherBitsSay) {
  const std::vector<Statusword> cases = {
      {0x00, DriveState::kNotReady},         {0x40, DriveState::kSwitchOnDisabled},
      {0x21, DriveState::kReadyToSwitchOn},  {0x23, DriveState::kSwitchedOn},
      {0x27, DriveState::kOperationEnabled}, {0x07, DriveState::kQuickStop},
      {0x0F, DriveState::kFaultReaction},    {0x08, DriveState::kFault}};
  for (const Statusword& one : cases) {
    for (const int others : {0x0000, 0x0010, 0x0080, 0x1600, 0xFF90}) {
      EXPECT_EQ(drive_state(static_cast<std::uint16_t>(one.word | others)), one.state)
          << std::hex << one.word << " | " << others;
    }
  }
}

}  // namespace
}  // namespace meridian
