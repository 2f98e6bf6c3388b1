// SPDX-License-Identifier: Apache-2.0
// CYCLE81 and its kin, alone and after MCALL, against levels worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>

#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

std::string siemens_holes(const std::string& body) {
  const ReadText read = read_siemens("S100 M3\nG0 X0 Y0 Z20\n" + body);
  return read.error.empty() ? levels_of(read) : read.error;
}

std::vector<double> feeds_of(const ReadText& read) {
  std::vector<double> out;
  for (const ClBlock& block : read.motion()) {
    if (block.kind == BlockKind::kCut) out.push_back(block.feed * 60);
  }
  return out;
}

TEST(SiemensCycles, DrillWhereTheToolStands) {
  EXPECT_EQ(siemens_holes("CYCLE81(10,1,2,-9)\nG1 X5\n"), "3r -9f 10r 10f");
  EXPECT_EQ(siemens_holes("CYCLE82(10, 1, 2, , 10, 0.5)\n"), "3r -9f 10r") << "a depth as a length";
}

TEST(SiemensCycles, DrillBehindEveryMotionUntilMcallStandsAlone) {
  EXPECT_EQ(siemens_holes("MCALL CYCLE81(10,0,2,-9)\nX5\nY5\nMCALL\nX0\n"),
            "20r 2r -9f 10r 10r 2r -9f 10r 10r");
  EXPECT_EQ(read_siemens("G0 X0 Y0 Z20\nMCALL CYCLE81(10,0,2,-9)\nX5\nM8\nY5\n").summary.holes, 2U)
      << "a line without motion drills nothing";
}

TEST(SiemensCycles, LeaveTheMotionInForceAsItWas) {
  const ReadText read = read_siemens("G0 X0 Y0 Z20\nCYCLE81(10,0,2,-9)\nX5\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.motion().back().kind, BlockKind::kRapid);
}

TEST(SiemensCycles, Dwell) {
  EXPECT_DOUBLE_EQ(read_siemens("G0 X0 Y0 Z20\nCYCLE82(10,0,2,-9,,0.5)\n").summary.dwell_time_s,
                   0.5);
  EXPECT_DOUBLE_EQ(
      read_siemens("S120 M3\nG0 X0 Y0 Z20\nCYCLE82(10,0,2,-9,,-3)\n").summary.dwell_time_s, 1.5)
      << "below zero: turns of the spindle";
}

TEST(SiemensCycles, PeckOutOfTheHoleOrBreakTheChip) {
  EXPECT_EQ(siemens_holes("CYCLE83(10,0,2,-9,,-4,,0,0,0,1,1)\n"),
            "2r -4f 2r -3r -8f 2r -7r -9f 10r");
  EXPECT_EQ(siemens_holes("CYCLE83(10,0,2,-9,,,4,0,0,0,1,0)\n"), "2r -4f -3r -8f -7r -9f 10r");
}

TEST(SiemensCycles, ShortenEachPeckByTheDecrement) {
  // 6, 4, 2, 2 and what is left twice half: 12 + 2 + 1 + 1.
  EXPECT_EQ(siemens_holes("CYCLE83(10,0,2,-15,,-6,,2,0,0,1,0)\n"),
            "2r -6f -5r -10f -9r -12f -11r -13f -12r -15f 10r");
}

TEST(SiemensCycles, ReamWithItsOwnFeeds) {
  const ReadText read = read_siemens("G0 X0 Y0 Z20\nCYCLE85(10,0,2,-9,,0,120,300)\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(levels_of(read), "2r -9f 2f 10r");
  EXPECT_EQ(feeds_of(read), (std::vector<double>{120, 300}));
  EXPECT_EQ(feeds_of(read_siemens("G0 X0 Y0 Z20\nCYCLE89(10,0,2,-9)\n")),
            (std::vector<double>{600, 600}));
}

TEST(SiemensCycles, TakeNumbersByName) {
  EXPECT_EQ(siemens_holes("R1=10\nR2=-9\nCYCLE81(R1,0,2,R2)\n"), "2r -9f 10r");
}

TEST(SiemensCycles, DrillAlongATiltedPlane) {
  const MachineModel model = shipped("trunnion-ac");
  const ReadText read = read_siemens(
      "CYCLE800(0,\"\",0,57,0,0,0,30,0,0,0,0,0,-1)\nG0 X0 Y0 Z20\nCYCLE81(10,0,2,-9)\n",
      siemens(on(model)));
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 4U);
  const Vector3 along(0, -0.5, std::sqrt(0.75));
  EXPECT_LT((axis(motion[2]) - along).norm(), kTiny);
  EXPECT_LT((tip(motion[2]) + 9 * along).norm(), 1e-6);
}

TEST(SiemensCycles, AreRefusedByName) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"CYCLE84(10,0,2,-9)", "CYCLE84: a cycle that only the control knows"},
      {"MCALL CYCLE86(10,0,2,-9)", "CYCLE86: a cycle"},
      {"CYCLE81(10,0,2,5)", "the depth has to be below"},
      {"CYCLE81(-1,0,2,-9)", "the retract plane above"},
      {"CYCLE81(10,0,2,-9,12)", "two depths, 9 by its Z and 12"},
      {"CYCLE81(10,0,2,-9,,0,1)", "not that of the tip"},
      {"CYCLE81(10,0,2,-9,,0,0,2)", "outside G17"},
      {"CYCLE81(10,0,2,_Z)", "argument 4 is no number"},
      {"CYCLE83(10,0,2,-9,,-4,,0,0,0,0.5,1)", "another feed for its first peck"},
      {"CYCLE83(10,0,2,-9,,4,,0,0,0,1,1)", "first depth is not below"},
      {"G18\nCYCLE81(10,0,2,-9)", "outside G17"}};
  for (const auto& [line, says] : cases) {
    EXPECT_NE(siemens_holes(std::string(line) + "\n").find(says), std::string::npos)
        << line << ": " << siemens_holes(std::string(line) + "\n");
  }
}

}  // namespace
}  // namespace meridian::nc
