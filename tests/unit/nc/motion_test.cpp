// SPDX-License-Identifier: Apache-2.0
// Points, arcs, feeds and units of NC programs, without a machine.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

TEST(NcMotion, MayHaveTheNumberOfARadiusBesideIt) {
  const ReadText read = read_nc("G0 X0. Y0.\nG43 Z25. H01 D01\nG1 X9. D1\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(to_vector(read.motion().back().tip_mm), Vector3(9, 0, 25));
  EXPECT_NE(read_nc("G0 X0. Y0. Z0.\nG1 X9. E1\n").error.find("word E"), std::string::npos);
}

TEST(NcMotion, HasModalMotionAndCoordinates) {
  const ReadText read = read_nc("G0 X1. Y2. Z3.\nX4.\nG1 Z-1.\nY5. Z6.\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 4U);
  EXPECT_EQ(motion[1].kind, BlockKind::kRapid);
  EXPECT_EQ(tip(motion[1]), Vector3(4, 2, 3));
  EXPECT_EQ(motion[2].kind, BlockKind::kCut);
  EXPECT_DOUBLE_EQ(motion[2].feed, 10);
  EXPECT_EQ(tip(motion[3]), Vector3(4, 5, 6));
  EXPECT_EQ(axis(motion[3]), Vector3(0, 0, 1));
  EXPECT_EQ(motion[3].line, 7U);
  EXPECT_EQ(read.blocks.back().kind, BlockKind::kEnd);
}

TEST(NcMotion, SumsUpIncrements) {
  const auto motion = read_nc("G0 X1. Y2. Z3.\nG91 G1 X1.\nX1. Z-1.\n").motion();
  ASSERT_EQ(motion.size(), 3U);
  EXPECT_EQ(tip(motion[2]), Vector3(3, 2, 2));
}

TEST(NcMotion, ReadsInchesInMillimetres) {
  const auto motion = read_nc("G20 F10.\nG0 X1. Y0. Z0.\nG1 X2.\n").motion();
  ASSERT_EQ(motion.size(), 2U);
  EXPECT_DOUBLE_EQ(motion[1].tip_mm[0], 50.8);
  EXPECT_DOUBLE_EQ(motion[1].feed, 254.0 / 60);
}

TEST(WorkOffsets, LieWhereTheMachineHasThem) {
  MachineModel machine = shipped("trunnion-ac");
  machine.X_MW.origin_mm = {10, 20, 30};
  ClReaderOptions options = on(machine);
  options.work_offsets = {{1, {110, 20, 30}}, {2, {10, 220, 30}}, {8, {10, 20, 330}}};
  const ReadText read = read_nc(
      "G54\nG43 H1\nG0 X1. Y2. Z3.\nG55\nG0 X5. Y6. Z7.\nG1 X6.\nG54.1 P2\nG0 Z9.\nG1 X0. Y0.\n"
      "G54\nG0 X0. Y0. Z0.\n",
      options);
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 6U);
  EXPECT_EQ(tip(motion[0]), Vector3(101, 2, 3));
  EXPECT_EQ(tip(motion[2]), Vector3(6, 206, 7));
  EXPECT_EQ(tip(motion[3]), Vector3(6, 206, 309)) << "X and Y stand where they stood";
  EXPECT_EQ(tip(motion[4]), Vector3(0, 0, 309));
  EXPECT_EQ(tip(motion[5]), Vector3(100, 0, 0));
  EXPECT_EQ(read.summary.nc.work_offset, "G54, G55, G54.1 P2");
  EXPECT_TRUE(read.warned_of("another work offset"));
  EXPECT_TRUE(read.warned_of("G55 is not the work frame in force: its points lie 0, 200, 0 mm"));
}

TEST(WorkOffsets, CountInTheUnitOfTheProgramAndTurnWithItsFrames) {
  ClReaderOptions options = on(shipped("trunnion-ac"));
  options.work_offsets = {{1, {0, 0, 0}}, {2, {25.4, 0, 0}}};
  const ReadText read =
      read_nc("G20\nG54\nG43 H1\nG68.2 X0. Y0. Z0. I90. J0. K0.\nG53.1\nG0 X1. Y2. Z3.\nG55\nX2.\n",
              options);
  ASSERT_EQ(read.error, "");
  EXPECT_LT((tip(read.motion()[0]) - 25.4 * Vector3(-2, 1, 3)).norm(), kTiny);
  EXPECT_LT((tip(read.motion()[1]) - 25.4 * Vector3(-2, 2, 3)).norm(), kTiny)
      << "Y of the plane stands where it stood";
}

TEST(WorkOffsets, AreRefusedWhereOneOfTwoIsNotKnown) {
  ClReaderOptions options = on(shipped("trunnion-ac"));
  options.work_offsets = {{2, {0, 0, 0}}};
  const std::string first = read_nc("G54\nG43 H1\nG0 X0. Y0. Z9.\nG55\nX1.\n", options).error;
  EXPECT_NE(first.find("where G54 lies only the control knows; --work-zero 1=X,Y,Z"),
            std::string::npos)
      << first;
  const std::string second = read_nc("G55\nG43 H1\nG0 X0. Y0. Z9.\nG59.1\nX1.\n", options).error;
  EXPECT_NE(second.find("where G59.1 lies"), std::string::npos) << second;
  options.nc = reader_of_programs();
  EXPECT_NE(read_nc("G55\nG43 H1\nG0 X0. Y0. Z9.\nG54\nX1.\n", options).error, "") << "no machine";
}

TEST(WorkOffsets, HoldFromTheNextMotionOn) {
  const ReadText read = read_nc("G54\nG43 H1\nG0 X0. Y0. Z9.\nG55\nG54\nG1 X1.\n");
  ASSERT_EQ(read.error, "") << "G55 is not moved in";
  EXPECT_EQ(read.summary.nc.work_offset, "G54");
}

TEST(WorkOffsets, BehindMotionWithoutOneAreG54OrRefused) {
  const std::string head = "G43 H1\nG0 X0. Y0. Z9.\n";
  const ReadText read = read_nc(head + "G54\nX1.\n");
  ASSERT_EQ(read.error, "");
  EXPECT_TRUE(read.warned_of("taken to lie in G54 too"));
  EXPECT_NE(read_nc(head + "G55\nX1.\n").error.find("after motion without a work offset"),
            std::string::npos);
  EXPECT_NE(read_siemens("G0 X0 Y0 Z9\nG54\nX1\n").error.find("after motion without"),
            std::string::npos);
}

TEST(NcMotion, HasTheUnitWordsOfDin66025) {
  for (const auto& [unit, x_mm] :
       std::vector<std::pair<const char*, double>>{{"G70", 50.8}, {"G71", 2.0}}) {
    const ReadText read = cl::read_text(
        "%\nO1\n" + std::string(unit) + " G90\nG0 X1. Y0. Z0.\nX2.\nM30\n%\n", without_machine());
    ASSERT_EQ(read.error, "") << unit;
    EXPECT_DOUBLE_EQ(read.motion().back().tip_mm[0], x_mm) << unit;
  }
  EXPECT_NE(read_nc("G0 X0. Y0. Z0.\nG70 I5. J15. L12\n").error, "") << "holes on a circle";
}

TEST(NcMotion, KnowsThreeKindsOfFeed) {
  const ReadText read =
      read_nc("G0 X0. Y0. Z0.\nG93 G1 X1. F30.\nG95 S1000 M3\nG1 X2. F0.1\nG94 G1 X3. F300.\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 4U);
  EXPECT_EQ(motion[1].feed_meaning, FeedMeaning::kInverseTime);
  EXPECT_DOUBLE_EQ(motion[1].feed, 0.5);
  EXPECT_DOUBLE_EQ(motion[2].feed, 100.0 / 60);
  EXPECT_DOUBLE_EQ(motion[3].feed, 5);
}

TEST(NcMotion, TakesTheAxisOfG435FromItsVector) {
  const ReadText read =
      read_nc("G43.5 H1\nG0 X0. Y0. Z10. I0. J0. K1.\nG1 X1. I0. J-6. K8.\nX2.\nG49\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 3U);
  EXPECT_LT((axis(motion[1]) - Vector3(0, -0.6, 0.8)).norm(), kTiny);
  EXPECT_EQ(axis(motion[2]), axis(motion[1]));
  EXPECT_EQ(read.summary.goto_six, 3U);
}

TEST(NcMotion, TurnsCircularInEveryPlane) {
  struct Case {
    const char* words;
    Vector3 end, normal;
  };
  const std::vector<Case> cases = {{"G17 G3 X0. Y10. I-10. J0.", {0, 10, 0}, {0, 0, 1}},
                                   {"G17 G2 X0. Y-10. I-10. J0.", {0, -10, 0}, {0, 0, -1}},
                                   {"G18 G3 X0. Z-10. I-10. K0.", {0, 0, -10}, {0, 1, 0}},
                                   {"G18 G2 X0. Z10. I-10. K0.", {0, 0, 10}, {0, -1, 0}},
                                   {"G17 G3 X0. Y10. R10.", {0, 10, 0}, {0, 0, 1}},
                                   {"G90.1 G17 G3 X0. Y10. I0. J0.", {0, 10, 0}, {0, 0, 1}}};
  for (const Case& c : cases) {
    const ReadText read = read_nc("G0 X10. Y0. Z0.\n" + std::string(c.words) + "\n");
    ASSERT_EQ(read.error, "") << c.words;
    const ClBlock arc = read.motion().at(1);
    ASSERT_TRUE(arc.is_arc) << c.words;
    EXPECT_NEAR(arc.sweep_rad, std::numbers::pi / 2, kTiny) << c.words;
    EXPECT_LT((to_vector(arc.centre_mm)).norm(), kTiny) << c.words;
    EXPECT_LT((to_vector(arc.normal) - c.normal).norm(), kTiny) << c.words;
    EXPECT_EQ(tip(arc), c.end) << c.words;
  }
}

TEST(NcMotion, TurnsAcrossTheYZPlane) {
  const ClBlock arc = read_nc("G0 X0. Y10. Z0.\nG19 G3 Y0. Z10. J-10. K0.\n").motion().at(1);
  EXPECT_LT((to_vector(arc.normal) - Vector3::UnitX()).norm(), kTiny);
  EXPECT_NEAR(arc.sweep_rad, std::numbers::pi / 2, kTiny);
}

TEST(NcMotion, TakesTheLongWayForANegativeRadius) {
  const ClBlock arc = read_nc("G0 X10. Y0. Z0.\nG3 X0. Y10. R-10.\n").motion().at(1);
  EXPECT_NEAR(arc.sweep_rad, 1.5 * std::numbers::pi, kTiny);
  EXPECT_LT((to_vector(arc.centre_mm) - Vector3(10, 10, 0)).norm(), kTiny);
}

TEST(NcMotion, RunsFullCirclesAndHelices) {
  const ReadText read = read_nc("G0 X10. Y0. Z0.\nG2 I-10.\nG3 X-10. Z4. I-10. J0.\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 3U);
  EXPECT_NEAR(motion[1].sweep_rad, 2 * std::numbers::pi, kTiny);
  EXPECT_NEAR(motion[2].sweep_rad, std::numbers::pi, kTiny);
  EXPECT_EQ(tip(motion[2]), Vector3(-10, 0, 4));
}

TEST(NcMotion, WaitsUntilAllCoordinatesAreKnown) {
  const ReadText read = read_nc("G0 X1. Y2.\nG43 H1 Z50.\nG1 Z0.\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 2U);
  EXPECT_EQ(tip(motion[0]), Vector3(1, 2, 50));
}

TEST(NcMotion, PutsPointsIntoTheFrameOfTheCaller) {
  ClReaderOptions options = without_machine();
  options.frame = cl::Frame{Eigen::AngleAxisd(std::numbers::pi / 2, Vector3::UnitZ()).matrix(),
                            Vector3(100, 0, 0)};
  const auto motion = read_nc("G43.5 H1\nG0 X1. Y2. Z3. I1. J0. K0.\n", options).motion();
  ASSERT_EQ(motion.size(), 1U);
  EXPECT_LT((tip(motion[0]) - Vector3(98, 1, 3)).norm(), kTiny);
  EXPECT_LT((axis(motion[0]) - Vector3(0, 1, 0)).norm(), kTiny);
}

TEST(NcMotion, SaysWhichWorkOffsetIsTheFrameOfTheStation) {
  const ReadText read = read_nc("G55\nG0 X1. Y2. Z3.\n");
  EXPECT_EQ(read.summary.nc.work_offset, "G55");
  EXPECT_NE(to_text(read.summary).find("work offset    G55"), std::string::npos);
  EXPECT_EQ(read_nc("G54.1 P12\nG0 X1. Y2. Z3.\n").summary.nc.work_offset, "G54.1 P12");
}

TEST(NcMotion, NamesTheWorkOffsetsOfHaasAsThoseOfTheTable) {
  EXPECT_EQ(read_nc("G154 P3\nG0 X1. Y2. Z3.\n").summary.nc.work_offset, "G54.1 P3");
  EXPECT_NE(read_nc("G154\nG0 X1. Y2. Z3.\n").error.find("G154 need their number"),
            std::string::npos);
}

TEST(NcMotion, TakesNoLengthFromH0AndFlagsThatOfAnotherTool) {
  const std::string point = " H0\nG0 X0. Y0. Z9. A0. C0.\nG1 X5.\n";
  EXPECT_TRUE(read_nc("G43" + point).warned_of("a cut without G43"));
  const ReadText refused = read_nc("G43.4" + point, on(shipped("trunnion-ac")));
  EXPECT_NE(refused.error.find("part.apt:4: H0: tool-centre control without"), std::string::npos)
      << refused.error;
  const std::string call = "T2 M6\nS500 M3\nG43 H";
  EXPECT_TRUE(read_nc(call + "12\nG0 X0. Y0. Z9.\n").warned_of("H12 beside tool 2"));
  EXPECT_TRUE(read_nc(call + "2\nG0 X0. Y0. Z9.\n").warnings.empty());
}

TEST(NcMotion, RefusesALeanOfTheToolBesideAPoint) {
  const std::string program = "G43.5 H1\nG0 X0. Y0. Z9. I0. J0. K1. ";
  const ReadText lean = read_nc(program + "Q5.\nG1 X9.\n");
  EXPECT_NE(lean.error.find("part.apt:5: word Q beside a point"), std::string::npos) << lean.error;
  EXPECT_EQ(read_nc(program + "Q0.\nG1 X9.\n").error, "");
}

TEST(NcMotion, WarnsOfNumbersWithoutAPoint) {
  EXPECT_TRUE(read_nc("G0 X100 Y0 Z0\n").warned_of("no decimal point"));
  EXPECT_FALSE(read_nc("G0 X100. Y0 Z0\n").warned_of("no decimal point"));
}

TEST(NcMotion, BeginsAtALineOfTheMiddle) {
  ClReaderOptions options = without_machine();
  options.first_line = 6;
  const auto motion = read_nc("G0 X1. Y2. Z3.\nG1 X2.\nX3.\n", options).motion();
  ASSERT_EQ(motion.size(), 2U);
  EXPECT_EQ(motion[0].kind, BlockKind::kRapid);
  EXPECT_EQ(tip(motion[0]), Vector3(2, 2, 3));
  EXPECT_EQ(tip(motion[1]), Vector3(3, 2, 3));
}

TEST(NcMotion, FlagsACutWithoutALengthOfTheToolInForce) {
  const ReadText bare = read_nc("G0 X0. Y0. Z5.\nG1 Z0.\nX10.\n");
  EXPECT_EQ(bare.error, "");
  ASSERT_EQ(bare.warnings.size(), 1U);
  EXPECT_NE(bare.warnings[0].message.find("a cut without G43"), std::string::npos);
  EXPECT_TRUE(read_nc("G43 H1\nG0 X0. Y0. Z5.\nG1 Z0.\nX10.\n").warnings.empty());
}

}  // namespace
}  // namespace meridian::nc
