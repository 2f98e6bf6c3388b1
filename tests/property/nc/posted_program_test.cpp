// SPDX-License-Identifier: Apache-2.0
// What `meridian post` writes with tool-centre control, read back as a program: the same tips and
// axes within the digits of the words, the same kinds, feeds and actions, in the same order.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "meridian/units.hpp"
#include "property/planner/random_programs.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/programs/cl/cl_writer.hpp"
#include "service/programs/nc/nc_reader.hpp"
#include "service/programs/post/post.hpp"
#include "support/cl_path.hpp"
#include "support/shipped_machines.hpp"

namespace meridian {
namespace {

constexpr unsigned kSeed = 20261125;
constexpr int kPrograms = 10;
constexpr int kLength = 10;
constexpr double kTip_mm = 2e-4;    // words have 1e-4 mm
constexpr double kAxis_rad = 2e-5;  // words have 1e-5 deg; relaxing onto the pole

/// How the tool axis is written.
enum class Words : std::uint8_t { kRotary, kVectors, kSiemens, kKlartext };

std::string text_of(const std::vector<ClBlock>& blocks) {
  std::ostringstream out;
  cl::ClWriter writer(out, "TRIAL");
  for (const ClBlock& block : blocks) writer.write(block);
  ClBlock end;
  end.kind = BlockKind::kEnd;
  writer.write(end);
  return out.str();
}

std::vector<ClBlock> blocks_of(const std::string& text, const cl::ClReaderOptions& options,
                               std::string& error) {
  std::vector<ClBlock> blocks;
  cl::ClReader reader(text, "trial", options);
  for (;;) {
    const auto block = reader.next();
    if (!block) error = block.error().text();
    if (!block || !*block) return blocks;
    blocks.push_back(**block);
  }
}

/// The line of the CL file that every line of the program was made from, by its N word; 0: none.
std::vector<std::uint32_t> sources_of(const std::string& text) {
  std::vector<std::uint32_t> sources{0};
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    constexpr std::string_view kNote = " ; CL ";
    const std::size_t note = line.find(kNote);
    std::string digits = line.starts_with('N') ? line.substr(1) : "0";
    if (note != std::string::npos) digits = line.substr(note + kNote.size());
    sources.push_back(static_cast<std::uint32_t>(std::stoul(digits)));
  }
  return sources;
}

bool is_at(const ClBlock& a, const ClBlock& b) {
  return (to_vector(a.tip_mm) - to_vector(b.tip_mm)).norm() < kTip_mm &&
         test::angle_of(to_vector(a.axis), to_vector(b.axis)) < kAxis_rad;
}

bool is_same_action(const ClBlock& a, const ClBlock& b) {
  return a.kind == b.kind && a.action == b.action && std::abs(a.value - b.value) < 0.51;
}

struct Counts {
  int programs = 0, motions = 0, read = 0;
};

class PostedProgram : public testing::TestWithParam<std::string> {
 protected:
  MachineModel model = config::load_machine(test::shipped_file(GetParam()));
  /// The part lies askew on it: program and part have not the same axes then.
  void turn_part() { config::place_workpiece(model, config::parse_frame("5,-8,3,4,-7,25")); }
  Counts counts;

  [[nodiscard]] std::optional<std::string> posted(const std::string& text, Words words) {
    post::PostOptions options;
    options.dialect = words == Words::kSiemens    ? post::Dialect::kSiemens
                      : words == Words::kKlartext ? post::Dialect::kHeidenhain
                                                  : post::Dialect::kFanuc;
    options.has_vectors = words == Words::kVectors;
    options.offset_number = 1;
    options.has_line_words = true;
    cl::ClReader reader(text, "trial.apt");
    const auto program = post::write_nc(reader, "trial.apt", model, tools(), options);
    if (!program) return std::nullopt;
    return program->text;
  }

  [[nodiscard]] ToolTable tools() const {
    return ToolTable({{1, model.tool_length_mm, 5}, {2, model.tool_length_mm + 20, 5}});
  }

  /// Every motion of `programmed` ends where the last block does that was made from its line; where
  /// there is none it moved nothing.
  void compare_motions(const std::vector<ClBlock>& programmed, const std::vector<ClBlock>& read,
                       const std::vector<std::uint32_t>& sources) {
    std::size_t at = 0;
    const ClBlock* last = nullptr;
    for (const ClBlock& block : programmed) {
      if (!is_motion(block.kind)) continue;
      bool has_any = false;
      for (; at < read.size() && sources[read[at].line] <= block.line; ++at) {
        if (!is_motion(read[at].kind)) continue;
        last = &read[at];
        has_any = true;
      }
      ASSERT_NE(last, nullptr);
      ASSERT_TRUE(is_at(block, *last)) << "CL line " << block.line << ", NC line " << last->line;
      const bool is_first = &block == &programmed.front();  // which is approached
      if (has_any && !is_first) check_motion(block, *last);
    }
  }

