// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/tools_sum.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace meridian::stream {
namespace {

Tool whole_tool() {
  Tool tool{4, 110, 5};
  tool.corner_radius_mm = 1;
  tool.length_wear_mm = -0.02;
  tool.radius_wear_mm = -0.01;
  tool.holder_mm = {{0, 31.5}, {60, 20}};
  return tool;
}

TEST(ToolsSum, DistinguishesTablesByAllThatTheySay) {
  const std::uint64_t sum = tools_sum(ToolTable({whole_tool()}));
  EXPECT_NE(sum, 0U);
  EXPECT_EQ(tools_sum(ToolTable({whole_tool()})), sum);
  EXPECT_NE(tools_sum(ToolTable()), 0U);
  EXPECT_NE(tools_sum(ToolTable()), sum);
  const std::vector<std::function<void(Tool&)>> changes{
      [](Tool& tool) { ++tool.number; },
      [](Tool& tool) { tool.length_mm += 1e-12; },
      [](Tool& tool) { tool.radius_mm += 1e-12; },
      [](Tool& tool) { tool.corner_radius_mm = 0; },
      [](Tool& tool) { tool.length_wear_mm = 0; },
      [](Tool& tool) { tool.radius_wear_mm = 0; },
      [](Tool& tool) { tool.holder_mm.pop_back(); },
      [](Tool& tool) { tool.holder_mm.back()[1] = 21; },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Tool tool = whole_tool();
    changes[i](tool);
    EXPECT_NE(tools_sum(ToolTable({tool})), sum) << i;
  }
}

}  // namespace
}  // namespace meridian::stream
