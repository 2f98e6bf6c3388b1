// SPDX-License-Identifier: Apache-2.0
// Every row of the table of words and of the table of cycles, in every dialect that has its form.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "read_text.hpp"
#include "service/programs/cl/shapes/hole_cycle.hpp"
#include "service/programs/cl/words/word_table.hpp"

namespace meridian::cl {
namespace {

/// A program of our own as one CAM system writes them (tests/unit/cl/samples).
struct Sample {
  const char* file;
  Dialect named;      ///< kUnknown: the file shows it
  const char* title;  ///< of its dialect
  std::array<double, 3> end_mm;
  std::uint64_t points, arcs, holes;
};

constexpr std::array kSamples = std::to_array<Sample>({
    {"nx.cls", Dialect::kUnknown, "NX CLSF", {5, 5, 10}, 5, 3, 1},
    {"catia.apt", Dialect::kUnknown, "CATIA APT", {0, 0, 100}, 4, 3, 1},
    {"creo.ncl", Dialect::kUnknown, "Creo NCL", {5, 5, 3}, 6, 1, 1},
    {"solidworks.apt", Dialect::kUnknown, "SolidWorks CAM APT", {5, 5, 20}, 6, 1, 1},
    {"mastercam.apt", Dialect::kUnknown, "Mastercam APT", {0, 10, 0}, 3, 1, 0},
    {"hypermill.apt", Dialect::kUnknown, "hyperMILL APT", {10, 0, 20}, 4, 0, 0},
    {"makino.cldata", Dialect::kUnknown, "Makino FF CLDATA", {20, 0, 0}, 3, 1, 0},
    {"hsm.apt", Dialect::kHsm, "HSM APT", {5, 5, 20}, 6, 1, 1},
    {"fusion.apt", Dialect::kFusion, "Autodesk ISO 4343 APT", {5, 5, 15}, 2, 0, 1},
    {"mfgsuite.apt", Dialect::kIso, "ISO 4343 APT", {10, 10, 0}, 3, 1, 0},
    {"camplete.apt", Dialect::kIso, "ISO 4343 APT", {10, 10, 0}, 3, 1, 0},
    {"iso.apt", Dialect::kIso, "ISO 4343 APT", {0, 0, 50}, 6, 0, 1},
});

std::string text_of(const Sample& sample) {
  const std::ifstream in(std::string(MERIDIAN_SOURCE_DIR "/tests/unit/cl/samples/") + sample.file);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// The first word of every line, by plain text: what our reader makes of it is not asked.
std::vector<std::string> major_words(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("TOOL PATH")) line = "TOOL PATH/";
    words.push_back(
        line.substr(0, line.find_first_of("/, ", line.starts_with("TOOL PATH") ? 9 : 0)));
  }
  return words;
}

TEST(Samples, AreReadAsTheirDialectsToTheirEnds) {
  for (const Sample& sample : kSamples) {
    const std::string text = text_of(sample);
    const ReadText read = read_text(
        text, sample.named == Dialect::kUnknown ? ClReaderOptions() : written_by(sample.named));
    ASSERT_EQ(read.error, "") << sample.file;
    EXPECT_EQ(read.summary.dialect, sample.title) << sample.file;
    ASSERT_FALSE(read.motion().empty()) << sample.file;
    EXPECT_LT((to_vector(read.motion().back().tip_mm) - to_vector(sample.end_mm)).norm(), 1e-9)
        << sample.file;
    const auto words = major_words(text);
    const auto points = std::count(words.begin(), words.end(), "GOTO");
    EXPECT_EQ(read.summary.goto_three + read.summary.goto_six, static_cast<std::uint64_t>(points));
    EXPECT_EQ(read.summary.goto_three + read.summary.goto_six, sample.points) << sample.file;
    EXPECT_EQ(read.summary.arcs, sample.arcs) << sample.file;
    EXPECT_EQ(read.summary.holes, sample.holes) << sample.file;
    EXPECT_EQ(read.summary.tools.front(), 3U) << sample.file;
  }
}

/// Rows that do something: neither skipped, nor passed on, nor refused whatever stands behind them.
bool does_something(const WordRow& row) {
  return row.handler != skip && row.handler != skip_flagged && row.handler != pass_on &&
         row.handler != refuse_word;
}

TEST(Samples, HaveEveryRowOfTheTableThatDoesSomething) {
  std::set<std::string> used;
  for (const Sample& sample : kSamples) {
    for (std::string& word : major_words(text_of(sample))) used.insert(std::move(word));
  }
  used.insert("HOME");  // needs the home of a machine: motion_test.cpp
  for (const WordRow& row : word_rows()) {
    if (!does_something(row)) continue;
    EXPECT_TRUE(used.contains(std::string(row.word))) << row.word << row.forms;
  }
}

/// Two points of a file of that dialect, with `line` between them.
ReadText read_between(const DialectTraits& dialect, const std::string& line) {
  const bool is_nx = dialect.dialect == Dialect::kNx;
  return read_text((is_nx ? "TOOL PATH/A,TOOL,B\n" : std::string()) +
                       "UNITS/MM\nFEDRAT/600,MMPM\nGOTO/0,0,0,0,0,1\n" + line +
                       "\nGOTO/1,2,3,0,0,1\n" + (is_nx ? "END-OF-PATH\n" : "FINI\n"),
                   written_by(dialect.dialect));
}

std::string written(const WordRow& row) {
  return std::string(row.word) + (row.word.ends_with('_') ? "WORD" : "") + "/1,2";
}

TEST(WordRows, OfViewersAndNotesLeaveThePathAsItIsInEveryDialect) {
  for (const DialectTraits& dialect : dialects()) {
    if (is_nc(dialect.dialect)) continue;
    for (const WordRow& row : word_rows()) {
      if (row.handler != skip && row.handler != skip_flagged) continue;
      const ReadText read = read_between(dialect, written(row));
      ASSERT_EQ(read.error, "") << dialect.name << " " << row.word;
      EXPECT_EQ(read.motion().size(), 2U) << dialect.name << " " << row.word;
      const auto& skipped = read.summary.skipped;
      EXPECT_TRUE(std::any_of(skipped.begin(), skipped.end(),
                              [&](const auto& s) { return written(row).starts_with(s.word); }))
          << dialect.name << " " << row.word;
      if (row.handler == skip_flagged) {
        EXPECT_TRUE(read.warned_of(row.note)) << dialect.name << " " << row.word;
      }
    }
  }
}

TEST(WordRows, OfTheMachineArePassedOnInEveryDialect) {
  for (const DialectTraits& dialect : dialects()) {
    if (is_nc(dialect.dialect)) continue;
    for (const WordRow& row : word_rows()) {
      if (row.handler != pass_on) continue;
      const ReadText read = read_between(dialect, written(row));
      ASSERT_EQ(read.error, "") << dialect.name << " " << row.word;
      ASSERT_EQ(read.blocks.size(), 4U) << dialect.name << " " << row.word;
      EXPECT_EQ(read.blocks[1].action, ActionKind::kVendorWord);
      EXPECT_EQ(std::string(read.blocks[1].text), written(row));
    }
  }
}

TEST(WordRows, ThatCouldMoveTheMachineAreRefusedWithTheirReasonInEveryDialect) {
  for (const DialectTraits& dialect : dialects()) {
    if (is_nc(dialect.dialect)) continue;
    for (const WordRow& row : word_rows()) {
      if (row.handler != refuse_word && row.handler != refuse_unless_off &&
          row.handler != refuse_unless_first) {
        continue;
      }
      const ReadText read = read_between(dialect, written(row) + ",3");
      EXPECT_EQ(read.error_line, dialect.dialect == Dialect::kNx ? 5U : 4U)
          << dialect.name << " " << row.word << ": " << read.error;
      const std::string note(row.note.substr(0, row.note.find(';')));
      EXPECT_NE(read.error.find(std::string(row.word) + " " + note), std::string::npos)
          << dialect.name << " " << row.word << ": " << read.error;
    }
  }
}

/// A cycle of depth 8 in four forms, from a rapid level of 3 back to a level of 10.
std::string cycle_of(const HoleType& type, Dialect dialect) {
  const std::string head = "CYCLE/" + std::string(type.word) + ",";
  const bool has_pecks = type.kind == HoleKind::kDeep || type.kind == HoleKind::kChipBreak;
  switch (dialect) {
    case Dialect::kNx:
      return head + "RAPTO,3,FEDTO,-8,RTRCTO,10,MMPM,100" + (has_pecks ? ",STEP,3" : "");
    case Dialect::kSolidWorks:
      return head + "FEDTO,8,MMPM,100,RAPTO,3,RTRCTO,10,DWELL,0" + (has_pecks ? ",INCR,3" : "");
    case Dialect::kHsm:
      return head + "8," + (has_pecks ? "INCR,3,MMPM,100,18" : "MMPM,100,18") + ",RAPTO,7";
    default:
      return head + "DEPTH,8,MMPM,100,CLEAR,3,RETURN,10" + (has_pecks ? ",STEP,3" : "");
  }
}

TEST(CycleRows, DrillToTheirDepthInEveryDialectOrAreRefused) {
  for (const DialectTraits& dialect : dialects()) {
    if (is_nc(dialect.dialect)) continue;
    for (const HoleType& type : hole_types()) {
      const std::string line = cycle_of(type, dialect.dialect);
      const std::string which = std::string(dialect.name) + " " + line;
      const ReadText read = read_between(
          dialect, "RAPID\nGOTO/5,6,10,0,0,1\n" + line + "\nGOTO/5,6,0,0,0,1\nCYCLE/OFF");
      if (!type.refusal.empty()) {
        EXPECT_NE(read.error.find(type.refusal), std::string::npos) << which << read.error;
        continue;
      }
      ASSERT_EQ(read.error, "") << which;
      EXPECT_EQ(read.summary.holes, 1U) << which;
      EXPECT_EQ(read.summary.box_min_mm[2], -8) << which;
      const auto motion = read.motion();
      ASSERT_GE(motion.size(), 5U) << which;
      const ClBlock& out = motion[motion.size() - 2];
      EXPECT_EQ(out.tip_mm, (Array3{5, 6, type.word == "MILL" ? -8.0 : 10.0})) << which;
      const auto bottoms = std::count_if(motion.begin(), motion.end(), [](const ClBlock& block) {
        return block.kind == BlockKind::kCut && block.tip_mm[2] < 0;
      });
      const bool has_pecks = type.kind == HoleKind::kDeep || type.kind == HoleKind::kChipBreak;
      EXPECT_EQ(bottoms, has_pecks ? 3 : 1) << which << ": at 3, 6 and 8 mm, or at once";
    }
  }
}

}  // namespace
}  // namespace meridian::cl
