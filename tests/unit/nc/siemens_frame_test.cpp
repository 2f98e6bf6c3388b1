// SPDX-License-Identifier: Apache-2.0
// TRANS, ROT and CYCLE800, worked out by hand.
#include <gtest/gtest.h>

#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

TEST(SiemensFrame, MovesAndTurnsPointsInItsOrder) {
  const ReadText read = read_siemens(
      "G0 X0 Y0 Z0\nTRANS X10 Y5\nG1 X1\nAROT Z90\nX2 Y0\nATRANS X1\nX0 Y0\nROT Z180\nX1 Y0\n"
      "TRANS\nX1 Y0\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 6U);
  EXPECT_EQ(tip(motion[1]), Vector3(11, 0, 0)) << "Y stands where it stood";
  EXPECT_LT((tip(motion[2]) - Vector3(10, 7, 0)).norm(), kTiny);
  EXPECT_LT((tip(motion[3]) - Vector3(10, 6, 0)).norm(), kTiny);
  EXPECT_LT((tip(motion[4]) - Vector3(-1, 0, 0)).norm(), kTiny) << "ROT replaces TRANS";
  EXPECT_EQ(tip(motion[5]), Vector3(1, 0, 0));
  EXPECT_EQ(axis(motion[5]), Vector3(0, 0, 1));
  EXPECT_EQ(read.summary.frame_changes, 5U);
}

TEST(SiemensFrame, TurnsVectorsOfTheToolAxisToo) {
  const ReadText read = read_siemens(
      "TRAORI\nORIWKS ORIVECT\nG0 X0 Y0 Z0 A3=0 B3=0 C3=1\nAROT X-90\nAROT Z90\n"
      "G1 X1 A3=0 B3=0 C3=1\nTRAFOOF\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 2U);
  // About x by -90: z is +y, y is -z. About that z by 90: x is the y before, -z.
  EXPECT_LT((axis(motion[1]) - Vector3(0, 1, 0)).norm(), kTiny);
  EXPECT_LT((tip(motion[1]) - Vector3(0, 0, -1)).norm(), kTiny);
}

TEST(SiemensFrame, TakesRotaryWordsAsTheMachineHasThem) {
  const ReadText read = read_siemens(
      "G0 A90 C0\nTRAORI\nG54\nAROT X90\nG0 X1 Y2 Z5\nG1 Z0\nTRANS X0 Y0 Z0\nTRAFOOF\n",
      siemens(on(shipped("trunnion-ac"))));
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 2U);
  EXPECT_LT((tip(motion[1]) - Vector3(1, 0, 2)).norm(), kTiny);
  EXPECT_NEAR(axis(motion[1])[2], 0, kTiny);
}

TEST(SiemensFrame, SaysHowItReadsTurnsAboutSeveralAxes) {
  const ReadText read = read_siemens("ROT X90 Z90\nG0 X1 Y0 Z0\nX0 Y1\n");
  ASSERT_EQ(read.error, "");
  EXPECT_TRUE(read.warned_of("taken as about Z, the new Y and the new X"));
  EXPECT_LT((tip(read.motion()[0]) - Vector3(0, 1, 0)).norm(), kTiny);
  EXPECT_LT((tip(read.motion()[1]) - Vector3(0, 0, 1)).norm(), kTiny);
}

TEST(Swivel, TurnsTheToolAcrossItsPlane) {
  const ReadText read = read_siemens(
      "CYCLE800(0,\"TABLE\",0,57,10,0,0,0,45,0,0,0,1,-1)\nG0 X0 Y2 Z5\nG1 Z-1\nCYCLE800()\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 2U);
  const Vector3 z(kHalfRoot, 0, kHalfRoot);
  EXPECT_LT((axis(motion[1]) - z).norm(), kTiny);
  EXPECT_LT((tip(motion[0]) - (Vector3(10, 2, 0) + 6 * z)).norm(), kTiny);
  EXPECT_LT((tip(motion[1]) - Vector3(10, 2, 0)).norm(), kTiny);
}

TEST(Swivel, AddsToTheOneInForceWhereItSaysSo) {
  const ReadText read = read_siemens(
      "CYCLE800(0,\"\",0,57,0,0,0,0,90,0,0,0,0,-1)\nCYCLE800(0,\"\",1,57,0,0,0,90,0,0,0,0,0,-1)\n"
      "G0 X1 Y0 Z0\nX0 Y1\nX0 Y0 Z1\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 3U);
  EXPECT_LT((tip(motion[0]) - Vector3(0, 0, -1)).norm(), kTiny);
  EXPECT_LT((tip(motion[1]) - Vector3(1, 0, 0)).norm(), kTiny);
  EXPECT_LT((tip(motion[2]) - Vector3(0, -1, 0)).norm(), kTiny);
}

TEST(Swivel, IsRefusedWhereItHasNoSingleReading) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"CYCLE800(0,\"\",0,39,0,0,0,30,0,0,0,0,0,-1)", "two readings"},
      {"CYCLE800(0,\"\",0,192,0,0,0,30,0,0,0,0,0,-1)", "places of the rotary axes"},
      {"CYCLE800(0,\"\",0,0,0,0,0,30,0,0,0,0,0,-1)", "in mode 0"},
      {"CYCLE800(0,\"\",0,57,0,0,0,_A,0,0,0,0,0,-1)", "argument 8 is no number"},
      {"TRANS X5\nCYCLE800(0,\"\",0,57,0,0,0,30,0,0,0,0,0,-1)", "while TRANS or ROT"},
      {"CYCLE800(0,\"\",0,57,0,0,0,30,0,0,0,0,0,0)\nG0 X0 Y0 Z0\nG1 X1", "does not stand across"}};
  for (const auto& [body, says] : cases) {
    const ReadText read = read_siemens(std::string(body) + "\n");
    EXPECT_NE(read.error.find(says), std::string::npos) << body << ": " << read.error;
  }
  EXPECT_EQ(read_siemens("CYCLE800(0,\"\",0,45,0,0,0,30,0,0,0,0,0,-1)\nG0 X0 Y0 Z0\n").error, "")
      << "about X first, by its letter and by its turn";
}

}  // namespace
}  // namespace meridian::nc
