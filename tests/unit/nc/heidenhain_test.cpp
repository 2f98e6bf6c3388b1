// SPDX-License-Identifier: Apache-2.0
// Klartext: its statements, tool-centre control, and what is refused.
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "meridian/units.hpp"
#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

TEST(Klartext, TakesTheAxisOfLn) {
  const ReadText read = read_klartext(
      "2 FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR\n"
      "3 LN X+0 Y+0 Z+10 TX+0 TY+0 TZ+1 FMAX\n4 LN X+1,5 Y+0 Z+10 NX+1 NY+0 NZ+0 TX+0 TY-6 TZ+8 "
      "F600\n"
      "5 L X+2 FMAX\n6 L X+3\n7 FUNCTION RESET TCPM\n8 M30\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 4U);
  EXPECT_EQ(motion[0].kind, BlockKind::kRapid);
  EXPECT_EQ(tip(motion[1]), Vector3(1.5, 0, 10));
  EXPECT_LT((axis(motion[1]) - Vector3(0, -0.6, 0.8)).norm(), kTiny);
  EXPECT_EQ(motion[2].kind, BlockKind::kRapid);
  EXPECT_EQ(motion[3].kind, BlockKind::kCut) << "FMAX holds for its block alone";
  EXPECT_DOUBLE_EQ(motion[3].feed, 10);
  EXPECT_EQ(read.summary.program, "PART");
  EXPECT_TRUE(read.warnings.empty());
}

TEST(Klartext, TurnsByRotaryWordsUnderM128) {
  const ReadText read = read_klartext(
      "2 L A+30 C+0 R0 FMAX\n3 M128\n4 L X+0 Y+0 Z+50 FMAX\n5 L X+90 C+90 F600\n6 M129\n",
      klartext(on(shipped("trunnion-ac"))));
  ASSERT_EQ(read.error, "");
  EXPECT_GT(read.motion().size(), 5U) << "the joints turn evenly, so the block is cut";
}

TEST(Klartext, TurnsArcs) {
  const ReadText read = read_klartext(
      "2 L X+10 Y+0 Z+0 R0 FMAX\n3 CC X+0 Y+0\n4 C X+0 Y+10 DR+ F600\n5 CR X-10 Y+0 R+10 DR+\n"
      "6 C X-10 Y+0 DR-\n7 L IX+5 IZ-1\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 5U);
  EXPECT_NEAR(motion[1].sweep_rad, std::numbers::pi / 2, kTiny);
  EXPECT_NEAR(motion[2].sweep_rad, std::numbers::pi / 2, kTiny);
  EXPECT_NEAR(motion[3].sweep_rad, 2 * std::numbers::pi, kTiny);
  EXPECT_LT((to_vector(motion[3].normal) + Vector3::UnitZ()).norm(), kTiny);
  EXPECT_EQ(tip(motion[4]), Vector3(-5, 0, -1));
}

TEST(Klartext, TurnsArcsByTheirAngle) {
  const ReadText read = read_klartext(
      "2 L X+10 Y+0 Z+0 R0 FMAX\n3 CC X+0 Y+0\n4 CP IPA+90 DR+ F600\n5 CP PA+180 DR+\n"
      "6 CP IPA-810 IZ-9 DR-\n7 CP IPA+720 IZ+2 DR+\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 8U) << "a helix of two turns and a quarter has three blocks";
  EXPECT_LT((tip(motion[1]) - Vector3(0, 10, 0)).norm(), kTiny);
  EXPECT_LT((tip(motion[2]) - Vector3(-10, 0, 0)).norm(), kTiny);
  double sweep = 0;
  for (std::size_t n = 3; n < 6; ++n) {
    sweep += motion[n].sweep_rad;
    EXPECT_LT((to_vector(motion[n].normal) + Vector3::UnitZ()).norm(), kTiny);
  }
  EXPECT_NEAR(sweep, 4.5 * std::numbers::pi, kTiny);
  EXPECT_LT((tip(motion[3]) - Vector3(-10, 0, -4)).norm(), kTiny) << "it falls evenly";
  EXPECT_LT((tip(motion[5]) - Vector3(0, 10, -9)).norm(), kTiny);
  EXPECT_LT((tip(motion[6]) - Vector3(0, 10, -8)).norm(), kTiny);
  EXPECT_LT((tip(motion[7]) - Vector3(0, 10, -7)).norm(), kTiny);
  for (const char* const arc : {"CP IPA-90 DR+", "CP IPA+0 DR+", "CP DR+", "CP X+1 IPA+90 DR+"}) {
    EXPECT_NE(
        read_klartext("2 L X+9 Y+0 Z+0 FMAX\n3 CC X+0 Y+0\n4 " + std::string(arc) + "\n").error, "")
        << arc;
  }
}

TEST(Klartext, LeavesThePartAlongTheToolAxis) {
  const std::string head =
      "1 PLANE SPATIAL SPA+0 SPB+45 SPC+0 TURN FMAX\n2 L X+0 Y+0 Z+5 R0 FMAX\n3 L Z+0 F600\n";
  const ReadText read = read_klartext(head + "4 L M140 MB50\n5 L X+1\n6 L M140 MB2 F300\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 5U);
  EXPECT_EQ(motion[2].kind, BlockKind::kRapid);
  EXPECT_LT((tip(motion[2]) - 50 * Vector3(kHalfRoot, 0, kHalfRoot)).norm(), kTiny);
  EXPECT_LT((tip(motion[3]) - tip(motion[2]) - Vector3(kHalfRoot, 0, -kHalfRoot)).norm(), kTiny)
      << "Z of the plane is where it went";
  EXPECT_EQ(motion[4].kind, BlockKind::kCut);
  EXPECT_DOUBLE_EQ(motion[4].feed, 5);
  EXPECT_EQ(read_klartext("1 L M140 MB MAX\n2 L X+0 Y+0 Z+0 FMAX\n").error, "")
      << "before the first motion nothing has to be known";
}

TEST(Klartext, LeavesThePartToTheEndOfTravel) {
  const MachineModel machine = shipped("trunnion-ac");
  const std::string program = "1 TOOL CALL 1 Z\n2 L X+0 Y+0 Z+5 R0 FMAX\n3 L ";
  const ReadText read = read_klartext(program + "M140 MB MAX\n", klartext(on(machine)));
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read_klartext(program + "R F M140 MBMAX M9\n", klartext(on(machine))).motion().size(),
            2U);
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 2U);
  EXPECT_EQ(axis(motion[1]), Vector3::UnitZ());
  EXPECT_GT(tip(motion[1])[2], 5);
  const auto solved =
      solve(machine, machine.tool_length_mm, Pose<double>{tip(motion[1]), axis(motion[1])}, 0, {});
  double nearest = 1e9;
  for (int i = 0; i < 3; ++i) {
    const JointLimits& limits = machine.joints[i].limits;
    nearest = std::min({nearest, std::abs(solved.q[i] - limits.travel_max),
                        std::abs(solved.q[i] - limits.travel_min)});
  }
  EXPECT_LT(nearest, 1e-6);
}

TEST(Klartext, LeavesTheFeedOfM128ToM128) {
  const ReadText read = read_klartext(
      "2 L X+0 Y+0 Z+0 F600 M128 F5000\n3 LN X+1 Y+0 Z+0 TX+0 TY+0 TZ+1\n4 M128 F4000\n5 L X+2\n");
  ASSERT_EQ(read.error, "");
  for (const ClBlock& block : read.motion()) EXPECT_DOUBLE_EQ(block.feed, 10);
}

TEST(Klartext, CountsRotaryAxesWithinATurnBehindM94) {
  const std::string head =
      "2 L A+30 C+350 R0 FMAX\n3 M128\n4 L X+0 Y+0 Z+50 FMAX\n5 L C+370 F600\n";
  const auto options = klartext(on(shipped("trunnion-ac")));
  const std::size_t before = read_klartext(head, options).motion().size();
  const ReadText without = read_klartext(head + "6 L C+10\n", options);
  EXPECT_GT(without.motion().size(), before + 4) << "a whole turn back";
  const ReadText with = read_klartext(head + "6 M94\n7 L C+10\n", options);
  EXPECT_EQ(with.motion().size(), before + 1);
}

TEST(Klartext, SkipsWhatEndsFramesThatNobodySet) {
  const ReadText read = read_klartext(
      "2 CYCL DEF 10.0 ROTATION\n3 CYCL DEF 10.1 ROT+0\n4 CYCL DEF 8.0 MIRROR IMAGE\n5 CYCL DEF "
      "8.1\n"
      "6 CYCL DEF 11.0 SCALING\n7 CYCL DEF 11.1 SCL 1\n8 CYCL DEF 19.0 WORKING PLANE\n"
      "9 CYCL DEF 19.1 A+0 B+0 C+0\n10 CYCL DEF 19.0 WORKING PLANE\n11 CYCL DEF 19.1\n"
      "12 TRANS DATUM AXIS X+10 Y+5\n13 FUNCTION MODE MILL\n14 L X+0 Y+0 Z+0 FMAX M120 LA5\n"
      "15 TRANS DATUM RESET\n16 L X+0 F600\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(tip(read.motion()[0]), Vector3(10, 5, 0));
  EXPECT_EQ(tip(read.motion()[1]), Vector3(0, 5, 0)) << "Y stays where it stands";
}

TEST(Klartext, Acts) {
  const ReadText read = read_klartext(
      "2 TOOL CALL 5 Z S6000 F200\n3 L X+0 Y+0 Z+0 R0 FMAX M13\n4 TOOL CALL S300\n"
      "5 CYCL DEF 9.0 DWELL TIME\n6 CYCL DEF 9.1 DWELL 0.500\n7 STOP\n8 M5\n");
  ASSERT_EQ(read.error, "");
  ASSERT_EQ(read.blocks.size(), 9U);
  EXPECT_EQ(read.blocks[0].value, 5);
  EXPECT_EQ(read.blocks[1].value, 6000);
  EXPECT_EQ(read.blocks[2].action, ActionKind::kCoolantFlood);
  EXPECT_EQ(read.blocks[4].value, 300);
  EXPECT_DOUBLE_EQ(read.blocks[5].value, 0.5);
  EXPECT_EQ(read.blocks[6].kind, BlockKind::kStop);
  EXPECT_EQ(read.blocks[7].action, ActionKind::kSpindleOff);
}

TEST(Klartext, TurnsTheToolByAnglesInSpace) {
  const std::string head =
      "1 FUNCTION TCPM F TCP AXIS SPAT PATHCTRL VECTOR\n2 L X+0 Y+0 Z+9 A+0 B+0 C+0 FMAX\n";
  const ReadText read = read_klartext(
      head + "3 L X+1 B+30 F600\n4 L X+2 C+90\n5 L X+3\n6 L X+4 A-30 B+0 C+180\n", klartext());
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 5U);
  const double c = std::cos(units::rad_from_deg(30));
  EXPECT_LT((axis(motion[1]) - Vector3(0.5, 0, c)).norm(), kTiny);
  EXPECT_LT((axis(motion[2]) - Vector3(0, 0.5, c)).norm(), kTiny) << "B, and then C about z";
  EXPECT_EQ(axis(motion[3]), axis(motion[2]));
  EXPECT_LT((axis(motion[4]) - Vector3(0, -0.5, c)).norm(), kTiny) << "A, and then C about z";
  EXPECT_TRUE(read.warnings.empty());
  for (const char* const line : {"3 L X+1 IB+30 F600\n", "3 LN X+1 A+5 TX+0 TY+0 TZ+1 F600\n"}) {
    EXPECT_NE(read_klartext(head + line).error, "") << line;
  }
  EXPECT_NE(read_klartext("1 FUNCTION TCPM F TCP AXIS SPAT PATHCTRL VECTOR\n"
                          "2 L X+0 Y+0 Z+9 B+5 FMAX\n")
                .error.find("needs all of A, B and C"),
            std::string::npos);
}

TEST(Klartext, EndsAnglesInSpaceWithTcpmAndM128) {
  const std::string space =
      "1 FUNCTION TCPM F TCP AXIS SPAT PATHCTRL AXIS\n2 L X+0 Y+0 Z+9 A+0 B+0 C+0 FMAX\n"
      "3 FUNCTION RESET TCPM\n";
  const auto options = klartext(on(shipped("trunnion-ac")));
  const ReadText joints =
      read_klartext(space + "4 M128\n5 L X+1 Y+0 Z+9 A+30 C+0 FMAX\n6 L X+2 C+90 F600\n", options);
  ASSERT_EQ(joints.error, "");
  EXPECT_GT(joints.motion().size(), 3U) << "positions of the joints, which turn evenly";
  EXPECT_NE(read_klartext(space + "4 L X+0 Y+0 Z+9 B+30 FMAX\n", options).error, "")
      << "the machine has no B";
}

TEST(Klartext, LeavesOutWordsThatWereNotAnswered) {
  const ReadText read = read_klartext(
      "2 L X+0 Y+0 R FMAX M\n3 L Z+5 R F600 M8 M\n4 L X+10 R F M\n5 CC X+10 Y+10\n"
      "6 C X+20 Y+10 DR+ R F M\n7 L R F M\n8 M\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 3U);
  EXPECT_EQ(motion[0].kind, BlockKind::kCut);
  EXPECT_DOUBLE_EQ(motion[2].feed, 10);
  EXPECT_NE(read_klartext("2 L X+0 Y+0 Z+0 FMAX\n3 L X F100\n").error.find("word X without"),
            std::string::npos);
  EXPECT_NE(read_klartext("2 L X+0 Y+0 Z+0 FMAX\n3 CR X+1 Y+1 R DR+ F9\n").error, "");
}

TEST(Klartext, ReadsDeltasOfAToolInBothForms) {
  for (const char* const delta : {"DR2:+0.1", "DR2+0.1", "DR+0.1", "DL+0.1"}) {
    const ReadText read = read_klartext("2 TOOL CALL 5 Z S6000 " + std::string(delta) +
                                        "\n3 L X+0 Y+0 Z+0 R0 FMAX M3\n");
    EXPECT_EQ(read.error, "") << delta;
    EXPECT_TRUE(read.warned_of("TOOL CALL are not applied")) << delta;
  }
}

TEST(Klartext, RefusesByName) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"L X+Q5", "a Q parameter"},
      {"L X+5 FU0.2", "FU: this word"},
      {"L X+5 FZ0.1", "FZ: this word"},
      {"CALL LBL 1", "CALL LBL: this word"},
      {"CALL PGM A", "CALL PGM: this word"},
      {"TCH PROBE 0.0", "TCH PROBE: this word"},
      {"PLANE AXIAL B-45 TURN", "PLANE AXIAL: a plane"},
      {"PLANE SPATIAL SPA+Q1 SPB+0 SPC+0 TURN", "'SPA+Q1' has no number"},
      {"L C+Q122 FMAX", "a Q parameter"},
      {"CYCL DEF 207 RIGID TAPPING ~", "CYCL DEF 207: a cycle"},
      {"CYCL DEF 7.1 #5", "CYCL DEF 7 by '#5'"},
      {"RND R5", "RND: this word"},
      {"APPR LT X+0", "APPR: this word"},
      {"L X+5 RL F100", "radius compensation (RL, RR)"},
      {"TOOL CALL Q5 Z", "TOOL CALL by a parameter"},
      {"C X+1 Y+1 DR+", "an arc (C) before any CC"},
      {"CR X+1 Y+1 R+5", "an arc without DR+ or DR-"},
      {"LN X+1 TX+0 TY+0 TZ+1 F5", "TX, TY, TZ without tool-centre control"},
      {"FUNCTION TCPM F TCP AXIS POS REFPNT CENTER-CENTER", "the ball's centre"},
      {"L X+1 F5 M140 MB5", "M140 beside coordinates"},
      {"L M140", "M140 needs MB"},
      {"L M140 MB MAX", "--machine FILE"},
      {"L M140 MB-5", "M140 into the part"},
      {"L X+1 M130", "M130 is not run here"},
      {"L M118 X1 Y1 Z1", "M118 is not run here"},
      {"M103 F20", "M103 is not run here"},
      {"M144", "M144 is not run here"},
      {"CYCL DEF 19.1 A+0 B+45 C+0", "CYCL DEF 19.1 B+45: whether its angles"},
      {"CYCL DEF 10.1 ROT+30", "CYCL DEF 10.1 ROT+30: mirroring"},
      {"CYCL DEF 11.1 SCL 0.99", "CYCL DEF 11.1 SCL: mirroring"},
      {"CYCL DEF 8.1 X", "CYCL DEF 8.1 X: mirroring"},
      {"TRANS DATUM TABLE", "TRANS DATUM TABLE, which only the control knows"},
      {"CP IPA+90 DR+", "an arc (CP) before any CC"},
      {"L X+1 X+2", "word X twice"}};
  for (const auto& [line, says] : cases) {
    const ReadText read = read_klartext("2 L X+0 Y+0 Z+0 R0 FMAX\n3 " + std::string(line) + "\n");
    EXPECT_EQ(read.error_line, 4U) << line << ": " << read.error;
    EXPECT_NE(read.error.find(says), std::string::npos) << line << ": " << read.error;
  }
  const ReadText inch =
      cl::read_text("0 BEGIN PGM A INCH\n1 L X+0 Y+0 Z+0 FMAX\n2 M30\n", klartext());
  EXPECT_NE(inch.error.find("a program in inch"), std::string::npos);
}

