// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/shapes/hole.hpp"

#include <gtest/gtest.h>

#include <array>

#include "hole_blocks.hpp"

namespace meridian::cl {
namespace {

TEST(Cycle, DrillOfNxGoesBackToItsRetractLevel) {
  expect_blocks(holes("CYCLE/DRILL,RAPTO,3.0,FEDTO,-20.0,RTRCTO,10.0,MMPM,250.\n"
                      "GOTO/10,0,5\nGOTO/30,0,5\nCYCLE/OFF\n",
                      Dialect::kNx),
                {{'R', {10, 0, 50}},
                 {'R', {10, 0, 8}},
                 {'F', {10, 0, -15}, 250},
                 {'R', {10, 0, 15}},
                 {'R', {30, 0, 15}},
                 {'R', {30, 0, 8}},
                 {'F', {30, 0, -15}, 250},
                 {'R', {30, 0, 15}}});
}

TEST(Cycle, OfNxGoesBackToWhereTheToolWasWithRtrctoAuto) {
  expect_blocks(holes("CYCLE/DRILL,RAPTO,3.0,FEDTO,-20.0,RTRCTO,AUTO,MMPM,250.\nGOTO/10,0,5\n"
                      "GOTO/20,0,5\n",
                      Dialect::kNx),
                {{'R', {10, 0, 50}},
                 {'R', {10, 0, 8}},
                 {'F', {10, 0, -15}, 250},
                 {'R', {10, 0, 50}},
                 {'R', {20, 0, 50}},
                 {'R', {20, 0, 8}},
                 {'F', {20, 0, -15}, 250},
                 {'R', {20, 0, 50}}});
}

TEST(Cycle, OfNxGoesBackToItsRapidLevelWithoutRtrcto) {
  expect_blocks(
      holes("CYCLE/DRILL,RAPTO,3.0,FEDTO,-20.0,MMPM,250.\nGOTO/10,0,5\n", Dialect::kNx),
      {{'R', {10, 0, 50}}, {'R', {10, 0, 8}}, {'F', {10, 0, -15}, 250}, {'R', {10, 0, 8}}});
}

TEST(Cycle, DwellsAtTheBottom) {
  const std::vector<Want> want = {{'R', {10, 0, 50}},
                                  {'R', {10, 0, 2}},
                                  {'F', {10, 0, -4}, 600},
                                  {'D', {}, 1.5},
                                  {'R', {10, 0, 2}}};
  expect_blocks(holes("CYCLE/FACE,FEDTO,4,RAPTO,2,DWELL,1.5\nGOTO/10,0,0\n"), want);
  const auto turns = holes("SPINDL/1200\nCYCLE/FACE,FEDTO,4,RAPTO,2,DWELL,REV,30\nGOTO/10,0,0\n");
  ASSERT_EQ(turns.size(), 6U);
  EXPECT_NEAR(turns[4].value, 1.5, 1e-12);
}

TEST(Cycle, DeepOfNxComesOutBehindEveryPeck) {
  expect_blocks(
      holes("CYCLE/DRILL,DEEP,RAPTO,3.,FEDTO,-12.,STEP,5.,MMPM,100.\nGOTO/10,0,0\n", Dialect::kNx),
      {{'R', {10, 0, 50}},
       {'R', {10, 0, 3}},
       {'F', {10, 0, -5}, 100},
       {'R', {10, 0, 3}},
       {'R', {10, 0, -4}},  // 1 mm above where it was
       {'F', {10, 0, -10}, 100},
       {'R', {10, 0, 3}},
       {'R', {10, 0, -9}},
       {'F', {10, 0, -12}, 100},
       {'R', {10, 0, 3}}});
}

TEST(Cycle, ChipBreakGoesBackALittle) {
  expect_blocks(holes("CYCLE/DRILL,BRKCHP,RAPTO,3.,FEDTO,-12.,STEP,5.,MMPM,100.\nGOTO/10,0,0\n",
                      Dialect::kNx),
                {{'R', {10, 0, 50}},
                 {'R', {10, 0, 3}},
                 {'F', {10, 0, -5}, 100},
                 {'R', {10, 0, -4.5}},  // half a millimetre
                 {'F', {10, 0, -10}, 100},
                 {'R', {10, 0, -9.5}},
                 {'F', {10, 0, -12}, 100},
                 {'R', {10, 0, 3}}});
}

TEST(Cycle, ChipBreakOfCreoComesOutBehindSoManyPecks) {
  expect_blocks(holes("CYCLE / BRKCHP, DEPTH, 20, STEP, 5, MMPM, 100, CLEAR, 3, BACK, 1, TIMES, 2\n"
                      "GOTO/10,0,0\n",
                      Dialect::kCreo),
                {{'R', {10, 0, 50}},
                 {'R', {10, 0, 3}},
                 {'F', {10, 0, -5}, 100},
                 {'R', {10, 0, -4}},
                 {'F', {10, 0, -10}, 100},
                 {'R', {10, 0, 3}},  // out after the second
                 {'R', {10, 0, -9}},
                 {'F', {10, 0, -15}, 100},
                 {'R', {10, 0, -14}},
                 {'F', {10, 0, -20}, 100},
                 {'R', {10, 0, 3}}});
}

TEST(Cycle, OfCreoCountsRaptoDownFromClear) {
  expect_blocks(
      holes("CYCLE / DRILL, DEPTH, 12., MMPM, 100., CLEAR, 3., RAPTO, 1., RETURN, 20.\n"
            "GOTO/10,0,0\n",
            Dialect::kCreo),
      {{'R', {10, 0, 50}}, {'R', {10, 0, 2}}, {'F', {10, 0, -12}, 100}, {'R', {10, 0, 20}}});
}

TEST(Cycle, OfCreoGoesBackToTheRetractPlaneWithReturnZero) {
  const auto blocks =
      holes("CYCLE / DRILL, DEPTH, 12., MMPM, 100., CLEAR, 3., RETURN, 0.\nGOTO/10,0,0\n",
            Dialect::kCreo);
  ASSERT_EQ(blocks.size(), 4U);
  EXPECT_NEAR(blocks[3].tip_mm[2], 50, kTight_mm);
}

TEST(Cycle, OfIsoIsReadAsPairsWithoutADialect) {
  expect_blocks(
      holes("CYCLE/DRILL,DEPTH,6,PERMIN,120,CLEAR,2\nGOTO/10,0,0\n"),
      {{'R', {10, 0, 50}}, {'R', {10, 0, 2}}, {'F', {10, 0, -6}, 120}, {'R', {10, 0, 2}}});
}

TEST(Cycle, Deep2OfSolidWorksCamHasAFirstPeckAndFurtherOnes) {
  expect_blocks(holes("TRNTYP/WORLD,0,0,0\nRAPID/\nGOTO/10,0,25\nCYCLE/INIT\n"
                      "CYCLE/DEEP2,FEDTO,9.,1STPECK,5.,SUBPECK,2.,MMPM,300.,RAPTO,3.,RTRCTO,25.\n"
                      "GOTO/10,0,0\nGOTO/40,0,0\nCYCLE/OFF\n"),
                {{'R', {10, 0, 25}},  // the point before the cycle
                 {'R', {10, 0, 3}},  {'F', {10, 0, -5}, 300}, {'R', {10, 0, 3}},
                 {'R', {10, 0, -4}}, {'F', {10, 0, -7}, 300}, {'R', {10, 0, 3}},
                 {'R', {10, 0, -6}}, {'F', {10, 0, -9}, 300}, {'R', {10, 0, 25}},
                 {'R', {40, 0, 25}}, {'R', {40, 0, 3}},       {'F', {40, 0, -5}, 300},
                 {'R', {40, 0, 3}},  {'R', {40, 0, -4}},      {'F', {40, 0, -7}, 300},
                 {'R', {40, 0, 3}},  {'R', {40, 0, -6}},      {'F', {40, 0, -9}, 300},
                 {'R', {40, 0, 25}}});
}

TEST(Cycle, OfSolidWorksCamStaysAtTheRapidLevelBehindCycleClear) {
  expect_blocks(
      holes("TRNTYP/WORLD,0,0,0\nRAPID/\nGOTO/10,0,25\nCYCLE/CLEAR\n"
            "CYCLE/DRILL,FEDTO,6.,MMPM,300.,RAPTO,3.,RTRCTO,25.,DWELL,0\nGOTO/10,0,0\n"),
      {{'R', {10, 0, 25}}, {'R', {10, 0, 3}}, {'F', {10, 0, -6}, 300}, {'R', {10, 0, 3}}});
}

TEST(Cycle, DeepOfSolidWorksCamPecksByIncr) {
  const auto blocks = holes(
      "TRNTYP/WORLD,0,0,0\nCYCLE/INIT\nCYCLE/DEEP,FEDTO,6.,INCR,3.,MMPM,300.,RAPTO,3.,RTRCTO,50.\n"
      "GOTO/10,0,0\n");
  expect_blocks(blocks, {{'R', {10, 0, 50}},
                         {'R', {10, 0, 3}},
                         {'F', {10, 0, -3}, 300},
                         {'R', {10, 0, 3}},
                         {'R', {10, 0, -2}},
                         {'F', {10, 0, -6}, 300},
                         {'R', {10, 0, 50}}});
}

TEST(Cycle, ReamAndBoreFeedOut) {
  for (const char* type : {"REAM", "BORE"}) {
    expect_blocks(holes(std::string("CYCLE/") + type +
                            ",RAPTO,3,FEDTO,-8,RTRCTO,20,MMPM,80,DWELL,1\nGOTO/10,0,0\n",
                        Dialect::kNx),
                  {{'R', {10, 0, 50}},
                   {'R', {10, 0, 3}},
                   {'F', {10, 0, -8}, 80},
                   {'D', {}, 1},
                   {'F', {10, 0, 3}, 80},
                   {'R', {10, 0, 20}}});
  }
}

TEST(Cycle, BoreWithDragStopsTheSpindleBeforeItComesOut) {
  const auto blocks = holes(
      "SPINDL/900,CCLW\nCYCLE/BORE,DRAG,RAPTO,3,FEDTO,-8,MMPM,80\nGOTO/10,0,0\n", Dialect::kNx);
  ASSERT_EQ(blocks.size(), 7U);
  EXPECT_EQ(blocks[4].action, ActionKind::kSpindleOff);
  EXPECT_EQ(blocks[5].kind, BlockKind::kRapid);
  EXPECT_EQ(blocks[6].action, ActionKind::kSpindleCounterClockwise);
  EXPECT_EQ(blocks[6].value, 900);
  EXPECT_NE(read_body("GOTO/0,0,50\nCYCLE/BORE,DRAG,RAPTO,3,FEDTO,8\nGOTO/10,0,0\n").error, "");
}

TEST(Cycle, CountersinkGoesAsDeepAsItsDiameterAsks) {
  // 8 mm wide at 90 degrees is 4 mm deep.
  const auto blocks = holes("CYCLE/CSINK,CSINK,8,90,RAPTO,2,MMPM,100\nGOTO/10,0,0\n");
  ASSERT_EQ(blocks.size(), 4U);
  EXPECT_NEAR(blocks[2].tip_mm[2], -4, kTight_mm);
  const auto by_depth = holes("CYCLE/CSINK,FEDTO,8,90,RAPTO,2,MMPM,100\nGOTO/10,0,0\n");
  EXPECT_NEAR(by_depth.at(2).tip_mm[2], -4, kTight_mm);
}

TEST(Cycle, RunsAlongTheAxisOfEachHole) {
  const double s = .6, c = .8;  // tilted about x: (0, .6, .8)
  const auto blocks = holes(
      "CYCLE/DRILL,RAPTO,3,FEDTO,-10,RTRCTO,20,MMPM,100\nGOTO/10,0,0,0,0,1\nGOTO/10,40,0,0,.6,.8\n",
      Dialect::kNx);
  expect_blocks(blocks, {{'R', {10, 0, 50}},
                         {'R', {10, 0, 3}},
                         {'F', {10, 0, -10}, 100},
                         {'R', {10, 0, 20}},
                         {'R', {10, 40 + 20 * s, 20 * c}},
                         {'R', {10, 40 + 3 * s, 3 * c}},
                         {'F', {10, 40 - 10 * s, -10 * c}, 100},
                         {'R', {10, 40 + 20 * s, 20 * c}}});
  EXPECT_NEAR(blocks[4].axis[1], .6, 1e-15);
}

TEST(Cycle, ClimbsBeforeItTravelsToAHigherHole) {
  const auto blocks =
      holes("CYCLE/DRILL,RAPTO,3,FEDTO,-10,MMPM,100\nGOTO/10,0,0\nGOTO/30,0,40\n", Dialect::kNx);
  expect_blocks(blocks, {{'R', {10, 0, 50}},
                         {'R', {10, 0, 3}},
                         {'F', {10, 0, -10}, 100},
                         {'R', {10, 0, 3}},
                         {'R', {10, 0, 43}},
                         {'R', {30, 0, 43}},
                         {'F', {30, 0, 30}, 100},
                         {'R', {30, 0, 43}}});
}

TEST(Cycle, HasAFeedOfItsOwnAndGivesTheOneBeforeBack) {
  const auto read = read_body(
      "GOTO/0,0,50\nCYCLE/DRILL,RAPTO,3,FEDTO,8,MMPM,80\nGOTO/10,0,0\nCYCLE/OFF\nGOTO/10,0,60\n");
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  EXPECT_NEAR(m.at(3).feed * 60, 80, 1e-9);
  EXPECT_NEAR(m.back().feed * 60, 600, 1e-9);
  EXPECT_EQ(read.summary.holes, 1U);
}

TEST(Cycle, InInchIsInInch) {
  const auto m = read_text(
                     "UNITS/INCHES\nFEDRAT/10\nGOTO/0,0,2\nCYCLE/DRILL,RAPTO,.1,FEDTO,.5,IPM,4\n"
                     "GOTO/1,0,0\nCYCLE/OFF\nFINI\n")
                     .motion();
  EXPECT_NEAR(m.at(2).tip_mm[2], 2.54, kTight_mm);
  EXPECT_NEAR(m.at(3).tip_mm[2], -12.7, kTight_mm);
  EXPECT_NEAR(m.at(3).feed * 60, 101.6, 1e-9);
}

TEST(Cycle, IsTakenUpAgainByCycleOn) {
  const auto read = read_body(
      "GOTO/0,0,50\nCYCLE/DRILL,RAPTO,3,FEDTO,8\nGOTO/10,0,0\nCYCLE/OFF\nGOTO/10,0,50\n"
      "CYCLE/ON\nGOTO/20,0,0\nCYCLE/OFF\n");
  EXPECT_EQ(read.summary.holes, 2U);
  EXPECT_NE(read_body("GOTO/0,0,50\nCYCLE/ON\nGOTO/1,0,0\n").error, "");
}

TEST(Cycle, OfMillStaysAtTheBottomAndEnds) {
  const auto blocks = holes("CYCLE/MILL,RAPTO,3,FEDTO,8,MMPM,80\nGOTO/10,0,0\nGOTO/20,0,-8\n");
  expect_blocks(
      blocks,
      {{'R', {10, 0, 50}}, {'R', {10, 0, 3}}, {'F', {10, 0, -8}, 80}, {'F', {20, 0, -8}, 600}});
}

TEST(Cycle, OnlyGoesToPointsUnderRapidAndSaysSo) {
  const auto read = read_body(
      "GOTO/0,0,50\nCYCLE/DRILL,RAPTO,3,FEDTO,8\nRAPID\nGOTO/10,0,20\nGOTO/20,0,0\nCYCLE/OFF\n");
  EXPECT_EQ(read.summary.holes, 1U);
  EXPECT_TRUE(read.warned_of("drills no hole"));
}

TEST(Cycle, ThatBeginsElsewhereThanItRetractsToIsFlaggedInSolidWorksCam) {
  const auto read = read_body(
      "TRNTYP/WORLD,0,0,0\nRAPID/\nGOTO/10,0,40\nCYCLE/INIT\n"
      "CYCLE/DRILL,FEDTO,6.,MMPM,300.,RAPTO,3.,RTRCTO,25.\nGOTO/10,0,0\nCYCLE/OFF\n");
  EXPECT_EQ(read.error, "");
  EXPECT_TRUE(read.warned_of("are its levels right?"));
}

struct Refused {
  const char* words;
  const char* reason;
};

class CycleRefused : public testing::TestWithParam<Refused> {};

TEST_P(CycleRefused, ByName) {
  const auto read =
      read_body("GOTO/0,0,50\nCYCLE/" + std::string(GetParam().words) + "\nGOTO/10,0,0\n");
  EXPECT_EQ(read.error_line, 4U) << GetParam().words;
  EXPECT_NE(read.error.find(GetParam().reason), std::string::npos) << read.error;
}

INSTANTIATE_TEST_SUITE_P(
    Cycles, CycleRefused,
    testing::Values(Refused{"TAP,RAPTO,3,FEDTO,8,MMPR,1.5", "is tapping"},
                    Refused{"RIGID,DEPTH,8,PITCH,1", "is tapping"},
                    Refused{"BORE,NODRAG,RAPTO,3,FEDTO,8", "stops the spindle in a certain angle"},
                    Refused{"BORE,BACK,RAPTO,3,FEDTO,8", "stops the spindle in a certain angle"},
                    Refused{"BORE,ORIENT,90,RAPTO,3,FEDTO,8", "in a certain angle"},
                    Refused{"BORE,MANUAL,RAPTO,3,FEDTO,8", "operator"},
                    Refused{"THRU,DEPTH,8,CLEAR,2", "several plates"}, Refused{"THREAD,1", "lathe"},
                    Refused{"MYOWN,1,2", "known to the control"},
                    Refused{"DRILL,FEDTO,20,RAPTO,3,MMPR", "without a feed"},
                    Refused{"DRILL,20,MMPM,100,3", "numbers by their place"},
                    Refused{"DRILL,126.,85.,1.0,MMPR", "numbers by their place"},
                    Refused{"DRILL,RAPTO,3,MMPM,100", "gives no depth"},
                    Refused{"DRILL,FEDTO,8,MMPM,100", "down to which the tool may move at rapid"},
                    Refused{"DRILL,FEDTO,8,RAPTO,-3", "inside the part"},
                    Refused{"DEEP,FEDTO,8,RAPTO,3", "gives no peck"},
                    Refused{"DEEP,FEDTO,8,RAPTO,3,STEP,0", "a peck of nothing"},
                    Refused{"DRILL,FEDTO,8,RAPTO,3,WOBBLE,2", "'WOBBLE' is not understood"},
                    Refused{"DRILL,FEDTO,8,FEDTO,9,RAPTO,3", "twice"},
                    Refused{"DRILL,FEDTO,8,RAPTO,3,IPT,.1", "per tooth"}));

TEST(Cycle, OffAloneIsHarmless) {
  for (const char* words : {"CYCLE/OFF", "CYCLE/NOMORE", "CYCLE/DRILL,OFF", "CYCLE/INIT"}) {
    const auto read = read_body("GOTO/0,0,50\n" + std::string(words) + "\nGOTO/10,0,50\n");
    EXPECT_EQ(read.error, "") << words;
    EXPECT_EQ(read.motion().size(), 2U) << words;
  }
}

TEST(Hole, MovesAreThoseOfItsCycleAlone) {
  HoleCycle cycle;
  cycle.kind = HoleKind::kDeep;
  cycle.depth = 1;
  cycle.rapid_level = 2;
  cycle.pecks = {.4};
  const auto moves = moves_of(cycle, {10, 1});
  ASSERT_EQ(moves.size(), 9U);
  EXPECT_NEAR(moves[3].level_mm, -.4 + .2, kTight_mm);  // half a peck above where it was
  EXPECT_NEAR(moves.back().level_mm, 10, kTight_mm);
}

}  // namespace
}  // namespace meridian::cl
