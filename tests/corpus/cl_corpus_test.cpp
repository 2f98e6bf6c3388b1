// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "service/programs/cl/cl_points.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "support/shared_folder.hpp"

namespace meridian::cl {
namespace {

constexpr double kPrinted_mm = 1e-12;  // both sides read the same decimal text

/// A file with the counts of its SOURCES.md and how it ends.
struct CorpusFile {
  const char* name;
  std::uint64_t goto_three;
  std::uint64_t goto_six;
  std::uint64_t zero_length;
  double tilt_min_deg, tilt_max_deg;
  double axis_change_deg;  ///< largest in one block
};

std::filesystem::path corpus() { return test::shared_folder() / "cl_corpus"; }

void PrintTo(const CorpusFile& file, std::ostream* out) { *out << file.name; }

/// What stands in a file by plain text matching, not by our reader.
struct PlainText {
  unsigned long three = 0, six = 0, circles = 0;
  std::array<double, 6> box{};
};

PlainText plain_text(const std::filesystem::path& path) {
  const std::string command = std::string("/usr/bin/python3 ") + MERIDIAN_SOURCE_DIR +
                              "/tests/corpus/extract_cl.py '" + path.string() + "'";
  PlainText text;
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  auto& box = text.box;
  const int read = std::fscanf(pipe, "%lu %lu %lu %lf %lf %lf %lf %lf %lf", &text.three, &text.six,
                               &text.circles, &box[0], &box[1], &box[2], &box[3], &box[4], &box[5]);
  EXPECT_EQ(pclose(pipe), 0);
  EXPECT_EQ(read, 9);
  return text;
}

class Corpus : public testing::TestWithParam<CorpusFile> {
 protected:
  void SetUp() override {
    path_ = corpus() / GetParam().name;
    if (!std::filesystem::exists(path_)) GTEST_SKIP() << path_ << " is not here";
  }
  std::filesystem::path path_;
};

TEST_P(Corpus, AgreesWithItsSourcesAndWithPlainTextExtraction) {
  std::ifstream in(path_, std::ios::binary);
  ClReaderOptions options;
  options.unit = LengthUnit::kMillimetre;
  ClReader reader(in, path_.filename(), options);
  while (true) {
    const auto block = reader.next();
    ASSERT_TRUE(block) << block.error().text();
    if (!*block) break;
  }
  const ClSummary& s = reader.summary();
  const CorpusFile& file = GetParam();
  EXPECT_EQ(s.goto_three, file.goto_three);
  EXPECT_EQ(s.goto_six, file.goto_six);
  EXPECT_EQ(s.zero_length, file.zero_length);
  const double deg = 180 / std::acos(-1.0);
  EXPECT_NEAR(s.tilt_min_rad * deg, file.tilt_min_deg, 0.05);
  EXPECT_NEAR(s.tilt_max_rad * deg, file.tilt_max_deg, 0.05);
  EXPECT_NEAR(s.axis_change_max_rad * deg, file.axis_change_deg, 0.005);

  const PlainText text = plain_text(path_);
  EXPECT_EQ(s.goto_three, text.three);
  EXPECT_EQ(s.goto_six, text.six);
  EXPECT_EQ(s.arcs, text.circles);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(s.box_min_mm[i], text.box[2 * i], kPrinted_mm);
    EXPECT_NEAR(s.box_max_mm[i], text.box[2 * i + 1], kPrinted_mm);
  }
}

TEST_P(Corpus, GivesTheSameBlocksFromMemoryAsFromAStream) {
  std::ifstream in(path_, std::ios::binary);
  std::stringstream all;
  all << in.rdbuf();
  const std::string text = all.str();
  ClReaderOptions options;
  options.unit = LengthUnit::kMillimetre;
  ClReader from_memory(std::string_view(text), "memory", options);
  ClReader from_stream(all, "stream", options);
  while (true) {
    const auto a = from_memory.next();
    const auto b = from_stream.next();
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->has_value(), b->has_value());
    if (!*a) break;
    ASSERT_EQ((*a)->tip_mm, (*b)->tip_mm);
    ASSERT_EQ((*a)->axis, (*b)->axis);
    ASSERT_EQ((*a)->line, (*b)->line);
  }
}

/// CAM systems leave lines tangentially into arcs, so the sense of rotation that we take must not
/// send arcs back against the motion before them.
TEST_P(Corpus, ArcsGoOnAlongTheMotionBeforeThem) {
  std::ifstream in(path_, std::ios::binary);
  ClReaderOptions options;
  options.unit = LengthUnit::kMillimetre;
  ClReader reader(in, path_.filename(), options);
  std::array<Vector3, 2> last = {Vector3::Zero(), Vector3::Zero()};
  int along = 0;
  int against = 0;
  bool was_line = false;
  for (auto block = reader.next(); block && *block; block = reader.next()) {
    const ClBlock& b = **block;
    if (!is_motion(b.kind)) continue;
    if (b.is_arc && was_line && (last[1] - last[0]).norm() > 1e-6) {
      const Vector3 arm = last[1] - to_vector(b.centre_mm);
      const Vector3 tangent = to_vector(b.normal).cross(arm).normalized();
      const double cosine = tangent.dot((last[1] - last[0]).normalized());
      along += cosine > 0.9 ? 1 : 0;
      against += cosine < -0.9 ? 1 : 0;
    }
    last = {last[1], to_vector(b.tip_mm)};
    was_line = !b.is_arc;
  }
  EXPECT_LE(against, along / 20) << along << " along, " << against << " against";
}

