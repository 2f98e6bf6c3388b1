// SPDX-License-Identifier: Apache-2.0
#include "fences/text_fence.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>
#include <regex>

namespace meridian::fences {
namespace {

std::vector<TextRule> project_rules() {
  return read_text_rules(read_file(MERIDIAN_SOURCE_DIR, "tests/fences/forbidden_text.txt"));
}

std::vector<SourceFile> project_files(const std::vector<std::string>& endings) {
  std::vector<SourceFile> files;
  for (const char* const folder : {"include", "service", "idl", "tests", "deploy", "docs"}) {
    for (SourceFile& file : read_tree(MERIDIAN_SOURCE_DIR, folder, endings)) {
      if (!file.path.starts_with("tests/fences/")) {
        files.push_back(std::move(file));
      }
    }
  }
  return files;
}

TEST(TextFence, HoldsForTheProject) {
  auto files = project_files({".hpp", ".cpp", ".h", ".c", ".idl", ".txt", ".md", ".toml", ".xml",
                              ".py", ".cmake", "/build", "/demo", "/test"});
  for (const char* const file :
       {"CMakeLists.txt", "README.md", ".ci/run", "deploy/install_packages"}) {
    files.push_back(read_file(MERIDIAN_SOURCE_DIR, file));
  }
  EXPECT_GT(files.size(), 30U) << "the fence saw hardly any file";
  EXPECT_EQ(to_text(find_forbidden_text(files, project_rules())), "");
}

TEST(TextFence, ProofsThatAreNamedAreThere) {
  static const std::regex kTest(R"(tests/[A-Za-z0-9_/]+\.(cpp|py))");
  for (const SourceFile& file : project_files({".hpp", ".cpp"})) {
    for (const std::string& line : file.lines) {
      for (std::sregex_iterator at(line.begin(), line.end(), kTest), end; at != end; ++at) {
        EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(MERIDIAN_SOURCE_DIR) / at->str()))
            << file.path << " names " << at->str();
      }
    }
  }
}

TEST(TextFence, EverySourceStartsWithItsLicenceLine) {
  EXPECT_EQ(to_text(find_missing_heads(project_files({".hpp", ".cpp", ".h", ".c"}))), "");
}

struct BadLine {
  const char* path;
  const char* text;
};
void PrintTo(const BadLine& bad, std::ostream* out) { *out << bad.text; }

class TextFenceCatches : public testing::TestWithParam<BadLine> {};

TEST_P(TextFenceCatches, TheBadLine) {
  const auto findings =
      find_forbidden_text({{GetParam().path, {"fine", GetParam().text, "fine"}}}, project_rules());
  ASSERT_EQ(findings.size(), 1U) << GetParam().text;
  EXPECT_EQ(findings.front().line, 2U);
}

INSTANTIATE_TEST_SUITE_P(
    Samples, TextFenceCatches,
    testing::Values(BadLine{"docs/a.md", "see /home/somebody/meridian"},
                    BadLine{"service/programs/cl/a.cpp", "// TODO later"},
                    BadLine{"include/meridian/cycle/a.hpp", "/// Source: MOTION 9.4."},
                    BadLine{"include/meridian/cycle/a.hpp", "auto t = steady_clock::now();"},
                    BadLine{"service/core/planner/a.cpp", "throw 1;"},
                    BadLine{"include/meridian/cycle/a.hpp", "std::vector<double> v;"},
                    BadLine{"service/programs/cl/a.cpp", "return parsed.value();"},
                    BadLine{"service/programs/cl/a.cpp", "double r = d * std::numbers::pi / 180;"},
                    BadLine{"service/daemon/a.hpp", "/// Tells the operator."},
                    BadLine{"service/daemon/a.cpp", "void tell(const Event& event);"},
                    BadLine{"tests/unit/daemon/a_test.cpp", "TEST(Daemon, IsToldOnce) {"},
                    BadLine{"service/core/CMakeLists.txt", "add_compile_options(-march=native)"},
                    BadLine{"CMakeLists.txt", "include(FetchContent)"}));

TEST(TextFence, CatchesAMissingLicenceLineAndPragma) {
  EXPECT_EQ(find_missing_heads({{"a.hpp", {"int a;"}}}).size(), 2U);
  EXPECT_EQ(
      find_missing_heads({{"a.hpp", {"// SPDX-License-Identifier: Apache-2.0", "#pragma once"}}})
          .size(),
      0U);
  const std::vector<std::string> gpl{"// SPDX-License-Identifier: GPL-2.0-or-later"};
  EXPECT_EQ(find_missing_heads({{"service/drives/hal/component/a.c", gpl}}).size(), 0U);
  EXPECT_EQ(find_missing_heads({{"service/drives/hal/a.c", gpl}}).size(), 1U);
}

TEST(TextFence, ProseOfThePagesIsAtMost100CharactersWide) {
  auto pages = project_files({".md"});
  pages.push_back(read_file(MERIDIAN_SOURCE_DIR, "README.md"));
  EXPECT_GT(pages.size(), 30U) << "the fence saw hardly any page";
  EXPECT_EQ(to_text(find_wide_prose(pages)), "");
}

TEST(TextFence, CatchesWideProseAndNotWhatCannotBeBroken) {
  const std::string wide(101, 'x'), greek = "   é" + std::string(96, 'x');
  EXPECT_EQ(find_wide_prose({{"a.md", {wide, "- " + wide, greek}}}).size(), 2U);
  EXPECT_EQ(find_wide_prose({{"a.md", {"```sh", wide, "```", "| " + wide, "    " + wide}}}).size(),
            0U);
}

}  // namespace
}  // namespace meridian::fences
