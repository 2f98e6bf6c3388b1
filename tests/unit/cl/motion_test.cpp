// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <istream>
#include <streambuf>
#include <string>
#include <vector>

#include "read_text.hpp"

namespace meridian::cl {
namespace {

TEST(Reader, KeepsTheAxisWhereGotoOfNxHasThreeNumbers) {
  const auto read =
      read_body("GOTO/1,2,3,0,.6,.8\nGOTO/4,5,6\nGOTO/4,5,7,0,0,1\n", written_by(Dialect::kNx));
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  ASSERT_EQ(m.size(), 3U);
  EXPECT_EQ(m[1].tip_mm, (Array3{4, 5, 6}));
  EXPECT_NEAR(m[1].axis[1], 0.6, 1e-15);
  EXPECT_NEAR(m[1].axis[2], 0.8, 1e-15);
  EXPECT_EQ(m[2].axis, (Array3{0, 0, 1}));
  EXPECT_EQ(read.summary.goto_three, 1U);
  EXPECT_EQ(read.summary.goto_six, 2U);
}

TEST(Reader, TakesSixNumbersWithoutMultax) {
  EXPECT_EQ(read_body("GOTO/1,2,3,.5,.2961981327,.8137976813\n").error, "");
}

TEST(Reader, CountsBlocksAndCarriesLines) {
  const auto read = read_body("GOTO/1,2,3\n$$ note\nGOTO/1,2,$\n4\n");
  ASSERT_EQ(read.blocks.size(), 3U);
  EXPECT_EQ(read.blocks[0].line, 3U);
  EXPECT_EQ(read.blocks[1].line, 5U);
  EXPECT_EQ(read.blocks[2].line, 7U);
  EXPECT_EQ(read.blocks[2].kind, BlockKind::kEnd);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(read.blocks[i].sequence, i);
}

TEST(Reader, HoldsRapidForOneMotion) {
  const auto m =
      read_body("RAPID\nGOTO/0,0,9\nGOTO/0,0,8\nRAPID/\nGOTO/0,0,9\nRAPID \nGOTO/0,0,8\n").motion();
  ASSERT_EQ(m.size(), 4U);
  EXPECT_EQ(m[0].kind, BlockKind::kRapid);
  EXPECT_EQ(m[0].feed_meaning, FeedMeaning::kNone);
  EXPECT_EQ(m[1].kind, BlockKind::kCut);
  EXPECT_EQ(m[1].feed, 10.0);  // 600 mm/min
  EXPECT_EQ(m[2].kind, BlockKind::kRapid);
  EXPECT_EQ(m[3].kind, BlockKind::kRapid);
}

TEST(Reader, GoesToTheHomeOfTheMachineWithTheToolInTheSpindleAndSaysSo) {
  ClReaderOptions options;
  options.home = [](std::optional<std::uint32_t> tool) -> std::optional<ToolPose> {
    if (tool && *tool != 7) return std::nullopt;
    return ToolPose{{0, 0, tool ? 300.0 : 400.0}, {0, 0, 1}};
  };
  const auto read =
      read_body("GOTO/1,2,3,0,.6,.8\nGOHOME\nLOADTL/7\nGOTO/1,2,3,0,.6,.8\nHOME\n", options);
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  ASSERT_EQ(m.size(), 4U);
  EXPECT_EQ(m[1].kind, BlockKind::kRapid);
  EXPECT_EQ(m[1].tip_mm, (Array3{0, 0, 400}));
  EXPECT_EQ(m[1].axis, (Array3{0, 0, 1}));
  EXPECT_EQ(m[3].tip_mm, (Array3{0, 0, 300}));
  EXPECT_TRUE(read.warned_of("nothing is in the way"));
  EXPECT_NE(read_body("GOTO/1,2,3\nLOADTL/8\nGOHOME\n", options).error, "");
}

TEST(Reader, LetsFeedBehindRapidWinAndSaysSo) {
  const auto read = read_body("RAPID\nFEDRAT/60,MMPM\nGOTO/0,0,9\n");
  EXPECT_EQ(read.motion().at(0).kind, BlockKind::kCut);
  EXPECT_TRUE(read.warned_of("FEDRAT between RAPID"));
}

TEST(Reader, AddsGodltaToThePositionInAllItsForms) {
  const auto read = read_body("GOTO/1,2,3,0,.6,.8\nGODLTA/1,0,-1\nGODLTA/10\nGODLTA/0,0,1,0,0,1\n",
                              written_by(Dialect::kNx));
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  EXPECT_EQ(m[1].tip_mm, (Array3{2, 2, 2}));
  EXPECT_NEAR(m[2].tip_mm[1], 8, 1e-12);  // 10 mm along the tool axis
  EXPECT_NEAR(m[2].tip_mm[2], 10, 1e-12);
  EXPECT_EQ(m[3].axis, (Array3{0, 0, 1}));
}

TEST(Reader, RefusesGodltaWithoutAPosition) {
  EXPECT_NE(read_body("GODLTA/0,0,1\n").error.find("before any position"), std::string::npos);
}

TEST(Reader, TakesFromAsPositionWithoutMotion) {
  const auto read = read_body("FROM/1,1,50,0,0,1\nRAPID\nGODLTA/0,0,-1\n");
  const auto m = read.motion();
  ASSERT_EQ(m.size(), 1U);
  EXPECT_EQ(m[0].tip_mm, (Array3{1, 1, 49}));
}

TEST(Reader, MakesFromABlockWhereACutBeginsThere) {
  const auto read = read_body("FROM/0,0,0,0,.6,.8\nGOTO/100,0,0,0,0,1\nGOTO/100,50,0\n");
  const auto m = read.motion();
  ASSERT_EQ(m.size(), 3U);
  EXPECT_EQ(m[0].kind, BlockKind::kRapid);
  EXPECT_EQ(m[0].tip_mm, (Array3{0, 0, 0}));
  EXPECT_NEAR(m[0].axis[1], .6, 1e-15);
  EXPECT_EQ(m[1].kind, BlockKind::kCut);
  EXPECT_EQ(m[1].tip_mm, (Array3{100, 0, 0}));
  EXPECT_EQ(m[1].axis, (Array3{0, 0, 1}));
  EXPECT_DOUBLE_EQ(read.summary.cut_length_mm, 150);
  EXPECT_EQ(read_body("FROM/1,2,3\nGOTO/1,2,3\nGOTO/9,2,3\n").motion().size(), 2U);
}

TEST(Reader, TakesFromBehindMotionForARapidAlone) {
  const auto read = read_body("GOTO/0,0,0\nFROM/50,0,0\nRAPID\nGOTO/60,0,0\nGOTO/70,0,0\n");
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.motion().size(), 3U);
  EXPECT_TRUE(read.warned_of("FROM after motion"));
  for (const char* next :
       {"GOTO/60,0,0\n", "GODLTA/10,0,0\n", "CIRCLE/40,0,0,0,0,1\nGOTO/40,10,0\n"}) {
    const auto cut = read_body("GOTO/0,0,0\nFROM/50,0,0\n" + std::string(next));
    EXPECT_EQ(cut.error_line, 4U) << next;
    EXPECT_NE(cut.error.find("FROM"), std::string::npos) << cut.error;
  }
  const auto same = read_body("GOTO/0,0,0\nFROM/0,0,0\nGOTO/10,0,0\n");
  EXPECT_EQ(same.error, "");
  EXPECT_TRUE(same.warnings.empty());
  EXPECT_DOUBLE_EQ(same.summary.cut_length_mm, 10);
}

TEST(Reader, RefusesCoordinatesBeyondAKilometre) {
  for (const char* line :
       {"GOTO/1000001,0,0\n", "GOTO/0,-1000001,0\n", "FROM/0,0,1E7\n", "GODLTA/1E6,0,0\n"}) {
    const auto read = read_body("GOTO/1,0,0\n" + std::string(line) + "GOTO/0,0,0\n");
    EXPECT_EQ(read.error_line, 4U) << line;
    EXPECT_NE(read.error.find("beyond 1e6 mm"), std::string::npos) << read.error;
  }
  EXPECT_EQ(read_body("GOTO/1000000,0,0\n").error, "");
}

TEST(Reader, MakesFromABlockWhereAnArcBeginsThere) {
  const auto m = read_body("FROM/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0\n").motion();
  ASSERT_EQ(m.size(), 2U);
  EXPECT_EQ(m[0].kind, BlockKind::kRapid);
  EXPECT_EQ(m[0].tip_mm, (Array3{10, 0, 0}));
  EXPECT_TRUE(m[1].is_arc);
}

TEST(Reader, NormalisesAnAxisThatIsSlightlyOffUnitLength) {
  for (const char* goto_line : {"GOTO/0,0,0,0,.59997,.79996\n", "GOTO/0 0 0 0 .60003 .80004\n"}) {
    const auto m = read_body(goto_line).motion();
    ASSERT_EQ(m.size(), 1U);
    EXPECT_NEAR(std::hypot(m[0].axis[0], m[0].axis[1], m[0].axis[2]), 1, 1e-15);
    EXPECT_NEAR(m[0].axis[1] / m[0].axis[2], 0.75, 1e-4);
  }
}

TEST(Reader, RefusesAnAxisThatIsFarOffUnitLength) {
  for (const char* axis : {"0,0,0", "0,0,1.0011", "0,0,.9989", "0,0,2", ".5,.5,.5"}) {
    const auto read = read_body("GOTO/0,0,0\nGOTO/0,0,1," + std::string(axis) + "\n");
    EXPECT_EQ(read.error_line, 4U) << axis;
    EXPECT_NE(read.error.find("not a unit vector"), std::string::npos) << read.error;
    EXPECT_EQ(read.blocks.size(), 1U);
  }
  EXPECT_EQ(read_body("GOTO/0,0,0,0,0,1.0009\nGOTO/0,0,0,0,0,.9991\n").error, "");
}

TEST(Reader, PassesMovesOfZeroLength) {
  const auto read = read_body("GOTO/1,2,3\nGOTO/1,2,3\nGOTO/1,2,4\n");
  EXPECT_EQ(read.motion().size(), 3U);
  EXPECT_EQ(read.summary.zero_length, 1U);
}

TEST(Reader, SetsTheAxisByTlaxis) {
  const auto m = read_body("TLAXIS/0,.6,.8\nGOTO/0,0,0\n").motion();
  EXPECT_NEAR(m.at(0).axis[1], 0.6, 1e-15);
}

TEST(Reader, KeepsShortSegmentsOfTenDecimals) {
  const auto m = read_body(
                     "GOTO / 12.3456789012, 0.0000000000, 5.0000000000,  $\n"
                     "  0.0000000000, 0.0000000000, 1.0000000000\n"
                     "GOTO / 12.3457789012, 0.0000000000, 5.0000000000,  $\n"
                     "  0.0000000000, 0.0000000000, 1.0000000000\n")
                     .motion();
  EXPECT_NEAR(m.at(1).tip_mm[0] - m.at(0).tip_mm[0], 1e-4, 1e-14);
}

TEST(Reader, TakesAxesThatJumpByARightAngleBetweenSetups) {
  const auto read = read_body(
      "TRNTYP/WORLD\nCSYS/1,0,0,0,0,1,0,0,0,0,1,0\nGOTO/0,0,25.,0,0,1\n"
      "CSYS/0,0,1,0,1,0,0,0,0,1,0,0\nRAPID/\nGOTO/25,0,0,1,0,0\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.motion().at(1).axis, (Array3{1, 0, 0}));
  EXPECT_NEAR(read.summary.axis_change_max_rad, std::asin(1.0), 1e-15);
}

/// Gives one line at a time and knows how many were asked for.
class SlowSource : public std::streambuf {
 public:
  explicit SlowSource(std::vector<std::string> lines) : lines_(std::move(lines)) {}
  [[nodiscard]] std::size_t given() const { return given_; }

 private:
  int_type underflow() override {
    if (given_ == lines_.size()) return traits_type::eof();
    std::string& line = lines_[given_++];
    setg(line.data(), line.data(), line.data() + line.size());
    return traits_type::to_int_type(line[0]);
  }
  std::vector<std::string> lines_;
  std::size_t given_ = 0;
};

TEST(Reader, GivesABlockAsSoonAsItsLineIsThere) {
  SlowSource source({"UNITS/MM\n", "FEDRAT/60\n", "GOTO/1,2,3,$\n", "0,0,1\n", "GOTO/1,2,4\n",
                     "FINI\n", "never asked for\n"});
  std::istream stream(&source);
  ClReader reader(stream, "slow");
  for (const std::size_t lines : {4U, 5U, 6U}) {
    const auto block = reader.next();
    ASSERT_TRUE(block && *block);
    EXPECT_EQ(source.given(), lines);
  }
  EXPECT_FALSE(reader.next()->has_value());
  EXPECT_EQ(source.given(), 6U);
}

TEST(Reader, KnowsAForeignProgramThatComesLineByLine) {
  SlowSource source({"\n", "( boat )\n", "G21 G90\n", "M428\n", "G93\n", "G1 X  16.339 Y 2 F12\n"});
  std::istream stream(&source);
  ClReader reader(stream, "slow");
  const auto block = reader.next();
  ASSERT_FALSE(block);
  EXPECT_NE(block.error().text().find("a LinuxCNC NC program (M428)"), std::string::npos)
      << block.error().text();
}

TEST(Reader, WaitsForTheFirstWordOfAProgramThatBeginsWithNothing) {
  SlowSource source(
      {"\n", "$$ note\n", "MULTAX\n", "UNITS/MM\n", "FEDRAT/60\n", "GOTO/1,2,3\n", "FINI\n"});
  std::istream stream(&source);
  ClReader reader(stream, "slow");
  const auto block = reader.next();
  ASSERT_TRUE(block && *block);
  EXPECT_EQ(source.given(), 6U);
}

TEST(Reader, RefusesMalformedGotos) {
  for (const char* line :
       {"GOTO/1,2\n", "GOTO/1,2,3,4\n", "GOTO/1,,3\n", "GOTO/1,2,X\n", "GOTO/\n",
        "GOTO/1,2,3,0,0,1,5\n", "GOTO/1,2,NAN\n", "GOTO/1,2,1E400\n", "GOTO/1,2,3E7\n"}) {
    const auto read = read_body(std::string("GOTO/0,0,0\n") + line);
    EXPECT_EQ(read.error_line, 4U) << line << read.error;
    EXPECT_EQ(read.blocks.size(), 1U) << line;
  }
}

TEST(Summary, ReportsBoxTiltFeedAndLengths) {
  const auto read = read_body("RAPID\nGOTO/0,0,10\nGOTO/0,0,0\nGOTO/30,40,0,0,.6,.8\nDELAY/2\n");
  const ClSummary& s = read.summary;
  EXPECT_EQ(s.box_min_mm, (Array3{0, 0, 0}));
  EXPECT_EQ(s.box_max_mm, (Array3{30, 40, 10}));
  EXPECT_NEAR(s.tilt_max_rad, std::atan2(.6, .8), 1e-15);
  EXPECT_NEAR(s.axis_change_max_rad, std::atan2(.6, .8), 1e-15);
  EXPECT_NEAR(s.cut_length_mm, 60, 1e-12);
  EXPECT_NEAR(s.cut_time_s, 6, 1e-12);
  EXPECT_EQ(s.dwell_time_s, 2);
  EXPECT_EQ(s.feed_max_mm_per_s, 10);
  EXPECT_NE(to_text(s).find("3 numbers"), std::string::npos);
}

}  // namespace
}  // namespace meridian::cl
