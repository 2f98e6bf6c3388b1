// SPDX-License-Identifier: Apache-2.0
// CYCL DEF 200 and its kin with CYCL CALL, M99 and M89, against levels worked out by hand.
#include <gtest/gtest.h>

#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

const std::string kAbove = "2 L X+0 Y+0 Z+20 R0 FMAX\n";
const std::string kDrill =
    "3 CYCL DEF 200 DRILLING ~\n  Q200=+2 ;SET-UP CLEARANCE ~\n  Q201=-9    ;DEPTH ~\n"
    "  Q206=150 ;FEED RATE FOR PLNGNG ~\n  Q202=+20 ;PLUNGING DEPTH ~\n  Q210=+0 ;DWELL ~\n"
    "  Q203=+1,0 ;SURFACE COORDINATE ~\n  Q204=+10 ;2ND SET-UP CLEARANCE ~\n"
    "  Q211=+0 ;DWELL TIME AT DEPTH\n";

std::string klartext_holes(const std::string& body) {
  const ReadText read = read_klartext(kAbove + body);
  return read.error.empty() ? levels_of(read) : read.error;
}

TEST(KlartextCycles, DrillBehindM99) {
  const ReadText read = read_klartext(kAbove + kDrill + "4 L X+5 Y+5 R0 FMAX M99\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(levels_of(read), "20r 3r -8f 11r");
  EXPECT_DOUBLE_EQ(read.motion()[3].feed * 60, 150);
  EXPECT_EQ(klartext_holes(kDrill + "4 L X+5 R0 FMAX M99\n5 L X+9 R0 FMAX\n"),
            "20r 3r -8f 11r 11r");
}

TEST(KlartextCycles, DrillWhereTheToolStands) {
  EXPECT_EQ(klartext_holes(kDrill + "4 CYCL CALL\n5 CYCL CALL FMAX\n"), "3r -8f 11r 3r -8f 11r");
}

TEST(KlartextCycles, DrillBehindEveryMotionFromM89ToM99) {
  EXPECT_EQ(
      klartext_holes(kDrill + "4 L X+1 FMAX M89\n5 L X+2 FMAX\n6 L X+3 FMAX M99\n7 L X+4 FMAX\n"),
      "20r 3r -8f 11r 11r 3r -8f 11r 11r 3r -8f 11r 11r");
}

TEST(KlartextCycles, TakeAllParametersInOneLine) {
  EXPECT_EQ(
      klartext_holes("3 CYCL DEF 240 CENTERING Q200=2 Q343=0 Q201=-3 Q344=0 Q206=90 Q211=0 Q203=0 "
                     "Q204=5\n4 CYCL CALL\n"),
      "2r -3f 5r");
}

TEST(KlartextCycles, PeckWithADecrement) {
  EXPECT_EQ(klartext_holes(
                "3 CYCL DEF 203 UNIVERSAL DRILLING Q200=2 Q201=-9 Q206=90 Q202=4 Q203=0 Q204=5 "
                "Q212=1 Q213=0 Q205=2 Q208=FMAX\n4 CYCL CALL\n"),
            "2r -4f 2r -3r -7f 2r -6r -9f 5r");
}

TEST(KlartextCycles, BreakTheChipSoManyTimesBeforeLeavingTheHole) {
  EXPECT_EQ(klartext_holes(
                "3 CYCL DEF 203 UNIVERSAL DRILLING Q200=2 Q201=-9 Q206=90 Q202=3 Q203=0 Q204=5 "
                "Q213=1 Q256=1 Q208=99999\n4 CYCL CALL\n"),
            "2r -3f -2r -6f 2r -5r -9f 5r");
}

TEST(KlartextCycles, FeedOutWithTheirOwnFeedOrThatOfTheWayIn) {
  const std::string ream = "3 CYCL DEF 201 REAMING Q200=2 Q201=-9 Q206=90 Q211=0.5 Q203=0 Q204=5 ";
  const ReadText read = read_klartext(kAbove + ream + "Q208=250\n4 CYCL CALL\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(levels_of(read), "2r -9f 2f 5r");
  EXPECT_DOUBLE_EQ(read.motion()[3].feed * 60, 250);
  EXPECT_DOUBLE_EQ(read.summary.dwell_time_s, 0.5);
  EXPECT_DOUBLE_EQ(read_klartext(kAbove + ream + "Q208=0\n4 CYCL CALL\n").motion()[3].feed * 60,
                   90);
}

TEST(KlartextCycles, DwellAtTheBottomAlone) {
  EXPECT_DOUBLE_EQ(read_klartext(kAbove + "3 CYCL DEF 200 DRILLING Q200=2 Q201=-9 Q206=90 Q202=4 "
                                          "Q203=0 Q204=5 Q211=0.25\n4 CYCL CALL\n")
                       .summary.dwell_time_s,
                   0.25);
}

TEST(KlartextCycles, NameTheRowOfThePresetTableThatIsTheFrameOfTheStation) {
  const std::string preset = "2 CYCL DEF 247 DATUM SETTING ~\n  Q339=+1 ;DATUM NUMBER\n";
  const ReadText read = read_klartext(preset + kAbove + kDrill + preset + "4 CYCL CALL\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.summary.nc.work_offset, "CYCL DEF 247 Q339=1");
  EXPECT_EQ(read.summary.holes, 1U) << "the cycle in force stays";
  EXPECT_NE(read_klartext(preset + kAbove + "CYCL DEF 247 DATUM SETTING Q339=2\nL X+1\n")
                .error.find("a second work offset (CYCL DEF 247 Q339=2"),
            std::string::npos);
}

TEST(KlartextCycles, AreCalledWithActionsBesideThem) {
  const ReadText read = read_klartext("TOOL CALL 1 Z S900\n" + kAbove + kDrill +
                                      "CYCL CALL FMAX M13\nL X+5 FMAX\nCYCL CALL M9\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.summary.holes, 2U);
  const auto is_at = [&](ActionKind action) {
    return std::find_if(read.blocks.begin(), read.blocks.end(), [&](const ClBlock& block) {
      return block.kind == BlockKind::kAuxiliary && block.action == action;
    });
  };
  const auto first_cut = std::find_if(read.blocks.begin(), read.blocks.end(),
                                      [](const auto& b) { return b.kind == BlockKind::kCut; });
  EXPECT_LT(is_at(ActionKind::kSpindleClockwise), first_cut);
  EXPECT_LT(is_at(ActionKind::kCoolantFlood), first_cut);
  EXPECT_LT(first_cut, is_at(ActionKind::kCoolantOff));
  EXPECT_NE(is_at(ActionKind::kCoolantOff), read.blocks.end());
}

TEST(KlartextCycles, AreRefusedByName) {
  const std::vector<std::pair<std::string, const char*>> cases = {
      {"CYCL DEF 207 RIGID TAPPING ~", "CYCL DEF 207: a cycle of the control"},
      {"CYCL CALL", "no CYCL DEF that is run here"},
      {"L X+5 FMAX M99", "no CYCL DEF that is run here"},
      {kDrill + "CYCL CALL POS X+5 Y+5", "CYCL CALL POS X+5 Y+5 is not run"},
      {kDrill + "CYCL CALL PAT FMAX", "CYCL CALL PAT FMAX is not run"},
      {"CYCL DEF 200 DRILLING Q200=2 Q201=-9 Q202=5\nCYCL CALL", "without Q203"},
      {"CYCL DEF 200 DRILLING Q200=2 Q201=9 Q202=5 Q203=0\nCYCL CALL", "has to be below zero"},
      {"CYCL DEF 200 DRILLING Q200=2 Q201=-9 Q203=0\nCYCL CALL", "without a plunging depth Q202"},
      {"CYCL DEF 240 CENTERING Q200=2 Q343=1 Q201=-9 Q203=0\nCYCL CALL", "with Q343 other than 0"},
      {"CYCL DEF 205 PECKING Q200=2 Q201=-9 Q202=5 Q203=0 Q257=2\nCYCL CALL",
       "with Q257 other than 0"},
      {"CYCL DEF 200 DRILLING Q200=+Q1", "a Q parameter: 'Q200=+Q1'"},
      {kDrill + "L X+1 FMAX\nQ201=-20", "a Q parameter: 'Q201=-20'"},
      {kDrill + "M128\nL X+5 FMAX M99", "with tool-centre control"}};
  for (const auto& [lines, says] : cases) {
    EXPECT_NE(klartext_holes(lines + "\n").find(says), std::string::npos)
        << lines << ": " << klartext_holes(lines + "\n");
  }
}

}  // namespace
}  // namespace meridian::nc
