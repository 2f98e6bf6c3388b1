// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/tip_box_file.hpp"

#include <gtest/gtest.h>

#include <string>

#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/text_file.hpp"

namespace meridian::config {
namespace {

MachineModel machine_with_tip_box(const std::string& section) {
  const std::string text = test::read_text(MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml");
  return parse_machine(text + "\n" + section, "lai.toml");
}

std::string refusal_of_tip_box(const std::string& section) {
  try {
    (void)machine_with_tip_box(section);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(TipBoxFile, GivesTheBoxOrNone) {
  const MachineModel model =
      machine_with_tip_box("[tip_box]\nmin_mm = [-300, -200, -100]\nmax_mm = [300, 200, 500]\n");
  EXPECT_EQ(model.tip_box, (TipBox{true, {-300, -200, -100}, {300, 200, 500}}));
  EXPECT_FALSE(machine_with_tip_box("").tip_box.is_set);
}

TEST(TipBoxFile, RefusesABoxThatMeansNothingAndSaysWhy) {
  const std::string whole = "[tip_box]\nmin_mm = [-300, -200, -100]\nmax_mm = [300, 200, 500]\n";
  const struct {
    std::string section;
    const char* reason;
  } kCases[] = {
      {"[tip_box]\nmin_mm = [-300, -200, -100]\n", "max_mm"},
      {"[tip_box]\nmin_mm = [300, -200, -100]\nmax_mm = [-300, 200, 500]\n", "both corners"},
      {"[tip_box]\nmin_mm = [-300, -200]\nmax_mm = [300, 200, 500]\n", "min_mm"},
      {"[tip_box]\nmin = [-300, -200, -100]\nmax_mm = [300, 200, 500]\n", "min"},
      {"[tip_box]\nmin_mm = [200, -200, -100]\nmax_mm = [300, 200, 500]\n", "at home"},
      {whole + "[[position]]\nname = \"far\"\njoints = [350, 0, 0, 0, 0]\n",
       "the tip in the tip box"},
  };
  for (const auto& one : kCases) {
    EXPECT_NE(refusal_of_tip_box(one.section).find(one.reason), std::string::npos)
        << one.section << refusal_of_tip_box(one.section);
  }
}

}  // namespace
}  // namespace meridian::config
