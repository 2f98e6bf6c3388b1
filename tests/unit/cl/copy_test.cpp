// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "read_text.hpp"
#include "service/programs/cl/interpreter/copies.hpp"

namespace meridian::cl {
namespace {

using Tips = std::vector<Array3>;

/// Where the blocks of motion end, to a nanometre.
Tips tips_of(const ReadText& read) {
  Tips out;
  for (const ClBlock& b : read.motion()) {
    Array3 tip{};
    for (std::size_t i = 0; i < 3; ++i) tip[i] = std::round(b.tip_mm[i] * 1e6) / 1e6 + 0.0;
    out.push_back(tip);
  }
  return out;
}

TEST(Copy, RunsThePatternAgainShiftedFurtherEveryTime) {
  const auto read = read_body(
      "GOTO/0,0,9\nINDEX/1\nGOTO/1,0,0\nGOTO/2,0,0\nCOPY/1,TRANSL,10,0,1,2\nGOTO/5,5,5\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(tips_of(read), (Tips{{0, 0, 9},
                                 {1, 0, 0},
                                 {2, 0, 0},
                                 {11, 0, 1},
                                 {12, 0, 1},
                                 {21, 0, 2},
                                 {22, 0, 2},
                                 {5, 5, 5}}));
  EXPECT_TRUE(read.warned_of("run 2 times more"));
  EXPECT_EQ(read.summary.frame_changes, 0U);
}

TEST(Copy, TurnsPointsAxesAndArcsFromTheFirstLetterOfItsWordToTheSecond) {
  const auto turned = [](std::string_view word) {
    return read_body("INDEX/7\nGOTO/1,2,3,0,.6,.8\nCOPY/7," + std::string(word) +
                     ",90,1\nGOTO/0,0,0,0,0,1\n");
  };
  EXPECT_EQ(tips_of(turned("XYROT")).at(1), (Array3{-2, 1, 3}));
  EXPECT_NEAR(turned("XYROT").motion().at(1).axis[0], -.6, 1e-12);
  EXPECT_EQ(tips_of(turned("YZROT")).at(1), (Array3{1, -3, 2}));
  EXPECT_EQ(tips_of(turned("ZXROT")).at(1), (Array3{3, 2, -1}));
  const auto arc =
      read_body("INDEX/1\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1\nGOTO/0,10,0\nCOPY/1,XYROT,180,1\n");
  EXPECT_EQ(tips_of(arc).back(), (Array3{0, -10, 0}));
}

TEST(Copy, RepeatsInTheSamePlaceOrThroughAMatrix) {
  EXPECT_EQ(tips_of(read_body("INDEX/1\nGOTO/1,0,0\nGOTO/2,0,0\nCOPY/1,SAME,2\n")).size(), 6U);
  const auto moved = read_body(
      "INDEX/1\nGOTO/1,2,3\nCOPY/1,MODIFY,0,-1,0,10, 1,0,0,20, 0,0,1,30, 2\nGOTO/0,0,0\n");
  EXPECT_EQ(tips_of(moved), (Tips{{1, 2, 3}, {8, 21, 33}, {-11, 28, 63}, {0, 0, 0}}));
  EXPECT_NE(read_body("INDEX/1\nGOTO/1,2,3\nCOPY/1,MODIFY,-1,0,0,0, 0,1,0,0, 0,0,1,0, 1\n").error,
            "");
}

TEST(Copy, OfACopyMakesAGrid) {
  const auto nested =
      read_body("INDEX/1\nINDEX/2\nGOTO/1,1,0\nCOPY/2,TRANSL,10,0,0,1\nCOPY/1,TRANSL,0,10,0,1\n");
  EXPECT_EQ(tips_of(nested), (Tips{{1, 1, 0}, {11, 1, 0}, {1, 11, 0}, {11, 11, 0}}));
  const auto twice =
      read_body("INDEX/1\nGOTO/1,1,0\nCOPY/1,TRANSL,10,0,0,1\nCOPY/1,TRANSL,0,10,0,1\n");
  EXPECT_EQ(tips_of(twice), tips_of(nested));
}

