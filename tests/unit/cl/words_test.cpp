// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "read_text.hpp"
#include "service/programs/cl/words/word_table.hpp"

namespace meridian::cl {
namespace {

const ClBlock& first_block(const ReadText& read) {
  EXPECT_EQ(read.error, "");
  return read.blocks.at(0);
}

TEST(Words, OfToolsBecomeToolBlocks) {
  for (const char* line :
       {"LOADTL/45", "LOADTL / 45", "LOADTL/45,ADJUST,1", "LOAD/TOOL,45", "LOAD / TOOL, 45, 2"}) {
    const auto read = read_body(std::string(line) + "\nGOTO/0,0,0\n");
    const ClBlock& block = first_block(read);
    EXPECT_EQ(block.kind, BlockKind::kTool) << line;
    EXPECT_EQ(block.action, ActionKind::kToolChange);
    EXPECT_EQ(block.value, 45);
    EXPECT_EQ(read.summary.tools, (std::vector<std::uint32_t>{45}));
  }
  for (const char* line : {"LOADTL/", "LOADTL/A", "LOAD/TAPE,1", "LOADTL/1.5", "LOADTL/-1"}) {
    EXPECT_EQ(read_body(std::string(line) + "\nGOTO/0,0,0\n").error_line, 3U) << line;
  }
}

TEST(Words, ThatOnlyDescribeAToolGiveNoBlock) {
  const auto read = read_body(
      "SELECT/TOOL,45\nTLDATA/MILL,30.0000,0.0000,75.0000,0.0000,0.0000\n"
      "CUTTER/10.,5.,5.,$\n0.,0.,50.\nTOOLNO/1,MILL,1,6,10.\nTPRINT/T1 Fraise \xe0 bout, D 10\n"
      "GOTO/0,0,0\n");
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.blocks.size(), 2U);
  EXPECT_TRUE(read.warnings.empty());
}

TEST(Words, OfTheSpindleComeInAnyOrder) {
  for (const char* line :
       {"SPINDL/RPM,1000,CCLW ", "SPINDL/1000,RPM,CCLW", "SPINDL/CCLW,RPM,1000",
        "SPINDL / RPM, 1000.00,  CCLW", "SPINDL/ 1000.0,CCLW,RPM", "SPINDL/1000,CCLW"}) {
    const auto read = read_body(std::string(line) + "\nGOTO/0,0,0\n");
    EXPECT_EQ(first_block(read).action, ActionKind::kSpindleCounterClockwise) << line;
    EXPECT_EQ(first_block(read).value, 1000);
  }
  EXPECT_EQ(first_block(read_body("SPINDL/RPM,1310,CLW\nGOTO/0,0,0\n")).action,
            ActionKind::kSpindleClockwise);
  EXPECT_EQ(first_block(read_body("SPINDL/OFF\nGOTO/0,0,0\n")).action, ActionKind::kSpindleOff);
  const auto again = read_body("SPINDL/800,CCLW\nSPINDL/OFF\nSPINDL/ON\nGOTO/0,0,0\n");
  EXPECT_EQ(again.blocks.at(2).action, ActionKind::kSpindleCounterClockwise);
  EXPECT_EQ(again.blocks.at(2).value, 800);
  EXPECT_EQ(first_block(read_body("SPINDL/ORIENT,90\nGOTO/0,0,0\n")).action,
            ActionKind::kVendorWord);
}

TEST(Words, OfGearsAndLimitsLeaveTheSpindleItsSpeed) {
  for (const char* words :
       {"3000,RPM,CLW,RANGE,HIGH", "RANGE,2,3000,CLW", "3000,RANGE,CLW", "3000,RPM,CLW,MAXRPM,5000",
        "MAXRPM,5000,CLW,3000", "3000,CLW,HIGH", "RPM,3000,LOW,CLW"}) {
    const auto read = read_text("UNITS/MM\nSPINDL/1000\nFEDRAT/0.2,MMPR\nSPINDL/" +
                                std::string(words) + "\nGOTO/0,0,0\nDELAY/100,REV\nFINI\n");
    ASSERT_EQ(read.error, "") << words;
    EXPECT_EQ(read.blocks.at(1).action, ActionKind::kSpindleClockwise) << words;
    EXPECT_EQ(read.blocks[1].value, 3000) << words;
    EXPECT_DOUBLE_EQ(read.blocks.at(2).feed, 10) << words;
    EXPECT_DOUBLE_EQ(read.blocks.at(3).value, 2) << words;
    EXPECT_EQ(read.warnings.size(), 1U) << words;
    EXPECT_TRUE(read.warned_of("is left to the machine")) << words;
  }
  EXPECT_EQ(read_body("SPINDL/RANGE,HIGH\nGOTO/0,0,0\n").blocks.at(0).action,
            ActionKind::kVendorWord);
}

TEST(Words, OfTheSpindleThatNobodyKnowsAreRefusedBesideSpeedOrSense) {
  for (const char* words : {"3000,FAST", "FAST,3000", "CLW,FAST", "ON,FAST", "3000,ORIENT,CLW",
                            "3000,CLW,RANGE,3000", "3000,MAXRPM"}) {
    const auto read = read_body("SPINDL/900\nSPINDL/" + std::string(words) + "\nGOTO/0,0,0\n");
    EXPECT_EQ(read.error_line, 4U) << words;
  }
  for (const char* words : {"ORIENT", "ORIENT,90", "LOCK,90", "NEUTRL"}) {
    EXPECT_EQ(first_block(read_body("SPINDL/" + std::string(words) + "\nGOTO/0,0,0\n")).action,
              ActionKind::kVendorWord)
        << words;
  }
}

TEST(Words, OfTheCoolantMayHaveOnBesideThem) {
  const auto what = [](const char* words) {
    return first_block(read_body("COOLNT/" + std::string(words) + "\nGOTO/0,0,0\n")).action;
  };
  EXPECT_EQ(what("ON,MIST"), ActionKind::kCoolantMist);
  EXPECT_EQ(what("MIST,ON"), ActionKind::kCoolantMist);
  EXPECT_EQ(what("FLOOD,ON"), ActionKind::kCoolantFlood);
  EXPECT_EQ(what("ON,THRU"), ActionKind::kCoolantThrough);
  EXPECT_EQ(what("ON,TAPKUL"), ActionKind::kVendorWord);
  EXPECT_EQ(what("MIST,FLOOD"), ActionKind::kVendorWord);
}

TEST(Words, OfTheCoolantBecomeActions) {
  const auto read = read_body(
      "COOLNT/ON\nCOOLNT/FLOOD\nCOOLNT/MIST\nCOOLNT/THRU\nCOOLNT/OFF\nCOOLNT/TAPKUL\nGOTO/0,0,0\n");
  ASSERT_EQ(read.error, "");
  const ActionKind wanted[] = {ActionKind::kCoolantFlood, ActionKind::kCoolantFlood,
                               ActionKind::kCoolantMist,  ActionKind::kCoolantThrough,
                               ActionKind::kCoolantOff,   ActionKind::kVendorWord};
  for (std::size_t i = 0; i < std::size(wanted); ++i) {
    EXPECT_EQ(read.blocks.at(i).action, wanted[i]) << i;
    EXPECT_EQ(read.blocks[i].kind, BlockKind::kAuxiliary);
  }
}

TEST(Reader, RestsBehindEveryCutBetweenTransitionWords) {
  const auto read = read_body(
      "GOTO/0,0,0\nTRANSITION/EXACT_STOP\nGOTO/1,0,0\nRAPID\nGOTO/1,0,5\nGOTO/1,0,0\n"
      "transition/smooth\nGOTO/2,0,0\n");
  ASSERT_EQ(read.error, "");
  std::string kinds;
  for (const ClBlock& b : read.blocks) {
    kinds += b.kind == BlockKind::kCut ? 'c' : b.kind == BlockKind::kRapid ? 'r' : '.';
    EXPECT_TRUE(b.kind != BlockKind::kDwell || b.value == 0);
  }
  EXPECT_EQ(kinds, "cc.rc.c.") << "a rest after each cut, and the end";
}

TEST(Reader, RestsAtTheEndOfASplineAndNotAtItsChords) {
  const auto read = read_body(
      "GOTO/0,0,0\nTRANSITION/EXACT_STOP\nNURBS/\nKNOT/1\nCNTRL/1,1,0\nCNTRL/2,-1,0\n"
      "CNTRL/3,0,0\n");
  ASSERT_EQ(read.error, "");
  const auto is_dwell = [](const ClBlock& b) { return b.kind == BlockKind::kDwell; };
  EXPECT_EQ(std::count_if(read.blocks.begin(), read.blocks.end(), is_dwell), 1);
  EXPECT_GT(read.blocks.size(), 10U);
}

TEST(Reader, RefusesATransitionThatItDoesNotKnow) {
  for (const char* word :
       {"TRANSITION/FAST", "TRANSITION/1", "TRANSITION", "TRANSITION/SMOOTH,1"}) {
    EXPECT_NE(read_body(std::string(word) + "\nGOTO/0,0,0\n").error, "") << word;
  }
}

TEST(Words, OfDwellAndStop) {
  const auto read =
      read_body("DELAY/2.5\nSPINDL/600\nDELAY/ 5.0,REV\nDWELL/1\nSTOP\nOPSTOP\nGOTO/0,0,0\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.blocks.at(0).kind, BlockKind::kDwell);
  EXPECT_EQ(read.blocks[0].value, 2.5);
  EXPECT_EQ(read.blocks.at(2).value, 0.5);
  EXPECT_EQ(read.blocks.at(3).value, 1);
  EXPECT_EQ(read.blocks.at(4).kind, BlockKind::kStop);
  EXPECT_EQ(read.blocks.at(5).kind, BlockKind::kOptionalStop);
  EXPECT_NE(read_body("DELAY/5,REV\nGOTO/0,0,0\n").error, "");
  EXPECT_NE(read_body("DELAY/-1\nGOTO/0,0,0\n").error, "");
}

TEST(Words, ForViewersAreSkippedAndCounted) {
  const auto read = read_body(
      "PAINT/PATH\nPAINT/SPEED,10\nPAINT/COLOR,186\nDISPLY/ON\nGOTO/0,0,0\nPAINT/TOOL,NOMORE\n");
  EXPECT_EQ(read.error, "");
  EXPECT_TRUE(read.warnings.empty());
  ASSERT_EQ(read.summary.skipped.size(), 2U);
  EXPECT_EQ(read.summary.skipped[0].word, "PAINT");
  EXPECT_EQ(read.summary.skipped[0].count, 4U);
  EXPECT_EQ(read.summary.skipped[0].line, 3U);
  EXPECT_EQ(skipped_text(read.summary), "PAINT (4), DISPLY (1)");
  EXPECT_NE(to_text(read.summary).find("PAINT (4)"), std::string::npos);
}

TEST(Words, OfVendorsThatDoNotShapeThePathAreSkipped) {
  const auto read = read_body(
      "CSI_SET_FLUTE_LENGTH/20\nCSI_SET_FLUTE_LENGTH/30\nCSI_STOCK/\"a b\"\nINSERT/(Bohren) [T1] "
      "\"x\"\n"
      "CUTCOM/LEFT\nCUTCOM/OFF\nTHREAD/OFF\nHEAD/1\nCYCLE/INIT\nCYCLE/OFF\nMULTAX\nMULTAX/ON\nSET/"
      "MODE,ABSOL\n"
      "REMARK free $ text\nORIGIN/0,0,0\nGOTO/0,0,0\n");
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.blocks.size(), 2U);
  EXPECT_EQ(read.warnings.size(), 2U);  // INSERT, CUTCOM
  EXPECT_TRUE(read.warned_of("CUTCOM is not applied"));
}

TEST(Words, OfInsertedTextAreFlaggedAsTheyMayMoveTheMachine) {
  const auto read = read_body("GOTO/0,0,0\nINSERT G91 X100\nINSERT G90\nGOTO/0,0,1\n");
  EXPECT_EQ(read.error, "");
  ASSERT_EQ(read.warnings.size(), 1U);
  EXPECT_EQ(read.warnings[0].line, 4U);
  EXPECT_TRUE(read.warned_of("text for another control"));
}

TEST(Words, ThatAskAPostprocessorForSomethingAreFlaggedOnceEach) {
  const auto read =
      read_body("LINTOL/ON\nLINTOL/OFF\nOPSKIP/ON\nSEQNO/10\nSEQNO/20\nPPFUN/x\nGOTO/0,0,0\n");
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.blocks.size(), 2U);
  ASSERT_EQ(read.warnings.size(), 2U);  // LINTOL, OPSKIP
  EXPECT_TRUE(read.warned_of("LINTOL is skipped"));
  EXPECT_EQ(read.warnings[0].count, 2U);
}

