// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "service/analysis/simulate/simulate.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/machine/inspect/placing.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "support/draws.hpp"
#include "support/shared_folder.hpp"
#include "support/shipped_machines.hpp"

/// Where real programs fit on every machine: a frame in which the simulation runs, or none, which a
/// search of drawn frames confirms. MERIDIAN_PLACING_LINES: how many lines of a file count (all:
/// 0), MERIDIAN_PLACING_FRAMES: how many frames are drawn where nothing fits.
namespace meridian {
namespace {

[[nodiscard]] cl::ClReaderOptions placing_reader() {
  cl::ClReaderOptions options;
  options.unit = cl::LengthUnit::kMillimetre;
  options.allow_no_end = true;
  return options;
}

struct PlacedFile {
  const char* name;
  const char* closing = "";  ///< what a head of it has to end with
};

void PrintTo(const PlacedFile& file, std::ostream* out) { *out << file.name; }

/// The first lines of `file`, as many as count, and what closes them.
[[nodiscard]] std::string head_of(const std::filesystem::path& file, int lines,
                                  const char* closing) {
  std::ifstream in(file, std::ios::binary);
  std::string text, line;
  for (int n = 0; (lines == 0 || n < lines) && std::getline(in, line); ++n) text += line + "\n";
  return lines == 0 ? text : text + closing;
}

[[nodiscard]] ToolTable all_tools(const MachineModel& model) {
  std::vector<Tool> tools;
  for (int number = 1; number <= 99; ++number) tools.push_back({number, model.tool_length_mm, 5});
  return ToolTable(tools);
}

/// How many of `frames` drawn frames in `box` fit.
[[nodiscard]] int drawn_that_fit(const MachineModel& model,
                                 const std::vector<inspect::ProgramPose>& poses,
                                 const inspect::PlacingBox& box, int frames) {
  std::mt19937 engine(20261128);
  int fitting = 0;
  for (int n = 0; n < frames; ++n) {
    std::array<double, 3> origin{};
    for (std::size_t i = 0; i < 3; ++i) {
      origin[i] = std::uniform_real_distribution<>(box.low_mm[i], box.high_mm[i])(engine);
    }
    fitting += inspect::fit_of(inspect::placed(model, origin, 0), poses).margin >= 0;
  }
  return fitting;
}

struct PlacingCount {
  int confirmed = 0, impossible = 0, refused = 0;
};

/// Places `text`, a program called `name`, on `machine`.
void place_and_confirm(const std::string& name, const std::string& text, const std::string& machine,
                       PlacingCount& count) {
  SCOPED_TRACE(name + " on " + machine);
  const int frames = test::number_of("MERIDIAN_PLACING_FRAMES", 200);
  const MachineModel model = config::load_machine(test::shipped_file(machine));
  cl::ClReader reader(std::string_view(text), name, placing_reader());
  const ToolTable tools = all_tools(model);
  const auto poses = inspect::read_poses(reader, model, tools);
  ASSERT_TRUE(poses) << poses.error().text();
  ASSERT_FALSE(poses->empty());
  const inspect::PlacingBox box = inspect::widest_box(model, *poses);
  const inspect::Placing found = inspect::find_placing(model, *poses, box);
  if (found.fit.margin < 0) {
    EXPECT_EQ(drawn_that_fit(model, *poses, box, frames), 0) << to_text(found, model, *poses);
    EXPECT_FALSE(inspect::findings_of(inspect::placed(model, found.origin_mm, found.turn_rad),
                                      *poses, found.fit.branch)
                     .empty());
    ++count.impossible;
    return;
  }
  const MachineModel there = inspect::placed(model, found.origin_mm, found.turn_rad);
  cl::ClReader again(std::string_view(text), name, placing_reader());
  const auto report = simulate::simulate(again, name, there, tools, {}, [](const CycleRecord&) {});
  if (report.outcome == simulate::Outcome::kDone) {
    ++count.confirmed;
    return;
  }
  ++count.refused;
  std::printf("%s on %s: %s\n", name.c_str(), machine.c_str(), report.reason.c_str());
}

class PlacingCorpus : public testing::TestWithParam<PlacedFile> {};

TEST_P(PlacingCorpus, FindsAFrameThatRunsOnEveryMachineOrAReasonThatDrawnFramesConfirm) {
  const auto file = test::shared_folder() / "cl_corpus" / GetParam().name;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  const int lines = test::number_of("MERIDIAN_PLACING_LINES", 60);
  const std::string text = head_of(file, lines, GetParam().closing);
  PlacingCount count;
  for (const std::string& machine : test::shipped_machines()) {
    place_and_confirm(GetParam().name, text, machine, count);
  }
  std::printf("%d run where they were placed, %d fit nowhere, %d refused\n", count.confirmed,
              count.impossible, count.refused);
  EXPECT_EQ(count.refused, 0);
}

[[nodiscard]] std::string placing_name(const testing::TestParamInfo<PlacedFile>& file) {
  std::string name = file.param.name;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

constexpr const char* kEndOfSections = "PPRINT/END-SECTION,PATH\nPPRINT/END-SECTION,MACHINING\n";

INSTANTIATE_TEST_SUITE_P(Files, PlacingCorpus,
                         testing::Values(PlacedFile{"makino_ff_Plane_1.cldata", kEndOfSections},
                                         PlacedFile{"makino_ff_Plane_2.cldata", kEndOfSections},
                                         PlacedFile{"nx_coremill.cls", "END-OF-PATH\n"},
                                         PlacedFile{"nx_simple_block.cls", "END-OF-PATH\n"},
                                         PlacedFile{"ramsai_1-1_plan_3x.apt"},
                                         PlacedFile{"ramsai_1-2_plan_5x_depincage_lateral.apt"},
                                         PlacedFile{"ramsai_1-3_plan_5x_depincage_double.apt"},
                                         PlacedFile{"ramsai_2-1_calotte_3x.apt"},
                                         PlacedFile{"solidworks_boss.apt"},
                                         PlacedFile{"solidworks_manufacture3_top.apt"},
                                         PlacedFile{"solidworks_sacrifice_board.apt"}),
                         placing_name);

}  // namespace
}  // namespace meridian
