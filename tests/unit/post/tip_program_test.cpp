// SPDX-License-Identifier: Apache-2.0
// Tool-centre words: the whole of a small program in each dialect.
#include <gtest/gtest.h>

#include "service/programs/post/tip_frame.hpp"
#include "support/nc_program.hpp"
#include "support/text_file.hpp"
#include "unit/post/written.hpp"

namespace meridian {
namespace {

constexpr const char* kProgram =
    "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/6000,RPM,CLW\nCOOLNT/FLOOD\nRAPID\n"
    "GOTO/10,20,60,0,0,1\nFEDRAT/600,MMPM\nGOTO/10,20,50\nGOTO/30,20,50,0,-0.6,0.8\nDELAY/0.5\n"
    "OPSTOP\nRAPID\nGOTO/30,20,80,0,-0.6,0.8\nFINI\n";

/// Lines of the program without comments and, in Klartext, without block numbers.
std::string lines_of(const std::string& text) {
  std::string out;
  for (std::string line : test::read_nc(text).lines) {
    if (line[0] >= '0' && line[0] <= '9') {
      if (line.find(' ') == std::string::npos) continue;  // the number of a comment
      line.erase(0, line.find(' ') + 1);
    }
    out.append(line).append("\n");
  }
  return out;
}

std::string written_in(post::Dialect dialect, bool has_vectors = false) {
  post::PostOptions options;
  options.dialect = dialect;
  options.has_vectors = has_vectors;
  options.axis_rad = 1;  // one block a turn: the words are looked at, not the path
  MachineModel model = test::shipped("head-table-bc");
  config::place_workpiece(model, config::parse_frame("5,0,-30"));
  const auto program = test::written(kProgram, model, options);
  EXPECT_TRUE(program) << program.error().message;
  return program ? lines_of(program->text) : "";
}

TEST(TipProgram, FanucWithVectors) {
  EXPECT_EQ(written_in(post::Dialect::kFanuc, true),
            "G17 G21 G40 G49 G80 G90 G94\nG54\nG91 G28 Z0.\nG90\nT1 M6\nS6000 M3\nM8\n"
            "G0 C0.00000 B0.00000\nG0 X10.0000 Y20.0000\nG43.5 H1\n"
            "G0 X10.0000 Y20.0000 Z110.0000 I0.0000000 J0.0000000 K1.0000000\n"
            "G1 X10.0000 Y20.0000 Z60.0000 I0.0000000 J0.0000000 K1.0000000 F1000.000\n"
            "G1 X10.0000 Y20.0000 Z50.0000 I0.0000000 J0.0000000 K1.0000000 F600.000\n"
            "G1 X30.0000 Y20.0000 Z50.0000 I0.0000000 J-0.6000000 K0.8000000\n"
            "G4 X0.500\nM1\n"
            "G0 X30.0000 Y20.0000 Z80.0000 I0.0000000 J-0.6000000 K0.8000000\n"
            "G49\nM5\nM9\nM30\n");
}

TEST(TipProgram, Siemens) {
  EXPECT_EQ(written_in(post::Dialect::kSiemens),
            "TRAFOOF\nG17 G710 G40 G90 G94\nG54\nSUPA G0 Z0 D0\nT1\nM6\nS6000 M3\nM8\n"
            "G0 C0.00000 B0.00000\nG0 X10.0000 Y20.0000\nD1\nTRAORI\nG54\nORIWKS ORIVECT\n"
            "G0 X10.0000 Y20.0000 Z110.0000 A3=0.0000000 B3=0.0000000 C3=1.0000000\n"
            "G1 Z60.0000 F1000.000\nG1 Z50.0000 F600.000\n"
            "G1 X30.0000 A3=0.0000000 B3=-0.6000000 C3=0.8000000\nG4 F0.500\nM1\nG0 Z80.0000\n"
            "TRAFOOF\nM5\nM9\nM30\n");
}

TEST(TipProgram, Heidenhain) {
  EXPECT_EQ(
      written_in(post::Dialect::kHeidenhain),
      "BEGIN PGM PART MM\nFUNCTION RESET TCPM\nL Z+0 R0 FMAX M91\nTOOL CALL 1 Z\n"
      "TOOL CALL S6000\nM3\nM8\nL C+0.00000 B+0.00000 R0 FMAX\nL X+10.0000 Y+20.0000 R0 FMAX\n"
      "FUNCTION TCPM F TCP AXIS POS PATHCTRL VECTOR\n"
      "LN X+10.0000 Y+20.0000 Z+110.0000 TX+0.0000000 TY+0.0000000 TZ+1.0000000 FMAX\n"
      "LN X+10.0000 Y+20.0000 Z+60.0000 TX+0.0000000 TY+0.0000000 TZ+1.0000000 F1000.000\n"
      "LN X+10.0000 Y+20.0000 Z+50.0000 TX+0.0000000 TY+0.0000000 TZ+1.0000000 F600.000\n"
      "LN X+30.0000 Y+20.0000 Z+50.0000 TX+0.0000000 TY-0.6000000 TZ+0.8000000\n"
      "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 0.500\nM1\n"
      "LN X+30.0000 Y+20.0000 Z+80.0000 TX+0.0000000 TY-0.6000000 TZ+0.8000000 FMAX\n"
      "FUNCTION RESET TCPM\nM5\nM9\nM30\nEND PGM PART MM\n");
}

TEST(TipProgram, FanucWithRotaryWordsTurnsAtRestOnThePole) {
  const std::string text = written_in(post::Dialect::kFanuc);
  // The table turns by a quarter with the tip at rest, then the head tilts on the way.
  EXPECT_NE(text.find("G43.4 H1\nG0 X10.0000 Y20.0000 Z110.0000\nG1 Z60.0000 F1000.000\n"
                      "G1 Z50.0000 F600.000\nG1 C-22.50000\nG1 C-45.00000\nG1 C-67.50000\n"
                      "G1 C-90.00000\nG1 X20.0000 B-18.43495\nG1 X30.0000 B-36.86990\n"),
            std::string::npos)
      << text;
}

TEST(TipProgram, HeidenhainCountsItsBlocks) {
  post::PostOptions options;
  options.dialect = post::Dialect::kHeidenhain;
  const auto program = test::written(kProgram, test::shipped("fork-ca"), options);
  ASSERT_TRUE(program);
  std::istringstream lines(program->text);
  int number = 0;
  for (std::string line; std::getline(lines, line); ++number) {
    EXPECT_EQ(std::atoi(line.c_str()), number);
  }
  EXPECT_GT(number, 10);
}

TEST(TipProgram, TheNumberOfALengthOffsetIsNotGuessed) {
  post::PostOptions options;
  options.dialect = post::Dialect::kFanuc;
  const auto program = test::written(test::program_with(""), test::shipped("fork-ca"), options);
  ASSERT_FALSE(program);
  EXPECT_NE(program.error().message.find("--offset-number"), std::string::npos);
}

TEST(TipProgram, MachinesWhoseWordsDoNotLieAlongTheAxesAreRefused) {
  post::PostOptions options;
  options.dialect = post::Dialect::kSiemens;
  const auto robot = test::written(test::program_with(""), test::shipped("robot-5r"), options);
  ASSERT_FALSE(robot);
  EXPECT_NE(robot.error().message.find("no linear joint is called X"), std::string::npos);
  MachineModel lai = test::shipped("lai");
  lai.joints[2].nc_word.erase(0, 1);  // b4 grows downwards: Z against it is the word's sign
  const auto upside_down = test::written(test::program_with(""), lai, options);
  ASSERT_FALSE(upside_down);
  EXPECT_NE(upside_down.error().message.find("word Z does not move the tool along +Z"),
            std::string::npos)
      << upside_down.error().message;
}

/// trunnion-ac, but its spindle lies along Y.
MachineModel horizontal() {
  std::string text = test::read_text(MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml");
  const std::string upright = "tool_axis = [0, 0, 1]";
  text.replace(text.find(upright), upright.size(), "tool_axis = [0, 1, 0]");
  return config::load_machine(test::TextFile(text).path());
}

TEST(TipProgram, ASpindleThatDoesNotStandAlongZIsReported) {
  EXPECT_TRUE(post::is_spindle_along_z(test::shipped("trunnion-ac")));
  EXPECT_TRUE(post::is_spindle_along_z(test::shipped("nutating-head")));
  MachineModel model = horizontal();
  EXPECT_FALSE(post::is_spindle_along_z(model));
  EXPECT_TRUE(post::find_program_zero(model, *post::AxisWords::of(model)));
  model.joints[1].nc_word = "Z";
  model.joints[2].nc_word = "Y";
  const auto swapped = post::find_program_zero(model, *post::AxisWords::of(model));
  ASSERT_FALSE(swapped);
  EXPECT_NE(swapped.error().message.find("the spindle does not stand along its +Z"),
            std::string::npos)
      << swapped.error().message;
}

TEST(TipProgram, WordsOfATurnedPartStayParallelToTheMachine) {
  post::PostOptions options;
  options.dialect = post::Dialect::kHeidenhain;
  MachineModel model = test::shipped("fork-ca");
  config::place_workpiece(model, config::parse_frame("0,0,0,0,0,90"));
  const auto program = test::written(kProgram, model, options);
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_NE(program->text.find("LN X-20.0000 Y+30.0000 Z+50.0000 TX+0.6000000"), std::string::npos)
      << program->text;
}

}  // namespace
}  // namespace meridian