TEST(Words, ThatTheCallerAllowsGoToTheMachine) {
  ClReaderOptions options = metric();
  options.allowed_words = {"wobble"};
  const auto read = read_text("FEDRAT/9\nWOBBLE / 7, FAST\nGOTO/0,0,0\nFINI\n", options);
  const ClBlock& block = first_block(read);
  EXPECT_EQ(block.kind, BlockKind::kAuxiliary);
  EXPECT_EQ(block.action, ActionKind::kVendorWord);
  EXPECT_STREQ(block.text, "WOBBLE/7,FAST");
  EXPECT_EQ(block.value, 7);
  const auto longer =
      read_text("FEDRAT/9\nWOBBLE/A-VERY-LONG-ARGUMENT-INDEED\nGOTO/0,0,0\nFINI\n", options);
  EXPECT_STREQ(first_block(longer).text, "WOBBLE/A-VERY-LONG-ARGU");
  EXPECT_TRUE(longer.warned_of("is cut to 23 characters"));
}

TEST(Words, OfTheMachineBecomeVendorWords) {
  const auto read = read_body("AUXFUN/8\nPREFUN/90\nCLAMP/ON\nAIR/ON\nGOTO/0,0,0\n");
  EXPECT_STREQ(first_block(read).text, "AUXFUN/8");
  EXPECT_EQ(first_block(read).value, 8);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(read.blocks.at(i).action, ActionKind::kVendorWord) << i;
  }
  EXPECT_STREQ(read.blocks[2].text, "CLAMP/ON");
}

