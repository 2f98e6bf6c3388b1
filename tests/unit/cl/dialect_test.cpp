// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/dialect.hpp"

#include <gtest/gtest.h>

#include "read_text.hpp"

namespace meridian::cl {
namespace {

TEST(Dialect, TableStandsInTheOrderOfItsNames) {
  for (std::size_t i = 0; i < dialects().size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(dialects()[i].dialect), i);
    if (i == 0) continue;
    EXPECT_EQ(find_dialect(dialects()[i].name), dialects()[i].dialect);
  }
  EXPECT_FALSE(find_dialect("word"));
}

struct Shown {
  const char* head;
  const char* title;
};

class DialectShown : public testing::TestWithParam<Shown> {};

TEST_P(DialectShown, ByItsWords) {
  const auto read =
      read_text(std::string(GetParam().head) + "FEDRAT/9\nGOTO/0,0,0\nEND-OF-PATH\nFINI\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.summary.dialect, GetParam().title);
  EXPECT_NE(to_text(read.summary).find(GetParam().title), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Files, DialectShown,
    testing::Values(Shown{"TOOL PATH/A,TOOL,B\n", "NX CLSF"},
                    Shown{"PPRINT/APTCL-SPEC,MAKINO-FF,1\n", "Makino FF CLDATA"},
                    Shown{"$$-> CUTTER / 6.0\n", "Creo NCL"},
                    Shown{"$$*          Pro/CLfile  Version 9.0 - 0\n", "Creo NCL"},
                    Shown{"UNIT/MM\n", "SolidWorks CAM APT"},
                    Shown{"TRNTYP/WORLD,0,0,0\n", "SolidWorks CAM APT"},
                    Shown{"CSI_SET_FLUTE_LENGTH/19.\n", "SolidWorks CAM APT"},
                    Shown{"$$     CATIA APT VERSION 1.0\n", "CATIA APT"},
                    Shown{"$$*CATIA0\n$$ 1 0 0 0\n$$ 0 1 0 0\n$$ 0 0 1 0\n", "CATIA APT"},
                    Shown{"$$ Mastercam APT post\n", "Mastercam APT"},
                    Shown{"PPRINT hyperMILL 2024\n", "hyperMILL APT"}, Shown{"LOADTL/1\n", "APT"}));

TEST(Dialect, IsNotShownByANameThatSomebodyGaveAPart) {
  EXPECT_EQ(read_body("PARTNO MODELLED IN CREO FOR NX\n$$ exported from Creo Parametric\n"
                      "GOTO/0,0,0\n")
                .summary.dialect,
            "APT");
}

TEST(Dialect, SaysWhatShowsIt) {
  EXPECT_EQ(read_text("UNITS/MM\nTOOL PATH/A,TOOL,B\nFEDRAT/9\nGOTO/0,0,0\nEND-OF-PATH\n")
                .summary.dialect_reason,
            "TOOL PATH in line 2");
  EXPECT_EQ(read_body("GOTO/0,0,0\n", written_by(Dialect::kNx)).summary.dialect_reason,
            "--dialect");
}

constexpr const char* kMixed = "GOTO/1,2,3,0,.6,.8\nGOTO/4,5,6\n";

Array3 second_axis(const std::string& head, const ClReaderOptions& options = {}) {
  const auto read = read_body(head + kMixed + "END-OF-PATH\n", options);
  EXPECT_EQ(read.error, "") << head;
  return read.motion().size() == 2 ? read.motion()[1].axis : Array3{};
}

/// A wrong axis is a crash: what leaves it open is the dialect's to say.
TEST(MissingAxis, StaysInNx) { EXPECT_NEAR(second_axis("TOOL PATH/A,TOOL,B\n")[1], .6, 1e-15); }

TEST(MissingAxis, IsPlusZInCreoAndSaid) {
  const auto read = read_body(std::string("$$-> CUTTER / 6\n") + kMixed);
  EXPECT_EQ(read.motion().at(1).axis, (Array3{0, 0, 1}));
  EXPECT_TRUE(read.warned_of("as Creo means it"));
}

TEST(MissingAxis, IsThatOfTheLastCsysInSolidWorksCam) {
  EXPECT_EQ(second_axis("TRNTYP/WORLD,0,0,0\nCSYS/0,0,1,0, 1,0,0,0, 0,1,0,0\n"), (Array3{1, 0, 0}));
  EXPECT_EQ(second_axis("TRNTYP/LOCAL\nCSYS/1,0,0,0, 0,1,0,0, 0,0,1,0\n"), (Array3{0, 0, 1}));
  const auto first =
      read_body("TRNTYP/WORLD,0,0,0\nCSYS/-1,0,0,0, 0,1,0,0, 0,0,-1,0\nGOTO/1,2,3\n");
  EXPECT_EQ(first.motion().at(0).axis, (Array3{0, 0, -1}));
}

TEST(MissingAxis, IsRefusedWithTheRemedyWhereTheDialectIsNotCertain) {
  for (const char* head : {"", "$$     CATIA APT VERSION 1.0\n", "$$ Mastercam\n",
                           "PPRINT/APTCL-SPEC,MAKINO-FF,1\n", "UNIT/MM\n"}) {
    const auto read = read_body(std::string(head) + kMixed);
    EXPECT_NE(read.error.find("a point without a tool axis after a tilted one"), std::string::npos)
        << head;
    EXPECT_NE(read.error.find("--dialect nx"), std::string::npos) << read.error;
    EXPECT_EQ(read.motion().size(), 1U) << head;
  }
}

TEST(MissingAxis, IsWhatTheCallerSays) {
  for (const Dialect dialect :
       {Dialect::kNx, Dialect::kCatia, Dialect::kMastercam, Dialect::kHyperMill, Dialect::kIso}) {
    EXPECT_NEAR(second_axis("", written_by(dialect))[1], .6, 1e-15);
  }
  EXPECT_EQ(second_axis("", written_by(Dialect::kCreo)), (Array3{0, 0, 1}));
  EXPECT_EQ(second_axis("TOOL PATH/A,TOOL,B\n", written_by(Dialect::kCreo)), (Array3{0, 0, 1}));
}

TEST(MissingAxis, IsNoQuestionWhereTheAxisIsPlusZOrAWordNamesIt) {
  EXPECT_EQ(read_body("GOTO/1,2,3,0,0,1\nGOTO/4,5,6\n").error, "");
  const auto named = read_body("TLAXIS/0,.6,.8\nGOTO/1,2,3\nGOTO/4,5,6\n");
  ASSERT_EQ(named.error, "");
  EXPECT_NEAR(named.motion().at(1).axis[1], .6, 1e-15);
  const auto off = read_body("MULTAX/ON\nGOTO/1,2,3,0,.6,.8\nMULTAX/OFF\nGOTO/4,5,6\n");
  ASSERT_EQ(off.error, "");
  EXPECT_EQ(off.motion().at(1).axis, (Array3{0, 0, 1}));
}

TEST(MissingAxis, IsRefusedWhereWordsOfTwoSystemsMeet) {
  const auto read = read_body(std::string("TOOL PATH/A,TOOL,B\nCSI_STOCK/1\n") + kMixed);
  EXPECT_NE(read.error.find("a point without a tool axis"), std::string::npos);
  EXPECT_TRUE(read.warned_of("CSI_STOCK is a word of SolidWorks CAM APT"));
}

TEST(PointList, OfCreoGivesAPointForEachLine) {
  const auto read =
      read_body("GOTO / 10, 0, 0\n20, 0, 5\n30, 0, 5, 0, .6, .8\n", written_by(Dialect::kCreo));
  ASSERT_EQ(read.error, "");
  ASSERT_EQ(read.motion().size(), 3U);
  EXPECT_EQ(read.motion()[1].tip_mm, (Array3{20, 0, 5}));
}

TEST(PointList, IsRefusedWhereALineMayBeALostToolAxis) {
  EXPECT_NE(read_body("GOTO/1,2,3\n0,.6,.8\n", written_by(Dialect::kCreo))
                .error.find("a point or a tool axis"),
            std::string::npos);
  EXPECT_NE(read_body("GOTO/1,2,3,\nGOTO/1,2,4\n").error, "");  // a comma promises more
}

TEST(Statement, NumbersInFrontOfAWordAreTakenOff) {
  const auto read = read_body("N10 GOTO/1,2,3\nN20,GOTO/4,5,6\nN30 , RAPID\nGOTO/7,8,9\n");
  ASSERT_EQ(read.error, "");
  EXPECT_EQ(read.motion().size(), 3U);
  EXPECT_EQ(read.motion()[2].kind, BlockKind::kRapid);
}

}  // namespace
}  // namespace meridian::cl
