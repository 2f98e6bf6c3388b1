// SPDX-License-Identifier: Apache-2.0
// Names that stand for numbers, and tools that are called by name.
#include <gtest/gtest.h>

#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

TEST(SiemensVariables, StandForTheNumberThatTheLastLineGave) {
  const ReadText read = read_siemens(
      "DEF REAL _X_HOME, _Y=-2.5\nDEF INT N_PASS=3\n_X_HOME=-365. R1=5\nG0 X=_X_HOME Y=_Y Z=R1\n"
      "_X_HOME=7\nR2=-R1\nG1 X=_X_HOME Z=R2\nX=-_X_HOME F=R1\n");
  ASSERT_EQ(read.error, "");
  const auto motion = read.motion();
  ASSERT_EQ(motion.size(), 3U);
  EXPECT_EQ(tip(motion[0]), Vector3(-365, -2.5, 5));
  EXPECT_EQ(tip(motion[1]), Vector3(7, -2.5, -5));
  EXPECT_EQ(tip(motion[2]), Vector3(-7, -2.5, -5));
  EXPECT_DOUBLE_EQ(motion[2].feed, 5.0 / 60);
}

TEST(SiemensVariables, MayStandInBracketsToo) {
  const ReadText read =
      read_siemens("R1=5 R2=-3\nG0 X=AC(R1) Y=IC(-R2) Z=AC(7)\nG1 X=IC(R1) F100\n");
  EXPECT_NE(read.error.find("G91, but where Y stands"), std::string::npos) << read.error;
  const ReadText known =
      read_siemens("R1=5 R2=-3\nG0 X0 Y1 Z0\nG0 X=AC(R1) Y=IC(-R2) Z=AC(7)\nG1 X=IC(R1) F100\n");
  ASSERT_EQ(known.error, "");
  EXPECT_EQ(tip(known.motion()[1]), Vector3(5, 4, 7));
  EXPECT_EQ(tip(known.motion()[2]), Vector3(10, 4, 7));
}

TEST(SiemensProgram, FlagsAFeedGroupThatIsNotTheTip) {
  const std::string cut = "\nG0 X0 Y0 Z0\nG1 X9 F100\n";
  EXPECT_TRUE(read_siemens("FGROUP(X,Y)" + cut).warned_of("FGROUP(X,Y): F is taken as the feed"));
  EXPECT_TRUE(read_siemens("FGROUP(X,Y,Z,B,C)" + cut).warned_of("the control counts these axes"));
  for (const char* tip : {"FGROUP(X,Y,Z)", "FGROUP(Z, X, Y)", "FGROUP()", "FGREF[A]=10"}) {
    EXPECT_FALSE(read_siemens(tip + cut).warned_of("FGROUP")) << tip;
  }
}

TEST(SiemensProgram, NamesTheValueOrSpindleThatItDoesNotKnow) {
  for (const auto& [line, says] : {std::pair{"X9 RND=2", "a value for RND"},
                                   {"X9 CHF=2", "a value for CHF"},
                                   {"S2=1000 M2=3", "S2= is of another spindle"}}) {
    const std::string error =
        read_siemens("G0 X0 Y0 Z0\nG1 F100 " + std::string(line) + "\n").error;
    EXPECT_NE(error.find(says), std::string::npos) << line << ": " << error;
  }
  EXPECT_EQ(read_siemens("G0 X0 Y0 Z0\nFL[B]=500 VELOLIMA[X]=80\nG1 F100 X7\n").error, "");
}

TEST(SiemensVariables, AreRefusedWithoutANumber) {
  EXPECT_NE(read_siemens("DEF REAL _A\nG0 X=_A Y0 Z0\n").error.find("no line above gives it"),
            std::string::npos);
}

TEST(SiemensTools, AreNumberedInTheOrderOfTheirCallsWhereNoTableNamesThem) {
  const ReadText read =
      read_siemens("T=\"Mill_D10\" M6\nG0 X0 Y0 Z0\nT=\"DRILL\"\nM6\nT=\"MILL_D10\" M6\nT0 M6\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.summary.tools, (std::vector<std::uint32_t>{900'000'001, 900'000'002}));
  EXPECT_TRUE(read.warned_of("tool 'MILL_D10' is called 900000001 here"));
}

TEST(SiemensTools, HaveTheNumberThatTheTableGivesTheirName) {
  ClReaderOptions options;
  options = siemens();
  options.nc =
      reader_of_programs(shipped("trunnion-ac"), ToolTable({{7, 100, 5}}), {{"MILL_D10", 7}});
  const ReadText read = read_siemens("T=\"MILL_D10\" M6\nG0 X0 Y0 Z0\n", options);
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.summary.tools, (std::vector<std::uint32_t>{7}));
  EXPECT_TRUE(read.warnings.empty());
}

}  // namespace
}  // namespace meridian::nc
