// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/keep_out_file.hpp"

#include <gtest/gtest.h>

#include <string>

#include "meridian/units.hpp"
#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/text_file.hpp"

namespace meridian::config {
namespace {

MachineModel machine_with_boxes(const std::string& boxes) {
  const std::string text = test::read_text(MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml");
  return parse_machine(text + "\n" + boxes, "lai.toml");
}

std::string refusal_of_boxes(const std::string& boxes) {
  try {
    (void)machine_with_boxes(boxes);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(KeepOutFile, GivesTheBoxesInHouseUnits) {
  const MachineModel model = machine_with_boxes(
      "[[keep_out]]\nname = \"vice\"\nb3_mm = [100, 200]\ntheta2_deg = [-30, 30]\n"
      "[[keep_out]]\nname = \"probe\"\nb4_mm = [-500, -400]\n");
  const auto boxes = model.keep_out.boxes();
  ASSERT_EQ(boxes.size(), 2U);
  EXPECT_EQ(boxes[0].joints, 0b10001U);
  EXPECT_EQ(boxes[0].min[0], 100);
  EXPECT_EQ(boxes[0].max[0], 200);
  EXPECT_DOUBLE_EQ(boxes[0].min[4], units::rad_from_deg(-30));
  EXPECT_STREQ(model.keep_out.name_of(1), "probe");
  EXPECT_EQ(boxes[1].joints, 0b00100U);
  EXPECT_TRUE(machine_with_boxes("").keep_out.empty());
}

TEST(KeepOutFile, RefusesBoxesThatMeanNothingAndSaysWhy) {
  const struct {
    const char* boxes;
    const char* reason;
  } kCases[] = {
      {"[[keep_out]]\nb3_mm = [100, 200]\n", "name"},
      {"[[keep_out]]\nname = \"vice\"\n", "at least one joint"},
      {"[[keep_out]]\nname = \"vice\"\nb3_mm = [200, 100]\n", "minimum below maximum"},
      {"[[keep_out]]\nname = \"vice\"\nb3_deg = [100, 200]\n", "b3_deg"},
      {"[[keep_out]]\nname = \"vice\"\nX_mm = [100, 200]\n", "X_mm"},
      {"[[keep_out]]\nname = \"a name that is longer than this\"\nb3_mm = [1, 2]\n", "23"},
      {"[[keep_out]]\nname = \"vice\"\nb3_mm = [100, 200]\n"
       "[[keep_out]]\nname = \"vice\"\nb3_mm = [300, 400]\n",
       "a name of its own"},
      {"[[keep_out]]\nname = \"vice\"\nb3_mm = [-100, 100]\n", "home"},
      {"[[keep_out]]\nname = \"vice\"\nb3_mm = [100, 200]\n"
       "[[position]]\nname = \"inside\"\njoints = [150, 0, 0, 0, 0]\n",
       "outside of the keep-out box vice"},
  };
  for (const auto& one : kCases) {
    EXPECT_NE(refusal_of_boxes(one.boxes).find(one.reason), std::string::npos)
        << one.boxes << refusal_of_boxes(one.boxes);
  }
}

TEST(KeepOutFile, HoldsEightBoxesAndNoMore) {
  std::string boxes;
  for (int n = 0; n <= KeepOut::kMax; ++n) {
    EXPECT_EQ(refusal_of_boxes(boxes), "");
    boxes += "[[keep_out]]\nname = \"box " + std::to_string(n) + "\"\nb3_mm = [100, 200]\n";
  }
  EXPECT_NE(refusal_of_boxes(boxes).find("at most 8 boxes"), std::string::npos);
}

}  // namespace
}  // namespace meridian::config
