// SPDX-License-Identifier: Apache-2.0
#include "service/drives/kit/csp/csp_power.hpp"

#include <gtest/gtest.h>

namespace meridian::drive {
namespace {

// Statuswords as CiA 402-2 has them, with voltage enabled and remote.
constexpr std::uint16_t kNotReady = 0x210, kDisabled = 0x250, kReady = 0x231, kSwitchedOn = 0x233,
                        kEnabled = 0x237, kQuickStop = 0x217, kReaction = 0x21F, kFault = 0x218;

TEST(CspPower, EveryStateHasTheCommandThatLeadsOnOrOff) {
  struct Row {
    std::uint16_t statusword, on, off;
  };
  const Row table[] = {{kNotReady, 0x00, 0x00},   {kDisabled, 0x06, 0x06}, {kReady, 0x07, 0x06},
                       {kSwitchedOn, 0x0F, 0x06}, {kEnabled, 0x0F, 0x06},  {kQuickStop, 0x00, 0x00},
                       {kReaction, 0x00, 0x00},   {kFault, 0x00, 0x00}};
  for (const Row& row : table) {
    CspPower power;
    power.see(row.statusword);
    EXPECT_EQ(power.controlword(true, false), row.on) << std::hex << row.statusword;
    EXPECT_EQ(power.controlword(false, false), row.off) << std::hex << row.statusword;
  }
}

TEST(CspPower, ADriveThatDroppedIsNotLedBackBeforeItWasWantedOff) {
  CspPower power;
  power.see(kSwitchedOn);
  EXPECT_EQ(power.controlword(true, false), 0x0F);
  power.see(kEnabled);
  EXPECT_EQ(power.controlword(true, false), 0x0F);
  for (const std::uint16_t fallen : {kDisabled, kReady, kSwitchedOn, kQuickStop, kReady}) {
    power.see(fallen);  // safe torque off came and went
    EXPECT_TRUE(power.has_dropped());
    const std::uint16_t word = power.controlword(true, false);
    EXPECT_TRUE(word == 0x06 || word == 0x00) << word;
  }
  EXPECT_EQ(power.controlword(false, false), 0x06);
  EXPECT_FALSE(power.has_dropped());
  EXPECT_EQ(power.controlword(true, false), 0x07);
}

TEST(CspPower, AFaultIsNoDrop) {
  CspPower power;
  power.see(kSwitchedOn);
  (void)power.controlword(true, false);
  power.see(kEnabled);
  power.see(kReaction);
  EXPECT_FALSE(power.has_dropped());
  EXPECT_TRUE(power.is_fault());
}

TEST(CspPower, AResetIsARisingEdgeAndAnotherOneWhereItDidNotHelp) {
  CspPower power;
  power.see(kFault);
  int edges = 0;
  std::uint16_t before = power.controlword(false, false);
  EXPECT_EQ(before, 0x00) << "nobody asked for a reset";
  for (int n = 0; n < 100; ++n) {
    const std::uint16_t word = power.controlword(false, true);
    if ((word & ~before & 0x80) != 0) ++edges;
    before = word;
  }
  EXPECT_EQ(edges, 3);
  power.see(kDisabled);
  EXPECT_EQ(power.controlword(false, true), 0x06);
}

}  // namespace
}  // namespace meridian::drive
