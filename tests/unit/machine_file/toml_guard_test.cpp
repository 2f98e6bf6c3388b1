// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/toml_guard.hpp"

#include <gtest/gtest.h>

#include <string>

#include "service/machine/file/machine_file.hpp"
#include "support/text_file.hpp"

namespace meridian::config {
namespace {

std::string repeated(const std::string& part, int count) {
  std::string text;
  for (int n = 0; n < count; ++n) text += part;
  return text;
}

TEST(TomlGuard, RefusesWhatWouldOverflowTheParsersStackWithFileAndLine) {
  constexpr int kMany = 200'000;
  const std::string bombs[] = {
      "\n[a" + repeated(".a", kMany) + "]\n",
      "\na" + repeated(".a", kMany) + " = 1\n",
      "\na" + repeated(" . \"a\"", kMany / 4) + " = 1\n",
      "\na = " + repeated("[", kMany) + "\n",
      "\na = " + repeated("{a=", kMany) + "\n",
      "\n" + repeated("[", kMany) + "\n",
  };
  for (const std::string& bomb : bombs) {
    try {
      (void)parse_machine(bomb, "m.toml");
      ADD_FAILURE() << bomb.substr(0, 20);
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.fault().line, 2) << error.what();
      EXPECT_EQ(std::string(error.what()).rfind("m.toml:2: ", 0), 0U) << error.what();
    }
  }
  EXPECT_THROW((void)parse_machine(std::string(kMaxTomlBytes + 1, '\n'), "m.toml"), ConfigError);
}

TEST(TomlGuard, LetsDotsAndBracketsInStringsCommentsAndNumbersPass) {
  const std::string dots = repeated("...[[[{{{", 100);
  for (const std::string& text :
       {"a = \"" + dots + "\\\"" + dots + "\"\n", "a = '" + dots + "'\n", "# " + dots + "\n",
        "a = \"\"\"" + dots + "\n\"" + dots + "\"\"\"\n", "a = '''" + dots + "\n'" + dots + "'''\n",
        "a = [" + repeated("[1.5, 2.5], ", 1000) + "]\n", repeated("a.b.c = 1.5\n", 1000),
        "a = [" + repeated("\n1.5,", 1000) + "]\n"}) {
    EXPECT_FALSE(find_toml_bomb(text)) << text.substr(0, 40);
  }
  for (const char* file : {"machines/lai.toml", "machines/robot-5r.toml", "tools.toml",
                           "service.toml", "budgets.toml"}) {
    const std::string text = test::read_text(std::string(MERIDIAN_SOURCE_DIR "/deploy/") + file);
    EXPECT_FALSE(find_toml_bomb(text)) << file;
  }
}

}  // namespace
}  // namespace meridian::config
