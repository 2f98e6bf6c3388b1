// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/operator/tool_options.hpp"

#include <gtest/gtest.h>

#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/protocol/tools_sum.hpp"
#include "support/text_file.hpp"

namespace meridian::cli {
namespace {

constexpr const char* kTable =
    "# of the magazine\n[[tool]]\nnumber = 1\nlength_mm = 110\nradius_mm = 5\n"
    "[[tool]]\nnumber = 2\nlength_mm = 95\nradius_mm = 3\ncorner_radius_mm = 0.5\n";

dds::MachineInfo machine_with(const std::string& tools) {
  dds::MachineInfo machine;
  machine.tool_file = tools;
  return machine;
}

ToolTable table_of(const ToolOrder& order) { return config::parse_tools(order.file, "test"); }

TEST(ToolOptions, ChangeWhatTheySayOfThePublishedTable) {
  ToolOptions options;
  options.length_wear = -0.05;
  options.holder = "0,31.5,60,20";
  const auto order = tool_order({"set", "2"}, options, machine_with(kTable));
  ASSERT_TRUE(order);
  EXPECT_EQ(order->tools_seen, stream::tools_sum(config::parse_tools(kTable, "test")));
  const ToolTable tools = table_of(*order);
  ASSERT_EQ(tools.tools().size(), 2U);
  EXPECT_EQ(tools.find(2)->length_mm, 95);
  EXPECT_EQ(tools.find(2)->tip_length_mm(), 95 - 0.05);
  EXPECT_EQ(tools.find(2)->corner_radius_mm, 0.5);
  EXPECT_EQ(tools.find(2)->holder_mm, (std::vector<std::array<double, 2>>{{0, 31.5}, {60, 20}}));
  EXPECT_EQ(*tools.find(1), *config::parse_tools(kTable, "test").find(1));
}

TEST(ToolOptions, AddAToolWithItsLengthAndRadiusAndTakeOneAway) {
  ToolOptions options;
  options.length = 130;
  EXPECT_FALSE(tool_order({"set", "9"}, options, machine_with(kTable))) << "no radius";
  options.radius = 8;
  const auto added = tool_order({"set", "9"}, options, machine_with(kTable));
  ASSERT_TRUE(added);
  EXPECT_EQ(table_of(*added).find(9)->length_mm, 130);
  const auto cleared = tool_order({"clear", "1"}, {}, machine_with(kTable));
  ASSERT_TRUE(cleared);
  EXPECT_EQ(table_of(*cleared).find(1), nullptr);
  const auto empty = tool_order({"clear", "9"}, {}, machine_with(added->file));
  ASSERT_TRUE(empty);
  EXPECT_FALSE(tool_order({"clear", "7"}, {}, machine_with(kTable)));
}

TEST(ToolOptions, OfTheLastToolThatIsTakenAwayLeaveATableAndNotTheServicesOwn) {
  const auto last = tool_order(
      {"clear", "1"}, {}, machine_with("[[tool]]\nnumber = 1\nlength_mm = 110\nradius_mm = 5\n"));
  ASSERT_TRUE(last);
  EXPECT_FALSE(last->file.empty());
  EXPECT_TRUE(table_of(*last).tools().empty());
}

TEST(ToolOptions, LoadAFileToTheLetterOrTheServicesOwn) {
  const test::TextFile file(kTable);
  const auto order = tool_order({"load", file.path()}, {}, machine_with(""));
  ASSERT_TRUE(order);
  EXPECT_EQ(order->file, kTable);
  EXPECT_EQ(order->tools_seen, 0U);
  const auto own = tool_order({"load"}, {}, machine_with(kTable));
  ASSERT_TRUE(own);
  EXPECT_TRUE(own->file.empty());
}

TEST(ToolOptions, RefuseWhatIsNone) {
  ToolOptions length;
  length.length = 100;
  const auto machine = machine_with(kTable);
  EXPECT_FALSE(tool_order({}, {}, machine));
  EXPECT_FALSE(tool_order({"turn", "1"}, {}, machine));
  EXPECT_FALSE(tool_order({"set"}, length, machine));
  EXPECT_FALSE(tool_order({"set", "1"}, {}, machine));
  EXPECT_FALSE(tool_order({"clear", "1"}, length, machine));
  for (const char* number : {"x", "", "-1", "0", "1.5"}) {
    EXPECT_FALSE(tool_order({"set", number}, length, machine)) << number;
  }
  ToolOptions holder;
  for (const char* outline : {"1", "1,2,3", "a,b", "1,2,", "1;2"}) {
    holder.holder = outline;
    EXPECT_FALSE(tool_order({"set", "1"}, holder, machine)) << outline;
  }
  length.length = -3;
  EXPECT_THROW((void)tool_order({"set", "1"}, length, machine), config::ConfigError);
  const test::TextFile longer(std::string(dds::kToolFileBytes, '#') + "\n");
  EXPECT_FALSE(tool_order({"load", longer.path()}, {}, machine));
}

TEST(ToolOptions, ListTheTableWithAMarkAtTheToolInTheSpindle) {
  EXPECT_EQ(tools_text(machine_with(kTable), 2),
            "    1  --length 110 --radius 5\n"
            "*   2  --length 95 --radius 3 --corner-radius 0.5\n");
}

}  // namespace
}  // namespace meridian::cli
