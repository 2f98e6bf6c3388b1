// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "service/programs/nc/nc_line.hpp"

namespace meridian::nc {
namespace {

std::string words_of(std::string_view text) {
  Line line;
  const auto done = cut(text, 7, line);
  if (!done) return "refused: " + done.error().message;
  std::string out;
  for (const Word& word : line.words) {
    out += (out.empty() ? "" : " ") + std::string(word.address) + ":" + std::string(word.digits);
  }
  return out;
}

TEST(NcLine, IsCutIntoAddressesAndNumbers) {
  EXPECT_EQ(words_of("N10 G1 X1.5 Y-.25 F600"), "G:1 X:1.5 Y:-.25 F:600");
  EXPECT_EQ(words_of("g1x1.y2."), "G:1 X:1. Y:2.");
  EXPECT_EQ(words_of("G 43.4 H 1"), "G:43.4 H:1");
  EXPECT_EQ(words_of("C1=90. X+2"), "C1:90. X:+2");
  EXPECT_EQ(words_of("   "), "");
}

TEST(NcLine, LeavesCommentsOutAndKeepsTheFirst) {
  Line line;
  ASSERT_TRUE(cut("G1 (to the rim) X2. ; and on", 1, line));
  EXPECT_EQ(line.words.size(), 2U);
  EXPECT_EQ(line.comment, "TO THE RIM");
  EXPECT_EQ(line.comments, 2U);
}

TEST(NcLine, KnowsTapeMarksProgramNumbersAndBlockDelete) {
  Line line;
  ASSERT_TRUE(cut("%", 1, line));
  EXPECT_TRUE(line.is_tape_mark);
  ASSERT_TRUE(cut("/2 G0 X1.", 2, line));
  EXPECT_TRUE(line.has_block_delete);
  EXPECT_EQ(line.words.size(), 2U);
  EXPECT_EQ(words_of(":1234"), "O:1234");
}

TEST(NcLine, RefusesWhatOnlyAControlCanRun) {
  EXPECT_EQ(words_of("#100=5"), "refused: a variable (#)");
  EXPECT_EQ(words_of("G1 X#100"), "refused: a variable (#)");
  EXPECT_EQ(words_of("G1 X[1+2]"), "refused: an expression ([ ])");
  EXPECT_EQ(words_of("IF [#1 EQ 0] GOTO 10"),
            "refused: the word IF of macros and jumps is not run here");
  EXPECT_EQ(words_of("WHILE [#1 LT 2] DO1"),
            "refused: the word WHILE of macros and jumps is not run here");
  EXPECT_EQ(words_of("GOTO 20"), "refused: the word GOTO of macros and jumps is not run here");
  EXPECT_EQ(words_of("O<drill> CALL"),
            "refused: a name in < >: a subprogram or a variable of LinuxCNC");
  EXPECT_EQ(words_of("G1 X1. ,R2."), "refused: a word after a comma (chamfer or rounding)");
}

TEST(NcLine, RefusesWhatIsNoWord) {
  EXPECT_EQ(words_of("G1 X"), "refused: address X without a number after it");
  EXPECT_EQ(words_of("G1 X1. X2."), "refused: address X twice in one block");
  EXPECT_EQ(words_of("G1 X1.2.3"), "refused: address X without a number after it");
  EXPECT_EQ(words_of("G1 (open"), "refused: a comment without its closing bracket");
  EXPECT_EQ(words_of("G1 $"), "refused: what begins with '$' is no NC word with a number");
}

}  // namespace
}  // namespace meridian::nc
