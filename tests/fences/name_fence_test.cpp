// SPDX-License-Identifier: Apache-2.0
#include "fences/name_fence.hpp"

#include <gtest/gtest.h>

namespace meridian::fences {
namespace {

using Words = std::vector<std::string>;

NameRules name_rules() {
  return read_name_rules(read_file(MERIDIAN_SOURCE_DIR, "tests/fences/private_words.txt"));
}

TEST(NameFence, NoNameOfTheProjectHasAPrivateWord) {
  std::vector<SourceFile> files;
  for (const char* const folder : {"include", "service", "tests", "docs"}) {
    for (SourceFile& file : read_tree(MERIDIAN_SOURCE_DIR, folder, {".hpp", ".cpp", ".h", ".c"})) {
      files.push_back(std::move(file));
    }
  }
  EXPECT_GT(files.size(), 1000U) << "the fence saw hardly any file";
  EXPECT_EQ(to_text(find_private_names(files, name_rules())), "");
}

TEST(NameFence, SplitsNamesIntoWords) {
  EXPECT_EQ(words_of("way_in_mm"), (Words{"way", "in", "mm"}));
  EXPECT_EQ(words_of("kMaxWays_"), (Words{"k", "max", "ways"}));
  EXPECT_EQ(words_of("TCPPlace2"), (Words{"tcpplace"}));
  EXPECT_EQ(words_of("PoleEase"), (Words{"pole", "ease"}));
}

TEST(NameFence, CatchesAPrivateWordInCodeAlone) {
  const SourceFile file{"a.cpp",
                        {"// the way to it", "double way_mm = 0;", "auto said = \"way\";",
                         "struct PolePlace {};", "int replaced = release(kLease);"}};
  EXPECT_EQ(to_text(find_private_names({file}, name_rules())),
            "a.cpp:2: private word: way_mm\na.cpp:4: private word: PolePlace\n");
}

TEST(NameFence, PassesNamesOfTestsAndThoseThatAreAllowed) {
  const SourceFile file{"a.cpp",
                        {"TEST(Router, GoesTheWayThatIsLeft) {", "place_workpiece(model, frame);"}};
  EXPECT_EQ(to_text(find_private_names({file}, name_rules())), "");
}

TEST(NameFence, RefusesARuleThatIsNone) {
  EXPECT_THROW((void)read_name_rules({"a.txt", {"words: way"}}), std::runtime_error);
}

}  // namespace
}  // namespace meridian::fences
