// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/machine_name.hpp"

#include <gtest/gtest.h>

#include <string>

#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/sections/service_file.hpp"
#include "support/text_file.hpp"

namespace meridian::config {
namespace {

TEST(MachineName, IsOfLettersDigitsAndAFewMarks) {
  for (const char* name : {"lai", "robot-5r", "Mill_3.b", "7", "_x"}) {
    EXPECT_TRUE(is_machine_name(name)) << name;
  }
  EXPECT_TRUE(is_machine_name(std::string(63, 'm')));
  for (const char* name : {"", "*", "?ai", "[a-z]", "../..", ".hidden", "-x", "a/b", "a b", "a\n",
                           "a\x1b[2J", "fr\xC3\xA4se", "a,b"}) {
    EXPECT_FALSE(is_machine_name(name)) << name;
  }
  EXPECT_FALSE(is_machine_name(std::string(64, 'm')));
}

TEST(MachineName, ThatIsNoneIsRefusedInTheFilesThatSayOne) {
  std::string machine = test::read_text(MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml");
  machine.replace(machine.find("name = \"lai\""), 12, "name = \"?ai\"");
  const auto refusal = [](const auto& load) {
    try {
      load();
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("taken");
  };
  std::string words = refusal([&] { (void)parse_machine(machine, "m.toml"); });
  EXPECT_NE(words.find("machine.name = '?ai'"), std::string::npos) << words;
  const test::TextFile service("[service]\nmachine = \"m\"\n[dds]\npartition = \"*\"\n");
  words = refusal([&] { (void)load_service(service.path()); });
  EXPECT_NE(words.find(":4: dds.partition = '*'"), std::string::npos) << words;
}

}  // namespace
}  // namespace meridian::config
