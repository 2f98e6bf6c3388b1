// SPDX-License-Identifier: Apache-2.0
// What is refused, by its line and its name.
#include <gtest/gtest.h>

#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

struct Case {
  const char* line;
  const char* says;
};

/// `body` is refused in line 5, after a first point in line 4.
void expect_refused(const Case& c) {
  const ReadText read = read_nc("G0 X0. Y0. Z0.\n" + std::string(c.line) + "\n");
  EXPECT_EQ(read.error_line, 5U) << c.line << ": " << read.error;
  EXPECT_NE(read.error.find(c.says), std::string::npos) << c.line << ": " << read.error;
}

/// How many lines of a program are refused.
std::size_t refusals_of(const std::string& text, const ClReaderOptions& options) {
  cl::ClReader reader(std::string_view(text), "part.nc", options);
  std::size_t count = 0;
  while (true) {
    const auto block = reader.next();
    if (block && !*block) return count;
    if (block) continue;
    ++count;
    if (!reader.go_on()) return count;
  }
}

TEST(NcRefusal, OfALineHidesWhatOthersLackByIt) {
  const auto fanuc = without_machine();
  EXPECT_EQ(refusals_of("G90 G21\nG0 X[1+1] Y0.\nZ10.\nG1 Z0. F100.\nM30\n", fanuc), 1U)
      << "the G0 stood in the refused line";
  EXPECT_EQ(refusals_of("G90 G21\nG0 X0. Y0. Z9.\nG1 X[2] F100.\nX3.\nX4.\nM30\n", fanuc), 1U)
      << "so did F";
  EXPECT_EQ(refusals_of("G90 G21\nZ10.\nM30\n", fanuc), 1U) << "nothing hides it";
  EXPECT_EQ(refusals_of("G90 G21\nG0 X[1] Y0.\nG41 X1.\nM30\n", fanuc), 2U);
}

TEST(NcRefusal, NamesWhatOnlyAControlCanRun) {
  for (const Case& c : std::vector<Case>{{"#1=2", "a variable (#)"},
                                         {"X[#1]", "an expression"},
                                         {"IF [#1 EQ 1] GOTO 5", "the word IF"},
                                         {"WHILE [#1 LT 5] DO1", "the word WHILE"},
                                         {"GOTO 5", "the word GOTO"},
                                         {"G65 P9010", "G65: a macro call"},
                                         {"G66 P9010", "G66: a macro call"},
                                         {"M98 P1000", "M98: a subprogram"},
                                         {"M99", "end a main program with M30"},
                                         {"G28", "moves all axes on some controls"},
                                         {"O1\nO2", "a second program number"},
                                         {"G31 Z-5. F100.", "G31: probing"},
                                         {"G38.2 Z-5. F100.", "G38.2: probing"}}) {
    if (std::string(c.line).find('\n') == std::string::npos) expect_refused(c);
  }
  EXPECT_NE(read_nc("O1\nG0 X0. Y0. Z0.\nO2\n").error.find("a second program number"),
            std::string::npos);
}

TEST(NcRefusal, NamesWhatTheControlKeepsForItself) {
  for (const Case& c :
       std::vector<Case>{{"G68.2 P1 X0. Y0. Z0. I10. J20. K0.", "has two readings"},
                         {"G68.2 P4 X0. Y0. Z0. I0. J0. K0.", "angles of its projections"},
                         {"G68.3", "G68.3: a tilted plane"},
                         {"G53.1", "G53.1, but no G68.2"},
                         {"G68 R30.", "G68: a rotation"},
                         {"G41 D1", "G41: radius compensation"},
                         {"G42 D1", "G42: radius compensation"},
                         {"G92 X1.", "G92: changes offsets"},
                         {"G10 L2 P1 X0.", "G10: changes offsets"},
                         {"G91 G30 Z0.", "--machine FILE"},
                         {"G16", "G16: polar"},
                         {"G15 H2", "G15 H2: a work offset of Okuma"},
                         {"G54.2 P1", "G54.2: changes offsets"},
                         {"G54.4 P1", "G54.4: changes offsets"},
                         {"G51 P2.", "G51: scaling"},
                         {"G96 S100", "G96: surface speed"},
                         {"G84 Z-10. R2. F100.", "G84: a canned cycle"},
                         {"G123", "G123 is not known here; --allow-unknown G123"}}) {
    expect_refused(c);
  }
  const ReadText read = read_nc("G54\nG0 X0. Y0. Z0.\nG55\nX1.\n");
  EXPECT_NE(read.error.find("a second work offset (G55 after G54)"), std::string::npos);
}

