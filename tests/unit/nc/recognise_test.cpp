// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/text_file.hpp"
#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

constexpr std::string_view kVectors = "G21 G90\nG43.5 H1\nG0 X0. Y0. Z9. I0. J0. K1.\nM30\n";
constexpr std::string_view kPlain = "G21 G90\nG0 X0. Y0. Z9.\nG1 X1. F100\nM30\n";

ClReaderOptions without_dialect() {
  ClReaderOptions options = without_machine();
  options.dialect.reset();
  return options;
}

TEST(NcPrograms, AreKnownByToolCentreControl) {
  const ReadText read = cl::read_text(kVectors, without_dialect());
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.summary.dialect, "NC program, Fanuc and ISO words");
  EXPECT_EQ(read.summary.dialect_reason, "G43.5");
}

TEST(NcPrograms, AreKnownByMarkAndNumber) {
  const ReadText read = cl::read_text("%\nO1234\n" + std::string(kPlain), without_dialect());
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.summary.dialect_reason, "% and O number");
}

TEST(NcPrograms, AreKnownByTheirNumberOrName) {
  for (const char* head : {"O1001 (BLADE)\n", ":1001\n", "O7 G17\n", "%\n<BLADE-1>\n"}) {
    const ReadText read = cl::read_text(head + std::string(kPlain), without_dialect());
    EXPECT_EQ(read.error, "") << head;
    EXPECT_EQ(read.blocks.size(), 3U) << head;
  }
  EXPECT_NE(
      cl::read_text("o100 sub\n" + std::string(kPlain) + "o100 endsub\n", without_dialect()).error,
      "");
}

TEST(NcPrograms, AreKnownByCodesThatNoOtherControlHas) {
  for (const char* head : {"G05.1 Q1", "G5.1Q1", "G05 P10000", "G08P1", "N10G43.4H1",
                           "N10 G17 G68.2 X0. Y0. Z0. I0. J0. K0.\nG69"}) {
    const ReadText read =
        cl::read_text("%\n" + std::string(head) + "\n" + std::string(kPlain), without_dialect());
    EXPECT_EQ(read.summary.dialect, "NC program, Fanuc and ISO words") << head << read.error;
  }
  for (const char* head : {"G5.1 X1. Y1. I1. J0.", "G05 X1. Y1. I0. J3. P0. Q-3.", "G8", "(G68.2)",
                           "G43.45", "; G43.4"}) {
    const ReadText read =
        cl::read_text("%\n" + std::string(head) + "\n" + std::string(kPlain), without_dialect());
    EXPECT_NE(read.error.find("this is an NC program"), std::string::npos) << head << read.error;
  }
}

TEST(NcPrograms, MayHaveTabsAndCarriageReturnsAlone) {
  for (const char* text : {"%\rO1\rG21 G90 G17\rG0 X0. Y0. Z9.\rM30\r",
                           "0 BEGIN\tPGM\tA MM\r1 L\tX+0 Y+0\tZ+0 R0 FMAX\r2 END\tPGM A MM\r"}) {
    const ReadText read = cl::read_text(text, without_dialect());
    EXPECT_EQ(read.error, "") << text;
    EXPECT_EQ(read.motion().size(), 1U) << text;
  }
}

TEST(NcPrograms, OfTwoControlsAreReadAsFanucsWhereTheCallerSaysIt) {
  const ReadText read = cl::read_text("%\nG43 H1\n" + std::string(kPlain), without_dialect());
  EXPECT_NE(read.error.find("--dialect fanuc reads it where G43 is a word of Fanuc's"),
            std::string::npos)
      << read.error;
}

TEST(NcPrograms, OfSiemensAreKnownByTheirNames) {
  const ReadText read =
      cl::read_text("TRAORI\nG54 G710\nG0 X0 Y0 Z9 A3=0 B3=0 C3=1\nM30\n", without_dialect());
  EXPECT_EQ(read.error, "");
  EXPECT_EQ(read.summary.dialect_reason, "TRAORI");
}

TEST(NcPrograms, AreNotGuessed) {
  const ReadText read = cl::read_text(kPlain, without_dialect());
  EXPECT_NE(
      read.error.find(
          "this is an NC program (G code), not a CL file; --dialect fanuc, siemens or heidenhain"),
      std::string::npos)
      << read.error;
  EXPECT_EQ(cl::read_text(kPlain, without_machine()).error, "");
}

TEST(NcPrograms, OfOtherControlsAreRefusedAsBefore) {
  const ReadText read = cl::read_text("G21 G90\nM428\nG0 X0. Y0. Z9.\nM2\n", without_dialect());
  EXPECT_NE(read.error.find("a LinuxCNC NC program (M428)"), std::string::npos) << read.error;
}

TEST(NcPrograms, AreRefusedWhereTheCallerSaysItIsACamFile) {
  ClReaderOptions options = without_dialect();
  options.dialect = cl::Dialect::kNx;
  EXPECT_NE(cl::read_text(kVectors, options).error.find("a Fanuc NC program"), std::string::npos);
}

TEST(NcPrograms, AreRefusedByReadersThatWereNotTaughtThem) {
  EXPECT_NE(cl::read_text(kVectors).error.find("a Fanuc NC program (G43.5), not a CL file"),
            std::string::npos);
}

TEST(NcDocumentation, ShowsAnExampleThatIsReadWithoutAWarning) {
  const std::string example = test::read_text(MERIDIAN_SOURCE_DIR "/docs/examples/first.nc");
  ASSERT_FALSE(example.empty());
  EXPECT_NE(
      test::read_text(MERIDIAN_SOURCE_DIR "/docs/nc-programs.md").find("```\n" + example + "```"),
      std::string::npos);
  const ReadText read = cl::read_text(example, without_dialect());
  EXPECT_EQ(read.error, "");
  EXPECT_TRUE(read.warnings.empty());
  EXPECT_EQ(read.motion().size(), 4U);
}

}  // namespace
}  // namespace meridian::nc
