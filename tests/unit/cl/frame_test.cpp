// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/interpreter/frame.hpp"

#include <gtest/gtest.h>

#include "read_text.hpp"

namespace meridian::cl {
namespace {

constexpr double kTight = 1e-12;

void expect_near(const Array3& got, const Array3& want) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(got[i], want[i], kTight);
}

TEST(Frames, AlikeThroughoutLeaveThePointsAsWritten) {
  const auto read = read_body(
      "MSYS/10,20,30,0,1,0,-1,0,0\nGOTO/1,2,3,0,0,1\nMSYS/10,20,30,0,1,0,-1,0,0\nGOTO/4,5,6\n");
  EXPECT_EQ(read.motion().at(1).tip_mm, (Array3{4, 5, 6}));
  EXPECT_EQ(read.summary.frame_changes, 0U);
  EXPECT_TRUE(read.warnings.empty());
}

TEST(Frames, ThatChangeAreGivenInTheFirst) {
  // The second frame lies at (100, 0, 0) of the first and is turned by 90 deg about z.
  const auto read = read_body(
      "MSYS/10,0,0,1,0,0,0,1,0\nGOTO/1,2,3,0,0,1\n"
      "MSYS/110,0,0,0,1,0,-1,0,0\nGOTO/1,2,3,.6,0,.8\nGODLTA/1,0,0,.6,0,.8\n"
      "MSYS/10,0,0,1,0,0,0,1,0\nGOTO/1,2,3,0,0,1\n");
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  expect_near(m.at(1).tip_mm, {98, 1, 3});
  expect_near(m[1].axis, {0, .6, .8});
  expect_near(m.at(2).tip_mm, {98, 2, 3});
  expect_near(m.at(3).tip_mm, {1, 2, 3});
  EXPECT_TRUE(read.warned_of("changes its frame"));
  EXPECT_EQ(read.summary.frame_changes, 2U);
}

TEST(Frames, OfMcsAreThreeAxesAndThenTheirOrigin) {
  // The second one stands up: its z is -y, its origin at (5, 6, 7).
  const auto read = read_body(
      "MULTAX/OFF\nMCS/1, 0, 0, $\n0, 1, 0, $\n0, 0, 1, $\n0, 0, 0\nGOTO/1,2,3\n"
      "MULTAX/OFF\nMCS/1, 0, 0, $\n0, 0, 1, $\n0, -1, 0, $\n5, 6, 7\nGOTO/1,2,3\n");
  ASSERT_EQ(read.error, "");
  expect_near(read.motion().at(0).tip_mm, {1, 2, 3});
  expect_near(read.motion().at(1).tip_mm, {6, 3, 9});
  expect_near(read.motion()[1].axis, {0, -1, 0});
  EXPECT_NE(read_body("MCS/1,0,0, 0,1,0, 0,0,-1, 0,0,0\nGOTO/1,2,3\n").error, "");
}

TEST(Frames, OfMcsysLieInOneWorkOffset) {
  const std::string first = "MCSYS/ NUM, 1, POINT, 0, 0, 0, VECTOR, 1, 0, 0, VECTOR, 0, 1, 0\n";
  const std::string second = "POINT, 0, 0, 9, VECTOR, 0, 1, 0, VECTOR, -1, 0, 0\nGOTO/ 1, 2, 3\n";
  const auto read = read_body(first + "GOTO/ 1, 2, 3\nMCSYS/ NUM, 1, " + second);
  ASSERT_EQ(read.error, "");
  expect_near(read.motion().at(1).tip_mm, {-2, 1, 12});
  const auto other = read_body(first + "GOTO/ 1, 2, 3\nMCSYS/ NUM, 2, " + second);
  EXPECT_NE(other.error.find("part.apt:5: MCSYS/NUM,2 after NUM,1"), std::string::npos)
      << other.error;
  EXPECT_NE(read_body("MCSYS/ NUM, 1, POINT, 0, 0, 0\nGOTO/1,2,3\n").error, "");
}

TEST(Frames, TurnArcsWithThem) {
  const auto m =
      read_body(
          "CSYS/1,0,0,0, 0,1,0,0, 0,0,1,0\nGOTO/0,0,0\n"
          "CSYS/0,0,1,5, 1,0,0,0, 0,1,0,0\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1\nGOTO/0,10,0\n")
          .motion();
  expect_near(m.at(1).tip_mm, {5, 10, 0});
  expect_near(m.at(2).normal, {1, 0, 0});
  expect_near(m[2].tip_mm, {5, 0, 10});
}

TEST(Frames, OfCsysMeanNothingUnderTrntypWorld) {
  const auto m = read_body(
                     "TRNTYP/WORLD\nCSYS/1,0,0,0, 0,1,0,0, 0,0,1,0\nGOTO/1,2,3,0,0,1\n"
                     "CSYS/0,0,1,5, 1,0,0,0, 0,1,0,0\nGOTO/4,5,6,1,0,0\n")
                     .motion();
  expect_near(m.at(1).tip_mm, {4, 5, 6});
  expect_near(m[1].axis, {1, 0, 0});
  EXPECT_NE(read_body("TRNTYP/SIDEWAYS\nGOTO/1,2,3\n").error, "");
}

TEST(Frames, OfCreoComeFromCommentsThatContinue) {
  const auto m = read_body(
                     "$$-> CSYS / 1.0, 0.0, 0.0, 0.0,  $\n  0.0, 1.0, 0.0, 0.0,  $\n"
                     "  0.0, 0.0, 1.0, 0.0\nGOTO / 1, 2, 3\n"
                     "$$-> CSYS / 1.0, 0.0, 0.0, 7.0,  $\n  0.0, 1.0, 0.0, 0.0,  $\n"
                     "  0.0, 0.0, 1.0, 0.0\nGOTO / 1, 2, 3\n")
                     .motion();
  ASSERT_EQ(m.size(), 2U);
  expect_near(m[1].tip_mm, {8, 2, 3});
}

TEST(Frames, OfCatiaComeFromPlainComments) {
  const auto read = read_body(
      "$$*CATIA0\n$$ Programme d'usinage.1\n$$ 1 0 0 0\n$$ 0 1 0 0\n$$ 0 0 1 0\nGOTO/1,2,3\n"
      "$$*CATIA0\n$$ 001\n$$ 0.0 1.0 0.0 0.0\n$$ 0.0 0.0 1.0 0.0\n$$ 1.0 0.0 0.0 "
      "9.0\nGOTO/1,2,3\n");
  ASSERT_EQ(read.error, "");
  expect_near(read.motion().at(1).tip_mm, {2, 3, 10});
  EXPECT_EQ(read.summary.dialect, "CATIA APT");
}

TEST(Frames, InInchAreInch) {
  const auto m = read_text(
                     "UNITS/INCHES\nFEDRAT/10\nMSYS/0,0,0,1,0,0,0,1,0\nGOTO/0,0,0\n"
                     "MSYS/1,0,0,1,0,0,0,1,0\nGOTO/0,0,0\nFINI\n")
                     .motion();
  expect_near(m.at(1).tip_mm, {25.4, 0, 0});
}

TEST(Frames, ThatAreNoneAreRefused) {
  for (const char* line :
       {"MSYS/0,0,0,1,0,0,1,0,0\n", "MSYS/0,0,0,2,0,0,0,1,0\n", "MSYS/0,0,0,1,0,0\n",
        "CSYS/1,0,0,0,0,1,0,0,0,0,-1,0\n", "CSYS/1,0,0,0,0,1,0,0,0,0,1\n"}) {
    EXPECT_EQ(read_body(std::string(line) + "GOTO/0,0,0\n").error_line, 3U) << line;
  }
  EXPECT_EQ(read_body("CSYS/.99999,0,0,0,0,1.0001,0,0,0,0,1,0\nGOTO/0,0,0\n").error, "");
}

TEST(Frames, ThatLeadBeyondAllMachinesAreRefused) {
  EXPECT_NE(read_body("TRANS/1e308,0,0\nGOTO/1,2,3\n").error.find("beyond 1e6 mm"),
            std::string::npos);
  EXPECT_NE(read_body("GOTO/0,0,0\nMSYS/2e6,0,0,1,0,0,0,1,0\nGOTO/1,2,3\n").error, "");
}

TEST(Frames, OfTheCallerComeOnTop) {
  ClReaderOptions options = metric();
  Frame frame;
  frame.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // 90 deg about z
  frame.origin = {100, 0, 0};
  options.frame = frame;
  const auto m = read_text(
                     "FEDRAT/60\nMSYS/5,0,0,1,0,0,0,1,0\nGOTO/1,2,3,.6,0,.8\n"
                     "GOTO/0,0,0,.6,0,.8\nMSYS/6,0,0,1,0,0,0,1,0\nGOTO/0,0,0,.6,0,.8\nFINI\n",
                     options)
                     .motion();
  expect_near(m.at(0).tip_mm, {98, 1, 3});
  expect_near(m[0].axis, {0, .6, .8});
  expect_near(m.at(1).axis, {0, .6, .8});
  expect_near(m.at(2).tip_mm, {100, 1, 0});
}

}  // namespace
}  // namespace meridian::cl
