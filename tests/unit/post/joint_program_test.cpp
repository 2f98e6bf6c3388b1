// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/nc_program.hpp"
#include "unit/post/written.hpp"

namespace meridian {
namespace {

std::string without_comments(const std::string& text) {
  std::string out;
  for (const std::string& line : test::read_nc(text).lines) out += line + "\n";
  return out;
}

TEST(JointProgram, IsTheWholeOfASmallProgram) {
  const std::string text =
      "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/6000,RPM,CLW\nCOOLNT/FLOOD\nRAPID\n"
      "GOTO/0,0,60,0,0,1\nFEDRAT/600,MMPM\nGOTO/0,0,50\nGOTO/30,0,50\nDELAY/0.5\nOPSTOP\nSTOP\n"
      "FEDRAT/INVERS,2\nGOTO/30,10,50\nRAPID\nGOTO/30,10,80\nCOOLNT/OFF\nSPINDL/OFF\nFINI\n";
  const auto program = test::written(text, test::shipped("trunnion-ac"));
  ASSERT_TRUE(program) << program.error().message;
  // Tool 110 mm below the spindle's face at 300 mm: the tip at z is the joint Z at z - 190.
  EXPECT_EQ(without_comments(program->text),
            "G17 G21 G40 G49 G80 G90 G94\nG54\nG0 Z500.0000\nT1 M6\nS6000 M3\nM8\n"
            "G0 X0.0000 Y0.0000 C0.00000 A0.00000\nG0 Z-80.0000\nG93\nG1 Z-130.0000 F20.000\n"
            "G1 Z-140.0000 F60.000\nG1 X30.0000 F20.000\nG4 P0.500\nM1\nM0\n"
            "G1 Y10.0000 F2.000\nG0 Z-110.0000\nM9\nM5\nG94\nM5\nM9\nM30\n");
}

TEST(JointProgram, TheHeaderNamesWhatItWasMadeFrom) {
  const auto program =
      test::written(test::program_with(""), test::shipped("lai"), {}, "/tmp/a(b)\nM30.apt");
  ASSERT_TRUE(program);
  EXPECT_NE(program->text.find("(SOURCE a_b__M30.apt)"), std::string::npos) << program->text;
  EXPECT_NE(program->text.find("(MACHINE lai VERSION 1)"), std::string::npos);
  EXPECT_NE(program->text.find("(TOOL LENGTH AT THE START 110.000 MM)"), std::string::npos);
  EXPECT_NE(program->text.find("(CHORD 0.0100 MM, AXIS 0.1000 DEG)"), std::string::npos);
}

TEST(JointProgram, AJointThatTheControllerCountsAgainstIsWrittenSo) {
  // b4 of the Lai machine grows downwards, Z upwards.
  const auto program = test::written(test::program_with("GOTO/100,0,25\n"), test::shipped("lai"));
  ASSERT_TRUE(program);
  const auto moves = test::read_nc(program->text).moves;
  ASSERT_GT(moves.size(), 2U);
  EXPECT_NEAR(moves.back().at.at("Z") - moves[moves.size() - 2].at.at("Z"), 25, 1e-9);
}

TEST(JointProgram, ANewToolIsTakenClearOfThePartAndApproachedAgain) {
  const auto program =
      test::written(test::program_with("LOADTL/2\nGOTO/100,20,0\n"), test::shipped("trunnion-ac"));
  ASSERT_TRUE(program) << program.error().message;
  const std::string text = without_comments(program->text);
  // The longer tool stands 20 mm higher; Z moves last.
  EXPECT_NE(text.find("G0 Z500.0000\nT2 M6\nG0 X100.0000 Y20.0000 C0.00000 A0.00000\n"
                      "G0 Z-120.0000\nG93\nG1 Z-170.0000"),
            std::string::npos)
      << text;
}

TEST(JointProgram, ARobotStopsForItsOperatorBeforeItMoves) {
  MachineModel robot = test::shipped("robot-6r");
  config::place_workpiece(robot, config::parse_frame("850,0,250"));
  const auto program = test::written(test::program_with(""), robot);
  ASSERT_TRUE(program) << program.error().message;
  const auto lines = test::read_nc(program->text).lines;
  EXPECT_EQ(lines[2], "M0");
  EXPECT_EQ(lines[3].substr(0, 5), "G0 J1");
}

TEST(JointProgram, RapidsBecomeCutsWhereTheControllersRapidsAreNotStraight) {
  post::PostOptions options;
  options.rapid_feed_mm_per_s = 100;
  const auto program = test::written(test::program_with("RAPID\nGOTO/50,0,0\n"),
                                     test::shipped("trunnion-ac"), options);
  ASSERT_TRUE(program);
  // 50 mm at 100 mm/s.
  EXPECT_NE(program->text.find("G1 X50.0000 F120.000"), std::string::npos) << program->text;
}

TEST(JointProgram, NoBlockIsFasterThanAJointMayBe) {
  // 1 mm of way while the table turns by a quarter: C at 60 deg/s takes 1.5 s.
  const auto program = test::written(
      "UNITS/MM\nMULTAX/ON\nFEDRAT/6000,MMPM\nGOTO/0,0,0,0.5,0,0.8660254\n"
      "GOTO/1,0,0,0,0.5,0.8660254\nFINI\n",
      test::shipped("trunnion-ac"));
  ASSERT_TRUE(program) << program.error().message;
  double seconds = 0;
  bool is_first = true;
  for (const test::NcMove& move : test::read_nc(program->text).moves) {
    if (move.is_rapid) continue;
    if (!is_first) seconds += 60 / move.feed;
    is_first = false;
  }
  EXPECT_GT(seconds, 1.5);
}

}  // namespace
}  // namespace meridian
