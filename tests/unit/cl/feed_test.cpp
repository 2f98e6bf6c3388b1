// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "read_text.hpp"

namespace meridian::cl {
namespace {

struct Case {
  const char* words;
  double mm_per_s;
};

class FeedWords : public testing::TestWithParam<Case> {};

TEST_P(FeedWords, ComeOutAsTipFeed) {
  const auto read = read_text(std::string(GetParam().words) + "\nGOTO/0,0,0\nFINI\n");
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  ASSERT_EQ(m.size(), 1U);
  EXPECT_EQ(m[0].feed_meaning, FeedMeaning::kTip);
  EXPECT_NEAR(m[0].feed, GetParam().mm_per_s, 1e-12 * GetParam().mm_per_s);
}

INSTANTIATE_TEST_SUITE_P(
    InEveryUnitAndOrder, FeedWords,
    testing::Values(Case{"UNITS/MM\nFEDRAT/600,MMPM", 10}, Case{"UNITS/MM\nFEDRAT/MMPM,600", 10},
                    Case{"UNITS/MM\nFEDRAT/600", 10}, Case{"UNITS/MM\nFEDRAT/PERMIN,600", 10},
                    Case{"FEDRAT / 600 , MMPM\nUNITS / MM", 10},
                    Case{"UNITS/INCHES\nFEDRAT/60,IPM", 25.4},
                    Case{"UNITS/INCHES\nFEDRAT/60,PERMIN", 25.4},
                    Case{"UNITS/INCHES\nFEDRAT/60", 25.4}, Case{"UNITS/MM\nFEDRAT/ 60, IPM", 25.4},
                    Case{"UNITS/INCHES\nFEDRAT/MMPM,600", 10},
                    Case{"UNITS/MM\nSPINDL/RPM,1200,CLW\nFEDRAT/0.5,MMPR", 10},
                    Case{"UNITS/MM\nFEDRAT/MMPR,0.5\nSPINDL/1200,RPM,CLW", 10},
                    Case{"UNITS/MM\nFEDRAT/PERREV,0.5\nSPINDL/1200", 10},
                    Case{"UNITS/INCHES\nSPINDL/CLW,600\nFEDRAT/IPR,.1", 25.4},
                    Case{"UNITS/INCHES\nSPINDL/CLW,RPM,600\nFEDRAT/.1,PERREV", 25.4}));

TEST(Feed, PerRevolutionFollowsTheSpindle) {
  const auto m = read_text(
                     "UNITS/MM\nSPINDL/1200,CLW\nFEDRAT/0.5,MMPR\nGOTO/0,0,0\n"
                     "SPINDL/2400\nGOTO/0,0,1\nFINI\n")
                     .motion();
  EXPECT_DOUBLE_EQ(m.at(0).feed, 10);
  EXPECT_DOUBLE_EQ(m.at(1).feed, 20);
}

TEST(Feed, PerRevolutionIsRefusedWithoutASpindleSpeed) {
  const auto read = read_text("UNITS/MM\nFEDRAT/0.5,MMPR\nGOTO/0,0,0\nFINI\n");
  EXPECT_EQ(read.error_line, 3U);
  EXPECT_NE(read.error.find("no spindle speed"), std::string::npos);
  EXPECT_NE(read_text("UNITS/MM\nSPINDL/900\nFEDRAT/1,MMPR\nSPINDL/OFF\nGOTO/0,0,0\nFINI\n")
                .error.find("no spindle speed"),
            std::string::npos);
}

TEST(Feed, InverseTimeIsOneOverTheDuration) {
  for (const char* words : {"FEDRAT/INVERS,30", "FEDRAT/30,INVERS", "FEDRAT/30,INVERSE"}) {
    const auto m = read_text(std::string("UNITS/MM\n") + words + "\nGOTO/0,0,0\nFINI\n").motion();
    ASSERT_EQ(m.size(), 1U);
    EXPECT_EQ(m[0].feed_meaning, FeedMeaning::kInverseTime);
    EXPECT_DOUBLE_EQ(m[0].feed, 0.5);  // 30/min: two seconds
  }
}

TEST(Feed, OfNoneIsRefusedUnlessTheCallerGivesADefault) {
  const auto read = read_text("UNITS/MM\nGOTO/0,0,0\nFINI\n");
  EXPECT_NE(read.error.find("no FEDRAT"), std::string::npos);
  EXPECT_NE(read.error.find("--feed"), std::string::npos);
  ClReaderOptions options;
  options.default_feed_mm_per_s = 5;
  EXPECT_EQ(read_text("UNITS/MM\nGOTO/0,0,0\nFINI\n", options).motion().at(0).feed, 5);
}

TEST(Feed, ThatIsAbsurdIsRefused) {
  for (const char* feed : {"0", "-100", "1000001", "1E300"}) {
    const auto read =
        read_text("UNITS/MM\nFEDRAT/" + std::string(feed) + ",MMPM\nGOTO/0,0,0\nFINI\n");
    EXPECT_NE(read.error, "") << feed;
    EXPECT_TRUE(read.blocks.empty());
  }
  for (const char* words : {"FEDRAT/NAN", "FEDRAT/", "FEDRAT/1,2", "FEDRAT/100,FURLONGS"}) {
    EXPECT_EQ(read_text(std::string("UNITS/MM\n") + words + "\nGOTO/0,0,0\nFINI\n").error_line, 2U);
  }
}

TEST(Feed, InTwoUnitsIsRefused) {
  for (const char* words :
       {"0.2,MMPM,MMPR", "100,MMPR,MMPM", "100,IPM,INVERS", "MMPM,100,IPM", "100,PERMIN,PERREV"}) {
    const auto read =
        read_text("UNITS/MM\nSPINDL/1000\nFEDRAT/" + std::string(words) + "\nGOTO/0,0,0\nFINI\n");
    EXPECT_EQ(read.error_line, 3U) << words;
    EXPECT_NE(read.error.find("two units"), std::string::npos) << read.error;
  }
}

TEST(Feed, InInverseTimeLetsAnArcAndItsRestTakeTheTimeOfOneBlock) {
  const auto read = read_text(
      "UNITS/MM\nFEDRAT/INVERS,2\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/10.005,-0.002,0\n"
      "GOTO/10,10,0\nFINI\n");
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  ASSERT_EQ(m.size(), 4U);  // the arc, and its rest of 5 um
  EXPECT_TRUE(m[1].is_arc);
  EXPECT_NEAR(1 / m[1].feed + 1 / m[2].feed, 30, 1e-9);
  EXPECT_NEAR(m[2].feed / m[1].feed, 2 * 3.14159265 * 10 / 5e-3, 20);  // one speed all the way
  EXPECT_DOUBLE_EQ(1 / m[3].feed, 30);
  EXPECT_NEAR(read.summary.cut_time_s, 60, 1e-9);  // the first block is approached
}

TEST(Feed, InInverseTimeGivesABlockThatMovesNothingNoTime) {
  const auto read = read_text(
      "UNITS/MM\nRAPID\nGOTO/0,0,10,0,0,1\nFEDRAT/INVERS,6\nGOTO/0,0,10,0,.6,.8\n"
      "GOTO/0,0,10,0,.6,.8\nGOTO/30,0,10,0,0,1\nFINI\n");
  EXPECT_EQ(read.summary.zero_length, 1U);
  EXPECT_NEAR(read.summary.cut_time_s, 20, 1e-9);
}

TEST(Feed, BeyondTheMachineIsFlaggedOnceAndKept) {
  ClReaderOptions options;
  options.max_feed_mm_per_s = 50;
  const auto read = read_text(
      "UNITS/MM\nFEDRAT/6000,MMPM\nGOTO/0,0,0\nGOTO/0,0,1\nFEDRAT/9000,MMPM\nGOTO/0,0,2\nFINI\n",
      options);
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.warnings.size(), 1U);
  EXPECT_TRUE(read.warned_of("beyond the machine's 3000 mm/min"));
  EXPECT_EQ(read.motion().at(0).feed, 100);
  EXPECT_EQ(read.summary.feeds_limited, 3U);
}

TEST(Units, OfNoneAreMillimetreAndThatIsSaid) {
  const auto read = read_text("FEDRAT/100\nGOTO/1,0,0\nFINI\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.motion().at(0).tip_mm[0], 1);
  EXPECT_EQ(read.summary.unit_source, UnitSource::kStation);
  EXPECT_TRUE(read.warned_of("NO UNIT WORD"));
  EXPECT_TRUE(read.warned_of("--units inch"));
  EXPECT_NE(to_text(read.summary).find("NO UNIT WORD"), std::string::npos);
  const auto named = read_text("FEDRAT/100,MMPM\nGOTO/1,0,0\nFINI\n", metric());
  EXPECT_TRUE(named.warnings.empty());
  EXPECT_EQ(named.summary.unit_source, UnitSource::kCaller);
}

TEST(Units, DefaultOfTheMachineHelpsAndIsReported) {
  ClReaderOptions options;
  options.default_unit = LengthUnit::kInch;
  const auto read = read_text("FEDRAT/1\nGOTO/1,0,0\nFINI\n", options);
  EXPECT_EQ(read.motion().at(0).tip_mm[0], 25.4);
  EXPECT_TRUE(read.warned_of("read in inch, the machine's default"));
}

TEST(Units, ComeByBothWordsAndBothSpellings) {
  for (const char* word : {"UNITS/MM", "UNIT/MM", "UNITS / MM", "units/mm"}) {
    const auto read = read_text(std::string(word) + "\nFEDRAT/1\nGOTO/1,0,0\nFINI\n");
    EXPECT_EQ(read.motion().at(0).tip_mm[0], 1) << word;
  }
  for (const char* word : {"UNITS/INCHES", "UNITS / INCH", "UNIT/IN"}) {
    const auto read = read_text(std::string(word) + "\nFEDRAT/1\nGOTO/1,0,0\nFINI\n");
    EXPECT_EQ(read.motion().at(0).tip_mm[0], 25.4) << word;
  }
  EXPECT_EQ(read_text("UNITS/CUBITS\nGOTO/1,0,0\nFINI\n").error_line, 1U);
}

TEST(Units, InchOverAPlainlyMetricPartIsFlaggedAndTakenAsWritten) {
  const auto wide = read_text(
      "UNITS / INCHES\nFEDRAT / 10.0,  IPM\nGOTO / 0.0, 0.0, 0.0\nGOTO / 150.0, 0.0, 0.0\nFINI\n");
  EXPECT_EQ(wide.error, "");
  EXPECT_TRUE(wide.warned_of("plainly metric"));
  EXPECT_EQ(wide.motion().at(1).tip_mm[0], 3810);
  EXPECT_TRUE(read_text("UNITS/INCHES\n$$-> CUTTER / 6.0\nFEDRAT/10,IPM\nGOTO/0,0,0\nFINI\n")
                  .warned_of("cutter is 6 wide"));
  EXPECT_TRUE(read_text("UNITS / INCHES\nFEDRAT / 1193.66,  IPM\nGOTO / 0.0, 0.0, 0.0\nFINI\n")
                  .warned_of("plainly metric"));
  EXPECT_TRUE(read_text("UNITS/MM\nFEDRAT/10,IPM\nGOTO/0,0,0\nFINI\n").warned_of("feed in inch"));
  EXPECT_TRUE(read_text("UNITS/INCHES\nFEDRAT/10,IPM\nGOTO/1,1,1\nFINI\n").warnings.empty());
}

TEST(Units, ThatDifferAreFlaggedAndTheLastOneHolds) {
  const auto head = read_text("UNITS/MM\nUNITS/INCHES\nFEDRAT/10\nGOTO/1,0,0\nFINI\n");
  EXPECT_EQ(head.error, "");
  EXPECT_EQ(head.motion().at(0).tip_mm[0], 25.4);
  ASSERT_EQ(head.warnings.size(), 1U);
  EXPECT_EQ(head.warnings[0].line, 2U);
  EXPECT_TRUE(head.warned_of("unit"));
  const auto middle =
      read_text("UNITS/MM\nFEDRAT/10\nGOTO/1,0,0\nUNITS/INCHES\nGOTO/1,0,0\nFINI\n");
  EXPECT_TRUE(middle.warned_of("the unit changes in mid-program"));
  EXPECT_EQ(middle.motion().at(1).tip_mm[0], 25.4);
  EXPECT_TRUE(read_text("UNITS/MM\nUNITS/MM\nFEDRAT/10\nGOTO/1,0,0\nFINI\n").warnings.empty());
}

TEST(Units, OfTheCallerWinAndAreFlagged) {
  const auto read = read_text("UNITS/INCHES\nFEDRAT/60,PERMIN\nGOTO/100,0,0\nFINI\n", metric());
  EXPECT_EQ(read.motion().at(0).tip_mm[0], 100);
  EXPECT_EQ(read.motion().at(0).feed, 1);
  EXPECT_TRUE(read.warned_of("--units says otherwise"));
}

}  // namespace
}  // namespace meridian::cl
