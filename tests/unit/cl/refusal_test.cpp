// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>

#include "read_text.hpp"
#include "service/programs/cl/foreign.hpp"

namespace meridian::cl {
namespace {

struct Foreign {
  const char* name;
  std::string text;
};

class ForeignFiles : public testing::TestWithParam<Foreign> {};

TEST_P(ForeignFiles, AreRefusedByName) {
  const auto read = read_text(GetParam().text, metric());
  EXPECT_NE(read.error.find(GetParam().name), std::string::npos) << read.error;
  EXPECT_NE(read.error.find("not a CL file"), std::string::npos);
  EXPECT_TRUE(read.blocks.empty());
}

INSTANTIATE_TEST_SUITE_P(
    ByContent, ForeignFiles,
    testing::Values(
        Foreign{"Siemens",
                "N10 ;Start\nN20 DEF REAL _tol\nN30 G40 G17 G710 G94 G90\nN40 TRAORI\n"
                "N50 G0 X0.0 Y20. I0.0\nN60 SUPA G0 Z=_Z D0\n"},
        Foreign{"Siemens", "N10 G40 G17\nN20 CYCLE800()\nN30 G0 X25. Y4. S20000 D1 M3\n"},
        Foreign{"Siemens NC program (_N_)",
                "%_N_X_MPF\n;$PATH=/_N_WKS_DIR\nN10 TRAORI\nN20 G1 X=R1 Y2\n"},
        Foreign{
            "Siemens NC program (TRAORI)",
            "DEF REAL _camtolerance\nTRAORI\nCYCLE832(_camtolerance,1,1)\nCYCLE800()\nG1 X1 Y1\n"},
        Foreign{"Siemens NC program (CYCLE832)", "DEF REAL _t\nCYCLE832(_t,1,1)\nG1 X=_A\n"},
        Foreign{
            "Siemens",
            "N10 G17 G90 G54\nSTART:\nN20 TRAORI\nN30 G1 X10 Y20 Z3 F1000\nGOTOB START\nN50 M30\n"},
        Foreign{"Fanuc", "%\nO1000\nG90 G54\nG43.4 H1\nX1. Y2. Z3.\nGOTO 100\nM30\n%\n"},
        Foreign{"G code", "T1 M6\nG0 X[#1+2]\nWHILE [#1 LT 3] DO1\nG1 Y#2\nEND1\nM30\n"},
        Foreign{"Heidenhain",
                "0  BEGIN PGM 11 MM\n1 ;part\n2 CYCL DEF 7.0 DATUM SHIFT\n"
                "3 L Z-10 R0 FMAX M91\n4 L X+1 Z 25.000 F100\n"},
        Foreign{"LinuxCNC", "%\n(impeller)\nG21 G90\nM428\nG93\nG1 X  16.339 Y  2.0 A 10. F 30.\n"},
        Foreign{"LinuxCNC", "o<boat> sub\nG0 X1 Y2\nG1 X2 F100\n#<_depth> = 3\n"},
        Foreign{"Fanuc", "%\nO1234 (PART)\nG90 G54\nG43.4 H1\nG1 X1. Y2. Z3. A10. C20. F500.\n%\n"},
        Foreign{"Fanuc", "%\nO0001\nN10 G0 X0 Y0\nN20 G1 Z-1. F100.\nM30\n%\n"},
        Foreign{"G code", "G21\nG0 X0 Y0 Z5\nG1 Z-1 F100\nX10\nM30\n"},
        Foreign{"Mastercam NCI",
                "1050\n8 0 0 0 0 \"X7\"\n1002\n1 2 10. 5. 500\n0\n0 0. 0. 10. -2 0\n"},
        Foreign{"ZIP", std::string("PK\x03\x04 and so on", 14)},
        Foreign{"gzip", std::string("\x1f\x8b\x08\x00\x00", 5)}, Foreign{"PDF", "%PDF-1.7\n"},
        Foreign{"STEP", "ISO-10303-21;\nHEADER;\n"},
        Foreign{"XML", "<?xml version=\"1.0\"?>\n<a/>\n"},
        Foreign{"UTF-16", std::string("\xff\xfeG\0O\0T\0O\0", 10)},
        Foreign{"binary", std::string("GOTO\0\x01\x02\x03\x04\0\0\0\n", 13)}));

TEST(Foreign, LeavesClFilesAlone) {
  for (const char* text :
       {"GOTO/1 2 3", "$$ISO\nUNITS/MM\n", "PARTNO N10 G1 X1\nUNITS/MM\nGOTO/1,2,3\n",
        "PPRINT/APTCL-SPEC,MAKINO-FF,1\nUNITS/MM\n", "% \nPARTNO A\n", "PPRINT TRAORI\n",
        "INSERT TRAORI\nINSERT CYCLE800()\nLOADTL / 1\n", "$$ TRAORI\nMULTAX\n"}) {
    EXPECT_EQ(recognise_foreign(text).foreign, "") << text;
  }
}

TEST(Refusal, OfAnEmptyFile) {
  for (const char* text : {"", "\n\n  \r\n", "\x1a", "\xef\xbb\xbf"}) {
    EXPECT_NE(read_text(text, metric()).error.find("empty"), std::string::npos);
  }
  EXPECT_NE(read_text("$$ only a comment\n", metric()).error.find("empty"), std::string::npos);
  EXPECT_NE(read_text("UNITS/MM\nFINI\n").error.find("no motion"), std::string::npos);
}

TEST(Refusal, OfBinaryDataInTheMiddle) {
  const std::string text = "UNITS/MM\nFEDRAT/9\nGOTO/1,2,3\n" + std::string(70000, ' ') + "\n" +
                           std::string("GO\0TO", 5) + "\nFINI\n";
  EXPECT_NE(read_text(text).error, "");
}

TEST(Refusal, OfUnknownWordsNamesTheLineAndTheWayOut) {
  const auto read = read_body("GOTO/1,2,3\nFROBNICATE/1,2\nGOTO/1,2,4\n");
  EXPECT_EQ(read.error_line, 4U);
  EXPECT_NE(read.error.find("unknown word 'FROBNICATE'; --allow-unknown FROBNICATE"),
            std::string::npos)
      << read.error;
  EXPECT_EQ(read.blocks.size(), 1U);  // nothing of a later block comes out
}

TEST(Refusal, OfOrphanNumbers) {
  const auto read = read_body("GOTO/1,2,3\n0.5, 0.3, 0.8\n");
  EXPECT_NE(read.error.find("without a word"), std::string::npos);
}

TEST(Refusal, OfWordsThatMoveTheMachineBehindOurBack) {
  for (const char* line :
       {"CYCLE/DRILL,10,MMPM,100,5", "CYCLE/TAP,10,OFF,2", "CYCLE/DEEP2,12.5,IPM,5,.1", "GOHOME",
        "ROTABL/90,CLW", "COPY/1,TRANSL,10,0,0,3", "CALL/SUB1", "MODE/INCR", "SET/MODE,INCR",
        "SPINDL/SFM,200", "THREAD/TURN", "HEAD/2"}) {
    EXPECT_EQ(read_body("GOTO/1,2,3\n" + std::string(line) + "\nGOTO/1,2,4\n").error_line, 4U)
        << line;
  }
}

TEST(Refusal, OfADirectory) {
  std::ifstream in(testing::TempDir(), std::ios::binary);
  ClReader reader(in, "directory");
  EXPECT_FALSE(reader.next());
}

TEST(Refusal, OnceStaysRefused) {
  ClReader reader(std::string_view("UNITS/MM\nFEDRAT/9\nNO/1\nGOTO/1,2,3\nFINI\n"), "a");
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.next());
}

TEST(Truncation, InsideAStatementIsRefused) {
  const auto read = read_text("UNITS/MM\nFEDRAT/9\nGOTO/1,2,3\nGOTO/1,2,3 $\n");
  EXPECT_NE(read.error.find("cut short"), std::string::npos);
  EXPECT_EQ(read.error_line, 4U);
}

TEST(Truncation, BetweenCircleAndGotoIsRefused) {
  const auto read = read_text("UNITS/MM\nFEDRAT/9\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\n");
  EXPECT_NE(read.error.find("cut short"), std::string::npos);
}

TEST(Truncation, BeforeTheEndWordOfAProgramIsRefusedWithTheWayOut) {
  const std::string text = "UNITS/MM\nLOADTL/1\nFEDRAT/9\nGOTO/1,2,3\n";
  const auto read = read_text(text);
  EXPECT_NE(read.error.find("no FINI"), std::string::npos);
  EXPECT_NE(read.error.find("--allow-no-end"), std::string::npos);
  ClReaderOptions options;
  options.allow_no_end = true;
  const auto allowed = read_text(text, options);
  EXPECT_EQ(allowed.error, "");
  EXPECT_EQ(allowed.blocks.back().kind, BlockKind::kEnd);
}

TEST(Truncation, OfAToolPathOrASectionIsRefused) {
  EXPECT_NE(read_text("TOOL PATH/A,TOOL,B\nFEDRAT/9\nGOTO/1,2,3\n", metric())
                .error.find("no END-OF-PATH"),
            std::string::npos);
  EXPECT_NE(read_text("PPRINT/BEGIN-SECTION,PATH\nUNITS/MM\nFEDRAT/9\nGOTO/1,2,3\n")
                .error.find("END-SECTION"),
            std::string::npos);
}

TEST(Truncation, DoesNotHitFilesThatEndTheirOwnWay) {
  for (const char* text :
       {"TOOL PATH/A,TOOL,B\nFEDRAT/9\nGOTO/1,2,3\nEND-OF-PATH\n",
        "PPRINT/BEGIN-SECTION,P\nFEDRAT/9\nGOTO/1,2,3\nPPRINT/END-SECTION,P\n",
        "pprint/begin-section,p\nfedrat/9\ngoto/1,2,3\npprint/end-section,p\n",
        "FEDRAT/9\nGOTO/1,2,3\nEND\n", "FEDRAT/9\nGOTO/1,2,3\nFINI\nthis is not looked at",
        "FEDRAT/9\nGOTO/1,2,3\nEND\nFINI\n"}) {
    const auto read = read_text(text, metric());
    EXPECT_EQ(read.error, "") << text;
    ASSERT_FALSE(read.blocks.empty());
    EXPECT_EQ(read.blocks.back().kind, BlockKind::kEnd);
    EXPECT_EQ(read.summary.blocks_by_kind[static_cast<std::size_t>(BlockKind::kEnd)], 1U);
  }
}

TEST(Truncation, OfABareListOfPointsIsUnknowableAndTheReaderSaysSo) {
  ClReaderOptions options = metric();
  options.default_feed_mm_per_s = 10;
  const auto read = read_text("GOTO/1 2 3 0 0 1\nGOTO/1 2 4 0 .6 .8", options);
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.motion().size(), 2U);
  EXPECT_TRUE(read.warned_of("no FINI"));
}