INSTANTIATE_TEST_SUITE_P(
    ClFiles, Corpus,
    testing::Values(CorpusFile{"ramsai_1-1_plan_3x.apt", 206, 0, 0, 0, 0, 0},
                    CorpusFile{"ramsai_1-2_plan_5x_depincage_lateral.apt", 0, 208, 0, 20, 20, 0},
                    CorpusFile{"ramsai_1-3_plan_5x_depincage_double.apt", 0, 708, 0, 20.2, 35.5,
                               12.17},
                    CorpusFile{"ramsai_2-1_calotte_3x.apt", 605, 0, 0, 0, 0, 0},
                    CorpusFile{"nx_coremill.cls", 3129, 1, 0, 0, 0, 0},
                    CorpusFile{"nx_simple_block.cls", 103, 1, 0, 0, 0, 0},
                    CorpusFile{"makino_ff_Plane_1.cldata", 205, 0, 0, 0, 0, 0},
                    CorpusFile{"makino_ff_Plane_2.cldata", 62, 0, 0, 0, 0, 0}),
    [](const testing::TestParamInfo<CorpusFile>& file) {
      std::string name = file.param.name;
      for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
      return name;
    });

TEST(CorpusNc, ProgramsAreRefusedAsSiemens) {
  for (const char* name : {"siemens_Achskreuz.mpf", "siemens_Flaschenoeffner.mpf.txt"}) {
    const auto path = corpus() / name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
    std::ifstream in(path, std::ios::binary);
    ClReader reader(in, name);
    const auto block = reader.next();
    ASSERT_FALSE(block);
    EXPECT_NE(block.error().message.find("Siemens NC program"), std::string::npos);
  }
}

struct SolidWorksFile {
  const char* name;
  std::uint64_t holes;
  double z_min_mm;
};

void PrintTo(const SolidWorksFile& file, std::ostream* out) { *out << file.name; }

class SolidWorksCorpus : public testing::TestWithParam<SolidWorksFile> {};

/// Their cycles begin where the cycle retracts to, so levels and axes that are read wrong show.
TEST_P(SolidWorksCorpus, IsReadWithoutAnOptionAndItsCyclesBeginWhereTheyRetractTo) {
  const auto path = corpus() / GetParam().name;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  std::ifstream in(path, std::ios::binary);
  ClReader reader(in, GetParam().name);
  auto block = reader.next();
  while (block && *block) block = reader.next();
  ASSERT_TRUE(block) << block.error().text();
  const ClSummary& s = reader.summary();
  EXPECT_EQ(s.dialect, "SolidWorks CAM APT");
  EXPECT_EQ(s.holes, GetParam().holes);
  EXPECT_NEAR(s.box_min_mm[2], GetParam().z_min_mm, 1e-5);
  const PlainText text = plain_text(path);
  EXPECT_EQ(s.goto_three, text.three);
  EXPECT_EQ(s.goto_six, text.six);
  EXPECT_EQ(s.arcs, text.circles);
  for (const ClWarning& warning : reader.warnings()) {
    EXPECT_EQ(warning.message.find("are its levels right"), std::string::npos) << warning.line;
  }
}

INSTANTIATE_TEST_SUITE_P(
    ClFiles, SolidWorksCorpus,
    testing::Values(SolidWorksFile{"solidworks_boss.apt", 0, -125.381909},
                    SolidWorksFile{"solidworks_manufacture3_top.apt", 31, -9.00161},
                    SolidWorksFile{"solidworks_sacrifice_board.apt", 28, -55}));

TEST(CorpusUnits, FilesWithoutAUnitWordAreReadInTheUnitOfTheirFeedsAndThatIsSaid) {
  const auto path = corpus() / "nx_coremill.cls";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  std::ifstream in(path, std::ios::binary);
  ClReader reader(in, "nx_coremill.cls");
  auto block = reader.next();
  while (block && *block) block = reader.next();
  ASSERT_TRUE(block) << block.error().text();
  ASSERT_FALSE(reader.warnings().empty());
  EXPECT_EQ(reader.warnings()[0].line, 10U);
  EXPECT_NE(reader.warnings()[0].message.find("NO UNIT WORD"), std::string::npos);
  EXPECT_EQ(reader.summary().unit_source, UnitSource::kFeed);
}

/// Every file but the last byte, line or half of itself is refused or said to be incomplete.
TEST(CorpusTruncation, IsNeverSilent) {
  const auto path = corpus() / "ramsai_1-3_plan_5x_depincage_double.apt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  std::ifstream in(path, std::ios::binary);
  std::stringstream all;
  all << in.rdbuf();
  const std::string text = all.str();
  for (const std::size_t size : {text.size() - 8, text.size() - 100, text.size() / 2,
                                 text.size() / 3, std::size_t{4000}, std::size_t{777}}) {
    ClReader reader(std::string_view(text).substr(0, size), "cut");
    auto block = reader.next();
    while (block && *block) block = reader.next();
    EXPECT_FALSE(block) << size;
  }
}

}  // namespace
}  // namespace meridian::cl
