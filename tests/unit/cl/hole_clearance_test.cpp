// SPDX-License-Identifier: Apache-2.0
// Where the clearance of a canned cycle counts from, as the writers differ in it.
#include <gtest/gtest.h>

#include "hole_blocks.hpp"

namespace meridian::cl {
namespace {

TEST(Cycle, OfHsmCountsItsClearanceFromTheBottom) {
  // Depth 10, clearance 15 above the bottom, that is 5 above the top; rapid to 2 below that.
  expect_blocks(
      holes("RAPID\nGOTO/10,0,5.003\nCYCLE/DRILL, 10, MMPM, 200, 15, RAPTO, 2, DWELL, .5\n"
            "GOTO/10,0,0\n",
            Dialect::kHsm),
      {{'R', {10, 0, 5.003}},
       {'R', {10, 0, 3}},
       {'F', {10, 0, -10}, 200},
       {'D', {}, .5},
       {'R', {10, 0, 5}}});
}

TEST(Cycle, OfHsmWhoseToolIsNotAtItsClearanceIsRefused) {
  // The same words where the point is the bottom of a hole: it would be drilled twice as deep.
  const auto read =
      read_body("RAPID\nGOTO/10,0,15\nCYCLE/DRILL, 10, MMPM, 200, 15\nGOTO/10,0,-10\nCYCLE/OFF\n",
                written_by(Dialect::kHsm));
  EXPECT_NE(read.error.find("part.apt:6"), std::string::npos) << read.error;
  EXPECT_NE(read.error.find("--dialect fusion"), std::string::npos) << read.error;
}

TEST(Cycle, ThatIsStillOnInTheNextToolPathIsRefusedAtItsFirstPoint) {
  const std::string drill =
      "TOOL PATH/A,TOOL,T\nCYCLE/DRILL,RAPTO,3.0,FEDTO,-10.0,MMPM,250.\nGOTO/10,0,5\n";
  const std::string next = "END-OF-PATH\nTOOL PATH/B,TOOL,T\n";
  const auto read =
      read_body(drill + next + "GOTO/20,0,5\nGOTO/30,0,5\nEND-OF-PATH\n", written_by(Dialect::kNx));
  EXPECT_NE(read.error.find("while the CYCLE of the tool path before is still on"),
            std::string::npos)
      << read.error;
  for (const std::string& mended :
       {drill + "CYCLE/OFF\n" + next + "FEDRAT/MMPM,100\nGOTO/20,0,5\nEND-OF-PATH\n",
        drill + next + "CYCLE/DRILL,RAPTO,3.0,FEDTO,-10.0,MMPM,250.\nGOTO/20,0,5\nEND-OF-PATH\n",
        drill + "END-OF-PATH\n"}) {
    EXPECT_EQ(read_body(mended, written_by(Dialect::kNx)).error, "") << mended;
  }
}

TEST(Cycle, OfFusionGivesTheBottomOfAHoleAndItsClearanceAsAZ) {
  // Top at z = 2: depth 10 down to -8, clearance at z = 15, rapid to 9 below that.
  const auto blocks = holes(
      "CYCLE/DRILL, 10, MMPM, 200, 15, RAPTO, 9\nFEDRAT/200,MMPM\nGOTO/10,0,-8\nGOTO/20,0,-12\n"
      "CYCLE/OFF\n",
      Dialect::kFusion);
  expect_blocks(blocks, {{'R', {10, 0, 50}},
                         {'R', {10, 0, 6}},
                         {'F', {10, 0, -8}, 200},
                         {'R', {10, 0, 15}},
                         {'R', {20, 0, 15}},
                         {'R', {20, 0, 6}},
                         {'F', {20, 0, -12}, 200},
                         {'R', {20, 0, 15}}});
}

TEST(Cycle, OfFusionInsideThePartOrAlongATiltedAxisIsRefused) {
  const std::string cycle = "RAPID\nGOTO/0,0,15\nCYCLE/DRILL, 10, MMPM, 200, 15, RAPTO, 9\n";
  for (const char* const point : {"GOTO/10,0,0\n", "GOTO/10,0,-8,.6,0,.8\n"}) {
    const auto read = read_body(cycle + point, written_by(Dialect::kFusion));
    EXPECT_NE(read.error.find("part.apt:6"), std::string::npos) << point << read.error;
  }
}

TEST(Cycle, OfFusionWithAWordForItsClearanceTooIsRefused) {
  for (const char* const word : {"RTRCTO, 40", "CLEAR, 20"}) {
    const auto read =
        read_body(std::string("GOTO/0,0,50\nCYCLE/DRILL, 10, MMPM, 200, 15, RAPTO, 9, ") + word +
                      "\nGOTO/10,0,-8\n",
                  written_by(Dialect::kFusion));
    EXPECT_NE(read.error.find("a clearance by its position and by a word"), std::string::npos)
        << read.error;
  }
}

TEST(Cycle, WithAClearanceOfUnknownOriginBesideItsDepthIsRefused) {
  const auto at_rapid_level = read_body(
      "GOTO/0,0,50\nCYCLE/DRILL, DEEP, FEDTO, 9, INCR, 3, MMPM, 90, CLEAR, 15, RAPTO, 2\n"
      "GOTO/10,0,0\n");
  EXPECT_NE(at_rapid_level.error.find("CLEAR beside FEDTO"), std::string::npos);
  const auto alone =
      read_body("GOTO/0,0,50\nCYCLE/DRILL, FEDTO, 9, MMPM, 90, CLEAR, 15\nGOTO/10,0,0\n");
  EXPECT_NE(alone.error.find("RAPTO and RTRCTO"), std::string::npos) << alone.error;
  expect_blocks(
      holes("CYCLE/DRILL, FEDTO, 9, MMPM, 90, CLEAR, 15, RTRCTO, 20, RAPTO, 2\nGOTO/10,0,0\n"),
      {{'R', {10, 0, 50}}, {'R', {10, 0, 2}}, {'F', {10, 0, -9}, 90}, {'R', {10, 0, 20}}});
}

}  // namespace
}  // namespace meridian::cl
