// SPDX-License-Identifier: Apache-2.0
// A posted program passes on every shipped machine; spoilt ones fail, whatever was spoilt.
#include "service/programs/proof/program_check.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "support/shipped_machines.hpp"
#include "unit/post/written.hpp"

namespace meridian {
namespace {

// Tilts and moves at once, so that rows lie dense; two CL points on one straight line.
const std::string kPart =
    "UNITS/MM\nMULTAX/ON\nFEDRAT/1200,MMPM\nGOTO/60,0,0,0,0,1\nGOTO/60,30,5,0.1,0.05,0.9937303457\n"
    "GOTO/20,60,10,-0.1,0.1,0.9899494937\nRAPID\nGOTO/20,60,40,-0.1,0.1,0.9899494937\nFINI\n";

MachineModel machine(const std::string& name) {
  MachineModel model = test::shipped(name);
  if (model.family == MachineFamily::kRobot) {
    config::place_workpiece(model, config::parse_frame("850,0,250"));
  }
  return model;
}

ToolTable tools_of(const MachineModel& model) {
  return ToolTable({{1, model.tool_length_mm, 5}, {2, model.tool_length_mm + 20, 5}});
}

std::vector<ClBlock> blocks_of(const std::string& text) {
  std::vector<ClBlock> blocks;
  cl::ClReader reader(text, "part.apt");
  for (auto block = reader.next(); block && *block; block = reader.next()) {
    blocks.push_back(**block);
  }
  return blocks;
}

/// What is found of `program` as the program of `part`; an unreadable one is a finding too.
proof::ProgramReport checked(const std::string& program, const std::string& part,
                             const MachineModel& model, double tip_mm = 0) {
  std::istringstream in(program);
  const auto steps = proof::read_joint_program(in, model);
  if (!steps) {
    proof::ProgramReport report;
    report.findings.push_back({steps.error().message, steps.error().line, 0});
    return report;
  }
  return proof::check_program(*steps, blocks_of(part), model, tools_of(model), {tip_mm, 0});
}

std::string posted(const MachineModel& model, const std::string& part = kPart) {
  const auto program = test::written(part, model);
  EXPECT_TRUE(program) << program.error().line << ": " << program.error().message;
  return program ? program->text : "";
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

class ShippedProgram : public testing::TestWithParam<std::string> {};

TEST_P(ShippedProgram, PassesWithinTheTolerancesItWasPostedWith) {
  const MachineModel model = machine(GetParam());
  const auto report = checked(posted(model), kPart, model);
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_GT(report.moves, 3U);
  EXPECT_GT(report.tip_mm.value, 0);
  EXPECT_LE(report.tip_mm.value, model.tolerances.tip_mm);
  EXPECT_LE(report.axis_rad.value, model.tolerances.axis_rad);
}

INSTANTIATE_TEST_SUITE_P(Shipped, ShippedProgram, testing::ValuesIn(test::shipped_machines()),
                         test::test_name);

TEST(ProgramCheck, ADigitAlteredInAnyAxisWordFails) {
  const MachineModel model = machine("trunnion-ac");
  const std::vector<std::string> lines = lines_of(posted(model));
  int spoilt = 0;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    if (lines[n].rfind("G1 ", 0) != 0) continue;
    for (const char letter : std::string("XYZAC")) {
      const std::size_t word = lines[n].find(std::string(" ") + letter);
      if (word == std::string::npos) continue;
      const std::size_t digit = lines[n].find('.', word) + 1;  // a tenth of mm or degree
      std::vector<std::string> altered = lines;
      altered[n][digit] = static_cast<char>('0' + (altered[n][digit] - '0' + 5) % 10);
      EXPECT_FALSE(checked(text_of(altered), kPart, model).passed()) << altered[n];
      ++spoilt;
    }
  }
  EXPECT_GT(spoilt, 50);
}

TEST(ProgramCheck, AMissingRowFails) {
  const MachineModel model = machine("trunnion-ac");
  post::PostOptions options;
  options.has_line_words = true;
  const auto program = test::written(kPart, model, options);
  ASSERT_TRUE(program);
  const std::vector<std::string> lines = lines_of(program->text);
  int cuts = 0, found = 0, points = 0;
  for (std::size_t n = 0; n + 1 < lines.size(); ++n) {
    const std::size_t at = lines[n].find(" G1 ");
    if (at == std::string::npos) continue;
    std::vector<std::string> shorter = lines;
    shorter.erase(shorter.begin() + static_cast<std::ptrdiff_t>(n));
    const bool is_found = !checked(text_of(shorter), kPart, model).passed();
    ++cuts;
    if (is_found) ++found;
    if (lines[n + 1].substr(0, at) == lines[n].substr(0, at)) continue;
    EXPECT_TRUE(is_found) << "the row of a CL point: " << lines[n];
    ++points;
  }
  EXPECT_EQ(points, 3);
  // Rows are found by halves and doubles: a few are shorter than the tolerance asks for, and the
  // program keeps it without them.
  EXPECT_GT(found, cuts * 3 / 4) << cuts;
  EXPECT_GT(cuts, 50);
}

TEST(ProgramCheck, AWrongAxisLetterFails) {
  const MachineModel model = machine("trunnion-ac");
  std::string text = posted(model);
  std::size_t at = text.find("\nG1 X");
  for (int n = 0; n < 3 && at != std::string::npos; ++n) at = text.find("\nG1 X", at + 1);
  ASSERT_NE(at, std::string::npos);
  text[at + 4] = 'B';
  EXPECT_FALSE(checked(text, kPart, model).passed());
}

TEST(ProgramCheck, RowsInAnotherOrderFail) {
  const MachineModel model = machine("trunnion-ac");
  std::vector<std::string> lines = lines_of(posted(model));
  std::size_t n = lines.size() / 2;
  std::swap(lines[n], lines[n + 6]);
  EXPECT_FALSE(checked(text_of(lines), kPart, model).passed());
}

TEST(ProgramCheck, AProgramForAnotherPartOrAnotherToolFails) {
  const MachineModel model = machine("trunnion-ac");
  std::string other = kPart;
  other.replace(other.find("GOTO/60,30,5"), 12, "GOTO/60,30,6");
  EXPECT_FALSE(checked(posted(model), other, model).passed());
  MachineModel longer = model;
  longer.tool_length_mm += 0.5;
  EXPECT_FALSE(checked(posted(model), kPart, longer).passed());
}

TEST(ProgramCheck, AToolChangeBeginsAnew) {
  const MachineModel model = machine("trunnion-ac");
  const std::string part =
      "UNITS/MM\nMULTAX/ON\nLOADTL/1\nFEDRAT/600,MMPM\nGOTO/0,0,0,0,0,1\nGOTO/30,0,0\nLOADTL/2\n"
      "GOTO/50,20,0\nGOTO/50,40,0\nFINI\n";
  const std::string text = posted(model, part);
  const auto report = checked(text, part, model);
  EXPECT_TRUE(report.passed()) << to_text(report) << text;
  EXPECT_EQ(report.sections, 2U);
  std::string wrong = text;
  wrong.replace(wrong.find("T2 M6"), 5, "T1 M6");
  EXPECT_FALSE(checked(wrong, part, model).passed());
}

TEST(ProgramCheck, CutsBehindTheEndFail) {
  const MachineModel model = machine("trunnion-ac");
  std::string text = posted(model);
  text.insert(text.find("G94\nM5"), "G1 X0. F5.\n");
  const auto report = checked(text, kPart, model);
  ASSERT_FALSE(report.passed());
  EXPECT_EQ(report.findings[0].text, "cuts after the last CL point");
}

TEST(ProgramCheck, TheDeviationIsTheOneWorkedOutByHand) {
  // One straight block over the rows (0,0), (30,0.004), (60,0): 0.004 mm beside it in the middle.
  const MachineModel model = machine("trunnion-ac");
  const std::string part =
      "UNITS/MM\nMULTAX/ON\nFEDRAT/600,MMPM\nGOTO/0,0,0,0,0,1\nGOTO/60,0,0,0,0,1\nFINI\n";
  std::string text = posted(model, part);
  const std::size_t at = text.find("G1 X60.0000");
  ASSERT_NE(at, std::string::npos) << text;
  text.insert(at, "G1 X30.0000 Y0.0040 F20.000\n");
  text.insert(text.find(" F", text.find("G1 X60.0000")), " Y0.0000");
  const auto report = checked(text, part, model, 0.005);
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_NEAR(report.tip_mm.value, 0.004, 1e-6);
  EXPECT_FALSE(checked(text, part, model, 0.003).passed());
}

}  // namespace
}  // namespace meridian