TEST(Words, IdentifyTheDialect) {
  const auto dialect = [](const char* head) {
    return read_text(std::string(head) + "FEDRAT/9\nGOTO/0,0,0\nEND-OF-PATH\nFINI\n", metric())
        .summary.dialect;
  };
  EXPECT_EQ(dialect("TOOL PATH/A,TOOL,B\n"), "NX CLSF");
  EXPECT_EQ(dialect("PPRINT/APTCL-SPEC,MAKINO-FF,1\n"), "Makino FF CLDATA");
  EXPECT_EQ(dialect("$$-> CUTTER / 6.0\n"), "Creo NCL");
  EXPECT_EQ(dialect("UNIT/MM\n"), "SolidWorks CAM APT");
  EXPECT_EQ(dialect("LOADTL/1\n"), "APT");
}

TEST(Words, NameTheProgram) {
  EXPECT_EQ(read_body("PARTNO PIECE 1\nGOTO/0,0,0\n").summary.program, "PIECE 1");
  EXPECT_EQ(read_text("TOOL PATH/FINISH,TOOL,B\nFEDRAT/9\nGOTO/0,0,0\nEND-OF-PATH\n", metric())
                .summary.program,
            "FINISH");
}

std::string content(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

TEST(Documentation, ShowsAnExampleThatIsReadWithoutAWarning) {
  const std::string example = content(MERIDIAN_SOURCE_DIR "/docs/examples/first.apt");
  ASSERT_FALSE(example.empty());
  EXPECT_NE(content(MERIDIAN_SOURCE_DIR "/docs/cl-files.md").find("```\n" + example + "```"),
            std::string::npos);
  const auto read = read_text(example);
  EXPECT_EQ(read.error, "");
  EXPECT_TRUE(read.warnings.empty());
  EXPECT_EQ(read.motion().size(), 5U);
}

TEST(CutterCompensation, IsAsCreoWritesWhatItsPointsAre) {
  const std::string body = "UNITS/MM\nFEDRAT/9,MMPM\nGOTO/0,0,0\nCUTCOM/LEFT\nGOTO/1,2,3\nFINI\n";
  const auto centre = read_text("$$-> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_CENTER\n" + body);
  EXPECT_EQ(centre.error, "");
  EXPECT_FALSE(centre.warned_of("CUTCOM"));
  const auto profile = read_text("$$-> CUTCOM_GEOMETRY_TYPE / OUTPUT_ON_PROFILE\n" + body);
  EXPECT_NE(profile.error.find("OUTPUT_ON_CENTER"), std::string::npos) << profile.error;
}

}  // namespace
}  // namespace meridian::cl
