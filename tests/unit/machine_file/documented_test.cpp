// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <sstream>

#include "support/text_file.hpp"

namespace meridian::config {
namespace {

/// Every key of the shipped files, commented-out ones included, stands in docs/machine-files.md.
class Documented : public testing::TestWithParam<const char*> {};

TEST_P(Documented, HasEveryKeyOfTheShippedFile) {
  const std::string page = test::read_text(MERIDIAN_SOURCE_DIR "/docs/machine-files.md");
  const std::string text =
      test::read_text(MERIDIAN_SOURCE_DIR "/deploy/" + std::string(GetParam()));
  std::istringstream lines(text);
  int keys = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.rfind("# ", 0) == 0 ? 2 : 0;
    const std::size_t end = line.find(" = ");
    if (end == std::string::npos) continue;
    const std::string key = line.substr(begin, end - begin);
    if (key.find(' ') != std::string::npos) continue;  // a sentence
    ++keys;
    const bool is_there = page.find('`' + key + '`') != std::string::npos ||
                          page.find('.' + key + '`') != std::string::npos ||
                          page.find('`' + key + " = ") != std::string::npos;
    EXPECT_TRUE(is_there) << key;
  }
  EXPECT_GT(keys, 5);
}

INSTANTIATE_TEST_SUITE_P(Every, Documented,
                         testing::Values("machines/lai.toml", "machines/bench.toml",
                                         "machines/lai-hybrid.toml", "machines/nutating-head.toml",
                                         "machines/robot-5r.toml", "tools.toml", "service.toml"));

}  // namespace
}  // namespace meridian::config
