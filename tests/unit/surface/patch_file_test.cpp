// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/patch_file.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "service/machine/file/config_error.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/programs/surface/surface_program.hpp"
#include "support/text_file.hpp"

namespace meridian::surface {
namespace {

const std::string kShipped = MERIDIAN_SOURCE_DIR "/deploy/parts/reference-patch.toml";

std::string shipped() { return test::read_text(kShipped); }

/// The shipped file with `from` replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string text = shipped();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(PatchFile, ThatIsShippedIsTheReferencePatch) {
  const PatchJob job = load_patch(kShipped);
  EXPECT_EQ(job.rule.surface, job.surface.get());
  EXPECT_TRUE(job.rule.cutter.is_ball());
  EXPECT_EQ(job.cover.points, 21u);
  EXPECT_EQ(job.cover.lines, 21u);
  EXPECT_FALSE(job.rule.runs_along_u);
  EXPECT_EQ(job.program.feed_mm_per_s, 50);
  const Vector3 middle = job.surface->evaluate(0.5, 0.5).at;
  EXPECT_LT((middle - Vector3{766.14, 741.88, 290}).norm(), 60);
}

TEST(PatchFile, GivesTheOtherKeysToTheirPlaces) {
  std::string text =
      with("kind = \"ball\"",
           "kind = \"toroidal\"\ncorner_radius_mm = 2\nnumber = 3\nspindle_rpm = 9000");
  text.replace(text.find("points = 21"), 11, "chord_error_mm = 0.02");
  text.replace(text.find("lines = 21"), 10, "scallop_mm = 0.03\nrange_u = [0.1, 0.9]");
  text.replace(text.find("along = \"v\""), 11, "along = \"u\"");
  text.replace(text.find("\"zigzag\""), 8, "\"one-way\"");
  text.replace(text.find("flip_normal = false"), 19, "flip_normal = true");
  text.replace(text.find("lead_deg = 0"), 12, "lead_deg = 90e-1");
  const PatchJob job = parse_patch(text, "patch.toml");
  EXPECT_EQ(job.rule.cutter.corner_radius_mm, 2);
  EXPECT_EQ(job.program.tool_number, 3);
  EXPECT_EQ(job.program.spindle_rpm, 9000);
  EXPECT_EQ(job.cover.points, 0u);
  EXPECT_EQ(job.cover.chord_error_mm, 0.02);
  EXPECT_EQ(job.cover.scallop_mm, 0.03);
  EXPECT_EQ(job.cover.range_u[0], 0.1);
  EXPECT_EQ(job.cover.range_v[1], 1);
  EXPECT_TRUE(job.rule.runs_along_u);
  EXPECT_FALSE(job.cover.is_zigzag);
  EXPECT_TRUE(job.rule.is_flipped);
  EXPECT_NEAR(job.rule.lead_rad, 9 * std::acos(-1.0) / 180, 1e-15);
}

struct PatchMistake {
  const char* name;
  const char* from;
  const char* to;
  const char* key;  ///< in the message, with the value as written
  const char* allowed;
};

class WrongPatchFile : public testing::TestWithParam<PatchMistake> {};

TEST_P(WrongPatchFile, IsRefusedWithPlaceValueAndRange) {
  const std::string text = with(GetParam().from, GetParam().to);
  try {
    (void)parse_patch(text, "patch.toml");
    FAIL() << "taken";
  } catch (const config::ConfigError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.rfind("patch.toml:", 0), 0u) << message;
    EXPECT_GT(error.fault().line, 0) << message;
    EXPECT_NE(message.find(GetParam().key), std::string::npos) << message;
    EXPECT_NE(message.find(GetParam().allowed), std::string::npos) << message;
    EXPECT_FALSE(error.fault().remedy.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Every, WrongPatchFile,
    testing::Values(
        PatchMistake{"zero_weight", "[1, 0.8, 1.1, 1]", "[1, 0, 1.1, 1]",
                     "surface.row[1].weight[1] = 0", "1e-06 to 1000000"},
        PatchMistake{"negative_weight", "[1, 0.8, 1.1, 1]", "[1, -0.8, 1.1, 1]",
                     "surface.row[1].weight[1] = -0.8", "1e-06 to"},
        PatchMistake{"short_weights", "[1, 0.8, 1.1, 1]", "[1, 0.8, 1.1]",
                     "row[1].weight = 3 numbers", "4 numbers"},
        PatchMistake{"short_row", "z_mm = [302, 301.99, 267.99, 284]", "z_mm = [302, 301.99, 284]",
                     "surface.row[2].z_mm = 3 numbers", "4 numbers"},
        PatchMistake{"no_number", "z_mm = [302, 301.99,", "z_mm = [302, nan,",
                     "row[2].z_mm[1] = nan", "-100000 to 100000"},
        PatchMistake{"word", "z_mm = [302, 301.99,", "z_mm = [302, \"a\",",
                     "row[2].z_mm[1] = ", "-100000 to 100000"},
        PatchMistake{"degree", "degree = [3, 3]", "degree = [3, 12]", "surface.degree[1] = 12",
                     "1 to 9"},
        PatchMistake{"half_degree", "degree = [3, 3]", "degree = [3, 2.5]",
                     "surface.degree = ", "whole numbers"},
        PatchMistake{"few_rows", "degree = [3, 3]", "degree = [4, 3]", "surface.row",
                     "at least 5 rows"},
        PatchMistake{"few_knots", "knots_u = [0, 0, 0, 0, 1, 1, 1, 1]",
                     "knots_u = [0, 0, 0, 0, 1, 1, 1]", "surface.knots_u = ", "8 knots"},
        PatchMistake{"falling_knots", "knots_v = [0, 0, 0, 0, 1, 1, 1, 1]",
                     "knots_v = [0, 0, 0, 2, 1, 1, 1, 1]",
                     "surface.knots_v = ", "none smaller than the one before"},
        PatchMistake{"no_domain", "knots_v = [0, 0, 0, 0, 1, 1, 1, 1]",
                     "knots_v = [0, 0, 0, 1, 1, 1, 1, 1]", "surface.knots_v = ", "a domain"},
        PatchMistake{"cutter", "kind = \"ball\"", "kind = \"bull\"", "cutter.kind = 'bull'",
                     "\"ball\", \"toroidal\", \"flat\""},
        PatchMistake{"no_corner", "kind = \"ball\"", "kind = \"toroidal\"",
                     "cutter.corner_radius_mm", "0.001 to 5"},
        PatchMistake{"corner", "kind = \"ball\"", "kind = \"flat\"\ncorner_radius_mm = 1",
                     "cutter.corner_radius_mm = 1", "only a toroidal cutter"},
        PatchMistake{"diameter", "diameter_mm = 10", "diameter_mm = 0", "cutter.diameter_mm = 0",
                     "0.001 to 1000"},
        PatchMistake{"lead", "lead_deg = 0", "lead_deg = 90", "cutter.lead_deg = 90", "-80 to 80"},
        PatchMistake{"along", "along = \"v\"", "along = \"w\"", "path.along = 'w'", "\"u\", \"v\""},
        PatchMistake{"both_steps", "points = 21", "points = 21\nchord_error_mm = 1",
                     "path.points = 21", "either points or chord_error_mm"},
        PatchMistake{"no_lines", "lines = 21", "", "path.lines", "either lines or scallop_mm"},
        PatchMistake{"one_point", "points = 21", "points = 1", "path.points = 1", "2 to 100000"},
        PatchMistake{"range", "lines = 21", "lines = 21\nrange_u = [0, 1.5]",
                     "path.range_u = [ 0, 1.5 ]", "0 to 1"},
        PatchMistake{"range_order", "lines = 21", "lines = 21\nrange_v = [0.5, 0.5]",
                     "path.range_v = ", "[minimum, maximum]"},
        PatchMistake{"feed", "feed_mm_per_min = 3000", "feed_mm_per_min = 0",
                     "path.feed_mm_per_min = 0", "0.001 to 1000000"},
        PatchMistake{"unknown", "clearance_mm = 30", "clearance_mm = 30\nstep_over_mm = 1",
                     "path.step_over_mm = 1", "scallop_mm"},
        PatchMistake{"unknown_range", "clearance_mm = 30", "clearance_mm = 30\nrange_w = 1",
                     "path.range_w = 1", "range_v"},
        PatchMistake{"no_table", "[path]", "[way]", "path", "a table [path]"}),
    [](const testing::TestParamInfo<PatchMistake>& test) { return std::string(test.param.name); });

TEST(PatchFile, EveryKeyOfTheShippedOneIsDocumented) {
  const std::string page = test::read_text(MERIDIAN_SOURCE_DIR "/docs/surface.md");
  std::istringstream lines(shipped());
  int keys = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find(" = ");
    if (end == std::string::npos || line[0] == '#') continue;
    ++keys;
    EXPECT_NE(page.find('`' + line.substr(0, end) + '`'), std::string::npos) << line;
  }
  EXPECT_GT(keys, 20);
}

TEST(PatchProgram, ReadsBackWithAllContactsBetweenItsWaysInAndOut) {
  const PatchJob job = load_patch(kShipped);
  const auto path = cover(job.rule, job.cover);
  ASSERT_TRUE(path);
  std::ostringstream out;
  write_program(job, *path, "reference-patch.toml", out);
  const std::string text = out.str();
  cl::ClReader reader(std::string_view(text), "patch.apt");
  std::vector<ClBlock> cuts;
  int rapids = 0;
  for (auto block = reader.next();; block = reader.next()) {
    ASSERT_TRUE(block) << block.error().text();
    if (!*block) break;
    if ((*block)->kind == BlockKind::kRapid) ++rapids;
    if ((*block)->kind == BlockKind::kCut) cuts.push_back(**block);
  }
  EXPECT_TRUE(reader.warnings().empty());
  EXPECT_EQ(rapids, 2);
  ASSERT_EQ(cuts.size(), 441u);
  EXPECT_NEAR(cuts[0].feed, 1000.0 / 60, 1e-12);
  EXPECT_NEAR(cuts[440].feed, 50, 1e-12);
  std::size_t i = 0;
  for (const SurfacePath::Line& line : path->lines) {
    for (const Contact& c : line.contacts) {
      EXPECT_LT((to_vector(cuts[i].tip_mm) - c.shape.at).norm(), 1e-6);
      EXPECT_LT((to_vector(cuts[i].axis) - c.shape.normal).norm(), 1e-8);
      ++i;
    }
  }
}

TEST(PatchProgram, OneWayLiftsBetweenLinesAndWritesToolAndSpindle) {
  std::string text = with("\"zigzag\"", "\"one-way\"");
  text.replace(text.find("kind = \"ball\""), 13, "kind = \"ball\"\nnumber = 2\nspindle_rpm = 9000");
  const PatchJob job = parse_patch(text, "patch.toml");
  const std::vector<ClBlock> blocks = program_of(job, *cover(job.rule, job.cover));
  int rapids = 0;
  for (const ClBlock& block : blocks) rapids += block.kind == BlockKind::kRapid ? 1 : 0;
  EXPECT_EQ(rapids, 2 * 21);
  EXPECT_EQ(blocks[0].kind, BlockKind::kTool);
  EXPECT_EQ(blocks[0].value, 2);
  EXPECT_EQ(blocks[1].action, ActionKind::kSpindleClockwise);
  EXPECT_EQ(blocks.back().kind, BlockKind::kEnd);
  EXPECT_EQ(blocks[blocks.size() - 2].action, ActionKind::kSpindleOff);
}

}  // namespace
}  // namespace meridian::surface
