// SPDX-License-Identifier: Apache-2.0
#include "fences/glossary_fence.hpp"

#include <gtest/gtest.h>

namespace meridian::fences {
namespace {

using Terms = std::vector<std::string>;

std::vector<SourceFile> product() {
  std::vector<SourceFile> files;
  for (const char* const folder : {"include", "service"}) {
    for (SourceFile& file : read_tree(MERIDIAN_SOURCE_DIR, folder, {".hpp", ".cpp", ".h"})) {
      files.push_back(std::move(file));
    }
  }
  return files;
}

Terms glossary() { return read_terms(read_file(MERIDIAN_SOURCE_DIR, "docs/glossary.md")); }

TEST(GlossaryFence, ExplainsEveryWordOfAClassThatIsNotPlain) {
  const auto files = product();
  EXPECT_GT(files.size(), 700U) << "the fence saw hardly any file";
  const auto plain = read_words(read_file(MERIDIAN_SOURCE_DIR, "tests/fences/plain_words.txt"));
  EXPECT_EQ(to_text(find_unexplained_classes(files, glossary(), plain)), "");
}

TEST(GlossaryFence, ExplainsNothingThatIsNotThere) {
  EXPECT_EQ(find_stale_terms(product(), glossary()), Terms{});
}

TEST(GlossaryFence, CatchesAClassThatNobodyExplains) {
  const SourceFile file{"a.hpp",
                        {"class PoleFrobnicator {", "struct Frob;", "enum class CellKind : int {",
                         "  [[nodiscard]] Frob make();", "template <class T> struct Grommet {"}};
  EXPECT_EQ(to_text(find_unexplained_classes({file}, {"pole", "feed cell"}, {"kind"})),
            "a.hpp:1: PoleFrobnicator: \"frobnicator\" is not explained\n"
            "a.hpp:5: Grommet: \"grommet\" is not explained\n");
}

TEST(GlossaryFence, ReadsTheTermsOfATable) {
  const SourceFile page{"g.md",
                        {"# Glossary", "", "| word | meaning |", "|---|---|",
                         "| window, tail | what the planner, then |", "| stop margin | x |"}};
  EXPECT_EQ(read_terms(page), (Terms{"window", "tail", "stop margin"}));
}

TEST(GlossaryFence, CatchesARowThatNothingSaysAnyMore) {
  const std::vector<SourceFile> files = {{"a.hpp", {"class StopMargin {", "/// The tail of it."}}};
  EXPECT_EQ(find_stale_terms(files, {"stop margin", "tail", "zone"}), Terms{"zone"});
}

}  // namespace
}  // namespace meridian::fences
