// SPDX-License-Identifier: Apache-2.0
// Q parameters of Klartext that stand for numbers.
#include <gtest/gtest.h>

#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

const std::string kOver = "2 L X+0 Y+0 Z+50 R0 FMAX\n";

TEST(KlartextParameters, StandForTheNumberThatTheLastLineGave) {
  const ReadText read = read_klartext(
      "2 FN 0: Q1 = +600\n3 FN0:Q2=-2,5\n4 QL3 = Q1\n5 Q4 = -Q2\n6 L X+Q2 Y-Q2 Z+Q4 R0 FMAX\n"
      "7 L X+10 FQ1\n8 Q1 = 300\n9 L IX+Q4 F Q1\n10 L X+20 F QL3\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 4U);
  EXPECT_EQ(tip(motion[0]), Vector3(-2.5, 2.5, 2.5));
  EXPECT_DOUBLE_EQ(motion[1].feed, 10);
  EXPECT_EQ(tip(motion[2]), Vector3(12.5, 2.5, 2.5));
  EXPECT_DOUBLE_EQ(motion[2].feed, 5);
  EXPECT_DOUBLE_EQ(motion[3].feed, 10);
}

TEST(KlartextParameters, GiveCyclesTheirNumbersAndDoNotEndInTheirDefinition) {
  const ReadText read = read_klartext(
      "2 FN 0: Q3 = 120\n" + kOver +
      "3 CYCL DEF 240 CENTERING ~\n Q200=2 ~\n Q201=-5 ~\n Q206=Q3 ~\n Q203=+0 ~\n Q204=50\n"
      "4 Q3 = 7\n5 L X+Q3 FMAX M99\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(levels_of(read), "50r 2r -5f 50r");
  EXPECT_DOUBLE_EQ(read.motion().at(3).feed, 2);
  EXPECT_EQ(read.motion()[3].tip_mm[0], 7);
}

TEST(KlartextParameters, GivePlanesAndDatumsTheirNumbers) {
  const std::string written =
      "4 CYCL DEF 7.0 DATUM SHIFT\n5 CYCL DEF 7.1 X+10\n6 CYCL DEF 7.2 Y-2,5\n"
      "7 CYCL DEF 7.3 IZ+5\n8 PLANE SPATIAL SPA+30 SPB+0 SPC-45 TURN FMAX\n9 L X+1 Y+2 Z+3 FMAX\n";
  const std::string by_parameters =
      "4 CYCL DEF 7.0 DATUM SHIFT\n5 CYCL DEF 7.1 X+Q1\n6 CYCL DEF 7.2 Y-Q2\n"
      "7 CYCL DEF 7.3 IZ+Q3\n8 PLANE SPATIAL SPA+Q4 SPB+0 SPC-Q5 TURN FMAX\n"
      "9 L X+1 Y+2 Z+3 FMAX\n";
  const std::string given = "1 Q1 = 10\n1 Q2 = 2,5\n1 Q3 = 5\n1 Q4 = 30\n1 Q5 = 45\n" + kOver;
  const ClReaderOptions options = klartext(on(shipped("trunnion-ac")));
  const ReadText numbers = read_klartext(given + written, options);
  const ReadText parameters = read_klartext(given + by_parameters, options);
  ASSERT_EQ(numbers.error, "");
  ASSERT_EQ(parameters.error, "");
  const auto expected = numbers.motion(), motion = parameters.motion();
  ASSERT_GE(expected.size(), 2U);
  ASSERT_EQ(motion.size(), expected.size());
  for (std::size_t n = 0; n < motion.size(); ++n) {
    EXPECT_EQ(tip(motion[n]), tip(expected[n])) << n;
    EXPECT_EQ(axis(motion[n]), axis(expected[n])) << n;
  }
  EXPECT_GT(std::abs(axis(motion.back()).y()), 0.1) << "the plane is tilted";
  const ReadText unknown = read_klartext(kOver + "3 CYCL DEF 7.1 X+Q1\n", options);
  EXPECT_NE(unknown.error.find("'+Q1' is no number"), std::string::npos) << unknown.error;
}

TEST(KlartextParameters, AreRefusedWhereNoNumberIsGiven) {
  for (const auto& [line, says] : std::vector<std::pair<const char*, const char*>>{
           {"L X+Q5", "a Q parameter"},
           {"Q5 = Q6", "a Q parameter: 'Q5 = Q6'"},
           {"Q5 = 3 + 4", "a Q parameter: 'Q5 = 3 + 4'"},
           {"Q5 3", "a Q parameter: 'Q5 3'"},
           {"Q201 = -20", "a Q parameter: 'Q201 = -20'"},
           {"FN 0: Q201 = 1", "a Q parameter: 'Q201 = 1'"},
           {"FN 1: Q5 = +1 + +2", "FN 1: Q5 = +1 + +2: jumps and formulas"},
           {"FN 9: IF +Q5 EQU +1 GOTO LBL 1", "jumps and formulas"},
           {"FN", "jumps and formulas"}}) {
    const ReadText read = read_klartext(kOver + "3 " + line + "\n");
    EXPECT_EQ(read.error_line, 4U) << line << ": " << read.error;
    EXPECT_NE(read.error.find(says), std::string::npos) << line << ": " << read.error;
  }
}

}  // namespace
}  // namespace meridian::nc