TEST(Klartext, DwellsForSecondsByFunctionAndByCycle) {
  const std::string moves = "1 L X+0 Y+0 Z+5 R0 FMAX\n";
  const ReadText read = read_klartext(
      moves +
      "1 Q1 = 0,25\n2 FUNCTION DWELL TIME2.5\n3 FUNCTION DWELL TIME 1,5\n"
      "4 FUNCTION DWELL TIME+Q1\n5 CYCL DEF 9.0 DWELL TIME\n6 CYCL DEF 9.1 DWELL 0,5\n");
  ASSERT_EQ(read.error, "");
  EXPECT_DOUBLE_EQ(read.summary.dwell_time_s, 4.75);
  for (const auto& [line, says] : std::vector<std::pair<const char*, const char*>>{
           {"TIME", "without a number of seconds"},
           {"TIME+Q2", "without a number of seconds"},
           {"TIME-1", "dwell of -1 s"},
           {"REV5", "FUNCTION DWELL REV5 is not run here"}}) {
    const ReadText refused = read_klartext(moves + "2 FUNCTION DWELL " + std::string(line) + "\n");
    EXPECT_NE(refused.error.find(says), std::string::npos) << line << ": " << refused.error;
  }
}

TEST(Klartext, PassesOverCodesOfCornersThatOnlyCompensationHas) {
  const ReadText read = read_klartext("1 L X+0 Y+0 Z+0 FMAX\n2 L X+1 F9 M97\n3 L X+2 M98\n");
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.motion().size(), 3U);
}

