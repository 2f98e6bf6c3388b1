// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "read_text.hpp"

namespace meridian::cl {
namespace {

//                                     1         2             3              4
const std::string kProgram =
    "UNITS/MM\nLOADTL/7\nSPINDL/9000,RPM,CLW\nCOOLNT/FLOOD\n"
    "COOLNT/MIST\nFEDRAT/600,MMPM\nGOTO/1,0,0\nGOTO/2,0,0,0,0.6,0.8\n"
    "DELAY/1\nGOTO/3,0,0,0,0.6,0.8\nFEDRAT/300,MMPM\nGOTO/4,0,0,0,0.6,0.8\nFINI\n";
//                             9        10          11               12

ReadText from_line(std::uint32_t line, const std::string& text = kProgram) {
  ClReaderOptions options;
  options.first_line = line;
  options.allowed_words = {"FOO"};
  return read_text(text, options);
}

TEST(Restart, BringsToolSpindleAndCoolantAndThePlaceBefore) {
  const auto read = from_line(10);
  ASSERT_EQ(read.error, "");
  ASSERT_EQ(read.blocks.size(), 8U);
  EXPECT_EQ(read.blocks[0].kind, BlockKind::kTool);
  EXPECT_EQ(read.blocks[0].value, 7);
  EXPECT_EQ(read.blocks[1].action, ActionKind::kSpindleClockwise);
  EXPECT_EQ(read.blocks[1].value, 9000);
  EXPECT_EQ(read.blocks[2].action, ActionKind::kCoolantFlood);
  EXPECT_EQ(read.blocks[3].action, ActionKind::kCoolantMist);
  EXPECT_EQ(read.blocks[4].kind, BlockKind::kRapid);
  EXPECT_EQ(read.blocks[4].tip_mm, (Array3{2, 0, 0}));
  EXPECT_EQ(read.blocks[4].axis, (Array3{0, 0.6, 0.8}));
  EXPECT_EQ(read.blocks[4].line, 8U);
  EXPECT_EQ(read.blocks[5].line, 10U);
  EXPECT_EQ(read.blocks[5].feed, 10);
  EXPECT_EQ(read.blocks[6].feed, 5);
  EXPECT_EQ(read.blocks[7].kind, BlockKind::kEnd);
}

TEST(Restart, CountsItsBlocksFromZero) {
  const auto read = from_line(10);
  for (std::size_t i = 0; i < read.blocks.size(); ++i) EXPECT_EQ(read.blocks[i].sequence, i);
}

TEST(Restart, BeginsWithTheNextBlockWhereTheLineHasNone) {
  const auto read = from_line(11);
  ASSERT_FALSE(read.blocks.empty());
  EXPECT_EQ(read.blocks[read.blocks.size() - 2].line, 12U);
  EXPECT_EQ(read.blocks[read.blocks.size() - 3].line, 10U) << "where the block before ended";
}

TEST(Restart, OfTheFirstLineIsTheWholeProgram) {
  const auto whole = read_text(kProgram, {}), read = from_line(1);
  ASSERT_EQ(read.blocks.size(), whole.blocks.size());
  for (std::size_t i = 0; i < whole.blocks.size(); ++i) {
    EXPECT_EQ(read.blocks[i].kind, whole.blocks[i].kind);
    EXPECT_EQ(read.blocks[i].tip_mm, whole.blocks[i].tip_mm);
  }
}

TEST(Restart, LeavesOutWhatWasSwitchedOff) {
  const auto read = from_line(6,
                              "UNITS/MM\nSPINDL/9000,RPM,CLW\nCOOLNT/FLOOD\nSPINDL/OFF\n"
                              "COOLNT/OFF\nFEDRAT/600,MMPM\nGOTO/1,0,0\nGOTO/2,0,0\nFINI\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.blocks.size(), 3U);
}

TEST(Restart, ForgetsWhereTheToolBeforeStood) {
  const auto read = from_line(6,
                              "UNITS/MM\nFEDRAT/600,MMPM\nLOADTL/1\nGOTO/1,0,0\nLOADTL/2\n"
                              "GOTO/2,0,0\nGOTO/3,0,0\nFINI\n");
  ASSERT_EQ(read.error, "");
  ASSERT_EQ(read.blocks.size(), 4U);
  EXPECT_EQ(read.blocks[0].value, 2);
  EXPECT_EQ(read.blocks[1].tip_mm, (Array3{2, 0, 0}));
}

TEST(Restart, IsRefusedBehindTheLastBlock) {
  EXPECT_NE(from_line(13).error.find("no block from this line on"), std::string::npos);
  EXPECT_NE(from_line(99).error.find("part.apt:99: "), std::string::npos) << from_line(99).error;
}

TEST(Restart, SaysThatVendorWordsAreNotRepeated) {
  const auto read =
      from_line(5, "UNITS/MM\nFEDRAT/600,MMPM\nFOO/1\nGOTO/1,0,0\nGOTO/2,0,0\nFINI\n");
  ASSERT_EQ(read.error, "");
  EXPECT_TRUE(read.warned_of("not repeated"));
}

}  // namespace
}  // namespace meridian::cl
