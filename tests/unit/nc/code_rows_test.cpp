// SPDX-License-Identifier: Apache-2.0
// Every row of the tables of G and M codes: it runs where it may stand, or is refused by its name.
#include <gtest/gtest.h>

#include <algorithm>

#include "service/programs/nc/words/codes.hpp"
#include "unit/nc/read_nc.hpp"

namespace meridian::nc {
namespace {

std::string name_of_row(const GRow& row) {
  std::string name = "G" + std::to_string(row.tenths / 10);
  if (row.tenths % 10 != 0) name += "." + std::to_string(row.tenths % 10);
  return name;
}

/// A program of Fanuc words in which the code of `row` has what it needs.
std::string program_of(const GRow& row) {
  const std::string code = name_of_row(row), above = "G43 H1\nG0 X0. Y0. Z20.\n";
  switch (row.kind) {
    case GKind::kMotion:
      return above + code + (row.value > 2 ? " X9. R9.\n" : " X9.\n");
    case GKind::kControl:
      return code + (row.tenths == 435 ? " H1\nG0 X0. Y0. Z9. I0. J0. K1.\nG1 X9.\n"
                                       : " H1\nG0 X0. Y0. Z9.\nG1 X9.\n");
    case GKind::kUnit:
      return code + "\n" + above + "G1 X9.\n";
    case GKind::kDistance:
      return above + code + " G1 X9.\n";
    case GKind::kFeed:
      return above + "S100 M3\n" + code + " G1 X9. F5.\n";
    case GKind::kWorkOffset:
      return code + (row.tenths == 541 || row.tenths == 1540 ? " P1\n" : "\n") + above + "G1 X9.\n";
    case GKind::kCycle:
      return above + "S100 M3\n" + code +
             (row.value != 0 ? " X9. Z-9. R2. Q3. P100\nG80\n" : "\nG1 X9.\n");
    case GKind::kReturn:
      return above + code + " G81 X9. Z-9. R2.\nG80\n";
    case GKind::kDwell:
      return above + code + " P100\nG1 X9.\n";
    case GKind::kHome:
    case GKind::kReference:
      return "G91 " + code + " Z0.\nG90\n" + above + "G1 X9.\n";
    case GKind::kMachinePosition:
      return code + " G0 Z0.\n" + above + "G1 X9.\n";
    case GKind::kPlaneTilt:
      return "G43 H1\n" + code + " X0. Y0. Z0. I0. J30. K0.\nG53.1\nG0 X0. Y0. Z20.\nG1 X9.\nG69\n";
    case GKind::kPlaneFollow:
      return "G43 H1\nG68.2 X0. Y0. Z0. I0. J30. K0.\n" + code + "\nG0 X0. Y0. Z20.\nG1 X9.\nG69\n";
    case GKind::kLocalZero:
      return above + code + " X1.\nG1 X9.\n";
    case GKind::kDynamicOffset:
      return "G254\nG43 H1\nG0 X0. Y0. Z20.\nG1 X9.\n" + (row.value == 0 ? code + "\n" : "");
    default:
      return above + code + "\nG1 X9.\n";
  }
}

/// By its name, with the reason and the remedy of its `row`.
template <class Row>
void expect_refused(const ReadText& read, const std::string& code, const Row& row) {
  EXPECT_NE(read.error.find(code + ": " + std::string(row.note)), std::string::npos)
      << code << ": " << read.error;
  EXPECT_NE(read.error.find(row.remedy), std::string::npos) << code << ": " << read.error;
}

TEST(CodeRows, OfFanucRunWhereTheyMayStandOrAreRefused) {
  const ClReaderOptions options = on(shipped("trunnion-ac"));
  for (const GRow& row : g_rows()) {
    const std::string code = name_of_row(row), body = program_of(row);
    const ReadText read = read_nc(body, options);
    if (row.kind == GKind::kRefused) {
      expect_refused(read, code, row);
      continue;
    }
    EXPECT_EQ(read.error, "") << body;
    EXPECT_GE(read.motion().size(), 2U) << body;
    if (row.kind != GKind::kNothing && row.kind != GKind::kSetting &&
        row.kind != GKind::kAxesSetting) {
      continue;
    }
    const auto& skipped = read.summary.skipped;
    EXPECT_TRUE(std::any_of(skipped.begin(), skipped.end(), [&](const auto& s) {
      return s.word == code;
    })) << code;
  }
}

TEST(CodeRows, OfSiemensRunWhereTheyMayStandOrAreRefused) {
  const std::string above = "G0 X0 Y0 Z20\n";
  int rows = 0;
  for (int number = 0; number < 1000; ++number) {
    const GRow* const row = find_siemens_g(number);
    if (row == nullptr) continue;
    ++rows;
    const std::string code = "G" + std::to_string(number);
    std::string body = above + code + "\nG1 X9\n";
    if (row->kind == GKind::kMotion)
      body = above + code + (row->value > 2 ? " X9 CR=9\n" : " X9\n");
    if (row->kind == GKind::kFeed) body = above + "S100 M3\n" + code + " G1 X9 F5\n";
    if (row->kind == GKind::kDwell) body = above + code + " F0.1\nG1 X9\n";
    if (row->kind == GKind::kMachinePosition) body = code + " G0 Z0\n" + above + "G1 X9\n";
    if (row->kind == GKind::kWorkOffset) body = code + "\n" + above + "G1 X9\n";
    // The head of these programs is metric.
    const ReadText read =
        row->kind == GKind::kUnit && row->value != 0
            ? cl::read_text("G17 G90 G94 F60\n" + code + "\n" + body + "M30\n", siemens())
            : read_siemens(body);
    if (row->kind == GKind::kRefused) {
      expect_refused(read, code, *row);
      continue;
    }
    EXPECT_EQ(read.error, "") << body;
    EXPECT_EQ(read.motion().size(), 2U) << body;
  }
  EXPECT_GT(rows, 130);
}

TEST(CodeRows, OfMActOrAreRefused) {
  int rows = 0;
  for (int number = 0; number < 1000; ++number) {
    const MRow* const row = find_m(number);
    if (row == nullptr) continue;
    ++rows;
    const std::string code = "M" + std::to_string(number);
    const ReadText read = read_nc("G0 X0. Y0. Z0.\nS100 T1 " + code + "\nG1 X9.\n");
    if (row->kind == MKind::kRefused) {
      expect_refused(read, code, *row);
      continue;
    }
    EXPECT_EQ(read.motion().size(), row->kind == MKind::kEnd    ? 1U
                                    : row->kind == MKind::kTool ? 1U
                                                                : 2U)
        << code << read.error;
    if (row->kind == MKind::kTool) {
      EXPECT_NE(read.error.find("where it begins is not known"), std::string::npos)
          << "a new tool without G43";
      continue;
    }
    ASSERT_EQ(read.error, "") << code;
    const auto has = [&](BlockKind kind, ActionKind action) {
      return std::any_of(read.blocks.begin(), read.blocks.end(),
                         [&](const ClBlock& b) { return b.kind == kind && b.action == action; });
    };
    const bool acts = row->kind == MKind::kStop ? has(BlockKind::kStop, ActionKind::kStop)
                      : row->kind == MKind::kOptionalStop
                          ? has(BlockKind::kOptionalStop, ActionKind::kStop)
                      : row->kind == MKind::kEnd
                          ? has(BlockKind::kEnd, ActionKind::kNone)
                          : has(BlockKind::kAuxiliary, static_cast<ActionKind>(row->value));
    EXPECT_TRUE(acts) << code;
  }
  EXPECT_GT(rows, 15);
}

}  // namespace
}  // namespace meridian::nc
