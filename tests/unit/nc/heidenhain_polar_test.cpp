// SPDX-License-Identifier: Apache-2.0
// Klartext: lines about the pole, by radius and angle.
#include <gtest/gtest.h>

#include <string>

#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

TEST(KlartextPolarLine, EndsAtItsRadiusAndAngleAboutThePole) {
  const ReadText read = read_klartext(
      "2 L X+0 Y+0 Z+5 R0 FMAX\n3 CC X+10 Y+20\n4 LP PR+30 PA+90 FMAX\n"
      "5 LP PR+10 PA-180 Z-1 F600\n6 CC X+0 Y+0\n7 LP PR+2,5 PA+0\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 4U);
  EXPECT_EQ(motion[1].kind, BlockKind::kRapid);
  EXPECT_LT((tip(motion[1]) - Vector3(10, 50, 5)).norm(), kTiny);
  EXPECT_EQ(motion[2].kind, BlockKind::kCut);
  EXPECT_LT((tip(motion[2]) - Vector3(0, 20, -1)).norm(), kTiny);
  EXPECT_LT((tip(motion[3]) - Vector3(2.5, 0, -1)).norm(), kTiny);
}

TEST(KlartextPolarLine, KeepsWhatItLeavesOutAndAddsWhatIsIncremental) {
  const ReadText read = read_klartext(
      "2 L X+0 Y+0 Z+5 R0 FMAX\n3 CC X+10 Y+0\n4 LP PR+20 PA+30 FMAX\n5 LP IPA+60 FMAX\n"
      "6 LP PA+180 F600\n7 LP IPR-5\n8 LP IPR+5 IPA+90\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 6U);
  EXPECT_LT((tip(motion[2]) - Vector3(10, 20, 5)).norm(), kTiny) << "30 and 60 degrees";
  EXPECT_LT((tip(motion[3]) - Vector3(-10, 0, 5)).norm(), kTiny);
  EXPECT_LT((tip(motion[4]) - Vector3(-5, 0, 5)).norm(), kTiny);
  EXPECT_LT((tip(motion[5]) - Vector3(10, -20, 5)).norm(), kTiny);
}

TEST(KlartextPolarLine, IsRefusedWhereItsEndIsNotSaid) {
  const struct {
    const char *before, *line, *says;
  } cases[] = {{"L X+0 Y+0 Z+0 FMAX", "LP PR+5 PA+0", "a line about the pole (LP) before any CC"},
               {"CC X+0 Y+0", "LP PA+30", "LP without PR"},
               {"CC X+0 Y+0", "LP PR+3", "LP without PA"},
               {"CC X+0 Y+0", "LP PR+5 IPR+1 PA+0", "LP with PR and IPR"},
               {"CC X+0 Y+0", "LP PR+5 PA+0 X+1", "LP beside X or Y"}};
  for (const auto& [before, line, says] : cases) {
    const ReadText read =
        read_klartext("2 " + std::string(before) + "\n3 " + std::string(line) + " F600\n");
    EXPECT_EQ(read.error_line, 4U) << line << ": " << read.error;
    EXPECT_NE(read.error.find(says), std::string::npos) << line << ": " << read.error;
  }
  const ReadText at_pole = read_klartext("2 L X+1 Y+2 Z+0 FMAX\n3 CC X+1 Y+2\n4 LP PR+5 F600\n");
  EXPECT_NE(at_pole.error.find("LP without PA"), std::string::npos) << at_pole.error;
}

TEST(KlartextPolarWords, AreRefusedInLinesThatWouldLeaveThemOut) {
  const struct {
    const char *line, *says;
  } cases[] = {{"L PR+5 PA+10 F100", "PR in a line with L"},
               {"L X+1 IPA+5 F100", "IPA in a line with L"},
               {"C X+0 Y+9 PA+90 DR+ F100", "PA in a line with C"},
               {"CP PR+9 PA+90 DR+ F100", "PR in a line with CP"},
               {"L X+1 MB5 F100", "MB in a line with L; write it beside M140"}};
  for (const auto& [line, says] : cases) {
    const ReadText read =
        read_klartext("2 L X+9 Y+0 Z+0 FMAX\n3 CC X+0 Y+0\n4 " + std::string(line) + "\n");
    EXPECT_NE(read.error.find(says), std::string::npos) << line << ": " << read.error;
  }
}

}  // namespace
}  // namespace meridian::nc
