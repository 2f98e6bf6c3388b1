// SPDX-License-Identifier: Apache-2.0
// M codes, tools, spindle and dwells of NC programs.
#include <gtest/gtest.h>

#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

constexpr std::string_view kStart = "G0 X0. Y0. Z0.\n";

std::vector<ClBlock> actions(std::string_view body) {
  const ReadText read = read_nc(std::string(kStart) + std::string(body));
  EXPECT_EQ(read.error, "");
  std::vector<ClBlock> out(read.blocks.begin() + 1, read.blocks.end() - 1);
  return out;
}

TEST(NcActions, StartTheSpindleBeforeTheMotionAndStopItBehind) {
  const auto blocks = actions("S1000 M3\nS2000\nG1 X1. M5\nM4 G1 X2.\n");
  ASSERT_EQ(blocks.size(), 6U);
  EXPECT_EQ(blocks[0].action, ActionKind::kSpindleClockwise);
  EXPECT_EQ(blocks[0].value, 1000);
  EXPECT_EQ(blocks[1].value, 2000);
  EXPECT_EQ(blocks[2].kind, BlockKind::kCut);
  EXPECT_EQ(blocks[3].action, ActionKind::kSpindleOff);
  EXPECT_EQ(blocks[4].action, ActionKind::kSpindleCounterClockwise);
  EXPECT_EQ(blocks[5].kind, BlockKind::kCut);
}

TEST(NcActions, ChangeToTheToolThatTNamed) {
  const auto blocks = actions("T12 M6\nT3\nM6\n");
  ASSERT_EQ(blocks.size(), 2U);
  EXPECT_EQ(blocks[0].kind, BlockKind::kTool);
  EXPECT_EQ(blocks[0].value, 12);
  EXPECT_EQ(blocks[1].value, 3);
}

TEST(NcActions, SwitchCoolantAndStop) {
  const auto blocks = actions("M8\nM7\nM9\nM0\nM1\n");
  ASSERT_EQ(blocks.size(), 5U);
  EXPECT_EQ(blocks[0].action, ActionKind::kCoolantFlood);
  EXPECT_EQ(blocks[1].action, ActionKind::kCoolantMist);
  EXPECT_EQ(blocks[2].action, ActionKind::kCoolantOff);
  EXPECT_EQ(blocks[3].kind, BlockKind::kStop);
  EXPECT_EQ(blocks[4].kind, BlockKind::kOptionalStop);
}

TEST(NcActions, PassOtherCodesToTheMachine) {
  const auto blocks = actions("M88\n");
  ASSERT_EQ(blocks.size(), 1U);
  EXPECT_EQ(blocks[0].action, ActionKind::kVendorWord);
  EXPECT_STREQ(blocks[0].text, "M88");
}

TEST(NcActions, PassOverSettingsOfTheControlWithTheirWords) {
  const ReadText read = read_nc(
      "G13.1\nG23\nG25\nG40.1\nG50.2\nG15\nG54.2 P0\nG54.4 P0\nG05.1 Q1 R5\nG0 X0. Y0. Z0.\nG103 "
      "P1\nG187 P3 E0.01\nG05 P10000\nG1 X1.\nG05 P0\nG103\n");
  EXPECT_EQ(read.error, "");
  EXPECT_TRUE(read.warnings.empty() || !read.warned_of("taken as motion"));
  EXPECT_EQ(read.motion().size(), 2U);
}

TEST(NcActions, PassOverAxesThatASettingNames) {
  for (const char* setting : {"G05.1 Q2 X0 Y0 Z0", "G5.1 Q3 X0 Y0 Z0 A0 C0", "G5.1 Q0"}) {
    const ReadText read =
        read_nc("G0 X10. Y10. Z10.\n" + std::string(setting) + "\nG1 Z0. F100.\n");
    ASSERT_EQ(read.error, "") << setting;
    const auto motion = read.motion();
    ASSERT_EQ(motion.size(), 2U) << setting;
    EXPECT_EQ(to_vector(motion.back().tip_mm), Vector3(10, 10, 0)) << setting;
  }
  EXPECT_NE(read_nc("G0 X10. Y10. Z10.\nG5.1 Q1 G1 X0.\n").error.find("G5.1 beside G0 to G3"),
            std::string::npos);
}

TEST(NcActions, DwellInSecondsAndMilliseconds) {
  const auto blocks = actions("G4 X1.5\nG4 P250\nG4 P0.5\n");
  ASSERT_EQ(blocks.size(), 3U);
  EXPECT_DOUBLE_EQ(blocks[0].value, 1.5);
  EXPECT_DOUBLE_EQ(blocks[1].value, 0.25);
  EXPECT_DOUBLE_EQ(blocks[2].value, 0.5);
}

TEST(NcActions, EndTheProgramAtM30OrTheClosingMark) {
  EXPECT_EQ(cl::read_text("%\nG21 G0 X0. Y0. Z0.\nM2\nG0 X9.\n", without_machine()).blocks.size(),
            2U);
  EXPECT_EQ(cl::read_text("%\nG21 G0 X0. Y0. Z0.\n%\n", without_machine()).error, "");
  const ReadText open = cl::read_text("%\nG21 G0 X0. Y0. Z0.\n", without_machine());
  EXPECT_NE(open.error.find("cut short: there is no M30"), std::string::npos) << open.error;
  ClReaderOptions options = without_machine();
  options.allow_no_end = true;
  EXPECT_EQ(cl::read_text("G21 G0 X0. Y0. Z0.\n", options).error, "");
}

TEST(NcActions, HoldTheProgramsName) {
  const ReadText read =
      cl::read_text("%\nO0012 (IMPELLER)\nG21 G0 X0. Y0. Z0.\nM30\n%\n", without_machine());
  EXPECT_EQ(read.summary.program, "O0012 IMPELLER");
  EXPECT_EQ(read.summary.comments, 1U);
}

}  // namespace
}  // namespace meridian::nc
