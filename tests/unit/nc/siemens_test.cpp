// SPDX-License-Identifier: Apache-2.0
// Siemens programs: their words, TRAORI, and what is refused.
#include <gtest/gtest.h>

#include <numbers>

#include "meridian/units.hpp"
#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

TEST(SiemensProgram, TakesTheAxisFromItsVector) {
  const ReadText read = read_siemens(
      "TRAFOOF\nG54\nT1\nM6\nD1\nTRAORI\nG54\nORIWKS ORIVECT\nG0 X0 Y0 Z10 A3=0 B3=0 C3=1\n"
      "G1 X1 B3=-6 C3=8\nX2\nTRAFOOF\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 3U);
  EXPECT_LT((axis(motion[1]) - Vector3(0, -0.6, 0.8)).norm(), kTiny);
  EXPECT_EQ(axis(motion[2]), axis(motion[1]));
  EXPECT_EQ(read.summary.dialect, "NC program, Siemens words");
  EXPECT_EQ(read.summary.nc.work_offset, "G54");
  EXPECT_FALSE(read.warned_of("no decimal point"));
}

TEST(SiemensProgram, KnowsItsWaysOfWritingNumbers) {
  const ReadText read = read_siemens("G0 X=1.5 Y2 Z=AC(3)\nG1 X=IC(2) Y=IC(-1)\nG91 X1 Z=AC(9)\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 3U);
  EXPECT_EQ(tip(motion[1]), Vector3(3.5, 1, 3));
  EXPECT_EQ(tip(motion[2]), Vector3(4.5, 1, 9));
}

/// How far from its begin the tool axis gets on the last line, deg, and the number of its blocks.
double largest_turn_deg(const ReadText& read) {
  double max = 0;
  for (const ClBlock& block : read.motion()) {
    if (block.kind != BlockKind::kCut) continue;
    const double cosine = axis(block).dot(axis(read.motion().at(0)));
    max = std::max(max, units::deg_from_rad(std::acos(std::clamp(cosine, -1.0, 1.0))));
  }
  return max;
}

TEST(SiemensProgram, TurnsRotaryAxesWithinATurnAsItsWordsSay) {
  // A stays at 30, C goes from 350 to 10: by 20 deg, or the other sense by 340.
  const std::string head = "G0 A30 C350\nTRAORI\nORIAXES\nG0 X0 Y0 Z50 A30 C350\n";
  const auto options = siemens(on(shipped("trunnion-ac")));
  for (const auto& [words, is_short] :
       {std::pair{"C=DC(10)", true}, {"C=ACP(10)", true}, {"C=ACN(10)", false}, {"C10", false}}) {
    const ReadText read = read_siemens(head + "G1 X90 " + words + "\n", options);
    ASSERT_EQ(read.error, "") << words;
    EXPECT_EQ(largest_turn_deg(read) < 11, is_short) << words << " " << largest_turn_deg(read);
    const double turn = units::rad_from_deg(10), tilt = units::rad_from_deg(30);
    const ClBlock last = read.motion().back();
    EXPECT_NEAR(axis(last)[2], std::cos(tilt), kTiny) << words;
    EXPECT_NEAR(std::abs(axis(last)[0]), std::sin(tilt) * std::sin(turn), kTiny) << words;
  }
  // 2.8 - 1.4 is not 1.4 where numbers are rounded: it stands there all the same.
  const ReadText still = read_siemens(
      "G0 A30 C2.8\nTRAORI\nORIAXES\nG0 X0 Y0 Z50 A30 C2.8\nG1 X1 C=ACP(1.4)\nG1 X2 C=ACP(1.4)\n",
      options);
  ASSERT_EQ(still.error, "");
  const auto& motion = still.motion();
  EXPECT_NEAR((axis(motion.back()) - axis(motion[motion.size() - 2])).norm(), 0, kTiny);
  EXPECT_NEAR((tip(motion.back()) - tip(motion[motion.size() - 2])).norm(), 1, kTiny);
  EXPECT_NE(read_siemens("G0 X=DC(5) Y0 Z0\n", options).error.find("an axis that does not turn"),
            std::string::npos);
}

TEST(SiemensProgram, TurnsArcsByRadiusCentreAndTurns) {
  const ReadText read = read_siemens(
      "G0 X10 Y0 Z0\nG3 X0 Y10 CR=10\nG3 X-10 Y0 I=AC(0) J=AC(0)\nG3 X0 Y-10 Z-3 I10 J0 TURN=2\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 6U);
  EXPECT_NEAR(motion[1].sweep_rad, std::numbers::pi / 2, kTiny);
  EXPECT_LT(to_vector(motion[2].centre_mm).norm(), kTiny);
  EXPECT_NEAR(motion[3].sweep_rad, 2 * std::numbers::pi, kTiny);
  EXPECT_EQ(tip(motion[5]), Vector3(0, -10, -3));
}

TEST(SiemensProgram, TurnsTheAxisByRotaryWordsOnTheGreatCircleUnlessOriaxesIsOn) {
  const std::string head = "G0 A30 C0\nTRAORI\nG0 X0 Y0 Z50\n";
  const auto options = siemens(on(shipped("trunnion-ac")));
  const ReadText circle = read_siemens(head + "ORIVECT\nG1 X90 C90\n", options);
  ASSERT_EQ(circle.error, "");
  EXPECT_EQ(circle.motion().size(), 2U);
  EXPECT_NEAR(axis(circle.motion()[1])[2], std::cos(units::rad_from_deg(30)), kTiny);
  const ReadText joints = read_siemens(head + "ORIAXES\nG1 X90 C90\n", options);
  ASSERT_EQ(joints.error, "");
  EXPECT_GT(joints.motion().size(), 5U);
}

TEST(SiemensProgram, WarnsOfVectorsWhoseWayIsTheJoints) {
  const ReadText read =
      read_siemens("TRAORI\nORIAXES\nG0 X0 Y0 Z9 A3=0 B3=0 C3=1\nG1 X5 A3=.6 B3=0 C3=.8\n");
  ASSERT_EQ(read.error, "");
  EXPECT_NEAR(axis(read.motion()[1])[0], .6, kTiny);
  EXPECT_TRUE(read.warned_of("A3, B3, C3 under ORIAXES"));
  EXPECT_FALSE(
      read_siemens("TRAORI\nORIVECT\nG0 X0 Y0 Z9 A3=0 B3=0 C3=1\n").warned_of("great circle"));
}

TEST(SiemensProgram, DwellsAndActs) {
  const ReadText read = read_siemens(
      "G0 X0 Y0 Z0\nS600 M3\nG4 F0.5\nG4 S5\nM1=5\nT=\"12\" M6\nMSG(\"ON; (AND ON)\")\nG1 X1\n");
  ASSERT_EQ(read.error, "");
  ASSERT_EQ(read.blocks.size(), 8U);
  EXPECT_EQ(read.blocks[1].value, 600);
  EXPECT_DOUBLE_EQ(read.blocks[2].value, 0.5);
  EXPECT_DOUBLE_EQ(read.blocks[3].value, 0.5);
  EXPECT_EQ(read.blocks[4].action, ActionKind::kSpindleOff);
  EXPECT_EQ(read.blocks[5].value, 12);
  EXPECT_DOUBLE_EQ(read.blocks[6].feed, 10) << "the dwell's F is no feed";
}

TEST(SiemensProgram, GoesToPlacesOfTheMachine) {
  const auto options = siemens(on(shipped("trunnion-ac")));
  EXPECT_EQ(read_siemens("SUPA G0 Z0 D0\nG0 X0 Y0 Z5\n", options).motion().size(), 1U);
  const ReadText read = read_siemens("G0 X0 Y0 Z5\nSUPA G0 Z0 D0\n", options);
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.motion().size(), 2U);
  EXPECT_TRUE(read.warned_of("SUPA: a straight rapid"));
}

struct Refused {
  const char* line;
  const char* says;
};

TEST(SiemensProgram, RefusesByName) {
  const std::vector<Refused> cases = {
      {"_HOME=5", "a value for _HOME, which the control alone knows"},
      {"X=_HOME", "X=_HOME: no line above gives it a number"},
      {"X=R1", "X=R1: no line above gives it a number"},
      {"X=10+5", "an expression"},
      {"R1=5*2", "an expression"},
      {"DEF STRING[10] TEXT", "DEF STRING[10]: only numbers"},
      {"DEF REAL PLACE[3]", "is not understood"},
      {"IF X1", "IF: variables, jumps"},
      {"GOTOF END1", "GOTOF: variables, jumps"},
      {"ROTS X10 Y20", "ROTS: angles in space"},
      {"MIRROR X0", "MIRROR: mirroring"},
      {"SCALE X2", "SCALE: scaling"},
      {"TRANS A10", "TRANS with the word A"},
      {"BSPLINE", "BSPLINE: a spline"},
      {"TRANSMIT", "TRANSMIT: a transformation"},
      {"MCALL CYCLE84(1)", "CYCLE84: a cycle"},
      {"HOLES2(1,2,3)", "HOLES2: a cycle that only the control knows"},
      {"PTP", "PTP: every axis goes for itself"},
      {"TOROT", "TOROT: a frame by a tool carrier"},
      {"G331 Z5 K1", "G331: the feed is tied to the turn of the spindle"},
      {"G291", "G291: words of ISO from here on"},
      {"D=\"MILL\"", "a name where a number is needed"},
      {"A3=0 B3=0 C3=1 G1 X1", "A3, B3, C3 without tool-centre control"},
      {"A2=10 X1", "address A2= is not understood"},
      {"G43.4", "G43.4 is not known here"},
      {"G70", "G70: inch for lengths"},
      {"G55 G0 X1", "a second work offset"},
      {"M17", "the end of a subprogram"},
      {"ACC[X 50", "ACC[ without its closing bracket"},
      {"CTOL=", "CTOL= without a number"},
      {"$AC_TIMER", "a variable of the control"},
      {"MSG(\"open", "without its closing bracket"},
      {"L10 P2", "L10: a subprogram"},
      {"TRAORI ORIMKS G1 X1 A3=1", "in the axes of the machine"}};
  for (const Refused& c : cases) {
    const ReadText read = read_siemens("G54 G0 X0 Y0 Z0\n" + std::string(c.line) + "\n");
    EXPECT_EQ(read.error_line, 5U) << c.line << ": " << read.error;
    EXPECT_NE(read.error.find(c.says), std::string::npos) << c.line << ": " << read.error;
  }
}

TEST(SiemensProgram, SkipsLabelsAndWhatSaysHowTheControlSmooths) {
  const ReadText read = read_siemens(
      "START:\nTRAORI\nG642 ADIS=0.05 ADISPOS=0.1\nFGROUP(X,Y,Z,A,C)\nFGREF[A]=10 FGREF[C]=R5\n"
      "R5=3 CTOL=0.01 OTOL=0.5\nFGREF[C]=R5 FIFOCTRL DYNFINISH ACC[X]=80\n"
      "GROUP_BEGIN(0,\"OP1\",0,0)\nG0 X0 Y0 Z0 A3=0 B3=0 C3=1\nG1 X1\nTRAFOOF\n");
  EXPECT_EQ(read.error_line, 8U) << "R5 has no number yet: " << read.error;
  const ReadText whole = read_siemens(
      "START:\nTRAORI\nG642 ADIS=0.05 ADISPOS=0.1\nFGROUP(X,Y,Z,A,C)\nR5=3 FGREF[A]=10 "
      "FGREF[C]=R5\n"
      "CTOL=0.01 OTOL=0.5 FIFOCTRL DYNFINISH ACC[X]=80\nGROUP_BEGIN(0,\"OP1\",0,0)\n"
      "G0 X0 Y0 Z0 A3=0 B3=0 C3=1\nG1 X1\nTRAFOOF\n");
  ASSERT_EQ(whole.error, "");
  EXPECT_EQ(whole.motion().size(), 2U);
}

TEST(SiemensProgram, SaysWhereACutIsUnderD0) {
  EXPECT_TRUE(read_siemens("G0 X0 Y0 Z0 D0\nG1 X1\n").warned_of("a cut under D0"));
  EXPECT_FALSE(read_siemens("D0\nT1 M6\nG0 X0 Y0 Z0\nG1 X1\n").warned_of("a cut under D0"))
      << "a new tool comes with its D1";
}

TEST(SiemensProgram, ClearsFramesThatNobodySet) {
  EXPECT_EQ(read_siemens("TRANS\nROT\nCYCLE800()\nG0 X0 Y0 Z0\n").error, "");
}

}  // namespace
}  // namespace meridian::nc
