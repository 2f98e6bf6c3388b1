// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <sstream>

#include "service/programs/proof/joint_program.hpp"
#include "unit/post/written.hpp"

namespace meridian {
namespace {

using Kind = proof::ProgramStep::Kind;

const std::string kHead = "%\n(A COMMENT)\nG17 G21 G40 G49 G80 G90 G94\nG54\n";

auto read(const std::string& text) {
  std::istringstream in(text);
  return proof::read_joint_program(in, test::shipped("trunnion-ac"));
}

std::string error(const std::string& body) {
  const auto steps = read(kHead + body);
  return steps ? "" : std::to_string(steps.error().line) + ": " + steps.error().message;
}

TEST(JointProgramReader, WordsAreModalAndUnitsAreMillimetreAndDegree) {
  const auto steps = read(kHead + "T1 M6\nG0 X1 Y2 Z3 A0 C90\nG93\nG1 X5.5 F20.\nM30\n%\n");
  ASSERT_TRUE(steps) << steps.error().message;
  ASSERT_EQ(steps->size(), 4U);
  EXPECT_EQ((*steps)[0].kind, Kind::kTool);
  EXPECT_EQ((*steps)[0].tool, 1);
  EXPECT_FALSE((*steps)[0].is_placed);
  EXPECT_EQ((*steps)[1].kind, Kind::kRapid);
  EXPECT_TRUE((*steps)[1].is_placed);
  EXPECT_EQ((*steps)[2].kind, Kind::kCut);
  EXPECT_EQ((*steps)[2].line, 8U);
  const MachineModel model = test::shipped("trunnion-ac");
  double sum = 0;  // X 5.5, Y 2, Z 3 and a quarter turn, in whichever order the joints stand
  for (int i = 0; i < model.joint_count; ++i) sum += (*steps)[2].drives[i];
  EXPECT_NEAR(sum, 5.5 + 2 + 3 + 1.5707963267948966, 1e-12);
}

TEST(JointProgramReader, WhatItDoesNotKnowIsRefusedWithItsLine) {
  EXPECT_EQ(error("G0 B5\nM30\n"), "5: machine trunnion-ac has no axis B");
  EXPECT_EQ(error("G0 X1 X2\nM30\n"), "5: X stands twice in the line");
  EXPECT_EQ(error("G2 X1 Y1\nM30\n"), "5: G2 is no word of a joint program");
  EXPECT_EQ(error("G93\nG1 X1\nM30\n"), "6: a cut in inverse time (G93) without F");
  EXPECT_EQ(error("G1 X1\nM30\n"), "5: a cut without a feed");
  EXPECT_EQ(error("X1\nM30\n"), "5: motion before G0 or G1 is known");
  EXPECT_EQ(error("G91\nG0 X1\nM30\n"), "6: motion before G21 and G90 are known");
  EXPECT_EQ(error("G0 X1,5\nM30\n"), "5: no row of words: G0 X1,5");
  EXPECT_EQ(error("#1=5\nM30\n"), "5: no row of words: #1=5");
  EXPECT_EQ(error("(open\nM30\n"), "5: a bracket is not closed");
  EXPECT_EQ(error("G0 X1\n"), "5: the program has no end (M2 or M30)");
  EXPECT_EQ(error("M30\nG0 X1\n"), "6: the program goes on after its end");
  EXPECT_EQ(error("G28 Z0\nG0 X1\nM30\n"), "");
}

TEST(JointProgramReader, ARecordingIsNoProgram) {
  EXPECT_TRUE(proof::is_nc_program("%\n(X)"));
  EXPECT_TRUE(proof::is_nc_program("\nG17 G21"));
  EXPECT_TRUE(proof::is_nc_program("N10 G0"));
  EXPECT_FALSE(proof::is_nc_program("cycle,due_ns,state"));
  EXPECT_FALSE(proof::is_nc_program(""));
}

}  // namespace
}  // namespace meridian
