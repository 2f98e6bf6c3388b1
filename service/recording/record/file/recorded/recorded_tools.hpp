// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "meridian/kinematics/tool_table.hpp"

namespace meridian::record {

/// A row of the events beside a recording: `cycle,tool,number,length,radius` in mm, wear included.
/// The rows of one cycle are the whole tool table that is in force from it on; one of number 0
/// stands for a table without tools.
inline constexpr std::string_view kToolWord = "tool";

struct RecordedTool {
  std::uint64_t cycle = 0;
  int number = 0;
  double length_mm = 0;  ///< Tool::tip_length_mm()
  double radius_mm = 0;  ///< Tool::cutting_radius_mm()
  [[nodiscard]] bool operator==(const RecordedTool&) const = default;
};

/// The tool of one row; nothing where it is another row, or holds anything else.
[[nodiscard]] std::optional<RecordedTool> read_tool(std::string_view row);
/// Whether a row is one of a tool, whatever else it holds.
[[nodiscard]] bool is_tool_row(std::string_view row);

/// The tool table that was in force when the first program of these events was started, or at
/// their end where none was; nothing where no row holds one.
/// Proof: tests/unit/record/recorded_tools_test.cpp.
[[nodiscard]] std::optional<ToolTable> find_recorded_tools(std::string_view events);

/// How long the tool was that was in the spindle when the first program of these events was
/// planned; nothing where that is not recorded.
[[nodiscard]] std::optional<double> find_recorded_tool_length(std::string_view events);

}  // namespace meridian::record
