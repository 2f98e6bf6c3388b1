// SPDX-License-Identifier: Apache-2.0
//
// Files without a unit word, as NX writes them: the words of their feeds show the unit.
#include <gtest/gtest.h>

#include <sstream>

#include "read_text.hpp"

namespace meridian::cl {
namespace {

constexpr const char* kInchPart = "RAPID\nGOTO/0,0,1\nFEDRAT/10,IPM\nGOTO/1,0,0\nFINI\n";

ClReaderOptions in_unit(LengthUnit unit) {
  ClReaderOptions options;
  options.unit = unit;
  return options;
}

ClReaderOptions on_inch_machine() {
  ClReaderOptions options;
  options.default_unit = LengthUnit::kInch;
  return options;
}

/// A text that is read once, as a pipe.
class Pipe final : public std::stringbuf {
 public:
  using std::stringbuf::stringbuf;

 protected:
  pos_type seekoff(off_type, std::ios_base::seekdir, std::ios_base::openmode) override {
    return {off_type(-1)};
  }
};

TEST(UnitByFeed, HoldsForRapidPointsBeforeTheFirstFeedAndIsSaid) {
  const auto read = read_text(kInchPart);
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  ASSERT_EQ(m.size(), 2U);
  EXPECT_EQ(m[0].tip_mm[2], 25.4);
  EXPECT_EQ(m[1].tip_mm[0], 25.4);
  EXPECT_NEAR(m[1].feed, 254.0 / 60, 1e-12);
  ASSERT_EQ(read.warnings.size(), 1U);
  EXPECT_EQ(read.warnings[0].line, 2U);
  EXPECT_TRUE(read.warned_of(
      "NO UNIT WORD IN THE FILE: read in inch, as its feeds are (line 3); --units mm"));
  EXPECT_EQ(read.summary.unit_source, UnitSource::kFeed);
  EXPECT_NE(to_text(read.summary).find("inch (NO UNIT WORD IN THE FILE: as its feeds are)"),
            std::string::npos);
  EXPECT_NE(to_json(read.summary).find("\"unit_source\": \"feed\""), std::string::npos);
}

TEST(UnitByFeed, HoldsForArcs) {
  const auto read =
      read_text("RAPID\nGOTO/1,0,0\nFEDRAT/10,IPM\nCIRCLE/0,0,0,0,0,1,1\nGOTO/0,1,0\nFINI\n",
                written_by(Dialect::kNx));
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  ASSERT_EQ(m.size(), 2U);
  EXPECT_TRUE(m[1].is_arc);
  EXPECT_NEAR(m[1].tip_mm[1], 25.4, 1e-9);
}

TEST(UnitByFeed, IsThatOfACycleToo) {
  const auto read =
      read_text("RAPID\nGOTO/0,0,2\nCYCLE/DRILL,RAPTO,1,FEDTO,-2,IPM,4\nGOTO/0,0,0\nFINI\n");
  ASSERT_EQ(read.error, "");
  const auto m = read.motion();
  ASSERT_GE(m.size(), 3U);
  EXPECT_EQ(m[0].tip_mm[2], 2 * 25.4);
  EXPECT_EQ(m[1].tip_mm[2], 25.4);
  EXPECT_TRUE(read.warned_of("as its feeds are (line 3)"));
  const auto at_once = read_text("CYCLE/DRILL,RAPTO,1,FEDTO,-2,IPM,4\nGOTO/0,0,0\nFINI\n");
  EXPECT_EQ(at_once.motion().at(0).tip_mm[2], 25.4);
  EXPECT_TRUE(at_once.warned_of("as its feeds are (line 1)"));
}

TEST(UnitByFeed, IsFoundByTheStatementsOfTheFileAndNotInItsComments) {
  const auto read = read_text(
      "RAPID\nGOTO/0,0,1\n$$ FEDRAT/100,MMPM\nPPRINT FEDRAT/100,MMPM\n"
      "FEDRAT / $ UNITS/MM\n$$ note\n 10.0 $\n , IPM $$ MMPM\nGOTO/1,0,0\nFINI\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.motion().at(0).tip_mm[2], 25.4);
  EXPECT_TRUE(read.warned_of("(line 5)"));
}

TEST(UnitByFeed, IsStrongerThanTheDefaultOfTheMachine) {
  const auto read =
      read_text("RAPID\nGOTO/0,0,1\nFEDRAT/10,MMPM\nGOTO/1,0,0\nFINI\n", on_inch_machine());
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.motion().at(0).tip_mm[2], 1);
  EXPECT_TRUE(read.warned_of("read in millimetre, as its feeds are (line 3); --units inch"));
  EXPECT_EQ(read.summary.unit_source, UnitSource::kFeed);
}

TEST(UnitByFeed, IsWeakerThanTheUnitsOfTheCaller) {
  const auto inch = read_text(kInchPart, in_unit(LengthUnit::kInch));
  EXPECT_EQ(inch.motion().at(1).tip_mm[0], 25.4);
  EXPECT_TRUE(inch.warnings.empty());
  const auto metric = read_text(kInchPart, in_unit(LengthUnit::kMillimetre));
  EXPECT_EQ(metric.motion().at(0).tip_mm[2], 1);
  EXPECT_TRUE(metric.warned_of("points in millimetre, but feed in inch"));
  EXPECT_EQ(metric.summary.unit_source, UnitSource::kCaller);
}

TEST(UnitByFeed, IsWeakerThanAUnitWordBeforeItOrBeforeTheFirstPoint) {
  const auto before = read_text("FEDRAT/10,IPM\nUNITS/MM\nGOTO/1,0,0\nFINI\n");
  EXPECT_EQ(before.motion().at(0).tip_mm[0], 1);
  EXPECT_EQ(before.summary.unit_source, UnitSource::kFile);
  const auto later = read_text(
      "RAPID\nGOTO/1,0,0\nUNITS/MM\nFEDRAT/10,IPM\nGOTO/2,0,0\nUNITS/INCHES\nGOTO/2,0,0\nFINI\n");
  ASSERT_EQ(later.error, "");
  EXPECT_EQ(later.motion().at(0).tip_mm[0], 1);
  EXPECT_EQ(later.motion().at(1).tip_mm[0], 2);
  EXPECT_EQ(later.motion().at(2).tip_mm[0], 50.8);
  EXPECT_TRUE(later.warned_of("the station's default"));
}

TEST(UnitByFeed, IsNotSoughtBehindTheEndOfTheProgram) {
  const auto read = read_text("RAPID\nGOTO/1,0,0\nFINI\nFEDRAT/10,IPM\n");
  EXPECT_EQ(read.motion().at(0).tip_mm[0], 1);
  EXPECT_EQ(read.summary.unit_source, UnitSource::kStation);
}

TEST(UnitByFeed, OfTwoUnitsIsRefusedWithBothLines) {
  const auto inch = read_text(
      "RAPID\nGOTO/0,0,1\nFEDRAT/10,IPM\nGOTO/1,0,0\nFEDRAT/99,MMPM\n"
      "GOTO/2,0,0\nFINI\n");
  EXPECT_NE(inch.error.find("part.apt:6: a file without a unit word is read in inch, as its feed "
                            "in line 3 is, but this feed is in millimetre"),
            std::string::npos)
      << inch.error;
  EXPECT_NE(inch.error.find("--units mm, or --units inch"), std::string::npos) << inch.error;
  const auto metric = read_text(
      "FEDRAT/99,MMPM\nGOTO/0,0,9\nCYCLE/DRILL,RAPTO,1,FEDTO,-2,IPM,4\n"
      "GOTO/0,0,0\nFINI\n");
  EXPECT_NE(metric.error.find("part.apt:4: a file without a unit word is read in millimetre, as "
                              "its feed in line 1 is, but this feed is in inch"),
            std::string::npos)
      << metric.error;
}

TEST(UnitByFeed, OfAPipeIsKnownWhereAFeedStandsBeforeTheFirstPointAndElseRefused) {
  const auto read = [](const std::string& text) {
    Pipe pipe(text, std::ios::in);
    std::istream stream(&pipe);
    ClReader reader(stream, "pipe");
    auto block = reader.next();
    for (std::size_t i = 0; i < 3 && block && *block && (*block)->kind != BlockKind::kCut; ++i) {
      block = reader.next();
    }
    return block;
  };
  const auto later = read(kInchPart);
  ASSERT_FALSE(later);
  for (const char* part :
       {"pipe:4: a file without a unit word is read in millimetre, but this feed "
        "is in inch",
        "--units inch", "a file, unlike a pipe, is searched"}) {
    EXPECT_NE(later.error().text().find(part), std::string::npos) << later.error().text();
  }
  const auto first = read("FEDRAT/10,IPM\nGOTO/1,0,0\nFINI\n");
  ASSERT_TRUE(first) << first.error().text();
  EXPECT_EQ((*first)->tip_mm[0], 25.4);
}

/// The buffer of a reader is far shorter than what lies before the first feed here.
TEST(UnitByFeed, IsFoundFarAheadInAStreamThatIsThenReadAsIfNothingHadBeen) {
  std::string text = "RAPID\n";
  for (int i = 0; i < 40'000; ++i) text += "RAPID\nGOTO/" + std::to_string(i % 100) + ",0,1\n";
  text += "FEDRAT/10,IPM\nGOTO/1,0,0\nFINI\n";
  const auto wanted = read_text(text);
  ASSERT_EQ(wanted.error, "");
  std::istringstream stream(text);
  ClReader reader(stream, "part.apt");
  for (const ClBlock& block : wanted.blocks) {
    const auto read = reader.next();
    ASSERT_TRUE(read) << read.error().text();
    ASSERT_TRUE(*read);
    ASSERT_EQ((*read)->line, block.line);
    ASSERT_EQ((*read)->tip_mm, block.tip_mm);
  }
  EXPECT_EQ(wanted.blocks.at(7).tip_mm[0], 7 * 25.4);
  EXPECT_FALSE(*reader.next());
  EXPECT_EQ(reader.summary().bytes, text.size());
}

}  // namespace
}  // namespace meridian::cl
