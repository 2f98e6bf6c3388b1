// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "service/machine/file/machine_file.hpp"
#include "service/machine/file/tool_names.hpp"
#include "support/text_file.hpp"

namespace meridian::config {
namespace {

TEST(ToolFile, GivesToolsByNumber) {
  const test::TextFile file(
      "[[tool]]\nnumber = 7\nlength_mm = 90.5\nradius_mm = 3\n"
      "[[tool]]\nnumber = 2\nlength_mm = 110\nradius_mm = 5\n");
  const ToolTable tools = load_tools(file.path());
  ASSERT_NE(tools.find(7), nullptr);
  EXPECT_EQ(tools.find(7)->length_mm, 90.5);
  EXPECT_EQ(tools.find(2)->radius_mm, 5);
  EXPECT_EQ(tools.find(3), nullptr);
  EXPECT_EQ(tools.find(8), nullptr);
}

TEST(ToolFile, MayBeEmpty) {
  const test::TextFile file("# no tools\n");
  EXPECT_EQ(load_tools(file.path()).find(1), nullptr);
}

TEST(ToolFile, ThatIsShippedHasTheToolOfTheLaiMachine) {
  const ToolTable tools = load_tools(MERIDIAN_SOURCE_DIR "/deploy/tools.toml");
  const MachineModel lai = load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml");
  ASSERT_NE(tools.find(1), nullptr);
  EXPECT_EQ(tools.find(1)->length_mm, lai.tool_length_mm);
}

TEST(ToolFile, GivesWearCornerAndHolder) {
  const test::TextFile file(
      "[[tool]]\nnumber = 7\nlength_mm = 90.5\nradius_mm = 3\ncorner_radius_mm = 0.5\n"
      "length_wear_mm = -0.25\nradius_wear_mm = 0.5\nholder_mm = [0, 31.5, 60, 20]\n");
  const ToolTable tools = load_tools(file.path());
  ASSERT_NE(tools.find(7), nullptr);
  const Tool& tool = *tools.find(7);
  EXPECT_EQ(tool.tip_length_mm(), 90.25);
  EXPECT_EQ(tool.cutting_radius_mm(), 3.5);
  EXPECT_EQ(tool.corner_radius_mm, 0.5);
  EXPECT_EQ(tool.holder_mm, (std::vector<std::array<double, 2>>{{0, 31.5}, {60, 20}}));
}

TEST(ToolFile, ComesBackBitForBitFromItsText) {
  Tool whole{999'999'999, 100.0 / 3.0, 1.0 / 7.0};
  whole.corner_radius_mm = 1e-17;
  whole.length_wear_mm = -2.0 / 3.0;
  whole.radius_wear_mm = 1e-3;
  whole.holder_mm = {{0, 31.5}, {1.0 / 3.0, 20}};
  const ToolTable tools({whole, {1, 0, 0}});
  EXPECT_EQ(parse_tools(to_text(tools), "test"), tools);
  EXPECT_EQ(parse_tools(to_text(ToolTable()), "test"), ToolTable());
}

struct ToolMistake {
  const char* text;
  int line;
  const char* key;
  const char* allowed;
};

TEST(ToolFile, ThatIsWrongIsRefusedWithLineAndKey) {
  const ToolMistake mistakes[] = {
      {"[[tool]]\nnumber = 1\nlength_mm = -1\nradius_mm = 1\n", 3, "tool[0].length_mm",
       "0 to 10000"},
      {"[[tool]]\nnumber = 0\nlength_mm = 1\nradius_mm = 1\n", 2, "tool[0].number", "1 to"},
      {"[[tool]]\nnumber = 1.5\nlength_mm = 1\nradius_mm = 1\n", 2, "tool[0].number", "whole"},
      {"[[tool]]\nnumber = 1\nlength_mm = 1\n", 1, "tool[0].radius_mm", "0 to 1000"},
      {"[[tool]]\nnumber = 1\nlength_mm = 1\nradius_mm = 1\nlength = 1\n", 5, "tool[0].length",
       "length_mm"},
      {"[[tool]]\nnumber = 1\nlength_mm = 1\nradius_mm = 1\n"
       "[[tool]]\nnumber = 1\nlength_mm = 1\nradius_mm = 1\n",
       6, "tool[1].number", "once"},
      {"[[tool]]\nnumber = 1\nlength_mm = 1\nradius_mm = 1\ncorner_radius_mm = 2\n", 5,
       "tool[0].corner_radius_mm", "0 to 1"},
      {"[[tool]]\nnumber = 1\nlength_mm = 1\nradius_mm = 1\nlength_wear_mm = -2\n", 5,
       "tool[0].length_wear_mm", "tool that is left"},
      {"[[tool]]\nnumber = 1\nlength_mm = 1\nradius_mm = 1\nradius_wear_mm = -2\n", 5,
       "tool[0].radius_wear_mm", "tool that is left"},
      {"[[tool]]\nnumber = 1\nlength_mm = 1\nradius_mm = 1\nholder_mm = [1, 2, 3]\n", 5,
       "tool[0].holder_mm", "pairs"},
      {"[[tool]]\nnumber = 1\nlength_mm = 1\nradius_mm = 1\nholder_mm = [5, 2, 3, 2]\n", 5,
       "tool[0].holder_mm", "goes down"},
      {"[tool]\nnumber = 1\n", 1, "tool", "array of tables"},
      {"[[tools]]\nnumber = 1\n", 1, "tools", "tool"},
  };
  for (const ToolMistake& mistake : mistakes) {
    const test::TextFile file(mistake.text);
    try {
      (void)load_tools(file.path());
      ADD_FAILURE() << "accepted:\n" << mistake.text;
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.fault().line, mistake.line) << error.what();
      EXPECT_EQ(error.fault().key, mistake.key) << error.what();
      EXPECT_NE(error.fault().allowed.find(mistake.allowed), std::string::npos) << error.what();
      EXPECT_FALSE(error.fault().remedy.empty()) << error.what();
    }
  }
}

TEST(ToolFile, GivesNumbersByName) {
  const std::string text =
      "[[tool]]\nnumber = 7\nlength_mm = 100\nradius_mm = 5\nname = \"Mill_d10\"\n"
      "[[tool]]\nnumber = 8\nlength_mm = 90\nradius_mm = 3\n";
  EXPECT_EQ(parse_tool_names(text, "tools.toml"),
            (std::map<std::string, std::uint32_t>{{"MILL_D10", 7}}));
  EXPECT_EQ(parse_tools(text, "tools.toml").tools().size(), 2U);
  EXPECT_THROW((void)parse_tool_names(text + "name = \"MILL_D10\"\n", "tools.toml"), ConfigError);
}

}  // namespace
}  // namespace meridian::config