TEST(NcRefusal, NamesWhatIsWrongWithAMotion) {
  for (const Case& c :
       std::vector<Case>{{"G1 X1. A10.", "a cut without tool-centre control while a rotary axis"},
                         {"G2 X1.", "an arc without R and without a centre"},
                         {"G2 X10. R1.", "R 1 is too small"},
                         {"G2 X0. R5.", "ends where it begins"},
                         {"G2 X10. I3.", "do not lie on one circle"},
                         {"G2 X10. I5. K1.", "K lies across the plane"},
                         {"G2 X10. I5. P3.", "several turns in one block"},
                         {"G2 X10. I5. C90.", "rotary axes turn"},
                         {"G1 X1. I1.", "word I in a block that is no arc"},
                         {"G1 U1.", "word U moves an axis beside"},
                         {"G0 G1 X1.", "two G codes of one group"},
                         {"G1 X2000000.", "beyond 1e6 mm"},
                         {"G93 G1 X1.", "under G93 every cutting block needs its own F"},
                         {"G95 G1 X1. F0.1", "no spindle speed is in force"},
                         {"G1 X1. F0.", "F0. is no feed"},
                         {"G4", "G4 needs one time"},
                         {"G20", "the unit changes"},
                         {"M3", "no S gave its speed"},
                         {"M6", "no T named the tool"},
                         {"T1.5", "is not a whole number"},
                         {"Q1 Z1. $", "no NC word"}}) {
    expect_refused(c);
  }
}

TEST(NcRefusal, NamesWhatTheBeginLacks) {
  EXPECT_NE(cl::read_text("%\nG21\nX1. Y2. Z3.\nM30\n", without_machine())
                .error.find("no G0, G1, G2 or G3 before it"),
            std::string::npos);
  EXPECT_NE(cl::read_text("%\nG21\nG0 X0. Y0. Z0.\nG1 X1.\nM30\n", without_machine())
                .error.find("no F before it; --feed"),
            std::string::npos);
  EXPECT_NE(read_nc("G0 X0. Y0.\nG1 X1.\n").error.find("where it begins is not known"),
            std::string::npos);
  EXPECT_NE(read_nc("G91 G0 X1. Y0. Z0.\n").error.find("G91, but where X stands"),
            std::string::npos);
  EXPECT_NE(read_nc("").error.find("there is no motion"), std::string::npos);
}

TEST(NcRefusal, NamesWhatAVectorLacks) {
  EXPECT_NE(read_nc("G43.5 H1\nG0 X0. Y0. Z0. I1.\n").error.find("all three of I, J and K"),
            std::string::npos);
  EXPECT_NE(read_nc("G43.5 H1\nG0 X0. Y0. Z0. I0. J0. K0.\n").error.find("no direction"),
            std::string::npos);
  EXPECT_NE(read_nc("G43.5 H1\nG0 X0. Y0. Z0. A5.\n").error.find("rotary word A under G43.5"),
            std::string::npos);
  EXPECT_NE(read_nc("G0 A5.\nG43.5 H1\nG0 X0. Y0. Z0.\n").error.find("no I J K yet"),
            std::string::npos);
}

TEST(NcRefusal, AsksForTheMachineWhereRotaryWordsNeedIt) {
  const std::string body = "G43.4 H1\nG0 X0. Y0. Z0. A10. C20.\n";
  EXPECT_NE(read_nc(body).error.find("need the machine that they are written for"),
            std::string::npos);
  EXPECT_NE(read_nc(body).error.find("--machine FILE"), std::string::npos);
  EXPECT_NE(
      read_nc(body, on(shipped("head-table-bc"))).error.find("no rotary axis with the NC word A"),
      std::string::npos);
  EXPECT_NE(read_nc(body, on(shipped("lai-hybrid"))).error.find("has a stage"), std::string::npos);
}

TEST(NcRefusal, GoesOnToTheNextLine) {
  const std::string text = "%\nG21 G0 X0. Y0. Z0.\nG65 P1\nG41 D1\nM30\n%\n";
  cl::ClReader reader(std::string_view(text), "part.nc", without_machine());
  int refusals = 0;
  for (auto block = reader.next(); !block || *block; block = reader.next()) {
    if (block) continue;
    ++refusals;
    ASSERT_TRUE(reader.go_on());
  }
  EXPECT_EQ(refusals, 2);
}

}  // namespace
}  // namespace meridian::nc