  /// The actions are the same; the end switches off what may be on.
  static void compare_actions(const std::vector<ClBlock>& programmed,
                              const std::vector<ClBlock>& read) {
    std::size_t at = 0;
    for (const ClBlock& block : programmed) {
      if (is_motion(block.kind)) continue;
      while (at < read.size() && (is_motion(read[at].kind) ||
                                  (block.kind == BlockKind::kEnd && read[at].kind != block.kind))) {
        ++at;
      }
      ASSERT_LT(at, read.size()) << "the action of CL line " << block.line << " is missing";
      ASSERT_TRUE(is_same_action(block, read[at])) << "CL line " << block.line;
      ++at;
    }
  }

  void check_motion(const ClBlock& programmed, const ClBlock& read) {
    ++counts.motions;
    EXPECT_EQ(programmed.kind == BlockKind::kRapid, read.kind == BlockKind::kRapid);
    if (programmed.feed_meaning != FeedMeaning::kTip || read.kind != BlockKind::kCut) return;
    const double feed = model.max_feed_mm_per_s > 0
                            ? std::min(programmed.feed, model.max_feed_mm_per_s)
                            : programmed.feed;
    EXPECT_LE(read.feed, feed + 1e-4) << "line " << programmed.line;
  }

  /// Actions between the motions, and a tool before them all.
  static std::vector<ClBlock> with_actions(test::RandomPrograms& draw,
                                           const std::vector<ClBlock>& motions) {
    constexpr std::array kActions = {ActionKind::kSpindleOff,
                                     ActionKind::kSpindleClockwise,
                                     ActionKind::kSpindleCounterClockwise,
                                     ActionKind::kCoolantOff,
                                     ActionKind::kCoolantFlood,
                                     ActionKind::kCoolantMist};
    std::vector<ClBlock> out;
    ClBlock action;
    for (const ClBlock& motion : motions) {
      out.push_back(motion);
      if (draw.chance(0.6)) continue;
      action.kind = BlockKind::kAuxiliary;
      action.action = kActions[static_cast<std::size_t>(draw.uniform(0, 5.99))];
      action.value = std::floor(draw.uniform(1, 20000));
      if (draw.chance(0.3)) {
        action.kind = draw.chance(0.5) ? BlockKind::kStop : BlockKind::kOptionalStop;
        action.action = ActionKind::kStop;
      }
      if (action.action == ActionKind::kSpindleOff || action.action >= ActionKind::kCoolantOff) {
        action.value = 0;
      }
      out.push_back(action);
    }
    return out;
  }

  void try_program(unsigned seed, Words words) {
    test::RandomPrograms draw(seed);
    const std::string text = text_of(with_actions(draw, draw.program(model, kLength)));
    const auto nc = posted(text, words);
    if (!nc) return;
    cl::ClReaderOptions options;
    options.nc = nc::reader_of_programs(model, tools());
    std::string error;
    const auto programmed = blocks_of(text, {}, error);
    const auto read = blocks_of(*nc, options, error);
    ASSERT_EQ(error, "") << *nc;
    compare_motions(programmed, read, sources_of(*nc));
    compare_actions(programmed, read);
    if (HasFatalFailure()) std::printf("%s\n%s\n", text.c_str(), nc->c_str());
    ++counts.programs;
    counts.read += static_cast<int>(read.size());
  }
};

TEST_P(PostedProgram, IsReadBackToTheSameBlocks) {
  if (model.family == MachineFamily::kRobot || has_stage(model)) {
    GTEST_SKIP() << "no tool-centre control knows this machine";
  }
  for (const bool is_askew : {false, true}) {
    if (is_askew) turn_part();
    for (const Words words : {Words::kRotary, Words::kVectors, Words::kSiemens, Words::kKlartext}) {
      for (unsigned n = 0; n < kPrograms && !HasFatalFailure(); ++n) {
        SCOPED_TRACE("seed " + std::to_string(kSeed + n) + ", words " +
                     std::to_string(static_cast<int>(words)));
        try_program(kSeed + n, words);
      }
    }
  }
  EXPECT_GT(counts.programs, kPrograms);
  std::printf("%s: %d programs, %d motions found among %d blocks\n", GetParam().c_str(),
              counts.programs, counts.motions, counts.read);
}

INSTANTIATE_TEST_SUITE_P(Shipped, PostedProgram, testing::ValuesIn(test::shipped_machines()),
                         test::test_name);

}  // namespace
}  // namespace meridian