TEST(Refusal, OfAFileThatOnlySaysWhereTheToolIs) {
  EXPECT_NE(read_text("UNITS/MM\nFROM/1,2,3\nFINI\n").error.find("no motion"), std::string::npos);
  EXPECT_NE(read_text("UNITS/MM\nFROM/1,2,3\n").error.find("no motion"), std::string::npos);
}

TEST(End, ComesLastWhereTheMachineIsSwitchedOffBehindIt) {
  for (const char* tail :
       {"END\nCOOLNT/OFF\nSPINDL/OFF\nFINI\n", "END\nCOOLNT/OFF\nSPINDL/OFF\n"}) {
    const auto read = read_text("FEDRAT/9\nGOTO/1,2,3\n" + std::string(tail), metric());
    ASSERT_EQ(read.error, "");
    ASSERT_EQ(read.blocks.size(), 4U);
    EXPECT_EQ(read.blocks[1].action, ActionKind::kCoolantOff);
    EXPECT_EQ(read.blocks[2].action, ActionKind::kSpindleOff);
    EXPECT_EQ(read.blocks[3].kind, BlockKind::kEnd);
    EXPECT_EQ(read.blocks[3].sequence, 3U);
  }
}

TEST(End, RefusesEveryOtherBlockBehindIt) {
  for (const char* line : {"SPINDL/1000,CLW", "COOLNT/ON", "DELAY/1", "STOP", "OPSTOP", "LOADTL/2",
                           "AUXFUN/8", "GOTO/1,2,4", "GODLTA/1"}) {
    const auto read =
        read_text("FEDRAT/9\nGOTO/1,2,3\nEND\n" + std::string(line) + "\nFINI\n", metric());
    EXPECT_EQ(read.error_line, 4U) << line;
    EXPECT_NE(read.error.find("after the end of the program"), std::string::npos) << read.error;
    EXPECT_EQ(read.blocks.size(), 1U) << line;
  }
}