TEST(Klartext, NamesWhatIsAnotherLanguageOrUnit) {
  for (const char* line : {"%PART G71 *", "N10 G00 X+0 *"}) {
    EXPECT_NE(read_klartext(std::string(line) + "\n").error.find("a line of DIN/ISO"),
              std::string::npos);
  }
  const std::string inch = cl::read_text(
                               "0 BEGIN PGM P INCH\n1 L X+0 Y+0 Z+0 FMAX\n"
                               "2 L X+1 F9\n3 END PGM P INCH\n",
                               klartext())
                               .error;
  EXPECT_NE(inch.find("a program in inch"), std::string::npos) << inch;
  EXPECT_EQ(inch.find("NO UNIT"), std::string::npos) << inch;
}

TEST(Klartext, KnowsTheFeedsOfOlderControlsWithABlank) {
  const ReadText read = read_klartext(
      "1 TOOL CALL 1 Z S100 F300\n2 L X+0 Y+0 Z+0 R0 F MAX M3\n3 L X+9 F AUTO\n4 L X+8 F600\n5 L "
      "X+9 FAUTO\n6 L Z+9 F MAX\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 5U);
  EXPECT_EQ(motion[0].kind, BlockKind::kRapid);
  EXPECT_DOUBLE_EQ(motion[1].feed, 5);
  EXPECT_DOUBLE_EQ(motion[2].feed, 10);
  EXPECT_DOUBLE_EQ(motion[3].feed, 5);
  EXPECT_EQ(motion[4].kind, BlockKind::kRapid);
  EXPECT_NE(read_klartext("1 L X+0 Y+0 Z+0 FMAX\n2 L X+1 FAUTO\n").error, "");
  const ReadText called = read_klartext(
      "1 L X+0 Y+0 Z+0 FMAX\n2 L X+1 F500\n3 TOOL CALL 1 Z S100 F300\n4 L X+2\n5 L X+3 F200\n"
      "6 TOOL CALL S200 F100\n7 L X+4\n");
  ASSERT_EQ(called.error, "");
  for (const auto& [n, feed] : {std::pair{1, 500.0}, {2, 300.0}, {3, 200.0}, {4, 100.0}}) {
    EXPECT_NEAR(60 * called.motion()[static_cast<std::size_t>(n)].feed, feed, 1e-9) << n;
  }
}

TEST(Klartext, SkipsLabelsAndTakesBlockDeleteBeforeTheNumber) {
  const ReadText read =
      read_klartext("2 LBL 1\n3 L X+0 Y+0 Z+0 R0 FMAX\n/4 L X+9 FMAX\n5 LBL 0\n/6 M30\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.motion().size(), 2U);
  EXPECT_TRUE(read.warned_of("blocks after / are run"));
}

TEST(Klartext, SaysOfACycleOfTheControlNoMoreThanItsName) {
  const std::string text =
      "0 BEGIN PGM A MM\n1 L X+0 Y+0 Z+9 R0 FMAX\n2 CYCL DEF 207 RIGID TAPPING ~\n   Q200=2 "
      ";SET-UP "
      "~\n   Q201=-9 ;DEPTH\n3 L X+1 FMAX M99\n4 END PGM A MM\n";
  cl::ClReader reader(std::string_view(text), "part.h", klartext());
  int refusals = 0;
  for (auto block = reader.next(); !block || *block; block = reader.next()) {
    if (block) continue;
    ++refusals;
    ASSERT_TRUE(reader.go_on());
  }
  EXPECT_EQ(refusals, 1);
}

TEST(Klartext, WarnsOfVectorsWhoseWayIsTheJoints) {
  EXPECT_TRUE(read_klartext("2 M128\n3 LN X+0 Y+0 Z+9 TX+0 TY+0 TZ+1 FMAX\n")
                  .warned_of("without PATHCTRL VECTOR"));
}

TEST(Klartext, IsKnownByItsFirstLine) {
  ClReaderOptions options = without_machine();
  options.dialect.reset();
  const ReadText read =
      cl::read_text("0 BEGIN PGM A MM\n1 L X+0 Y+0 Z+0 R0 FMAX\n2 END PGM A MM\n", options);
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.summary.dialect_reason, "BEGIN PGM");
}

}  // namespace
}  // namespace meridian::nc
