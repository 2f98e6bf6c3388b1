// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/text/statement.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

namespace meridian::cl {
namespace {

struct Taken {
  std::uint32_t line = 0;
  std::string major;
  std::string rest;
  std::vector<std::string> arguments;
  Statement::Source source = Statement::Source::kText;
  std::vector<double> numbers;
};

std::vector<Taken> statements(std::string_view text, StatementReader::Outcome* last = nullptr) {
  LineSource lines(text);
  StatementReader reader(lines);
  Statement s;
  std::vector<Taken> out;
  StatementReader::Outcome outcome{};
  while ((outcome = reader.next(s)) == StatementReader::Outcome::kStatement) {
    Taken taken{s.line, std::string(s.major), std::string(s.rest), {}, s.source, {}};
    for (std::size_t i = 0; i < s.argument_count; ++i) {
      taken.arguments.emplace_back(s.arguments[i].text);
      if (s.arguments[i].is_number) taken.numbers.push_back(s.arguments[i].number);
    }
    out.push_back(taken);
  }
  if (last != nullptr) *last = outcome;
  return out;
}

using Numbers = std::vector<double>;

TEST(Statement, ContinuesOnDollarWithoutComma) {
  const auto s = statements("GOTO / -50.0 , .5 , 30.0 $\r\n.0 , .34 , -.93\r\nRAPID\r\n");
  ASSERT_EQ(s.size(), 2U);
  EXPECT_EQ(s[0].major, "GOTO");
  EXPECT_EQ(s[0].line, 1U);
  EXPECT_EQ(s[0].numbers, (Numbers{-50, .5, 30, 0, .34, -.93}));
  EXPECT_EQ(s[1].major, "RAPID");
  EXPECT_EQ(s[1].line, 3U);
}

TEST(Statement, ContinuesOnDollarWithComma) {
  const auto s = statements("GOTO / 1.0000000000, 2.0000000000, 3.0,  $\n 0.0, 0.0, 1.0\n");
  ASSERT_EQ(s.size(), 1U);
  EXPECT_EQ(s[0].numbers, (Numbers{1, 2, 3, 0, 0, 1}));
}

TEST(Statement, IgnoresWhatStandsBehindTheDollar) {
  const auto s = statements("GOTO/1,2,$ sequence 00010\n3\n");
  ASSERT_EQ(s.size(), 1U);
  EXPECT_EQ(s[0].numbers, (Numbers{1, 2, 3}));
}

TEST(Statement, LetsCommentsStandBetweenContinuationLines) {
  const auto s = statements("GOTO/1,2,3,$\n$$ a note\n\n0,0,1 $$ and one behind\n");
  ASSERT_EQ(s.size(), 1U);
  EXPECT_EQ(s[0].numbers, (Numbers{1, 2, 3, 0, 0, 1}));
}

TEST(Statement, SkipsPlainCommentsAndTheIsoHeader) {
  const auto s = statements("$$ISO\n$$ centerline data\n  $$ indented\nFINI\n");
  ASSERT_EQ(s.size(), 1U);
  EXPECT_EQ(s[0].major, "FINI");
  EXPECT_EQ(s[0].line, 4U);
}

TEST(Statement, GivesCommentsThatCarryDataWithTheirOwnContinuation) {
  const auto s = statements(
      "$$-> CSYS / 1.0, 0.0, 0.0, 5.0,  $\n"
      "            0.0, 1.0, 0.0, 6.0,  $\n"
      "            0.0, 0.0, 1.0, 7.0\n"
      "$$-> CUTTER / 6.000000\n"
      "GOTO / 1, 2, 3\n");
  ASSERT_EQ(s.size(), 3U);
  EXPECT_EQ(s[0].source, Statement::Source::kCommentData);
  EXPECT_EQ(s[0].major, "CSYS");
  EXPECT_EQ(s[0].numbers, (Numbers{1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7}));
  EXPECT_EQ(s[1].major, "CUTTER");
  EXPECT_EQ(s[2].source, Statement::Source::kText);
  EXPECT_EQ(s[2].line, 5U);
}

TEST(Statement, SaysWhatIsWrongWithItsArgumentsAndForgetsItWithTheNext) {
  using Fault = Statement::ArgumentFault;
  std::string many = "GOTO/1";
  for (std::size_t i = 1; i <= Statement::kMaxArguments; ++i) many += ",1";
  const std::string text = "GOTO/1,2,3\nGOTO/1,,3\nGOTO/,1\nGOTO/1,\nGOTO/1,2\n" + many +
                           "\nGOTO/1\n" + many.substr(0, 6) + "," + many.substr(6) + "\nFINI\n";
  LineSource lines(text);
  StatementReader reader(lines);
  Statement s;
  for (const Fault want : {Fault::kNone, Fault::kEmpty, Fault::kEmpty, Fault::kEmpty, Fault::kNone,
                           Fault::kTooMany, Fault::kNone, Fault::kEmpty, Fault::kNone}) {
    ASSERT_EQ(reader.next(s), StatementReader::Outcome::kStatement);
    EXPECT_EQ(s.fault, want) << "line " << s.line;
    EXPECT_EQ(s.all_numbers(), want == Fault::kNone) << "line " << s.line;
    EXPECT_EQ(s.has_empty_argument(), want == Fault::kEmpty) << "line " << s.line;
  }
}

TEST(Statement, GathersTheMatrixOfCatiaFromComments) {
  const auto s = statements(
      "$$*CATIA0\n$$ 001\n$$ Axe d'usinage \xe9\n"
      "$$     0.00000     1.00000     0.00000    10.00000\n"
      "$$     0.00000     0.00000     1.00000    20.00000\n"
      "$$     1.00000     0.00000     0.00000    30.00000\n"
      "GOTO/1,2,3\n");
  ASSERT_EQ(s.size(), 2U);
  EXPECT_EQ(s[0].source, Statement::Source::kCatiaMatrix);
  EXPECT_EQ(s[0].numbers, (Numbers{0, 1, 0, 10, 0, 0, 1, 20, 1, 0, 0, 30}));
  EXPECT_EQ(s[1].major, "GOTO");
}

TEST(Statement, DropsAMatrixOfCatiaThatIsNotWhole) {
  const auto s = statements("$$*CATIA0\n$$ 1 0 0 0\n$$ 0 1 0 0\nGOTO/1,2,3\n");
  ASSERT_EQ(s.size(), 1U);
  EXPECT_EQ(s[0].major, "GOTO");
}

TEST(Statement, CutsNumbersThatBlanksSeparate) {
  const auto s = statements("GOTO/-10.0 5.0 0.0 -0.2414 -0.1345 0.9611");  // no line end either
  ASSERT_EQ(s.size(), 1U);
  EXPECT_EQ(s[0].numbers, (Numbers{-10, 5, 0, -0.2414, -0.1345, 0.9611}));
}

TEST(Statement, TakesBlanksAroundTheSlash) {
  const auto s = statements("LOADTL / 1\nFEDRAT /  1000 , MMPM\nGOTO  /  1.,2.,3.\nRAPID \n");
  ASSERT_EQ(s.size(), 4U);
  EXPECT_EQ(s[0].major, "LOADTL");
  EXPECT_EQ(s[1].arguments, (std::vector<std::string>{"1000", "MMPM"}));
  EXPECT_EQ(s[2].numbers, (Numbers{1, 2, 3}));
  EXPECT_EQ(s[3].major, "RAPID");
  EXPECT_EQ(s[3].arguments.size(), 0U);
}

TEST(Statement, KeepsFreeTextWhole) {
  const auto s = statements(
      "INSERT/(\"Roughing\") [2/3] costs $5, $\nPARTNO PI\xc8"
      "CE \xe0 usiner\nPPRINT/A,$,B\nEND\n");
  ASSERT_EQ(s.size(), 4U);
  EXPECT_EQ(s[0].rest, "(\"Roughing\") [2/3] costs $5, $");
  EXPECT_EQ(s[0].arguments.size(), 0U);
  EXPECT_EQ(s[1].major, "PARTNO");
  EXPECT_EQ(s[1].rest,
            "PI\xc8"
            "CE \xe0 usiner");
  EXPECT_EQ(s[2].rest, "A,$,B");
  EXPECT_EQ(s[3].major, "END");
}

TEST(Statement, KnowsTheMajorWordsOfTwoPartsAndWithHyphens) {
  const auto s = statements("TOOL PATH/ROUGH,TOOL,MILL-20MM\nEND-OF-PATH\n");
  ASSERT_EQ(s.size(), 2U);
  EXPECT_EQ(s[0].major, "TOOL PATH");
  EXPECT_EQ(s[0].arguments, (std::vector<std::string>{"ROUGH", "TOOL", "MILL-20MM"}));
  EXPECT_EQ(s[1].major, "END-OF-PATH");
}

TEST(Statement, CapitalisesTheMajorWord) {
  const auto s = statements("goto/1,2,3\n");
  ASSERT_EQ(s.size(), 1U);
  EXPECT_EQ(s[0].major, "GOTO");
}

TEST(Statement, LeavesOrphanNumbersWithoutAMajorWord) {
  const auto s = statements("0.5, 0.3, 0.8\n");
  ASSERT_EQ(s.size(), 1U);
  EXPECT_EQ(s[0].major, "");
}

TEST(Statement, ReportsAStatementThatTheFileCutsOff) {
  StatementReader::Outcome last{};
  const auto s = statements("GOTO/1,2,3\nGOTO/1,2,$\n", &last);
  EXPECT_EQ(s.size(), 1U);
  EXPECT_EQ(last, StatementReader::Outcome::kCutOff);
}

TEST(Statement, ReportsBinaryDataAndEndlessLines) {
  StatementReader::Outcome last{};
  (void)statements(std::string_view("GOTO/1,2,3\nGO\0TO/1\n", 20), &last);
  EXPECT_EQ(last, StatementReader::Outcome::kBinary);
  (void)statements("GOTO/" + std::string(LineSource::kLongestLine, '1') + "\n", &last);
  EXPECT_EQ(last, StatementReader::Outcome::kTooLong);
}

TEST(LineSource, GivesTheSameLinesFromAStreamAsFromMemory) {
  std::string text = "\xef\xbb\xbf";
  for (int i = 0; i < 40000; ++i) {
    text += "line " + std::to_string(i * 7919) + (i % 3 == 0 ? "\r\n" : "\n");
  }
  text += "last\x1a";
  std::istringstream stream(text);
  LineSource from_stream(stream);
  LineSource from_memory{std::string_view(text)};
  std::string_view a;
  std::string_view b;
  std::size_t lines = 0;
  while (from_memory.next(b) == LineSource::Outcome::kLine) {
    ASSERT_EQ(from_stream.next(a), LineSource::Outcome::kLine);
    ASSERT_EQ(a, b) << lines;
    ++lines;
  }
  EXPECT_EQ(from_stream.next(a), LineSource::Outcome::kEnd);
  EXPECT_EQ(lines, 40001U);
  EXPECT_EQ(b, "last");
  EXPECT_EQ(from_stream.bytes(), text.size());
}

TEST(LineSource, TakesCrAloneForALineEndWhereThereIsNoOther) {
  const auto lines_of = [](std::string_view text) {
    LineSource lines(text);
    std::vector<std::string> out;
    for (std::string_view line; lines.next(line) == LineSource::Outcome::kLine;) {
      out.emplace_back(line);
    }
    return out;
  };
  EXPECT_EQ(lines_of("UNITS/MM\rGOTO/1,2,3\rFINI\r"),
            (std::vector<std::string>{"UNITS/MM", "GOTO/1,2,3", "FINI"}));
  EXPECT_EQ(lines_of("UNITS/MM\rGOTO/1,2,3\r\nFINI"),
            (std::vector<std::string>{"UNITS/MM\rGOTO/1,2,3", "FINI"}));
}

}  // namespace
}  // namespace meridian::cl