TEST(Refusal, OfMotionBehindTheEnd) {
  EXPECT_NE(read_text("FEDRAT/9\nGOTO/1,2,3\nEND\nGOTO/1,2,4\nFINI\n", metric())
                .error.find("after the end"),
            std::string::npos);
}

TEST(Refusals, SayWhatADefinitionOfTheSourceLanguageIs) {
  for (const char* const line : {"P1=POINT/1,2,3", "P1 = POINT/1,2,3"}) {
    const auto read = read_text("UNITS/MM\n" + std::string(line) + "\nGOTO/1,2,3\nFINI\n");
    EXPECT_NE(read.error.find("part.apt:2: a definition in the source language of APT: 'P1' = ..."),
              std::string::npos)
        << read.error;
  }
}

TEST(Refusals, NameAModeInWhichPointsMeanSomethingElse) {
  for (const char* const mode : {"MODE/LATHE", "MODE/POLAR,ON", "MODE/TURN", "APPLY/ TURN"}) {
    const auto read = read_body(std::string(mode) + "\nGOTO/1,2,3\n");
    EXPECT_NE(read.error.find("part.apt:3"), std::string::npos) << mode << read.error;
    EXPECT_NE(read.error.find("changes what the points after it mean"), std::string::npos) << mode;
  }
  EXPECT_TRUE(read_body("MODE/SMOOTH,3\nGOTO/1,2,3\n").warned_of("MODE/SMOOTH,3 is skipped"));
  for (const char* const mode : {"MODE/MILL", "APPLY/ MILL", "SET/MODE,ABSOL", "MODE/ABSOL"}) {
    const auto read = read_body(std::string(mode) + "\nGOTO/1,2,3\n");
    EXPECT_EQ(read.error, "") << mode;
    EXPECT_TRUE(read.warnings.empty()) << mode;
  }
}

}  // namespace
}  // namespace meridian::cl