TEST(Copy, EndsItsPatternAtNomore) {
  const auto read = read_body(
      "INDEX/1\nGOTO/1,0,0\nINDEX/1,NOMORE\nGOTO/50,0,0\nCOPY/1,TRANSL,0,3,0,1\nGOTO/60,0,0\n");
  EXPECT_EQ(tips_of(read), (Tips{{1, 0, 0}, {50, 0, 0}, {1, 3, 0}, {60, 0, 0}}));
}

TEST(Copy, RepeatsHolesOfACycle) {
  const auto read = read_body(
      "GOTO/0,0,50\nCYCLE/DRILL,FEDTO,5,MMPM,100,RAPTO,2\nINDEX/1\nGOTO/0,0,0\n"
      "COPY/1,TRANSL,10,0,0,3\nCYCLE/OFF\nGOTO/0,0,50\n",
      written_by(Dialect::kNx));
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.summary.holes, 4U);
}

TEST(Copy, CarriesTheLineOfItsWordAndInchesToo) {
  const auto read = read_text(
      "UNITS/INCHES\nFEDRAT/5,IPM\nINDEX/1\nGOTO/1,0,0\nCOPY/1,TRANSL,1,0,0,1\nGOTO/0,0,0\nFINI\n");
  const auto m = read.motion();
  ASSERT_EQ(m.size(), 3U);
  EXPECT_NEAR(m[1].tip_mm[0], 50.8, 1e-9);
  EXPECT_EQ(m[1].line, 5U);
  EXPECT_EQ(m[2].line, 6U);
}

TEST(Copy, RefusesWhatHasNoSingleReading) {
  const auto error = [](std::string_view body) {
    return read_body("GOTO/0,0,1\n" + std::string(body) + "GOTO/1,2,4\n").error;
  };
  const auto says = [](const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos ? testing::AssertionSuccess()
                                                : testing::AssertionFailure() << text;
  };
  EXPECT_TRUE(says(error("COPY/1,SAME,1\n"), "without INDEX/1"));
  EXPECT_TRUE(says(error("INDEX/1\nGOTO/1,0,0\nCOPY/1,TRANSL,10,0,0\n"), "whole number"));
  EXPECT_TRUE(says(error("INDEX/1\nGOTO/1,0,0\nCOPY/1,MODIFY,MX1,3\n"), "not understood"));
  EXPECT_TRUE(says(error("INDEX/1\nGOTO/1,0,0\nCOPY/1,TRANSL,1,0,0,1.5\n"), "whole number"));
  EXPECT_TRUE(says(error("INDEX/1\nCOPY/1,SAME,1\n"), "nothing between"));
  EXPECT_TRUE(says(error("INDEX/1\nGOTO/1,0,0\nINDEX/1\nGOTO/2,0,0\n"), "line 4 too"));
  std::string long_pattern = "INDEX/1\n";
  for (int i = 0; i < 11; ++i) long_pattern += "GOTO/1,0,0\n";
  EXPECT_TRUE(says(error(long_pattern + "COPY/1,SAME,1000000\n"), "ten million"));
  EXPECT_TRUE(says(error("INDEX/AAXIS,90\n"), "not understood"));
}

TEST(Copy, GuessesNoToolAxis) {
  const auto nx = [](std::string_view body) {
    return read_body(body, written_by(Dialect::kNx)).error;
  };
  // The pattern relies on an axis that is another one at its end; behind it, on one that turned.
  EXPECT_NE(nx("GOTO/0,0,0,0,0,1\nINDEX/1\nGOTO/1,0,0\nGOTO/2,0,0,.6,0,.8\nCOPY/1,SAME,1\n"), "");
  EXPECT_NE(nx("INDEX/1\nGOTO/2,0,0,.6,0,.8\nCOPY/1,XYROT,90,1\nGOTO/1,0,0\n"), "");
  EXPECT_EQ(nx("INDEX/1\nGOTO/2,0,0,.6,0,.8\nCOPY/1,TRANSL,1,0,0,1\nGOTO/1,0,0\n"), "");
}

}  // namespace
}  // namespace meridian::cl
